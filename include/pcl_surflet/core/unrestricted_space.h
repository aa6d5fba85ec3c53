/** \file
 * Dynamic space representation without bounds: cubes made on demand. */
#pragma once

#include "pcl_surflet/core/cell_tree.h"

#include <map>

namespace pcl_surflet {

/** \brief Super-key of a cube: (floor(x / e0), floor(y / e0), floor(z / e0)), ordered
 * lexicographically [Wahl 2007, Eq. 4.28-4.30].
 *
 * Whole numbers kept as doubles: a float divided by a small e0 exceeds any integer type. */
using SuperKey = std::array<double, 3>;

/** \brief Unrestricted space [Wahl 2007, Sec. 4.5]: a balanced super-tree of cubes, each with a
 * cell tree of its own, made when its first point arrives and dropped with its last.
 *
 * Points may lie anywhere in the float range and may be added and removed at any time; nothing is
 * ever rebuilt. A region search asks every cube the sphere reaches; large ones share the work among
 * threads, and results come in the order of the super-keys whatever their number. */
class PCL_SURFLET_API UnrestrictedSpace : public RegionIndex {
public:
  /** \brief What its cubes are. */
  struct Options {
    TreeKind tree = TreeKind::Octree; ///< of every cube
    double cell = 0.01;   ///< edge of an atomic cell, in the unit of the coordinates, > 0
    int depth = 8;        ///< d_max in [0, 63]: a cube has edge e0 = cell * 2^depth
    unsigned threads = 1; ///< for searches across cubes; 0 = all of the machine
  };

  /** \throws std::invalid_argument if the cell or e0 is not positive and finite, or the depth is
   * out of range */
  explicit UnrestrictedSpace(const Options& options);
  ~UnrestrictedSpace() override;

  /** \brief Adds a point under the number \p id >= 0, which must not be in use. Memory grows with
   * the largest number used.
   * \return false, adding nothing, if a coordinate is not finite or the number is in use */
  bool add(PointIndex id, const Surflet& s);

  /** \brief Adds the points of \p set under the numbers \p first, first + 1, ...
   * \return how many were added */
  std::size_t addBatch(PointIndex first, const SurfletSet& set);

  /** \brief Adds \p n points under the numbers \p ids; fastest in pieces of some hundred whose
   * points are sorted along the Morton curve. \return how many were added */
  std::size_t addBatch(const PointIndex* ids, const Surflet* surflets, std::size_t n);

  /** \brief Makes room for numbers below \p end. */
  void reserve(PointIndex end);

  /** \brief Removes the point with number \p id; false if there is none. */
  bool remove(PointIndex id);

  bool contains(PointIndex id) const; ///< is the number in use?

  const Options& options() const; ///< as constructed, with the threads of setNumberOfThreads()
  void setNumberOfThreads(unsigned threads); ///< replaces Options::threads; 0: all of the machine
  std::size_t cubeCount() const;             ///< cubes that hold a point
  std::size_t cellCount() const;             ///< occupied atomic cells of all cubes

  SuperKey superKey(const Position& p) const; ///< of the cube that \p p lies in, occupied or not

  /** \brief Calls \p visit for every occupied cell, cube by cube in the order of the keys. */
  void forEachCell(const std::function<void(const Cell&)>& visit) const;

  /** \brief Region search on the cells: those whose mean position lies in F(r, q). */
  void regionCells(const Position& q, double radius, std::vector<Cell>& cells) const;

  std::size_t size() const override;
  std::size_t memoryUsage() const override;
  void regionSearch(const Position& q, double radius, std::vector<PointIndex>& indices,
                    std::vector<float>* sqr_distances) const override;
  void nearestSearch(const Position& q, std::size_t k, std::vector<PointIndex>& indices,
                     std::vector<float>& sqr_distances) const override;
  void boxSearch(const Position& low, const Position& high,
                 std::vector<PointIndex>& indices) const override;

private:
  using Cubes = std::map<SuperKey, std::unique_ptr<CellTree>>;

  SuperKey superKeyOf(const std::array<double, 3>& p) const;
  CellTree& cubeAt(const SuperKey& key);
  std::vector<const CellTree*> cubesBetween(const SuperKey& low, const SuperKey& high) const;
  std::vector<const CellTree*> cubesReached(const Position& q, double radius) const;

  Options options_;
  double edge_;
  Cubes cubes_;                 ///< std::map is a balanced binary tree ordered as Eq. 4.28 asks
  std::vector<Surflet> points_; ///< by number; a NaN x marks a number not in use
  std::size_t size_ = 0;
  CellTree* last_cube_ = nullptr; ///< consecutive points mostly share a cube
  SuperKey last_key_{};
};

} // namespace pcl_surflet
