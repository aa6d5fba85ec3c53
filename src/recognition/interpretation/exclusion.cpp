#include "exclusion.h"

#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/recognition/scene_interpretation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace pcl_surflet {
namespace interpretation {
namespace {

/** \brief cos 45 degrees, about. What stands on a table has its lowest cells near the table's, but
 * they look sideways or down. */
constexpr float kLeastCosine = 0.7f;
constexpr std::size_t kExclusionBlock = 256; ///< cells asked at a time by one thread

bool
haveLikeNormals(const SurfletSet& a, std::size_t i, const SurfletSet& b, std::size_t j)
{
  return a.nx[i] * b.nx[j] + a.ny[i] * b.ny[j] + a.nz[i] * b.nz[j] > kLeastCosine;
}

} // namespace

EmptyScene::EmptyScene(SurfletSet surface, double distance)
    : surface_(std::move(surface)), distance_(distance)
{
  if (!(distance > 0) || !std::isfinite(distance))
    throw std::invalid_argument("pcl_surflet: distance must be positive and finite");
  octree_.build({surface_.x.data(), surface_.y.data(), surface_.z.data(), 1, surface_.size()});
}

bool
EmptyScene::holds(const SurfletSet& set, std::size_t i, std::vector<PlaceRange>& near) const
{
  octree_.regionRanges({set.x[i], set.y[i], set.z[i]}, distance_, near);
  const PointIndex* index = octree_.indexData();
  return std::any_of(near.begin(), near.end(), [&](const PlaceRange& r) {
    return std::any_of(index + r.begin, index + r.end, [&](PointIndex j) {
      return haveLikeNormals(set, i, surface_, static_cast<std::size_t>(j));
    });
  });
}

std::vector<std::uint32_t>
EmptyScene::away(const SurfletSet& set, const std::vector<std::uint32_t>& indices,
                 unsigned threads) const
{
  std::vector<char> is_held(indices.size());
  std::vector<std::vector<PlaceRange>> memory(resolveThreads(threads));
  const std::size_t blocks = (indices.size() + kExclusionBlock - 1) / kExclusionBlock;
  parallelFor(blocks, threads, [&](std::size_t block, unsigned worker) {
    const std::size_t end = std::min(indices.size(), (block + 1) * kExclusionBlock);
    for (std::size_t k = block * kExclusionBlock; k < end; ++k)
      is_held[k] = holds(set, indices[k], memory[worker]) ? 1 : 0;
  });
  std::vector<std::uint32_t> away;
  for (std::size_t k = 0; k < indices.size(); ++k)
    if (is_held[k] == 0)
      away.push_back(indices[k]);
  return away;
}

} // namespace interpretation

std::vector<std::uint32_t>
cellsAwayFrom(const SurfletSet& cells, const SurfletSet& background, double distance,
              unsigned threads)
{
  std::vector<std::uint32_t> all(cells.size());
  std::iota(all.begin(), all.end(), 0u);
  return interpretation::EmptyScene(background, distance).away(cells, all, threads);
}

} // namespace pcl_surflet
