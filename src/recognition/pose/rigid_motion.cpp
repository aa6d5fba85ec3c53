#include "pcl_surflet/recognition/pose.h"

#include "core/vector3.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {

using detail::add;
using detail::dot;
using detail::scaled;
using detail::subtract;

RigidMotion::Vector
RigidMotion::turned(const Vector& v) const
{
  return {dot(rotation[0], v), dot(rotation[1], v), dot(rotation[2], v)};
}

RigidMotion::Vector
RigidMotion::moved(const Vector& p) const
{
  return add(turned(p), translation);
}

RigidMotion
RigidMotion::inverse() const
{
  RigidMotion out;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      out.rotation[i][j] = rotation[j][i];
  out.translation = scaled(out.turned(translation), -1);
  return out;
}

RigidMotion
RigidMotion::after(const RigidMotion& first) const
{
  RigidMotion out;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      out.rotation[i][j] = rotation[i][0] * first.rotation[0][j] +
                           rotation[i][1] * first.rotation[1][j] +
                           rotation[i][2] * first.rotation[2][j];
  out.translation = moved(first.translation);
  return out;
}

std::array<double, 4>
RigidMotion::quaternion() const
{
  // Squares of the four components times four; the largest is safe to divide by [Shepperd 1978].
  const auto& r = rotation;
  const std::array<double, 4> squares = {
      1 + r[0][0] - r[1][1] - r[2][2], 1 - r[0][0] + r[1][1] - r[2][2],
      1 - r[0][0] - r[1][1] + r[2][2], 1 + r[0][0] + r[1][1] + r[2][2]};
  const auto k =
      static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
  const std::array<std::array<double, 4>, 4> rows = {
      {{squares[0], r[0][1] + r[1][0], r[0][2] + r[2][0], r[2][1] - r[1][2]},
       {r[0][1] + r[1][0], squares[1], r[1][2] + r[2][1], r[0][2] - r[2][0]},
       {r[0][2] + r[2][0], r[1][2] + r[2][1], squares[2], r[1][0] - r[0][1]},
       {r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1], squares[3]}}};
  auto q = rows[k];
  double length = 0;
  for (const double c : q)
    length += c * c;
  length = std::copysign(std::sqrt(length), q[3]);
  for (double& c : q)
    c /= length;
  return q;
}

RigidMotion
turnAbout(const RigidMotion::Vector& axis, const RigidMotion::Vector& point, double angle)
{
  const double c = std::cos(angle), s = std::sin(angle);
  RigidMotion out;
  for (std::size_t i = 0; i < 3; ++i) // Rodrigues' formula
    for (std::size_t j = 0; j < 3; ++j)
      out.rotation[i][j] = (i == j ? c : 0.0) + (1 - c) * axis[i] * axis[j];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    out.rotation[j][i] += s * axis[k];
    out.rotation[i][j] -= s * axis[k];
  }
  out.translation = subtract(point, out.turned(point));
  return out;
}

SurfletSet
moved(const SurfletSet& set, const RigidMotion& motion)
{
  SurfletSet out;
  out.reserve(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    const auto p = detail::toFloat3(motion.moved({set.x[i], set.y[i], set.z[i]}));
    const auto n = detail::toFloat3(motion.turned({set.nx[i], set.ny[i], set.nz[i]}));
    out.push_back({p[0], p[1], p[2], n[0], n[1], n[2]});
  }
  return out;
}

} // namespace pcl_surflet
