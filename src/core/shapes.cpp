#include "pcl_surflet/core/shapes.h"

#include "require.h"
#include "shape_bodies.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace pcl_surflet {

namespace {

/** \brief Keeps these draws apart from those of others that are given the same seed. */
constexpr std::uint64_t kShapeStream = 0x7368617065ULL;

constexpr double kMaxTriangles = 5e7;
constexpr const char* kShape = "Shape: ";

} // namespace

void
detail::checkMeshSize(double triangles)
{
  if (!(triangles <= kMaxTriangles))
    throw std::invalid_argument("meshOfShape: longest_edge is too small, the mesh would have " +
                                std::to_string(triangles) + " triangles");
}

Shape
Shape::plane(double width, double depth)
{
  requirePositive(width, "width", kShape);
  requirePositive(depth, "depth", kShape);
  const double x = width / 2, y = depth / 2;
  return Shape(std::make_shared<detail::PolyhedronBody>(
      std::vector<detail::Vector3>{{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}},
      std::vector<TriangleMesh::Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

Shape
Shape::box(double width, double depth, double height)
{
  requirePositive(width, "width", kShape);
  requirePositive(depth, "depth", kShape);
  requirePositive(height, "height", kShape);
  std::vector<detail::Vector3> corners;
  for (unsigned i = 0; i < 8; ++i)
    corners.push_back({(i & 1 ? 0.5 : -0.5) * width, (i & 2 ? 0.5 : -0.5) * depth,
                       (i & 4 ? 0.5 : -0.5) * height});
  return Shape(std::make_shared<detail::PolyhedronBody>(
      std::move(corners), std::vector<TriangleMesh::Triangle>{{0, 2, 3},
                                                              {0, 3, 1}, // -z
                                                              {4, 5, 7},
                                                              {4, 7, 6}, // +z
                                                              {0, 1, 5},
                                                              {0, 5, 4}, // -y
                                                              {2, 6, 7},
                                                              {2, 7, 3}, // +y
                                                              {0, 4, 6},
                                                              {0, 6, 2}, // -x
                                                              {1, 3, 7},
                                                              {1, 7, 5}})); // +x
}

Shape
Shape::tetrahedron(double edge)
{
  requirePositive(edge, "edge", kShape);
  const double h = edge / std::sqrt(8.0); // every other corner of a cube of edge 2 h
  return Shape(std::make_shared<detail::PolyhedronBody>(
      std::vector<detail::Vector3>{{h, h, h}, {h, -h, -h}, {-h, h, -h}, {-h, -h, h}},
      std::vector<TriangleMesh::Triangle>{{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}));
}

Shape
Shape::sphere(double radius)
{
  requirePositive(radius, "radius", kShape);
  return ellipsoid(radius, radius, radius);
}

Shape
Shape::ellipsoid(double a, double b, double c)
{
  requirePositive(a, "semi-axis a", kShape);
  requirePositive(b, "semi-axis b", kShape);
  requirePositive(c, "semi-axis c", kShape);
  return Shape(std::make_shared<detail::EllipsoidBody>(detail::Vector3{a, b, c}));
}

Shape
Shape::torus(double major_radius, double minor_radius)
{
  requirePositive(major_radius, "major_radius", kShape);
  requirePositive(minor_radius, "minor_radius", kShape);
  require(minor_radius < major_radius, "minor_radius must be smaller than major_radius", kShape);
  return Shape(std::make_shared<detail::TorusBody>(major_radius, minor_radius));
}

Shape
Shape::cylinder(double radius, double height)
{
  requirePositive(radius, "radius", kShape);
  requirePositive(height, "height", kShape);
  return revolution({{0, 0}, {radius, 0}, {radius, height}, {0, height}});
}

Shape
Shape::cone(double radius, double height)
{
  requirePositive(radius, "radius", kShape);
  requirePositive(height, "height", kShape);
  return revolution({{0, 0}, {radius, 0}, {0, height}});
}

Shape
Shape::revolution(const std::vector<ProfilePoint>& profile)
{
  require(profile.size() >= 2, "a profile needs at least two points", kShape);
  bool off_axis = false;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    require(std::isfinite(profile[i][0]) && std::isfinite(profile[i][1]) && profile[i][0] >= 0,
            "profile coordinates must be finite, distances to the axis not negative", kShape);
    require(i == 0 || profile[i] != profile[i - 1], "a profile point is repeated", kShape);
    off_axis = off_axis || profile[i][0] > 0;
  }
  require(off_axis, "the profile lies on the axis", kShape);
  return Shape(std::make_shared<detail::RevolutionBody>(profile));
}

Shape
Shape::cup(double radius, double height, double wall, double handle_radius, double handle_thickness)
{
  requirePositive(radius, "radius", kShape);
  requirePositive(height, "height", kShape);
  requirePositive(wall, "wall", kShape);
  requirePositive(handle_radius, "handle_radius", kShape);
  requirePositive(handle_thickness, "handle_thickness", kShape);
  require(wall < radius && wall < height / 2, "the wall is too thick for the cup", kShape);
  require(handle_thickness < handle_radius && handle_thickness < radius / 2,
          "the handle is too thick", kShape);
  require(handle_radius + handle_thickness < height / 2, "the handle is higher than the wall",
          kShape);
  return Shape(
      std::make_shared<detail::CupBody>(radius, height, wall, handle_radius, handle_thickness));
}

double
areaOfShape(const Shape& shape)
{
  return shape.body().area();
}

SurfletSet
sampleShape(const Shape& shape, std::size_t n, std::uint64_t seed)
{
  SurfletSet out;
  out.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    // One stream per surflet: rejection draws as often as it likes without shifting the others.
    CounterRandom random(mix64(seed) ^ kShapeStream, i);
    const auto [p, d] = shape.body().sample(random);
    const auto u = detail::scaled(d, 1 / detail::norm(d));
    out.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]),
                   static_cast<float>(u[0]), static_cast<float>(u[1]), static_cast<float>(u[2])});
  }
  return out;
}

TriangleMesh
meshOfShape(const Shape& shape, double longest_edge)
{
  if (!(longest_edge > 0) || !std::isfinite(longest_edge))
    throw std::invalid_argument("meshOfShape: longest_edge must be positive and finite, not " +
                                std::to_string(longest_edge));
  return shape.body().mesh(longest_edge);
}

} // namespace pcl_surflet
