/** \file
 * The static space representation: an octree that is nothing but an order of the points. */
#pragma once

#include "pcl_surflet/core/instruction_set.h"
#include "pcl_surflet/core/region_index.h"

#include <memory>

namespace pcl_surflet {

/** \brief Where points lie in memory: coordinates x, y, z of point i at xyz + i * stride. */
struct PointArray {
  const float* x = nullptr; ///< of the first point
  const float* y = nullptr; ///< of the first point
  const float* z = nullptr; ///< of the first point
  std::size_t stride = 1;   ///< in floats, between consecutive points
  std::size_t size = 0;     ///< number of points
};

/** \brief Consecutive places [begin, end) in the order of a LinearOctree. */
struct PlaceRange {
  std::uint32_t begin = 0; ///< first place
  std::uint32_t end = 0;   ///< behind the last one
};

/** \brief Static octree: points sorted by their Morton key, every node a range of them.
 *
 * The keys are those of ch. 4.2 [Wahl 2007]. Where the dissertation descends by prefix and visits
 * all leaves below, here a node also knows the tight boxes of its up to eight children: halves of
 * halves of cells, bottom nodes of up to 192 points with runs of about 16. All eight are tested at
 * once; a node wholly inside the region is copied without tests, one wholly outside is skipped, and
 * only runs on the border are filtered, 8 or 16 points at a time. The points are copied, as
 * structure of arrays: 16 bytes a point, with nodes below 20. Building takes linear time.
 *
 * Cells that are crowded at the depth of a key (10 levels) get keys of their own, so clusters of
 * any scale are resolved. Non-finite points are left out.
 *
 * Tried and rejected: 63-bit keys (twice the sorting passes); nodes split by octal digit down to
 * leaves of 64 to 256 points without boxes for their runs (half as fast from 40 hits up: most of a
 * border leaf is filtered in vain); runs of exactly 16 points wherever cells end (their boxes
 * overlap so much that small queries take twice as long). */
class PCL_SURFLET_API LinearOctree : public RegionIndex {
public:
  /** \brief How it is built; results do not depend on it. */
  struct Options {
    /** \brief Kernels of this octree; there are none for Baseline, which takes the scalar ones, and
     * sets this machine lacks take the next lower. Results do not depend on it. */
    InstructionSet instruction_set = InstructionSet::Automatic;
  };

  LinearOctree();
  ~LinearOctree() override;
  LinearOctree(LinearOctree&&) noexcept;            ///< leaves the other only to be destroyed
  LinearOctree& operator=(LinearOctree&&) noexcept; ///< leaves the other only to be destroyed

  /** \brief Replaces the content by \p points, or by those of them that \p subset names.
   *
   * Results name a point by its number in \p points. The array is not needed afterwards.
   * \throws std::length_error beyond 2^31 - 1 points
   * \throws std::out_of_range if \p subset names a point that does not exist; the octree is then as
   * it was */
  void build(const PointArray& points, const std::vector<PointIndex>* subset = nullptr);

  void setOptions(const Options& options); ///< for the next build()
  const Options& options() const;          ///< those of setOptions()

  std::size_t size() const override;
  std::size_t memoryUsage() const override;
  void regionSearch(const Position& q, double radius, std::vector<PointIndex>& indices,
                    std::vector<float>* sqr_distances) const override;
  void nearestSearch(const Position& q, std::size_t k, std::vector<PointIndex>& indices,
                     std::vector<float>& sqr_distances) const override;
  void boxSearch(const Position& low, const Position& high,
                 std::vector<PointIndex>& indices) const override;

  /** \brief Region search without copying: the ranges of places whose points lie in F(r, q),
   * ascending and not touching. Read points by indexAt() and positionAt(). */
  void regionRanges(const Position& q, double radius, std::vector<PlaceRange>& ranges) const;

  PointIndex indexAt(std::uint32_t place) const;   ///< the user's number of the point at \p place
  Position positionAt(std::uint32_t place) const;  ///< its coordinates
  const PointIndex* indexData() const;             ///< indexAt() as an array of size()
  std::array<const float*, 3> coordinates() const; ///< positionAt() as three arrays of size()

  struct Data; ///< internal

private:
  std::unique_ptr<Data> data_;
};

/** \brief Whether this machine can run kernels of \p set. */
PCL_SURFLET_API bool isSupported(InstructionSet set);

} // namespace pcl_surflet
