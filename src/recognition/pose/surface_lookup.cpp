#include "pose_parts.h"

#include "pcl_surflet/core/cell_reduction.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_surflet {
namespace pose {
namespace {

constexpr double kVoxel = 1.0 / 56;
/** \brief A surflet answers queries of a direction if its normal has this much of it. A query's
 * largest component is at least 0.58, so normals within 30 degrees are never missed. */
constexpr double kSameWay = 0.1;
constexpr std::size_t kDirections = 6;

/** \brief Number of the direction +x, -x, +y ... that \p n has most of. */
std::size_t
directionOf(const Vector3& n)
{
  std::size_t axis = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (std::abs(n[a]) > std::abs(n[axis]))
      axis = a;
  return 2 * axis + (n[axis] < 0);
}

double
along(const Vector3& n, std::size_t direction)
{
  return direction % 2 == 0 ? n[direction / 2] : -n[direction / 2];
}

} // namespace

SurfletSet
cellsByDirection(const SurfletSet& set, double leaf)
{
  std::array<SurfletSet, kDirections> apart;
  for (std::size_t i = 0; i < set.size(); ++i)
    apart[directionOf(normalOf(set, i))].push_back(set[i]);
  SurfletSet cells;
  for (const auto& part : apart) {
    const SurfletSet reduced = reduceToCells(part, leaf).cells;
    for (std::size_t i = 0; i < reduced.size(); ++i)
      cells.push_back(reduced[i]);
  }
  return cells;
}

SurfletSet
thinned(const SurfletSet& set, std::size_t most)
{
  if (set.size() <= most)
    return set;
  SurfletSet out;
  for (std::size_t k = 0; k < most; ++k)
    out.push_back(set[k * set.size() / most]);
  return out;
}

SurfaceLookup::SurfaceLookup(const SurfletSet& surface)
{
  constexpr double margin = kReach + kVoxel;
  const std::vector<float>* axes[] = {&surface.x, &surface.y, &surface.z};
  std::size_t voxels = kDirections;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto [low, high] = std::minmax_element(axes[a]->begin(), axes[a]->end());
    low_[a] = *low - margin;
    size_[a] = static_cast<std::ptrdiff_t>((*high + margin - low_[a]) / kVoxel) + 1;
    voxels *= static_cast<std::size_t>(size_[a]);
  }
  voxels_.assign(voxels, none);
  std::vector<float> distances(voxels, static_cast<float>(kReach * kReach));
  for (std::size_t i = 0; i < surface.size(); ++i)
    for (std::size_t d = 0; d < kDirections; ++d)
      if (along(normalOf(surface, i), d) >= kSameWay)
        enter(surface, i, d, distances);
}

void
SurfaceLookup::enter(const SurfletSet& surface, std::size_t i, std::size_t direction,
                     std::vector<float>& distances)
{
  const Vector3 p = positionOf(surface, i);
  std::array<std::ptrdiff_t, 3> first{}, last{};
  for (std::size_t a = 0; a < 3; ++a) {
    first[a] = std::max<std::ptrdiff_t>(
        0, static_cast<std::ptrdiff_t>((p[a] - kReach - low_[a]) / kVoxel));
    last[a] =
        std::min(size_[a] - 1, static_cast<std::ptrdiff_t>((p[a] + kReach - low_[a]) / kVoxel));
  }
  const auto square = [&](std::size_t a, std::ptrdiff_t c) {
    const double d = low_[a] + (static_cast<double>(c) + 0.5) * kVoxel - p[a];
    return d * d;
  };
  for (std::ptrdiff_t x = first[0]; x <= last[0]; ++x)
    for (std::ptrdiff_t y = first[1]; y <= last[1]; ++y) {
      const double flat = square(0, x) + square(1, y);
      const auto row =
          ((static_cast<std::ptrdiff_t>(direction) * size_[0] + x) * size_[1] + y) * size_[2];
      for (std::ptrdiff_t z = first[2]; z <= last[2]; ++z) {
        const auto d = static_cast<float>(flat + square(2, z));
        const auto voxel = static_cast<std::size_t>(row + z);
        if (d >= distances[voxel])
          continue;
        distances[voxel] = d;
        voxels_[voxel] = static_cast<std::uint16_t>(i);
      }
    }
}

std::uint16_t
SurfaceLookup::nearest(const Vector3& p, const Vector3& n) const
{
  auto voxel = static_cast<std::ptrdiff_t>(directionOf(n));
  for (std::size_t a = 0; a < 3; ++a) {
    const double at = (p[a] - low_[a]) / kVoxel;
    if (!(at >= 0 && at < static_cast<double>(size_[a])))
      return none;
    voxel = voxel * size_[a] + static_cast<std::ptrdiff_t>(at);
  }
  return voxels_[static_cast<std::size_t>(voxel)];
}

} // namespace pose
} // namespace pcl_surflet
