/** \file
 * One search over points, whichever representation holds them. */
#pragma once

#include "pcl_surflet/core/linear_octree.h"
#include "pcl_surflet/core/unrestricted_space.h"

namespace pcl_surflet {

/** \brief How space is represented; see doc/space.md for the choice. */
enum class SpaceBackend { Octree, AVL, Linear };

/** \brief A search of PCL's kind on any backend: sorted or not, bounded in number, in batches.
 *
 * Const calls may run in several threads at once. */
class PCL_SURFLET_API SpaceSearch {
public:
  /** \brief What is built, and how. */
  struct Options {
    SpaceBackend backend = SpaceBackend::Linear; ///< the representation
    double cell = 0; ///< edge of an atomic cell (dynamic backends); 0: about 32 points per cell
    int depth = 8;   ///< d_max of a cube (dynamic backends), in [0, 63]
    unsigned threads = 1; ///< for batches and for searches across cubes; 0 = all of the machine
    LinearOctree::Options linear; ///< of the static backend
  };

  SpaceSearch();
  /** \brief Empty. \throws std::invalid_argument for options out of range */
  explicit SpaceSearch(const Options& options);
  ~SpaceSearch();
  SpaceSearch(SpaceSearch&&) noexcept;            ///< leaves the other only to be destroyed
  SpaceSearch& operator=(SpaceSearch&&) noexcept; ///< leaves the other only to be destroyed

  /** \brief Replaces the content; \p normals (x = nullptr: none) serve the mean surflets of the
   * dynamic backends. Non-finite points are left out.
   * \throws std::invalid_argument for options out of range, std::out_of_range for a bad subset */
  void build(const Options& options, const PointArray& points, const PointArray& normals,
             const std::vector<PointIndex>* subset);

  /** \brief Adds a batch to a dynamic backend under the numbers \p first, first + 1, ...; several
   * times as fast as adding points one by one in random order. Does nothing with the static one. */
  void addPoints(PointIndex first, const PointArray& points, const PointArray& normals);

  /** \brief Region search.
   * \param[in] q centre; if not finite, nothing is found
   * \param[in] radius inclusive; nothing is found if it is negative or NaN
   * \param[in] sorted ascending by distance, ties by index; without it in no particular order
   * \param[in] max_count at most so many points, the nearest ones; 0: all
   * \param[out] indices the points found, as the user numbers them
   * \param[out] sqr_distances parallel to \p indices
   * \return number of points found */
  std::size_t radiusSearch(const Position& q, double radius, bool sorted, std::size_t max_count,
                           std::vector<PointIndex>& indices,
                           std::vector<float>& sqr_distances) const;

  const RegionIndex& index() const;          ///< never null: an empty LinearOctree at first
  const LinearOctree* linear() const;        ///< null for dynamic backends
  const UnrestrictedSpace* space() const;    ///< null for the static backend
  UnrestrictedSpace* space();                ///< to be changed; null for the static backend
  const Options& options() const;            ///< those of the last build()
  void setNumberOfThreads(unsigned threads); ///< replaces Options::threads; 0: all of the machine

private:
  Options options_;
  std::unique_ptr<LinearOctree> linear_;
  std::unique_ptr<UnrestrictedSpace> space_;
};

/** \brief Edge of a cell that holds about \p per_cell of \p points where there are any, a power-of-
 * two part of their extent; 0.01 if they have none. */
PCL_SURFLET_API double suggestCellSize(const PointArray& points, double per_cell = 32);

} // namespace pcl_surflet
