#include "pcl_surflet/core/region_index.h"

#include <algorithm>
#include <limits>

namespace pcl_surflet {

RegionIndex::~RegionIndex() = default;

float
squaredRadius(double radius)
{
  constexpr float largest = std::numeric_limits<float>::max();
  const double square = radius * radius;
  return square < largest ? static_cast<float>(square) : largest;
}

float
squaredDistance(const Position& p, const Position& q)
{
  const float dx = p[0] - q[0], dy = p[1] - q[1], dz = p[2] - q[2];
  return dx * dx + dy * dy + dz * dz;
}

} // namespace pcl_surflet
