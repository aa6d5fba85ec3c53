/** \file
 * What is behind Shape: one class per family of surfaces; internal, not installed. */
#pragma once

#include "vector3.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/core/triangle_mesh.h"

namespace pcl_surflet {
namespace detail {

/** \brief A surflet in double precision. */
struct ExactSurflet {
  Vector3 p, n;
};

class ShapeBody {
public:
  ShapeBody() = default;
  ShapeBody(const ShapeBody&) = delete;
  ShapeBody& operator=(const ShapeBody&) = delete;
  virtual ~ShapeBody() = default;

  virtual double area() const = 0;
  /** \brief Draws one surflet uniformly by area. */
  virtual ExactSurflet sample(CounterRandom& random) const = 0;
  virtual TriangleMesh mesh(double longest_edge) const = 0;
};

/** \brief Flat triangles, counter-clockwise seen from outside. */
class PolyhedronBody : public ShapeBody {
public:
  PolyhedronBody(std::vector<Vector3> vertices, std::vector<TriangleMesh::Triangle> triangles);
  double area() const override;
  ExactSurflet sample(CounterRandom& random) const override;
  TriangleMesh mesh(double longest_edge) const override;

private:
  std::vector<Vector3> vertices_;
  std::vector<TriangleMesh::Triangle> triangles_;
  std::vector<double> cumulative_; ///< area up to and with each triangle
};

class EllipsoidBody : public ShapeBody {
public:
  explicit EllipsoidBody(const Vector3& axes);
  double area() const override;
  ExactSurflet sample(CounterRandom& random) const override;
  TriangleMesh mesh(double longest_edge) const override;

private:
  double stretch(const Vector3& unit) const;

  Vector3 axes_;
  double area_;
  double largest_stretch_;
};

/** \brief Stack of conical frusta about the z axis. */
class RevolutionBody : public ShapeBody {
public:
  explicit RevolutionBody(std::vector<Shape::ProfilePoint> profile);
  double area() const override;
  ExactSurflet sample(CounterRandom& random) const override;
  TriangleMesh mesh(double longest_edge) const override;

private:
  std::vector<Shape::ProfilePoint> profile_;
  std::vector<double> cumulative_; ///< area up to and with each frustum
};

/** \brief A torus about the z axis, or the part of it outside of a cylindrical wall.
 *
 * A point is (major angle phi, minor angle theta). Outside of the wall means |phi| < phiEnd(theta),
 * in closed form because the torus is centred on the wall. */
class TorusBody : public ShapeBody {
public:
  /** \brief \p wall_radius 0: the whole torus. Otherwise the wall is the cylinder of that radius
   * about the line x = -wall_radius, z = 0, parallel to y (it passes through the torus' centre). */
  TorusBody(double major_radius, double minor_radius, double wall_radius = 0);
  double area() const override;
  ExactSurflet sample(CounterRandom& random) const override;
  TriangleMesh mesh(double longest_edge) const override;

  /** \brief Whether \p p lies in the solid ring. */
  bool contains(const Vector3& p) const;
  ExactSurflet at(double phi, double theta) const;
  double phiEnd(double theta) const;

private:
  double weight(double theta) const;

  double major_, minor_, wall_;
  double area_, largest_weight_;
};

/** \brief Union of a hollow vessel with a cylindrical wall and a half-torus handle. */
class CupBody : public ShapeBody {
public:
  CupBody(double radius, double height, double wall, double handle_radius, double thickness);
  double area() const override;
  ExactSurflet sample(CounterRandom& random) const override;
  TriangleMesh mesh(double longest_edge) const override;

private:
  Vector3 toHandle(const Vector3& p) const;
  Vector3 fromHandle(const Vector3& p) const;
  bool hidden(const Vector3& p) const;
  double hiddenArea() const;

  double radius_, middle_;
  RevolutionBody vessel_;
  TorusBody handle_;
  double hidden_area_;
};

/** \brief Profile of a hollow vessel for Shape::revolution().
 *
 * The outer wall is the shape-preserving cubic through \p outer, points of increasing height from
 * the foot to the rim, on a flat bottom at the first height. The inner wall keeps \p wall (measured
 * horizontally) from it, down to a flat inner bottom at height \p inner_bottom. */
std::vector<Shape::ProfilePoint> vesselProfile(const std::vector<Shape::ProfilePoint>& outer,
                                               double wall, double inner_bottom);

/** \brief Number of the interval of ascending \p cumulative sums that \p u in [0, 1) falls into. */
std::size_t drawInterval(const std::vector<double>& cumulative, double u);

/** \brief Throws std::invalid_argument if a mesh would have too many triangles. */
void checkMeshSize(double triangles);

} // namespace detail
} // namespace pcl_surflet
