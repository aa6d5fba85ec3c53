/** \file
 * Clouds that are awkward for space representations, and searches by definition. */
#pragma once

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/region_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace pcl_surflet {
namespace testing {

struct Cloud {
  std::string name;
  std::vector<Position> points;
  double extent = 1; ///< rough size, to choose radii by
};

inline Cloud
uniformCloud(std::size_t n, double low = 0, double high = 1)
{
  CounterRandom random(n);
  Cloud cloud{"uniform", {}, high - low};
  for (std::size_t i = 0; i < n; ++i)
    cloud.points.push_back({float(random.uniform(low, high)), float(random.uniform(low, high)),
                            float(random.uniform(low, high))});
  return cloud;
}

inline Cloud
sphereCloud(std::size_t n)
{
  CounterRandom random(2);
  Cloud cloud{"surface", {}, 2};
  for (std::size_t i = 0; i < n; ++i) {
    const double z = random.uniform(-1, 1), t = random.uniform(0, 2 * M_PI);
    const double r = std::sqrt(1 - z * z);
    cloud.points.push_back({float(r * std::cos(t)), float(r * std::sin(t)), float(z)});
  }
  return cloud;
}

/** \brief Clusters within clusters: scales from 1 down to 1e-7. */
inline Cloud
clusteredCloud(std::size_t n)
{
  CounterRandom random(3);
  Cloud cloud{"clustered", {}, 1};
  for (std::size_t i = 0; i < n; ++i) {
    const double scale = std::pow(10.0, -static_cast<double>(random.below(8)));
    cloud.points.push_back({float(0.3 + scale * random.uniform(-0.5, 0.5)),
                            float(0.4 + scale * random.uniform(-0.5, 0.5)),
                            float(scale * random.uniform(-0.5, 0.5))});
  }
  return cloud;
}

/** \brief \p n points of which each of a few places has many: more than fit into a leaf. */
inline Cloud
duplicateCloud(std::size_t n)
{
  CounterRandom random(4);
  Cloud cloud{"duplicates", {}, 4};
  for (std::size_t i = 0; i < n; ++i)
    cloud.points.push_back(
        {float(random.below(2)), float(random.below(3)), float(random.below(2))});
  return cloud;
}

inline Cloud
transformed(Cloud cloud, std::string name, const Position& scale, const Position& shift)
{
  cloud.name = std::move(name);
  for (auto& p : cloud.points)
    for (int a = 0; a < 3; ++a)
      p[a] = p[a] * scale[a] + shift[a];
  return cloud;
}

inline std::vector<Cloud>
awkwardClouds(std::size_t n)
{
  const Cloud cube = uniformCloud(n);
  std::vector<Cloud> clouds = {cube, sphereCloud(n), clusteredCloud(n), duplicateCloud(n)};
  clouds.push_back(transformed(cube, "collinear", {1, 0, 0}, {0, 2, 3}));
  clouds.push_back(transformed(cube, "planar", {1, 1, 0}, {0, 0, -1}));
  clouds.push_back(transformed(cube, "offset", {1, 1, 1}, {1e6f, -1e6f, 1e6f}));
  clouds.push_back(transformed(cube, "one place", {0, 0, 0}, {1, 1, 1}));
  clouds.push_back(transformed(cube, "single cell", {1e-6f, 1e-6f, 1e-6f}, {0.5f, 0.5f, 0.5f}));
  clouds.back().extent = 1e-6;
  clouds.push_back(transformed(cube, "huge", {1e15f, 1e15f, 1e15f}, {-5e14f, 0, 0}));
  clouds.back().extent = 1e15;
  clouds.push_back({"empty", {}, 1});
  clouds.push_back({"one point", {{1, 2, 3}}, 1});
  clouds.push_back({"five points", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, 1});
  return clouds;
}

using Hits = std::vector<std::pair<float, PointIndex>>;

/** \brief Region search by definition, ordered by distance, then index. */
inline Hits
bruteForceRegion(const std::vector<Position>& points, const Position& q, double radius)
{
  Hits hits;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float square = squaredDistance(points[i], q);
    if (square <= squaredRadius(radius))
      hits.push_back({square, static_cast<PointIndex>(i)});
  }
  std::sort(hits.begin(), hits.end());
  return hits;
}

inline Hits
toHits(const std::vector<PointIndex>& indices, const std::vector<float>& squares)
{
  Hits hits;
  for (std::size_t i = 0; i < indices.size(); ++i)
    hits.push_back({i < squares.size() ? squares[i] : -1, indices[i]});
  std::sort(hits.begin(), hits.end());
  return hits;
}

inline std::vector<PointIndex>
sortedIndices(const Hits& hits)
{
  std::vector<PointIndex> indices;
  for (const auto& hit : hits)
    indices.push_back(hit.second);
  std::sort(indices.begin(), indices.end());
  return indices;
}

/** \brief Centres on, near and far from the points, drawn by number. */
inline Position
queryCentre(const Cloud& cloud, CounterRandom& random)
{
  const auto n = static_cast<std::uint32_t>(cloud.points.size());
  Position q = n == 0 ? Position{0, 0, 0} : cloud.points[random.below(n)];
  if (std::isnan(q[0])) // a removed point
    q = {0, 0, 0};
  const double away[] = {0, 0, 0.01, 0.3, 1, 5};
  const double reach = away[random.below(6)] * cloud.extent;
  for (auto& v : q)
    v = static_cast<float>(v + random.uniform(-reach, reach));
  return q;
}

/** \brief Radii from 0 to larger than the cloud; some reach a point exactly. */
inline double
queryRadius(const Cloud& cloud, const Position& q, CounterRandom& random)
{
  const double shares[] = {0, 1e-3, 0.01, 0.05, 0.1, 0.3, 0.7, 2, 20};
  const auto pick = random.below(10);
  if (pick < 9)
    return shares[pick] * cloud.extent;
  if (cloud.points.empty())
    return 1;
  const auto i = random.below(static_cast<std::uint32_t>(cloud.points.size()));
  const double distance = std::sqrt(static_cast<double>(squaredDistance(cloud.points[i], q)));
  return std::isnan(distance) ? cloud.extent / 2 : distance;
}

/** \brief Every search of \p index equals its definition on \p points; removed points are those
 * whose first coordinate is NaN. */
void expectEqualsBruteForce(const RegionIndex& index, const Cloud& cloud, int queries,
                            std::uint64_t seed);

} // namespace testing
} // namespace pcl_surflet
