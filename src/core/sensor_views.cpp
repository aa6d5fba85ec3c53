#include "pcl_surflet/core/depth_sensor.h"

#include "vector3.h"

#include <algorithm>
#include <stdexcept>

namespace pcl_surflet {
namespace {

using detail::Vector3;

constexpr double kDegree = M_PI / 180;

Vector3
unit(const Vector3& v)
{
  return detail::scaled(v, 1 / detail::norm(v));
}

bool
isFinite(const Vector3& v)
{
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

SensorPose
poseFrom(const ViewOptions& o, const Vector3& direction)
{
  SensorPose pose;
  pose.position = detail::add(o.target, detail::scaled(direction, o.distance));
  pose.target = o.target;
  return pose;
}

SensorPose
poseAt(const ViewOptions& o, double azimuth, double elevation)
{
  const double a = (o.azimuth + azimuth) * kDegree, e = elevation * kDegree;
  return poseFrom(o, {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)});
}

/** \brief Point \p k of \p n on the unit sphere, evenly spread (Fibonacci lattice). */
Vector3
onSphere(std::size_t k, std::size_t n, double turn)
{
  const double golden = M_PI * (3 - std::sqrt(5.0));
  const double z = 1 - (2 * static_cast<double>(k) + 1) / static_cast<double>(n);
  const double a = golden * static_cast<double>(k) + turn, r = std::sqrt(1 - z * z);
  return {r * std::cos(a), r * std::sin(a), z};
}

void
check(const ViewOptions& o)
{
  const auto steep = [](double elevation) { return !(std::abs(elevation) < 90); };
  if (!isFinite(o.target) || !std::isfinite(o.azimuth))
    throw std::invalid_argument("sensorPoses: target and azimuth must be finite");
  if (!(o.distance > 0) || !std::isfinite(o.distance))
    throw std::invalid_argument("sensorPoses: the distance must be positive and finite");
  if (steep(o.elevation) || steep(o.second_elevation))
    throw std::invalid_argument("sensorPoses: elevations must lie between -90 and 90 degrees");
  if (!(o.path >= 0) || !std::isfinite(o.path))
    throw std::invalid_argument("sensorPoses: the path must be finite and not negative");
  if (o.stops < 2 || o.stops > 10000)
    throw std::invalid_argument("sensorPoses: stops must be in [2, 10000]");
}

/** \brief From one end to the other with the sensor on the side of -y, and back on that of +y. */
std::vector<SensorPose>
passing(const ViewOptions& o)
{
  std::vector<SensorPose> poses;
  const std::size_t there = (o.stops + 1) / 2;
  for (std::size_t k = 0; k < o.stops; ++k) {
    const bool is_back = k >= there;
    const std::size_t n = is_back ? o.stops - there : there, i = is_back ? k - there : k;
    const double share = n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0.5;
    ViewOptions here = o;
    here.target[0] += o.path * (is_back ? 0.5 - share : share - 0.5);
    poses.push_back(poseAt(here, is_back ? 90 : -90, o.elevation));
  }
  return poses;
}

} // namespace

SensorFrame::SensorFrame(const SensorPose& pose) : position(pose.position)
{
  const Vector3 line = detail::subtract(pose.target, pose.position);
  const double length = detail::norm(line);
  if (!isFinite(pose.position) || !isFinite(pose.up) || !(length > 0) || !std::isfinite(length))
    throw std::invalid_argument("pcl_surflet: a sensor must stand at a finite place and look at "
                                "another one");
  forward = detail::scaled(line, 1 / length);
  right = detail::cross(forward, pose.up);
  if (!(detail::norm(right) > 1e-9 * detail::norm(pose.up))) // looks along "up"
    right =
        detail::cross(forward, std::abs(forward[0]) < 0.7 ? Vector3{1, 0, 0} : Vector3{0, 1, 0});
  right = unit(right);
  down = detail::cross(forward, right);
}

std::array<double, 3>
SensorFrame::toScene(const std::array<double, 3>& p) const
{
  return detail::add(position, detail::add(detail::scaled(right, p[0]),
                                           detail::add(detail::scaled(down, p[1]),
                                                       detail::scaled(forward, p[2]))));
}

std::array<double, 3>
SensorFrame::toSensor(const std::array<double, 3>& p) const
{
  const Vector3 d = detail::subtract(p, position);
  return {detail::dot(right, d), detail::dot(down, d), detail::dot(forward, d)};
}

std::array<double, 4>
SensorFrame::quaternion() const
{
  // Columns of the rotation are right, down, forward. The largest component comes from its square,
  // the others from it: no division by something small (Shepperd).
  const double xx = right[0], yy = down[1], zz = forward[2];
  const std::array<double, 4> squares = {1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz,
                                         1 - xx - yy + zz};
  const double a = down[2] - forward[1], b = forward[0] - right[2], c = right[1] - down[0];
  const double p = right[1] + down[0], q = forward[0] + right[2], r = down[2] + forward[1];
  const std::array<std::array<double, 4>, 4> rows = {
      {{squares[0], a, b, c}, {a, squares[1], p, q}, {b, p, squares[2], r}, {c, q, r, squares[3]}}};
  const auto largest =
      static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
  auto out = rows[largest];
  const double factor = (out[0] < 0 ? -0.5 : 0.5) / std::sqrt(squares[largest]);
  for (double& v : out)
    v *= factor;
  return out;
}

std::vector<SensorPose>
sensorPoses(const ViewOptions& o)
{
  check(o);
  constexpr std::size_t kAll = 24;
  if (o.views == ViewSet::Pass)
    return passing(o);
  std::vector<SensorPose> poses;
  if (o.views == ViewSet::All24) {
    for (std::size_t k = 0; k < kAll; ++k)
      poses.push_back(poseFrom(o, onSphere(k, kAll, o.azimuth * kDegree)));
    return poses;
  }
  if (o.views == ViewSet::Ring24) {
    for (int k = 0; k < 12; ++k)
      for (const double elevation : {o.elevation, o.second_elevation})
        poses.push_back(poseAt(o, 30 * k, elevation));
    return poses;
  }
  poses.push_back(poseAt(o, 0, o.elevation));
  if (o.views == ViewSet::Two)
    poses.push_back(poseAt(o, 180, o.elevation));
  return poses;
}

} // namespace pcl_surflet
