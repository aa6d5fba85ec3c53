#include "experiment/peers/descriptors.h"

#include "pcl_surflet/core/pair_counting.h"

#include <pcl/features/pfh.h>
#include <pcl/features/pfh_tools.h>
#include <pcl/features/ppf.h>

#include <algorithm>
#include <array>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr int kSplits = 5;
constexpr std::size_t kPfhPoints = 500;
constexpr std::uint64_t kPairs = 50000;

using Features = std::array<float, 4>;
using PairFunction = bool (*)(const Eigen::Vector4f&, const Eigen::Vector4f&,
                              const Eigen::Vector4f&, const Eigen::Vector4f&, float&, float&,
                              float&, float&);

std::size_t
interval(float value, float low, float high)
{
  const float share = (value - low) / (high - low);
  return static_cast<std::size_t>(std::clamp(static_cast<int>(share * kSplits), 0, kSplits - 1));
}

/** \brief Histogram of \p function over drawn pairs; \p low and \p high bound its four features. */
Signatures
pairHistogram(const PeerCloud& cloud, PairFunction function, const Features& low,
              const Features& high)
{
  if (cloud.points->size() < 2)
    return {};
  std::vector<float> bins(kSplits * kSplits * kSplits * kSplits, 0.0F);
  for (const auto& [i, j] : drawPairs(cloud.points->size(), kPairs, 1)) {
    Features f;
    if (!function((*cloud.points)[i].getVector4fMap(), (*cloud.normals)[i].getNormalVector4fMap(),
                  (*cloud.points)[j].getVector4fMap(), (*cloud.normals)[j].getNormalVector4fMap(),
                  f[0], f[1], f[2], f[3]))
      continue;
    std::size_t bin = 0;
    for (std::size_t k = 0; k < 4; ++k)
      bin = bin * kSplits + interval(f[k], low[k], high[k]);
    bins[bin] += 100.0F / kPairs;
  }
  return {bins};
}

} // namespace

Signatures
pfh(const PeerCloud& cloud)
{
  const std::size_t n = cloud.points->size(), wanted = std::min(n, kPfhPoints);
  if (wanted < 2)
    return {};
  pcl::Indices indices;
  for (std::size_t k = 0; k < wanted; ++k)
    indices.push_back(static_cast<pcl::index_t>(k * n / wanted));
  pcl::PFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::PFHSignature125> estimation;
  Eigen::VectorXf bins(kSplits * kSplits * kSplits);
  estimation.computePointPFHSignature(*cloud.points, *cloud.normals, indices, kSplits, bins);
  return {{bins.data(), bins.data() + bins.size()}};
}

Signatures
pfhWithDistance(const PeerCloud& cloud)
{
  constexpr auto pi = static_cast<float>(M_PI);
  return pairHistogram(cloud, pcl::computePairFeatures, {-pi, -1, -1, 0}, {pi, 1, 1, 1});
}

Signatures
ppf(const PeerCloud& cloud)
{
  return pairHistogram(cloud, pcl::computePPFPairFeature, {-1, -1, -1, 0}, {1, 1, 1, 1});
}

} // namespace apps
} // namespace pcl_surflet
