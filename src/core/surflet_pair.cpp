#include "pcl_surflet/core/surflet_pair.h"

#include "core/vector3.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace {

using detail::cross;
using detail::dot;
using detail::subtract;
using detail::Vector3;

/** \brief Is p2 the origin [Wahl 2007, Eq. 2.2]? \p a = n1.d, \p b = n2.d, d = p2 - p1.
 *
 * gamma is a/|d| at p1 and -b/|d| at p2. The end with the larger gamma gets the benefit of the
 * tolerance, so it wins every tie. */
bool
originIsSecond(double a, double b)
{
  const double tolerance = a < -b ? -kOriginTieTolerance : kOriginTieTolerance;
  return a * a > b * b * (1 + tolerance);
}

} // namespace

std::optional<PairFeature>
computePairFeature(const Surflet& s1, const Surflet& s2)
{
  bool ignored = false;
  return computePairFeature(s1, s2, ignored);
}

std::optional<PairFeature>
computePairFeature(const Surflet& s1, const Surflet& s2, bool& origin_is_second)
{
  Vector3 p1{s1.x, s1.y, s1.z}, n1{s1.nx, s1.ny, s1.nz};
  Vector3 p2{s2.x, s2.y, s2.z}, n2{s2.nx, s2.ny, s2.nz};
  Vector3 d = subtract(p2, p1);
  const double length = std::sqrt(dot(d, d));
  if (!(length > 0) || !std::isfinite(length) || !std::isfinite(dot(n1, n1) + dot(n2, n2)))
    return std::nullopt;

  const bool swap = originIsSecond(dot(n1, d), dot(n2, d));
  if (swap) {
    std::swap(n1, n2);
    d = subtract(p1, p2);
  }
  const Vector3& u = n1;   // Eq. 2.3
  Vector3 v = cross(d, u); // Eq. 2.4
  const double v_squared = dot(v, v);
  if (!(v_squared > kCollinearityTolerance * length * length))
    return std::nullopt;
  for (double& c : v)
    c /= std::sqrt(v_squared);
  const Vector3 w = cross(u, v); // Eq. 2.5

  origin_is_second = swap;
  PairFeature f;
  f.alpha = std::atan2(dot(w, n2), dot(u, n2)); // Eq. 2.6
  if (f.alpha >= M_PI)
    f.alpha = -M_PI;                                   // Eq. 2.12: the codomain is half open
  f.beta = std::clamp(dot(v, n2), -1.0, 1.0);          // Eq. 2.7
  f.gamma = std::clamp(dot(u, d) / length, -1.0, 1.0); // Eq. 2.8
  f.delta = length;                                    // Eq. 2.9
  return f;
}

} // namespace pcl_surflet
