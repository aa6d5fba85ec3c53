#include "pose_parts.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace pcl_surflet {
namespace pose {
namespace {

constexpr std::size_t kViewDirections = 128;
constexpr double kPixel = 0.03;
/** \brief What lies so far behind the front of its pixel is hidden; a slope within the pixel
 * explains less. */
constexpr double kDepth = 0.04;
constexpr double kFacing = 0.4; ///< cosine: what is seen at a sharper angle sensors may miss

/** \brief Evenly spread over the sphere, on a spiral of golden angles. */
Vector3
spiralDirection(std::size_t k)
{
  const double z = 1 - (2.0 * static_cast<double>(k) + 1) / kViewDirections;
  const double angle = static_cast<double>(k) * M_PI * (3 - std::sqrt(5.0));
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/** \brief The foremost depth of every pixel, looking against \p to_sensor. */
class FrontDepth {
public:
  explicit FrontDepth(const Vector3& to_sensor) : frame_(frameOf(to_sensor)) {}

  void
  enter(const Vector3& p)
  {
    const auto [place, ignored] = front_.try_emplace(key(p), depth(p));
    place->second = std::max(place->second, depth(p));
  }
  bool
  hides(const Vector3& p) const
  {
    const auto found = front_.find(key(p));
    return found != front_.end() && found->second - depth(p) > kDepth;
  }

private:
  double
  depth(const Vector3& p) const
  {
    return detail::dot(p, frame_[2]);
  }
  std::int64_t
  key(const Vector3& p) const
  {
    const auto u = static_cast<std::int64_t>(std::floor(detail::dot(p, frame_[0]) / kPixel));
    const auto v = static_cast<std::int64_t>(std::floor(detail::dot(p, frame_[1]) / kPixel));
    return u * 4096 + v;
  }

  std::array<Vector3, 3> frame_;
  std::unordered_map<std::int64_t, double> front_;
};

} // namespace

Visibility::Visibility(const SurfletSet& surface, const SurfletSet& cells)
{
  for (std::size_t k = 0; k < kViewDirections; ++k) {
    const Vector3 direction = spiralDirection(k);
    FrontDepth front(direction);
    for (std::size_t i = 0; i < surface.size(); ++i)
      front.enter(positionOf(surface, i));
    std::vector<char> seen(cells.size(), 0);
    for (std::size_t i = 0; i < cells.size(); ++i)
      seen[i] = detail::dot(normalOf(cells, i), direction) > kFacing &&
                !front.hides(positionOf(cells, i));
    directions_.push_back(direction);
    seen_.push_back(std::move(seen));
  }
}

void
Visibility::addSeen(const Vector3& to_sensor, std::vector<char>& seen) const
{
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < directions_.size(); ++k)
    if (detail::dot(directions_[k], to_sensor) > detail::dot(directions_[nearest], to_sensor))
      nearest = k;
  for (std::size_t i = 0; i < seen.size(); ++i)
    seen[i] |= seen_[nearest][i];
}

} // namespace pose
} // namespace pcl_surflet
