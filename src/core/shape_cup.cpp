#include "shape_bodies.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace detail {

namespace {

constexpr double kPi = 3.14159265358979323846;

std::vector<Shape::ProfilePoint>
cupProfile(double radius, double height, double wall)
{
  const double inner = radius - wall;
  return {{0, 0}, {radius, 0}, {radius, height}, {inner, height}, {inner, wall}, {0, wall}};
}

} // namespace

CupBody::CupBody(double radius, double height, double wall, double handle_radius, double thickness)
    : radius_(radius), middle_(height / 2), vessel_(cupProfile(radius, height, wall)),
      handle_(handle_radius, thickness, radius), hidden_area_(hiddenArea())
{
}

/** \brief From the cup's frame to the handle's, whose ring lies in its own xy plane. */
Vector3
CupBody::toHandle(const Vector3& p) const
{
  return {p[0] - radius_, p[2] - middle_, -p[1]};
}

Vector3
CupBody::fromHandle(const Vector3& p) const
{
  return {p[0] + radius_, -p[2], p[1] + middle_};
}

/** \brief Whether a point of the vessel lies inside the handle. Only the outer wall can: the other
 * half of the ring, inside the cup, is not there. */
bool
CupBody::hidden(const Vector3& p) const
{
  const double tolerance = 1e-9 * radius_;
  return std::hypot(p[0], p[1]) > radius_ - tolerance && p[0] > 0 && handle_.contains(toHandle(p));
}

/** \brief Area of the wall inside the two ends of the handle: by the polygon through points of the
 * end's outline on the unrolled wall. */
double
CupBody::hiddenArea() const
{
  constexpr int kSteps = 8192;
  const auto onWall = [&](int i) {
    const double theta = 2 * kPi * (i % kSteps) / kSteps;
    const Vector3 p = fromHandle(handle_.at(handle_.phiEnd(theta), theta).p);
    return std::array<double, 2>{radius_ * std::atan2(p[1], p[0]), p[2] - middle_};
  };
  double doubled = 0;
  for (int i = 0; i < kSteps; ++i) {
    const auto a = onWall(i), b = onWall(i + 1);
    doubled += a[0] * b[1] - b[0] * a[1];
  }
  return std::abs(doubled); // twice half of it: the handle has two ends
}

double
CupBody::area() const
{
  return vessel_.area() - hidden_area_ + handle_.area();
}

ExactSurflet
CupBody::sample(CounterRandom& random) const
{
  const double total = vessel_.area() + handle_.area();
  while (true) {
    if (random.uniform() * total < handle_.area()) {
      const auto s = handle_.sample(random);
      // A rotation turns normals like differences of points.
      return {fromHandle(s.p), subtract(fromHandle(s.n), fromHandle({0, 0, 0}))};
    }
    const auto s = vessel_.sample(random);
    if (!hidden(s.p)) // else draw again from all of the surface, or the vessel would be denser
      return s;
  }
}

TriangleMesh
CupBody::mesh(double longest_edge) const
{
  TriangleMesh mesh = vessel_.mesh(longest_edge);
  const auto covered = [&](const TriangleMesh::Triangle& t) {
    Vector3 centre = {0, 0, 0};
    for (const auto v : t)
      centre = add(centre, scaled(toVector3(mesh.vertices[v]), 1.0 / 3));
    // Chords lie inside the wall; judge the point of the wall above them.
    const double r = std::hypot(centre[0], centre[1]);
    bool outer = r > 0;
    for (const auto v : t)
      outer = outer && std::hypot(mesh.vertices[v][0], mesh.vertices[v][1]) > 0.9999 * radius_;
    return outer && hidden({centre[0] / r * radius_, centre[1] / r * radius_, centre[2]});
  };
  auto& triangles = mesh.triangles;
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(), covered), triangles.end());
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  const TriangleMesh handle = handle_.mesh(longest_edge);
  for (const auto& v : handle.vertices)
    mesh.vertices.push_back(toFloat3(fromHandle(toVector3(v))));
  for (const auto& t : handle.triangles)
    triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return mesh;
}

} // namespace detail
} // namespace pcl_surflet
