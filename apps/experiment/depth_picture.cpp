#include "experiment/depth_picture.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace apps {

DepthPicture::DepthPicture(const SurfletSet& vertices,
                           const std::vector<TriangleMesh::Triangle>& triangles)
    : heights_(kPixels, kPixels)
{
  const auto [left, right] = std::minmax_element(vertices.x.begin(), vertices.x.end());
  const auto [low, high] = std::minmax_element(vertices.y.begin(), vertices.y.end());
  left_ = *left;
  low_ = *low;
  size_ = std::max<double>(*right - *left, *high - *low) / (kPixels - 2);
  for (const auto& t : triangles)
    heights_.draw({inPixels(vertices[t[0]]), inPixels(vertices[t[1]]), inPixels(vertices[t[2]])},
                  0);
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
  return heights_.nearness(static_cast<std::size_t>(column), static_cast<std::size_t>(row)) -
             height <=
         2 * size_ / std::max<double>(s.nz, kSteepest);
}

DepthBuffer::Corner
DepthPicture::inPixels(const Surflet& s) const
{
  return {(s.x - left_) / size_, (s.y - low_) / size_, s.z};
}

} // namespace apps
} // namespace pcl_surflet
