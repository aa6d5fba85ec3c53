#include "pcl_surflet/core/conditions.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace pcl_surflet {
namespace {

using Vec3 = std::array<double, 3>;

/** \brief A direction, uniform on the unit sphere. */
Vec3
randomDirection(CounterRandom& random)
{
  const double z = random.uniform(-1, 1), t = random.uniform(0, 2 * M_PI);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(t), r * std::sin(t), z};
}

/** \brief Rotation of the uniformly random unit quaternion (Shoemake). */
std::array<Vec3, 3>
randomRotation(CounterRandom& random)
{
  const double u = random.uniform(), s = random.uniform(0, 2 * M_PI),
               t = random.uniform(0, 2 * M_PI);
  const double a = std::sqrt(1 - u), b = std::sqrt(u);
  const double x = a * std::sin(s), y = a * std::cos(s), z = b * std::sin(t), w = b * std::cos(t);
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
           {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
           {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
}

double
dot(const Vec3& a, double x, double y, double z)
{
  return a[0] * x + a[1] * y + a[2] * z;
}

} // namespace

SurfletSet
randomlyRotated(const SurfletSet& set, std::uint64_t seed)
{
  CounterRandom random(seed);
  const auto r = randomRotation(random);
  SurfletSet out;
  out.reserve(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Surflet s = set[i];
    const auto turned = [&](std::size_t k, double x, double y, double z) {
      return static_cast<float>(dot(r[k], x, y, z));
    };
    out.push_back({turned(0, s.x, s.y, s.z), turned(1, s.x, s.y, s.z), turned(2, s.x, s.y, s.z),
                   turned(0, s.nx, s.ny, s.nz), turned(1, s.nx, s.ny, s.nz),
                   turned(2, s.nx, s.ny, s.nz)});
  }
  return out;
}

SurfletSet
displacedAlongNormals(const SurfletSet& set, double amplitude, std::uint64_t seed)
{
  CounterRandom random(seed);
  SurfletSet out = set;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double d = random.uniform(-amplitude, amplitude);
    out.x[i] = static_cast<float>(set.x[i] + d * set.nx[i]);
    out.y[i] = static_cast<float>(set.y[i] + d * set.ny[i]);
    out.z[i] = static_cast<float>(set.z[i] + d * set.nz[i]);
  }
  return out;
}

SurfletSet
cutByRandomPlane(const SurfletSet& set, double visible, std::uint64_t seed)
{
  if (!(visible > 0 && visible <= 1))
    throw std::invalid_argument("pcl_surflet: the visible share must be in (0, 1]");
  if (set.empty())
    return set;
  CounterRandom random(seed);
  const Vec3 normal = randomDirection(random);
  std::vector<std::pair<double, std::uint32_t>> heights(set.size());
  for (std::size_t i = 0; i < set.size(); ++i)
    heights[i] = {dot(normal, set.x[i], set.y[i], set.z[i]), static_cast<std::uint32_t>(i)};
  const auto wanted =
      static_cast<std::size_t>(std::lround(visible * static_cast<double>(set.size())));
  const auto kept = std::clamp<std::size_t>(wanted, 1, set.size());
  std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(kept - 1),
                   heights.end());
  std::vector<std::uint32_t> indices;
  for (std::size_t k = 0; k < kept; ++k)
    indices.push_back(heights[k].second);
  std::sort(indices.begin(), indices.end());
  return set.subset(indices);
}

TriangleMesh
scaledToDiameter(const TriangleMesh& mesh, double diameter)
{
  SurfletSet vertices;
  for (const auto& v : mesh.vertices)
    vertices.push_back({v[0], v[1], v[2], 0, 0, 1});
  const double factor = diameter / farthestDistance(vertices);
  if (!std::isfinite(factor))
    throw std::invalid_argument("pcl_surflet: a mesh without extent cannot be scaled");
  TriangleMesh out = mesh;
  for (auto& v : out.vertices)
    for (float& c : v)
      c = static_cast<float>(c * factor);
  return out;
}

} // namespace pcl_surflet
