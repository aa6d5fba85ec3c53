/** \file
 * What a cell gathers; internal, not installed. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace pcl_surflet {
namespace detail {

/** \brief Position and normal sums of one cell. */
struct CellSums {
  double position[3] = {0, 0, 0};
  double normal[3] = {0, 0, 0};
  std::uint32_t count = 0;

  void
  add(const SurfletSet& set, std::size_t i)
  {
    position[0] += set.x[i];
    position[1] += set.y[i];
    position[2] += set.z[i];
    normal[0] += set.nx[i];
    normal[1] += set.ny[i];
    normal[2] += set.nz[i];
    ++count;
  }
  double
  normalLength() const
  {
    return std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  }
};

/** \brief Splits every cell whose mean normal is shorter than \p split_below in two, one behind the
 * other, by the side to which the surflets look: the sign along the axis that their normals have in
 * common. \p cell_of and \p sums are renumbered. */
void splitSides(const SurfletSet& set, double split_below, std::vector<CellSums>& sums,
                std::vector<std::uint32_t>& cell_of);

} // namespace detail
} // namespace pcl_surflet
