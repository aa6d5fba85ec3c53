/** \file
 * Scenes put together by hand. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"

namespace pcl_surflet {
namespace test {

inline SurfletSet
shifted(SurfletSet set, float x)
{
  for (float& v : set.x)
    v += x;
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

} // namespace test
} // namespace pcl_surflet
