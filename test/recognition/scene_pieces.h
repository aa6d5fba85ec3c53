/** \file
 * Scenes put together by hand. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"

#include <cstdint>
#include <numeric>
#include <vector>

namespace pcl_surflet {
namespace test {

inline SurfletSet
shifted(SurfletSet set, float x, float y = 0, float z = 0)
{
  for (std::size_t i = 0; i < set.size(); ++i) {
    set.x[i] += x;
    set.y[i] += y;
    set.z[i] += z;
  }
  return set;
}

/** \brief About the origin. */
inline SurfletSet
scaled(SurfletSet set, float factor)
{
  for (auto* axis : {&set.x, &set.y, &set.z})
    for (float& v : *axis)
      v *= factor;
  return set;
}

inline SurfletSet
together(SurfletSet a, const SurfletSet& b)
{
  for (std::size_t i = 0; i < b.size(); ++i)
    a.push_back(b[i]);
  return a;
}

/** \brief What looks to (\p x, \p y, 0), a unit vector, by at least this cosine. */
inline SurfletSet
facing(const SurfletSet& set, double x, double y, double cosine = 0.2)
{
  SurfletSet part;
  for (std::size_t i = 0; i < set.size(); ++i)
    if (x * set.nx[i] + y * set.ny[i] > cosine)
      part.push_back(set[i]);
  return part;
}

/** \brief begin, begin + 1, ..., end - 1. */
inline std::vector<std::uint32_t>
range(std::uint32_t begin, std::uint32_t end)
{
  std::vector<std::uint32_t> out(end - begin);
  std::iota(out.begin(), out.end(), begin);
  return out;
}

} // namespace test
} // namespace pcl_surflet
