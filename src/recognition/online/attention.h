/** \file
 * Where more data would decide, and what nothing explains; internal, not installed. */
#pragma once

#include "cells.h"

#include "pcl_surflet/recognition/online_interpretation.h"

#include <functional>
#include <memory>

namespace pcl_surflet {
namespace online {

/** \brief Where some cells are and whereto they look. */
struct Patch {
  Place centre{}, normal{};
  double radius = 0;
};

Patch patchOf(const SurfletSet& cells, const Indices& indices);

/** \param id of the detection in doubt, or 0 */
Attractor attractorAt(const Patch& patch, std::uint64_t id);

/** \brief Neighbouring cells that nothing explains, ascending. */
struct Group {
  Indices cells;
  CellKey low{}, high{}; ///< of the cells
  Patch patch;
};

/** \brief Does nothing explain this cell, which takes part? */
using IsOpen = std::function<bool(std::uint32_t cell)>;

/** \brief Groups that stay when scans change little. */
using Groups = std::vector<std::shared_ptr<const Group>>;

/** \brief The groups after \p changed cells have changed: come, gone, been explained or lost their
 * explanation. Groups that none of them touches stay; what is wider than \p widest is none.
 *
 * The result is as if all groups were sought afresh, at the cost of what lies within \p widest of a
 * change. By the least cell, ascending. */
Groups regrouped(const OnlineCells& cells, const Groups& before,
                 const std::vector<CellKey>& changed, double leaf, double widest,
                 const IsOpen& is_open);

} // namespace online
} // namespace pcl_surflet
