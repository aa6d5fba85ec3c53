#include "draw_interval.h"
#include "shape_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace pcl_surflet {
namespace detail {

namespace {

/** \brief Lattice points of a face of the icosahedron: corners (a, b, c) with weights (i, j, k). */
class GeodesicGrid {
public:
  GeodesicGrid(std::uint32_t frequency, const Vector3& axes) : frequency_(frequency), axes_(axes) {}

  TriangleMesh
  build()
  {
    static const TriangleMesh::Triangle faces[20] = {
        {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (const auto& face : faces)
      for (std::uint32_t i = 0; i < frequency_; ++i)
        for (std::uint32_t j = 0; i + j < frequency_; ++j) {
          mesh_.triangles.push_back(
              {vertex(face, i, j), vertex(face, i + 1, j), vertex(face, i, j + 1)});
          if (i + j + 1 < frequency_)
            mesh_.triangles.push_back(
                {vertex(face, i + 1, j), vertex(face, i + 1, j + 1), vertex(face, i, j + 1)});
        }
    return std::move(mesh_);
  }

private:
  /** \brief The vertex with weight i at the face's second corner and j at its third.
   *
   * Named by its corners in ascending order and their weights, so that faces share it. */
  std::uint32_t
  vertex(const TriangleMesh::Triangle& face, std::uint32_t i, std::uint32_t j)
  {
    std::array<std::array<std::uint32_t, 2>, 3> name = {
        {{face[0], frequency_ - i - j}, {face[1], i}, {face[2], j}}};
    for (auto& [corner, weight] : name)
      if (weight == 0)
        corner = 0;
    std::sort(name.begin(), name.end());
    const auto [it, added] =
        known_.try_emplace(name, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (added)
      mesh_.vertices.push_back(toFloat3(onEllipsoid(name)));
    return it->second;
  }

  Vector3
  onEllipsoid(const std::array<std::array<std::uint32_t, 2>, 3>& name) const
  {
    static const double g = (1 + std::sqrt(5.0)) / 2;
    static const Vector3 corners[12] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                        {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                        {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    Vector3 p = {0, 0, 0};
    for (const auto& [corner, weight] : name)
      p = add(p, scaled(corners[corner], weight));
    const double length = norm(p);
    return {p[0] / length * axes_[0], p[1] / length * axes_[1], p[2] / length * axes_[2]};
  }

  std::uint32_t frequency_;
  Vector3 axes_;
  TriangleMesh mesh_;
  std::map<std::array<std::array<std::uint32_t, 2>, 3>, std::uint32_t> known_;
};

} // namespace

PolyhedronBody::PolyhedronBody(std::vector<Vector3> vertices,
                               std::vector<TriangleMesh::Triangle> triangles)
    : vertices_(std::move(vertices)), triangles_(std::move(triangles))
{
  double sum = 0;
  for (const auto& t : triangles_)
    cumulative_.push_back(
        sum += norm(doubledAreaNormal(vertices_[t[0]], vertices_[t[1]], vertices_[t[2]])) / 2);
}

double
PolyhedronBody::area() const
{
  return cumulative_.back();
}

ExactSurflet
PolyhedronBody::sample(CounterRandom& random) const
{
  const auto& t = triangles_[drawInterval(cumulative_, random.uniform())];
  const Vector3 &a = vertices_[t[0]], &b = vertices_[t[1]], &c = vertices_[t[2]];
  const double s = std::sqrt(random.uniform()), v = random.uniform();
  const Vector3 p = add(add(scaled(a, 1 - s), scaled(b, s * (1 - v))), scaled(c, s * v));
  return {p, doubledAreaNormal(a, b, c)};
}

TriangleMesh
PolyhedronBody::mesh(double longest_edge) const
{
  // Halving edges can leave them half as long as they may be, and diagonals add a factor of two.
  checkMeshSize(8 * area() / (longest_edge * longest_edge));
  TriangleMesh mesh;
  for (const auto& v : vertices_)
    mesh.vertices.push_back(toFloat3(v));
  mesh.triangles = triangles_;
  return refineEdges(mesh, longest_edge, std::numeric_limits<std::size_t>::max());
}

EllipsoidBody::EllipsoidBody(const Vector3& axes)
    : axes_(axes), area_(0),
      largest_stretch_(std::max({axes[1] * axes[2], axes[0] * axes[2], axes[0] * axes[1]}))
{
  // Over an octant of the unit sphere: Simpson's rule in z, the trapezoidal rule (which converges
  // exponentially for periodic integrands) in the azimuth.
  constexpr int kHeights = 512, kAzimuths = 256;
  double sum = 0;
  for (int i = 0; i <= kHeights; ++i) {
    const double z = static_cast<double>(i) / kHeights, r = std::sqrt(1 - z * z);
    const double wz = i == 0 || i == kHeights ? 1 : (i % 2 ? 4 : 2);
    for (int k = 0; k <= kAzimuths; ++k) {
      const double phi = M_PI / 2 * k / kAzimuths;
      const double w = k == 0 || k == kAzimuths ? 0.5 : 1;
      sum += wz * w * stretch({r * std::cos(phi), r * std::sin(phi), z});
    }
  }
  area_ = 8 * sum / (3.0 * kHeights) * (M_PI / 2 / kAzimuths);
}

/** \brief Area on the ellipsoid per area on the unit sphere that it is stretched from. */
double
EllipsoidBody::stretch(const Vector3& u) const
{
  return norm({axes_[1] * axes_[2] * u[0], axes_[0] * axes_[2] * u[1], axes_[0] * axes_[1] * u[2]});
}

double
EllipsoidBody::area() const
{
  return area_;
}

ExactSurflet
EllipsoidBody::sample(CounterRandom& random) const
{
  while (true) {
    const double z = random.uniform(-1, 1), phi = random.uniform(-M_PI, M_PI);
    const double r = std::sqrt(1 - z * z);
    const Vector3 u = {r * std::cos(phi), r * std::sin(phi), z};
    if (random.uniform() * largest_stretch_ > stretch(u))
      continue;
    return {{u[0] * axes_[0], u[1] * axes_[1], u[2] * axes_[2]},
            {u[0] / axes_[0], u[1] / axes_[1], u[2] / axes_[2]}};
  }
}

TriangleMesh
EllipsoidBody::mesh(double longest_edge) const
{
  // The icosahedron's edge is 1.0515 radii; projection to the sphere stretches lattice edges most
  // in the middle of a face, 1 / 0.7947 of the radius away from the centre.
  const double longest = 1.0515 / 0.7947 * std::max({axes_[0], axes_[1], axes_[2]});
  const double frequency = std::max(1.0, std::ceil(longest / longest_edge));
  checkMeshSize(20 * frequency * frequency);
  return GeodesicGrid(static_cast<std::uint32_t>(frequency), axes_).build();
}

} // namespace detail
} // namespace pcl_surflet
