#include "explanation.h"

#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace interpretation {
namespace {

constexpr std::uint64_t kLongStream = 0x6c6f6e67ULL;
constexpr std::uint64_t kLongDraws = 200000;
constexpr float kFewestLongPairs = 2000; ///< a bin of 1 % then has 20
constexpr std::size_t kBlock = 256;      ///< cells judged at a time by one thread

/** \brief Is a pair more likely on a background model than on every object? */
bool
isBackground(const SceneModels& models, std::uint32_t angular_bin, float delta_squared)
{
  float object = 0, background = 0;
  for (std::size_t k = 0; k < models.all.size(); ++k) {
    float& best = k < models.objects ? object : background;
    best = std::max(best, models.all[k].densityOf(angular_bin, delta_squared));
  }
  return background > object;
}

/** \brief \p n neighbours of \p cell, spread evenly over those in reach, which may include itself;
 * fewer than two cells in reach give none. */
void
spreadNeighbours(const LinearOctree& octree, const SurfletSet& s, std::uint32_t cell, double radius,
                 unsigned n, std::vector<PlaceRange>& ranges, std::vector<std::uint32_t>& out)
{
  octree.regionRanges({s.x[cell], s.y[cell], s.z[cell]}, radius, ranges);
  std::uint64_t total = 0;
  for (const auto& r : ranges)
    total += r.end - r.begin;
  std::uint64_t before = 0;
  const auto* range = ranges.data();
  for (unsigned i = 0; total > 1 && i < n; ++i) {
    const std::uint64_t at = (2 * i + 1) * total / (2 * n);
    for (; at - before >= range->end - range->begin; ++range)
      before += range->end - range->begin;
    out.push_back(static_cast<std::uint32_t>(
        octree.indexAt(range->begin + static_cast<std::uint32_t>(at - before))));
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

/** \brief Which features are background, for all angles and distances up to a radius: asked once
 * for every step of distance, not for every pair. */
class FeatureTable {
public:
  /** \param longest in the scene's unit scale
   * \param is_background of (angular bin, squared distance) */
  template <class IsBackground>
  FeatureTable(const Resolution& resolution, double longest, const IsBackground& is_background)
      : angular_bins_(static_cast<std::uint32_t>(resolution.angularBins())),
        steps_per_length_(static_cast<float>(kSteps / longest))
  {
    for (unsigned k = 0; k < kSteps; ++k) {
      const auto delta = static_cast<float>((k + 0.5) / kSteps * longest);
      for (std::uint32_t a = 0; a < angular_bins_; ++a)
        table_.push_back(is_background(a, delta * delta) ? 1 : 0);
    }
  }
  unsigned
  operator()(std::uint32_t angular_bin, float delta_squared) const
  {
    if (angular_bin == kNoPairFeature)
      return 0;
    const float step = std::min(std::sqrt(delta_squared) * steps_per_length_, kSteps - 1.f);
    return table_[static_cast<std::size_t>(step) * angular_bins_ + angular_bin];
  }

private:
  static constexpr unsigned kSteps = 64; // nine or more in every interval of a model
  std::uint32_t angular_bins_;
  float steps_per_length_;
  std::vector<char> table_;
};

/** \brief Background are the cells of which enough pairs with neighbours within \p radius are, by
 * \p is_background (angular bin, squared distance). */
template <class IsBackground>
std::vector<char>
vote(const SceneData& scene, const LinearOctree& octree, double radius, double share,
     const ExplanationParameters& p, const IsBackground& is_background)
{
  const std::size_t n = scene.cells.size();
  const FeatureTable table(scene.models.resolution, radius * scene.source.scale(), is_background);
  std::vector<char> background(n, 0);
  parallelFor((n + kBlock - 1) / kBlock, p.steps.threads, [&](std::size_t block, unsigned) {
    const std::size_t begin = block * kBlock, end = std::min(n, begin + kBlock);
    std::vector<PlaceRange> ranges;
    std::vector<std::uint32_t> first, second;
    for (std::size_t i = begin; i < end; ++i) {
      spreadNeighbours(octree, scene.cells, static_cast<std::uint32_t>(i), radius, p.vote_pairs,
                       ranges, second);
      first.resize(second.size(), static_cast<std::uint32_t>(i));
    }
    PairFeatures features;
    featuresOfPairs(scene.source, scene.models.resolution, first, second, features);
    std::vector<unsigned> votes(end - begin, 0);
    for (std::size_t k = 0; k < first.size(); ++k)
      votes[first[k] - begin] += table(features.angular_bin[k], features.delta_squared[k]);
    for (std::size_t i = begin; i < end; ++i)
      background[i] = votes[i - begin] > 0 && votes[i - begin] >= share * p.vote_pairs;
  });
  return background;
}

/** \brief Distribution of the angles of drawn pairs longer than every object, up to twice as long;
 * empty if there are too few. */
std::vector<float>
anglesOfLongPairs(const SceneData& scene, std::uint64_t seed)
{
  const auto pairs = drawPairs(scene.cells.size(), kLongDraws, seed);
  std::vector<std::uint32_t> first, second;
  for (const auto& [a, b] : pairs) {
    first.push_back(a);
    second.push_back(b);
  }
  PairFeatures f;
  featuresOfPairs(scene.source, scene.models.resolution, first, second, f);
  const double longest = scene.models.largest_delta * scene.source.scale();
  std::vector<float> angles(static_cast<std::size_t>(scene.models.resolution.angularBins()), 0.f);
  float total = 0;
  for (std::size_t i = 0; i < f.angular_bin.size(); ++i)
    if (f.angular_bin[i] != kNoPairFeature && f.delta_squared[i] > longest * longest &&
        f.delta_squared[i] <= 4 * longest * longest) {
      angles[f.angular_bin[i]] += 1;
      total += 1;
    }
  if (total < kFewestLongPairs)
    return {};
  for (float& a : angles)
    a /= total;
  return angles;
}

/** \brief P(angles | delta) of a model: its bins divided by the sum of their delta interval. */
std::vector<float>
conditionalOnDelta(const SceneModel& m)
{
  std::vector<float> out(m.h.size());
  for (std::size_t begin = 0; begin < m.h.size(); begin += m.angular_bins) {
    float sum = 0;
    for (std::size_t a = 0; a < m.angular_bins; ++a)
      sum += m.h[begin + a];
    for (std::size_t a = 0; a < m.angular_bins; ++a)
      out[begin + a] = sum > 0 ? m.h[begin + a] / sum : 0;
  }
  return out;
}

} // namespace

std::vector<char>
voteForBackground(const SceneData& scene, const LinearOctree& octree,
                  const ExplanationParameters& p)
{
  return vote(scene, octree, neighbourhood(scene.models, p.vote_radius), p.vote_share, p,
              [&](std::uint32_t angular_bin, float delta_squared) {
                return isBackground(scene.models, angular_bin, delta_squared);
              });
}

std::vector<char>
voteForUniformBackground(const SceneData& scene, const LinearOctree& octree,
                         const ExplanationParameters& p)
{
  if (scene.cells.size() < 2)
    return {};
  const auto background = anglesOfLongPairs(scene, p.steps.seed ^ kLongStream);
  if (background.empty())
    return {};
  std::vector<std::vector<float>> conditional;
  for (std::size_t k = 0; k < scene.models.objects; ++k)
    conditional.push_back(conditionalOnDelta(scene.models.all[k]));
  const double radius = p.uniform_vote_radius * scene.models.largest_delta;
  return vote(scene, octree, radius, p.uniform_vote_share, p,
              [&](std::uint32_t angular_bin, float delta_squared) {
                float object = 0;
                for (std::size_t k = 0; k < conditional.size(); ++k) {
                  const auto b = scene.models.all[k].bin(angular_bin, delta_squared);
                  if (b != kBeyond)
                    object = std::max(object, conditional[k][b]);
                }
                return background[angular_bin] > object;
              });
}

} // namespace interpretation
} // namespace pcl_surflet
