/** \file
 * Test shapes of known geometry: exact area-uniform surflets with exact normals, and meshes. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"
#include "pcl_surflet/core/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_surflet {

namespace detail {
class ShapeBody;
}

/** \brief A surface that can be sampled exactly; an immutable value, cheap to copy.
 *
 * Lengths are in metres by convention. Round shapes stand upright: their axis is z. All factories
 * throw std::invalid_argument naming a parameter that is not positive and finite, or what else is
 * wrong. */
class PCL_SURFLET_API Shape {
public:
  using ProfilePoint = std::array<double, 2>; ///< (distance to the axis, height)

  /** \brief Rectangle in z = 0 around the origin; open, its normal is +z. */
  static Shape plane(double width, double depth);
  /** \brief Cuboid around the origin with edges along the axes. */
  static Shape box(double width, double depth, double height);
  /** \brief Regular tetrahedron around the origin. */
  static Shape tetrahedron(double edge);
  /** \brief Sphere around the origin. */
  static Shape sphere(double radius);
  /** \brief Ellipsoid around the origin with these semi-axes along x, y and z. */
  static Shape ellipsoid(double a, double b, double c);
  /** \brief Ring torus around the origin. Also throws if \p minor_radius >= \p major_radius. */
  static Shape torus(double major_radius, double minor_radius);
  /** \brief Cylinder with both caps, from z = 0 to \p height. */
  static Shape cylinder(double radius, double height);
  /** \brief Cone with its base in z = 0 and its apex at \p height. */
  static Shape cone(double radius, double height);

  /** \brief Surface of revolution of a polyline about the z axis.
   *
   * The surface is the one of the polyline itself, a stack of conical frusta: round about the axis,
   * facetted along the profile. Samples lie on the frusta and carry the frusta's normals, which is
   * exact for this surface; a smooth curve is approximated by as many points as one likes. Outward
   * is to the right of the profile's direction: outlines run counter-clockwise seen with the axis
   * to the left, from the axis at the bottom outwards and up (for hollow vessels then inwards over
   * the rim and down the inner wall). The surface is closed if the profile starts and ends on the
   * axis or where it started.
   * Also throws for less than two points, a negative or non-finite coordinate, repeated points
   * next to each other, a profile that lies on the axis. */
  static Shape revolution(const std::vector<ProfilePoint>& profile);

  /** \brief Cylindrical hollow cup of \p radius and \p height with walls and bottom \p wall thick
   * and a half-torus handle of \p handle_radius and \p handle_thickness (radii) on its +x side.
   *
   * The handle's centre line is a half circle in the plane y = 0 that leaves the wall at right
   * angles, centred at half the height. The surface is that of the union: what of the handle lies
   * inside the wall and what of the wall lies inside the handle is removed.
   * Also throws if the parts do not fit: wall >= radius or height / 2, handle thicker than its
   * radius or than half the radius, or reaching beyond the wall's height. */
  static Shape cup(double radius, double height, double wall, double handle_radius,
                   double handle_thickness);

  /** \brief The implementation; of no use outside the library. */
  const detail::ShapeBody&
  body() const
  {
    return *body_;
  }

private:
  explicit Shape(std::shared_ptr<const detail::ShapeBody> body) : body_(std::move(body)) {}

  std::shared_ptr<const detail::ShapeBody> body_;
};

/** \brief Area in squared units, analytic or numerically exact to a relative 1e-6. */
PCL_SURFLET_API double areaOfShape(const Shape& shape);

/** \brief Draws \p n surflets uniformly by area with the exact outward normals of the surface.
 *
 * Surflet i depends on the shape, \p seed and i alone: longer samples begin with shorter ones. */
PCL_SURFLET_API SurfletSet sampleShape(const Shape& shape, std::size_t n, std::uint64_t seed);

/** \brief A mesh inscribed in the shape with outward faces and edges not longer than
 * \p longest_edge (up to rounding).
 *
 * Meshes of closed shapes are closed, with shared vertices also at sharp edges; vertices lie on the
 * surface. The exception is the cup: its handle ends on the wall without sharing vertices, over a
 * hole in the wall that is ragged by up to one edge length.
 * \throws std::invalid_argument if \p longest_edge is not positive and finite, or so small that the
 * mesh would exceed about 50 million triangles. */
PCL_SURFLET_API TriangleMesh meshOfShape(const Shape& shape, double longest_edge);

/** \brief Names of the ready-made shapes, of the size of household things (0.1 to 0.3 m): plane,
 * box, cube, tetrahedron, sphere, ellipsoid, torus, cylinder, cone, bottle, carafe, wine_glass and
 * cup. Bottle, carafe, wine glass and cup are hollow, with outer and inner walls. */
PCL_SURFLET_API std::vector<std::string> shapeNames();

/** \brief The ready-made shape \p name, or nothing if shapeNames() does not have it. */
PCL_SURFLET_API std::optional<Shape> shapeByName(const std::string& name);

} // namespace pcl_surflet
