/** \file
 * Double-precision vectors of three; internal, not installed. */
#pragma once

#include <array>
#include <cmath>

namespace pcl_surflet {
namespace detail {

using Vector3 = std::array<double, 3>;

inline Vector3
toVector3(const std::array<float, 3>& p)
{
  return {p[0], p[1], p[2]};
}

inline std::array<float, 3>
toFloat3(const Vector3& v)
{
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

inline Vector3
add(const Vector3& a, const Vector3& b)
{
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

inline Vector3
subtract(const Vector3& a, const Vector3& b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline Vector3
scaled(const Vector3& a, double s)
{
  return {a[0] * s, a[1] * s, a[2] * s};
}

inline double
dot(const Vector3& a, const Vector3& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vector3
cross(const Vector3& a, const Vector3& b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double
norm(const Vector3& a)
{
  return std::sqrt(dot(a, a));
}

/** \brief Normal of the triangle (a, b, c), counter-clockwise, of twice the triangle's area.
 *
 * In double precision neither the smallest nor the largest float coordinates under- or overflow. */
inline Vector3
doubledAreaNormal(const Vector3& a, const Vector3& b, const Vector3& c)
{
  return cross(subtract(b, a), subtract(c, a));
}

} // namespace detail
} // namespace pcl_surflet
