/** \file
 * Draws from a discrete distribution; internal, not installed. */
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pcl_surflet {
namespace detail {

/** \brief Number of the interval of ascending \p cumulative sums that \p u in [0, 1) falls into.
 *
 * Empty intervals (sums that do not grow) are never drawn. */
inline std::size_t
drawInterval(const std::vector<double>& cumulative, double u)
{
  const auto it = std::upper_bound(cumulative.begin(), cumulative.end(), u * cumulative.back());
  return std::min(static_cast<std::size_t>(it - cumulative.begin()), cumulative.size() - 1);
}

} // namespace detail
} // namespace pcl_surflet
