#include "explanation.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/parallel.h"

#include <algorithm>

namespace pcl_surflet {
namespace interpretation {
namespace {

constexpr std::uint64_t kVoteStream = 0x766f7465ULL;
constexpr std::size_t kBlock = 256; ///< cells judged at a time by one thread

/** \brief Is a pair more likely on a background model than on every object? */
bool
isBackground(const SceneModels& models, std::uint32_t angular_bin, float delta_squared)
{
  if (angular_bin == kNoPairFeature)
    return false;
  float object = 0, background = 0;
  for (std::size_t k = 0; k < models.all.size(); ++k) {
    float& best = k < models.objects ? object : background;
    best = std::max(best, models.all[k].densityOf(angular_bin, delta_squared));
  }
  return background > object;
}

/** \brief \p n random neighbours of \p cell; fewer than two cells in reach give none. */
void
drawNeighbours(const LinearOctree& octree, const SurfletSet& s, std::uint32_t cell, double radius,
               unsigned n, CounterRandom random, std::vector<PlaceRange>& ranges,
               std::vector<std::uint32_t>& out)
{
  octree.regionRanges({s.x[cell], s.y[cell], s.z[cell]}, radius, ranges);
  std::uint32_t total = 0;
  for (const auto& r : ranges)
    total += r.end - r.begin;
  for (unsigned i = 0; total > 1 && i < n; ++i) {
    std::uint32_t at = random.below(total);
    const auto* range = ranges.data();
    for (; at >= range->end - range->begin; ++range)
      at -= range->end - range->begin;
    out.push_back(static_cast<std::uint32_t>(octree.indexAt(range->begin + at)));
  }
}

double
neighbourhood(const SceneModels& models, double share)
{
  double smallest = 0;
  for (std::size_t k = models.objects; k < models.all.size(); ++k) {
    const double d = share * models.all[k].model->delta_max;
    smallest = smallest > 0 ? std::min(smallest, d) : d;
  }
  return smallest;
}

} // namespace

std::vector<char>
voteForBackground(const SceneData& scene, const LinearOctree& octree,
                  const ExplanationParameters& p)
{
  const std::size_t n = scene.cells.size();
  const double radius = neighbourhood(scene.models, p.vote_radius);
  std::vector<char> background(n, 0);
  parallelFor((n + kBlock - 1) / kBlock, p.steps.threads, [&](std::size_t block, unsigned) {
    std::vector<PlaceRange> ranges;
    std::vector<std::uint32_t> first, second;
    PairFeatures features;
    for (std::size_t i = block * kBlock; i < std::min(n, (block + 1) * kBlock); ++i) {
      second.clear();
      drawNeighbours(octree, scene.cells, static_cast<std::uint32_t>(i), radius, p.vote_pairs,
                     CounterRandom(p.steps.seed, mix64(kVoteStream) + i), ranges, second);
      first.assign(second.size(), static_cast<std::uint32_t>(i));
      featuresOfPairs(scene.source, scene.models.resolution, first, second, features);
      std::size_t votes = 0;
      for (std::size_t k = 0; k < first.size(); ++k)
        votes += isBackground(scene.models, features.angular_bin[k], features.delta_squared[k]);
      background[i] = votes > 0 && static_cast<double>(votes) >= p.vote_share * p.vote_pairs;
    }
  });
  return background;
}

} // namespace interpretation
} // namespace pcl_surflet
