#include "scene_parts.h"

#include "draw_interval.h"
#include "pcl_surflet/core/counter_random.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace detail {
namespace {

/** \brief Radius of the bowl's sphere, as a share of its opening: the rim is 0.19 openings high. */
constexpr double kBowlRadius = 0.75;

/** \brief Rectangle with a corner at \p origin, spanned by \p a and \p b, seen from its \p normal.
 */
struct Rectangle {
  Vector3 origin, a, b, normal;

  double
  area() const
  {
    return norm(cross(a, b));
  }
};

std::vector<Rectangle>
rectanglesOf(const SceneOptions& o)
{
  const double s = o.size, h = s / 2, w = o.wall_height;
  std::vector<Rectangle> all;
  if (o.background == Background::None || o.background == Background::Bowl)
    return all;
  all.push_back({{-h, -h, 0}, {s, 0, 0}, {0, s, 0}, {0, 0, 1}});
  if (o.background == Background::Plane)
    return all;
  all.push_back({{-h, h, 0}, {s, 0, 0}, {0, 0, w}, {0, -1, 0}});
  if (o.background == Background::Corner)
    return all;
  all.push_back({{-h, -h, 0}, {s, 0, 0}, {0, 0, w}, {0, 1, 0}});
  all.push_back({{-h, -h, 0}, {0, s, 0}, {0, 0, w}, {1, 0, 0}});
  all.push_back({{h, -h, 0}, {0, s, 0}, {0, 0, w}, {-1, 0, 0}});
  return all;
}

double
bowlHeight(const SceneOptions& o, double rho)
{
  const double r = kBowlRadius * o.size;
  return r - std::sqrt(std::max(0.0, r * r - rho * rho));
}

Surflet
surfletAt(const Vector3& p, const Vector3& n)
{
  const auto q = toFloat3(p), m = toFloat3(n);
  return {q[0], q[1], q[2], m[0], m[1], m[2]};
}

/** \brief Uniform by area: on a sphere, uniform in height (Archimedes). */
Surflet
onBowl(const SceneOptions& o, CounterRandom& random)
{
  const double r = kBowlRadius * o.size;
  const double z = random.uniform(0, bowlHeight(o, o.size / 2));
  const double angle = random.uniform(0, 2 * M_PI);
  const double rho = std::sqrt(std::max(0.0, z * (2 * r - z)));
  const Vector3 p{rho * std::cos(angle), rho * std::sin(angle), z};
  return surfletAt(p, scaled(subtract({0, 0, r}, p), 1 / r));
}

/** \brief Two triangles, counter-clockwise seen from the normal's side. */
void
append(TriangleMesh& mesh, const Rectangle& r)
{
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& corner :
       {r.origin, add(r.origin, r.a), add(r.origin, add(r.a, r.b)), add(r.origin, r.b)})
    mesh.vertices.push_back(toFloat3(corner));
  const bool turned = dot(cross(r.a, r.b), r.normal) < 0;
  const std::uint32_t second = first + (turned ? 3 : 1), fourth = first + (turned ? 1 : 3);
  mesh.triangles.push_back({first, second, first + 2});
  mesh.triangles.push_back({first, first + 2, fourth});
}

/** \brief Rings of vertices from the lowest point to the rim, seen from inside. */
TriangleMesh
bowlMesh(const SceneOptions& o)
{
  constexpr std::uint32_t kRings = 64, kSectors = 256; // within 0.1 mm of a bowl of 1 m
  TriangleMesh mesh;
  for (std::uint32_t ring = 0; ring <= kRings; ++ring)
    for (std::uint32_t sector = 0; sector < kSectors; ++sector) {
      const double rho = 0.5 * o.size * ring / kRings, angle = 2 * M_PI * sector / kSectors;
      mesh.vertices.push_back(
          toFloat3({rho * std::cos(angle), rho * std::sin(angle), bowlHeight(o, rho)}));
    }
  for (std::uint32_t ring = 0; ring < kRings; ++ring)
    for (std::uint32_t sector = 0; sector < kSectors; ++sector) {
      const std::uint32_t next = (sector + 1) % kSectors, low = ring * kSectors,
                          high = low + kSectors;
      mesh.triangles.push_back({low + sector, high + sector, high + next});
      mesh.triangles.push_back({low + sector, high + next, low + next});
    }
  return mesh;
}

} // namespace

TriangleMesh
backgroundMesh(const SceneOptions& o)
{
  if (o.background == Background::Bowl)
    return bowlMesh(o);
  TriangleMesh mesh;
  for (const auto& rectangle : rectanglesOf(o))
    append(mesh, rectangle);
  return mesh;
}

double
floorHeight(const SceneOptions& o, double x, double y)
{
  return o.background == Background::Bowl ? bowlHeight(o, std::hypot(x, y)) : 0;
}

double
backgroundArea(const SceneOptions& o)
{
  if (o.background == Background::Bowl)
    return 2 * M_PI * kBowlRadius * o.size * bowlHeight(o, o.size / 2);
  double area = 0;
  for (const auto& rectangle : rectanglesOf(o))
    area += rectangle.area();
  return area;
}

SurfletSet
sampleBackground(const SceneOptions& o, std::size_t n, std::uint64_t seed)
{
  SurfletSet set;
  set.reserve(n);
  CounterRandom random(seed);
  const auto rectangles = rectanglesOf(o);
  std::vector<double> cumulative;
  cumulative.reserve(rectangles.size());
  for (const auto& rectangle : rectangles)
    cumulative.push_back((cumulative.empty() ? 0 : cumulative.back()) + rectangle.area());
  for (std::size_t i = 0; i < n; ++i) {
    if (o.background == Background::Bowl) {
      set.push_back(onBowl(o, random));
      continue;
    }
    const Rectangle& r = rectangles[drawInterval(cumulative, random.uniform())];
    const double a = random.uniform(), b = random.uniform();
    set.push_back(surfletAt(add(r.origin, add(scaled(r.a, a), scaled(r.b, b))), r.normal));
  }
  return set;
}

} // namespace detail
} // namespace pcl_surflet
