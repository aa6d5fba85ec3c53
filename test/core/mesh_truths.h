/** \file
 * Facts about meshes and samples that the tests compute in the plainest way. */
#pragma once

#include "pcl_surflet/core/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace pcl_surflet {
namespace test {

using D3 = std::array<double, 3>;

inline D3
vertexOf(const TriangleMesh& mesh, std::uint32_t i)
{
  return {mesh.vertices[i][0], mesh.vertices[i][1], mesh.vertices[i][2]};
}

inline D3
crossOf(const D3& a, const D3& b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double
dotOf(const D3& a, const D3& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** \brief Volume by the divergence theorem; positive where the faces look outwards. */
inline double
volumeOf(const TriangleMesh& mesh)
{
  double sixfold = 0;
  for (const auto& t : mesh.triangles)
    sixfold += dotOf(vertexOf(mesh, t[0]), crossOf(vertexOf(mesh, t[1]), vertexOf(mesh, t[2])));
  return sixfold / 6;
}

inline double
longestEdgeOf(const TriangleMesh& mesh)
{
  double longest = 0;
  for (const auto& t : mesh.triangles)
    for (int e = 0; e < 3; ++e) {
      const D3 a = vertexOf(mesh, t[e]), b = vertexOf(mesh, t[(e + 1) % 3]);
      longest = std::max(longest, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    }
  return longest;
}

/** \brief Number of directed edges without exactly one partner of the other direction: 0 means
 * closed and consistently oriented. */
inline std::size_t
openEdgesOf(const TriangleMesh& mesh)
{
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles)
    for (int e = 0; e < 3; ++e)
      ++edges[{t[e], t[(e + 1) % 3]}];
  std::size_t open = 0;
  for (const auto& [edge, count] : edges) {
    const auto partner = edges.find({edge.second, edge.first});
    open += count != 1 || partner == edges.end() || partner->second != 1;
  }
  return open;
}

/** \brief Smallest distance of two points, by comparing all. */
inline double
smallestDistanceOf(const SurfletSet& s)
{
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < s.size(); ++i)
    for (std::size_t k = i + 1; k < s.size(); ++k) {
      const double x = double(s.x[i]) - s.x[k], y = double(s.y[i]) - s.y[k],
                   z = double(s.z[i]) - s.z[k];
      smallest = std::min(smallest, x * x + y * y + z * z);
    }
  return std::sqrt(smallest);
}

/** \brief Chi-squared statistic of \p counts against shares (which sum to 1). */
inline double
chiSquared(const std::vector<std::size_t>& counts, const std::vector<double>& shares)
{
  double n = 0, sum = 0;
  for (const auto c : counts)
    n += static_cast<double>(c);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double expected = n * shares[i];
    sum += (static_cast<double>(counts[i]) - expected) *
           (static_cast<double>(counts[i]) - expected) / expected;
  }
  return sum;
}

/** \brief The 99.9 % quantile of chi-squared (Wilson and Hilferty's approximation). */
inline double
chiSquaredLimit(std::size_t degrees)
{
  const double k = static_cast<double>(degrees);
  return k * std::pow(1 - 2 / (9 * k) + 3.0902 * std::sqrt(2 / (9 * k)), 3);
}

inline bool
sameSurflets(const SurfletSet& a, const SurfletSet& b)
{
  return a.x == b.x && a.y == b.y && a.z == b.z && a.nx == b.nx && a.ny == b.ny && a.nz == b.nz;
}

} // namespace test
} // namespace pcl_surflet
