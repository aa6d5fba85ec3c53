#include "evaluation/pose_scoring.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace apps {

RigidMotion
motionOf(const PlacedItem& item)
{
  RigidMotion m;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      m.rotation[i][j] = item.pose[4 * i + j];
    m.translation[i] = item.pose[4 * i + 3];
  }
  return m;
}

PoseError::PoseError(const SurfletSet& surface) : dense_(surface)
{
  constexpr std::size_t kPoints = 1000;
  const std::size_t step = std::max<std::size_t>(1, surface.size() / kPoints);
  for (std::size_t i = 0; i < surface.size(); i += step)
    points_.push_back(surface[i]);
  octree_.build({dense_.x.data(), dense_.y.data(), dense_.z.data(), 1, dense_.size()});
}

double
PoseError::distance(const RigidMotion& found, const RigidMotion& truth) const
{
  double sum = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const RigidMotion::Vector p{points_.x[i], points_.y[i], points_.z[i]};
    const auto a = found.moved(p), b = truth.moved(p);
    sum += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  }
  return sum / static_cast<double>(points_.size());
}

double
PoseError::nearest(const RigidMotion& found, const RigidMotion& truth) const
{
  const RigidMotion back = truth.inverse().after(found);
  std::vector<PointIndex> index;
  std::vector<float> squared;
  double sum = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto p = back.moved({points_.x[i], points_.y[i], points_.z[i]});
    octree_.nearestSearch(
        {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])}, 1, index,
        squared);
    sum += std::sqrt(static_cast<double>(squared.at(0)));
  }
  return sum / static_cast<double>(points_.size());
}

PoseCounts&
PoseCounts::operator+=(const PoseCounts& other)
{
  present += other.present;
  segmented += other.segmented;
  posed += other.posed;
  right += other.right;
  errors.insert(errors.end(), other.errors.begin(), other.errors.end());
  seconds.insert(seconds.end(), other.seconds.begin(), other.seconds.end());
  return *this;
}

} // namespace apps
} // namespace pcl_surflet
