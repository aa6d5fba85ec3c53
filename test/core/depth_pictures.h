/** \file
 * Small scenes and pictures of a virtual depth sensor, and the geometry they are checked against.
 */
#pragma once

#include "core/vector3.h"
#include "pcl_surflet/core/depth_sensor.h"
#include "pcl_surflet/core/shapes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace pcl_surflet {
namespace test {

using Vec = detail::Vector3;
using detail::cross;
using detail::dot;
using detail::norm;
using detail::subtract;

/** \brief An upright square around \p middle, seen along y. */
inline SensedBody
square(const Vec& middle, double edge, std::uint32_t label)
{
  const auto corner = [&](double x, double z) {
    return TriangleMesh::Point{static_cast<float>(middle[0] + x * edge / 2),
                               static_cast<float>(middle[1]),
                               static_cast<float>(middle[2] + z * edge / 2)};
  };
  SensedBody body;
  body.mesh.vertices = {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
  body.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  body.label = label;
  body.instance = label;
  return body;
}

inline SensedBody
ball(double radius, std::uint32_t label = 1)
{
  return {meshOfShape(Shape::sphere(radius), radius / 60), label, label};
}

/** \brief Stands at the origin and looks along y, so that the picture's axes are x and -z. */
inline SensorPose
alongY()
{
  SensorPose pose;
  pose.position = {0, 0, 0};
  pose.target = {0, 1, 0};
  return pose;
}

inline DepthSensor
small()
{
  DepthSensor sensor;
  sensor.columns = 160;
  sensor.rows = 120;
  return sensor;
}

inline bool
returned(const DepthScan& scan, std::size_t i)
{
  const bool z = std::isfinite(scan.z[i]);
  EXPECT_EQ(std::isfinite(scan.x[i]), z);
  EXPECT_EQ(std::isfinite(scan.y[i]), z);
  return z;
}

inline std::size_t
returns(const DepthScan& scan)
{
  std::size_t n = 0;
  for (std::size_t i = 0; i < scan.z.size(); ++i)
    n += returned(scan, i) ? 1 : 0;
  return n;
}

inline Vec
pointOf(const DepthScan& scan, std::size_t i)
{
  return {scan.x[i], scan.y[i], scan.z[i]};
}

/** \brief Line of sight of pixel \p i, of depth 1, from the definition of a pinhole camera. */
inline Vec
rayOf(const DepthSensor& s, std::size_t i)
{
  const double half = std::tan(s.opening / 2 * M_PI / 180); // of the picture's width at depth 1
  const double pixel = 2 * half / static_cast<double>(s.columns);
  return {(static_cast<double>(i % s.columns) + 0.5) * pixel - half,
          (static_cast<double>(i / s.columns) + 0.5 - 0.5 * static_cast<double>(s.rows)) * pixel,
          1};
}

} // namespace test
} // namespace pcl_surflet
