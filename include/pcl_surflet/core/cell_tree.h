/** \file
 * Dynamic space representation of one cube: what the octree and the balanced tree have in common.
 */
#pragma once

#include "pcl_surflet/core/region_index.h"
#include "pcl_surflet/core/surflet_set.h"

#include <functional>
#include <memory>

namespace pcl_surflet {

/** \brief An occupied atomic cell: its mean surflet and how many points it stands for
 * [Wahl 2007, Sec. 4.3.1]. */
struct Cell {
  Surflet mean; ///< the normal is zero where there is none or where normals cancel exactly
  /** \brief Length of the mean of the normals, in [0, 1]: near 0 the direction means nothing. */
  float normal_agreement = 0;
  std::uint32_t count = 0; ///< points it stands for, >= 1
};

/** \brief The cube that a tree subdivides [Wahl 2007, Eq. 4.2]. */
struct PCL_SURFLET_API CubeFrame {
  std::array<double, 3> corner{0, 0, 0}; ///< lowest corner
  double edge = 1;                       ///< e0 > 0
  int depth = 8;                         ///< d_max in [0, 63]; atomic cells have edge e0 / 2^d_max

  /** \brief Whole numbers of a cell along x, y, z, each in [0, 2^depth). */
  using Coordinates = std::array<std::uint64_t, 3>;

  /** \brief Edge of a cell on level \p d. */
  double edgeAt(int d) const;

  /** \brief Coordinates of the atomic cell of a position [Wahl 2007, Eq. 4.3]. Monotone in each
   * coordinate; positions outside the cube count to its outermost cells. */
  Coordinates coordinates(const std::array<double, 3>& p) const;
};

/** \brief Which dynamic tree. */
enum class TreeKind { Octree, AVL };

/** \brief A tree of the occupied atomic cells of one cube, each with its points and their mean
 * surflet (the bucket concept). Points come and go one at a time, in any order.
 *
 * Mean surflets are kept as integer sums (fractions of 2^-30 of the cell edge and of the unit
 * normal), so they depend on the set of points alone, not on the order of additions and removals.
 * Searches are exact on the points, not on the means.
 *
 * Changing and searching at the same time needs a lock; searches alone do not. */
class PCL_SURFLET_API CellTree : public RegionIndex {
public:
  /** \brief Adds a point known to the user as \p id. A normal that is not finite counts as none.
   * The position must be finite; ids need not be unique, but remove() takes the first it meets. */
  virtual void add(PointIndex id, const Surflet& s) = 0;

  /** \brief Takes out what add() put in with the same arguments; false if there is no such point.
   */
  virtual bool remove(PointIndex id, const Surflet& s) = 0;

  /** \brief Number of occupied atomic cells. */
  virtual std::size_t cellCount() const = 0;

  /** \brief Calls \p visit for every occupied cell in the order of the keys. */
  virtual void forEachCell(const std::function<void(const Cell&)>& visit) const = 0;

  /** \brief Region search on the cells: those whose mean position lies in F(r, q). */
  virtual void regionCells(const Position& q, double radius, std::vector<Cell>& cells) const = 0;

  /** \brief The cube that is subdivided. */
  virtual const CubeFrame& frame() const = 0;
};

/** \brief Makes an empty tree: keys of one word down to depth 21, of three words below.
 * \throws std::invalid_argument if the edge is not positive and finite or the depth not in [0, 63]
 */
PCL_SURFLET_API std::unique_ptr<CellTree> makeCellTree(TreeKind kind, const CubeFrame& frame);

/** \brief Where a region search starts: step 1 of ch. 4.4 [Wahl 2007]. */
struct StartCells {
  int depth = 0; ///< d_F: the deepest level with 2 r <= e_dF (4.14, 4.15)
  std::vector<CubeFrame::Coordinates> cells; ///< on that level; that of the centre first (4.16)
};

/** \brief The start cell of F(r, q) and the neighbours that the sphere reaches (4.17-4.19), up to
 * eight in all. Cells outside the cube are left out. */
PCL_SURFLET_API StartCells findStartCells(const CubeFrame& frame, const Position& q, double radius);

} // namespace pcl_surflet
