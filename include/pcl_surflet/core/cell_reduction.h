/** \file
 * The bucket concept: a surflet set reduced to one mean surflet per atomic cell. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_surflet {

/** \brief What reduceToCells() yields. */
struct CellReduction {
  /** \brief Mark in cell_of of a surflet that belongs to no cell of the result. */
  static constexpr std::uint32_t no_cell = 0xffffffffu;

  SurfletSet cells;                  ///< one mean surflet per cell, in the order of the cells' keys
  std::vector<std::uint32_t> counts; ///< surflets per cell, parallel to cells
  std::vector<std::uint32_t> cell_of; ///< cell of each input surflet, or no_cell
  std::size_t rejected = 0;           ///< input surflets that are not finite
  std::size_t cancelled_cells = 0;    ///< cells left out because their normals cancel
  std::size_t cancelled_surflets = 0; ///< surflets in those cells
};

/** \brief Parameters of reduceToCells(). */
struct CellReductionOptions {
  /** \brief Edge of an atomic cell in the unit of the coordinates; positive and finite. */
  double leaf = 0;
  /** \brief Cells whose mean normal (before it is scaled to unit length) is shorter than this are
   * left out, in [0, 1].
   *
   * 1 means that all normals agree; a right-angled edge cut in the middle gives 0.71, a cube's
   * corner 0.58, a thin wall seen from both sides 0. Below 0.1 the direction is an accident of how
   * many points fell on either side. */
  double min_mean_normal = 0.1;
  /** \brief Cells whose mean normal is shorter than this become two, one for the surflets on each
   * side of a wall, in [0, 1]; 0: none.
   *
   * A wall thinner than a cell, seen from both sides, has no mean surflet: its normals cancel. What
   * is left of it depends on where the grid happens to cut it. Not in the dissertation. */
  double split_below = 0;
};

/** \brief CellReductionOptions::split_below that parts walls and leaves edges and corners alone. */
constexpr double kTwoSided = 0.4;

/** \brief Reduces \p set to the mean surflet of every occupied cell [Wahl 2007, Sec. 4.3.1].
 *
 * Cells are cubes with corners at multiples of the leaf size, so the result does not depend on
 * what else the set contains. The mean surflet has the mean position and the mean normal scaled to
 * unit length; CellReductionOptions::split_below makes two of a cell with opposite sides. Sums run
 * in double precision in the order of the set. Surflets with a non-finite coordinate or normal
 * belong to no cell; a zero normal adds its position only.
 *
 * Linear time: 20 to 30 ns a surflet. The result depends on nothing but the input.
 * \throws std::invalid_argument if the leaf is not positive and finite or so small that the set
 * spans more than 2^53 cells along an axis, or if min_mean_normal is outside [0, 1] */
PCL_SURFLET_API CellReduction reduceToCells(const SurfletSet& set,
                                            const CellReductionOptions& options);

/** \brief reduceToCells() with cells of edge \p leaf and the default options. */
PCL_SURFLET_API CellReduction reduceToCells(const SurfletSet& set, double leaf);

/** \brief The same but for thin walls, which become two cells (kTwoSided): what
 * interpretByExplanation() and trainForScenes() want. */
PCL_SURFLET_API CellReduction reduceToTwoSidedCells(const SurfletSet& set, double leaf);

} // namespace pcl_surflet
