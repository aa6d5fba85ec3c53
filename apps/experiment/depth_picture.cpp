#include "experiment/depth_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_surflet {
namespace apps {

DepthPicture::DepthPicture(const SurfletSet& vertices,
                           const std::vector<TriangleMesh::Triangle>& triangles)
    : heights_(kPixels * kPixels, -std::numeric_limits<double>::infinity())
{
  const auto [left, right] = std::minmax_element(vertices.x.begin(), vertices.x.end());
  const auto [low, high] = std::minmax_element(vertices.y.begin(), vertices.y.end());
  left_ = *left;
  low_ = *low;
  size_ = std::max<double>(*right - *left, *high - *low) / (kPixels - 2);
  for (const auto& t : triangles)
    draw({inPixels(vertices[t[0]]), inPixels(vertices[t[1]]), inPixels(vertices[t[2]])});
}

bool
DepthPicture::shows(const Surflet& s) const
{
  constexpr double kGrazing = 0.05, kSteepest = 0.15;
  if (s.nz < kGrazing)
    return false;
  const auto [x, y, height] = inPixels(s);
  const auto column = std::clamp(std::lround(x), 0L, kPixels - 1L);
  const auto row = std::clamp(std::lround(y), 0L, kPixels - 1L);
  // The pixel's middle may lie higher up the slope than the surflet.
  return heights_[pixel(column, row)] - height <= 2 * size_ / std::max<double>(s.nz, kSteepest);
}

DepthPicture::Corner
DepthPicture::inPixels(const Surflet& s) const
{
  return {(s.x - left_) / size_, (s.y - low_) / size_, s.z};
}

void
DepthPicture::draw(const std::array<Corner, 3>& t)
{
  const auto twiceArea = [](const Corner& a, const Corner& b, const Corner& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
  };
  const double area = twiceArea(t[0], t[1], t[2]);
  if (std::abs(area) < 1e-12)
    return; // seen from the edge
  const auto [left, right] = std::minmax({t[0][0], t[1][0], t[2][0]});
  const auto [low, high] = std::minmax({t[0][1], t[1][1], t[2][1]});
  for (long y = std::lround(std::ceil(low)); y <= std::lround(std::floor(high)); ++y)
    for (long x = std::lround(std::ceil(left)); x <= std::lround(std::floor(right)); ++x) {
      const Corner at = {static_cast<double>(x), static_cast<double>(y), 0};
      const double u = twiceArea(at, t[1], t[2]) / area, v = twiceArea(t[0], at, t[2]) / area,
                   w = 1 - u - v;
      if (std::min({u, v, w}) < -1e-9)
        continue;
      double& height = heights_[pixel(x, y)];
      height = std::max(height, u * t[0][2] + v * t[1][2] + w * t[2][2]);
    }
}

} // namespace apps
} // namespace pcl_surflet
