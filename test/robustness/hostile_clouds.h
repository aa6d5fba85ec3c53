/** \file
 * Clouds that nobody should have, for every class that takes clouds. */
#pragma once

#include "pcl_surflet/core/counter_random.h"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace test {

using HostileCloud = pcl::PointCloud<pcl::PointNormal>;

struct NamedCloud {
  std::string name;
  HostileCloud::Ptr cloud;
};

/** \brief \p n points of the unit ball's surface, reproducible. */
inline HostileCloud::Ptr
unitBall(std::size_t n)
{
  auto cloud = pcl::make_shared<HostileCloud>();
  CounterRandom random(1);
  for (std::size_t i = 0; i < n; ++i) {
    const double z = random.uniform(-1, 1), angle = random.uniform(0, 2 * M_PI);
    const double r = std::sqrt(1 - z * z);
    const auto x = static_cast<float>(r * std::cos(angle)),
               y = static_cast<float>(r * std::sin(angle));
    const auto up = static_cast<float>(z);
    cloud->push_back(pcl::PointNormal(x, y, up, x, y, up));
  }
  return cloud;
}

/** \brief The unit ball, every point spoilt by \p spoil. */
inline NamedCloud
spoilt(const std::string& name, const std::function<void(std::size_t, pcl::PointNormal&)>& spoil,
       std::size_t n = 300)
{
  NamedCloud out{name, unitBall(n)};
  for (std::size_t i = 0; i < n; ++i)
    spoil(i, (*out.cloud)[i]);
  out.cloud->is_dense = false;
  return out;
}

inline void
scale(pcl::PointNormal& p, float factor)
{
  p.getVector3fMap() *= factor;
}

inline std::vector<NamedCloud>
hostileCoordinates()
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float inf = std::numeric_limits<float>::infinity();
  using Point = pcl::PointNormal;
  return {
      {"empty", unitBall(0)},
      {"one point", unitBall(1)},
      {"two points", unitBall(2)},
      {"three points", unitBall(3)},
      spoilt("all NaN", [](auto, Point& p) { p.x = p.y = p.z = nan; }),
      spoilt("some Inf", [](auto i, Point& p) { p.y = i % 3 == 0 ? (i % 2 ? inf : -inf) : p.y; }),
      spoilt("1e30", [](auto, Point& p) { scale(p, 1e30F); }),
      spoilt("the largest", [](auto, Point& p) { scale(p, 3e38F); }),
      spoilt("one at 1e30", [](auto i, Point& p) { p.x = i == 7 ? 1e30F : p.x; }),
      spoilt("far from the origin", [](auto, Point& p) { p.x += 1e7F; }),
      spoilt("1e-30", [](auto, Point& p) { scale(p, 1e-30F); }),
      spoilt("denormal", [](auto, Point& p) { scale(p, 1e-40F); }),
      spoilt("identical", [](auto, Point& p) { p.x = p.y = p.z = 1; }),
      spoilt("collinear", [](auto, Point& p) { p.y = p.z = 0; }),
      spoilt("coplanar", [](auto, Point& p) { p.z = 0; }),
  };
}

inline std::vector<NamedCloud>
hostileNormals()
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  using Point = pcl::PointNormal;
  const auto normals = [](Point& p, float factor) { p.getNormalVector3fMap() *= factor; };
  return {
      spoilt("normals of length 0", [&](auto, Point& p) { normals(p, 0); }),
      spoilt("normals of length 1e-20", [&](auto, Point& p) { normals(p, 1e-20F); }),
      spoilt("normals of length 1e-42", [&](auto, Point& p) { normals(p, 1e-42F); }),
      spoilt("normals of length 1e30", [&](auto, Point& p) { normals(p, 1e30F); }),
      spoilt("normals of any length", [&](auto i, Point& p) { normals(p, static_cast<float>(i)); }),
      spoilt("NaN normals", [](auto, Point& p) { p.normal_x = nan; }),
      spoilt("one usable normal", [](auto i, Point& p) { p.normal_x = i == 5 ? p.normal_x : nan; }),
      spoilt("equal normals", [](auto, Point& p) { p.getNormalVector3fMap() << 0, 0, 1; }),
  };
}

/** \brief All of them, the last as an organised cloud with holes. */
inline std::vector<NamedCloud>
hostileClouds()
{
  auto all = hostileCoordinates();
  const auto normals = hostileNormals();
  all.insert(all.end(), normals.begin(), normals.end());
  all.push_back(spoilt("organised with holes", [](auto i, pcl::PointNormal& p) {
    if (i % 4 == 0)
      p.x = p.y = p.z = std::numeric_limits<float>::quiet_NaN();
  }));
  all.back().cloud->width = 20;
  all.back().cloud->height = 15;
  return all;
}

} // namespace test
} // namespace pcl_surflet
