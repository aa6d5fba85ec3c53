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
constexpr std::size_t kVoteBlock = 256;  ///< cells judged at a time by one thread
constexpr std::size_t kPartners = 4;     ///< partners in reach for each that is asked
constexpr std::uint32_t kTypicalBalls = 65;
constexpr double kSharedReach = 0.1; ///< share of the radius within which cells share partners

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

bool
areNear(const Position& a, const Position& b, double distance)
{
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z <= distance * distance;
}

/** \brief The cells at the places from \p begin to \p end of the octree, each with \p asked
 * partners of \p thin: one choice serves neighbours, which have nearly the same in reach. */
PairRows
rowsOf(const SceneData& scene, const LinearOctree& octree, std::uint32_t begin, std::uint32_t end,
       const LinearOctree& thin, double radius, unsigned asked)
{
  PairRows rows;
  std::vector<PlaceRange> ranges;
  Indices partners;
  std::size_t first = 0;
  Position middle{};
  for (std::uint32_t place = begin; place < end; ++place) {
    const Position q = octree.positionAt(place);
    if (place == begin || !areNear(q, middle, kSharedReach * radius)) {
      middle = q;
      first = partners.size();
      thin.regionRanges(q, radius, ranges);
      if (cellsIn(ranges) > 1)
        spreadOver(thin, ranges, asked, partners);
    }
    rows.addRow(static_cast<std::uint32_t>(octree.indexAt(place)), first, partners.size() - first);
  }
  rows.setPartners(scene.source, partners);
  return rows;
}

/** \brief Every so manieth cell of \p octree, so that a typical ball holds kPartners times as many
 * as are asked: partners are spread over it anyway, and finding all of them took nine tenths of the
 * vote. The octree keeps neighbours together, so what is left is even. */
LinearOctree
thinned(const SceneData& scene, const LinearOctree& octree, double radius, unsigned asked)
{
  const SurfletSet& s = scene.cells;
  std::vector<std::size_t> sizes;
  std::vector<PlaceRange> ranges;
  for (std::uint32_t k = 0; k < kTypicalBalls && octree.size() > 0; ++k) {
    const auto at = static_cast<std::uint32_t>(octree.size() * k / kTypicalBalls);
    const auto i = static_cast<std::size_t>(octree.indexAt(at));
    octree.regionRanges({s.x[i], s.y[i], s.z[i]}, radius, ranges);
    sizes.push_back(cellsIn(ranges));
  }
  std::sort(sizes.begin(), sizes.end());
  const std::size_t typical = sizes.empty() ? 0 : sizes[sizes.size() / 2];
  const std::size_t step = std::max<std::size_t>(1, typical / (kPartners * std::size_t{asked}));
  std::vector<PointIndex> some;
  for (std::size_t k = step / 2; k < octree.size(); k += step)
    some.push_back(octree.indexData()[k]);
  LinearOctree thin;
  thin.build({s.x.data(), s.y.data(), s.z.data(), 1, s.size()}, &some);
  return thin;
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
  const LinearOctree thin = thinned(scene, octree, radius, p.vote_pairs);
  std::vector<char> background(n, 0);
  parallelFor((octree.size() + kVoteBlock - 1) / kVoteBlock, p.steps.threads,
              [&](std::size_t block, unsigned) {
                const auto begin = static_cast<std::uint32_t>(block * kVoteBlock);
                const auto end = static_cast<std::uint32_t>(
                    std::min<std::size_t>(octree.size(), begin + kVoteBlock));
                PairRows rows = rowsOf(scene, octree, begin, end, thin, radius, p.vote_pairs);
                PairFeatures features;
                featuresOfRows(scene.source, scene.models.resolution, rows, features);
                std::size_t pair = 0;
                for (std::size_t row = 0; row < rows.surflet.size(); ++row) {
                  unsigned votes = 0;
                  for (const std::size_t last = pair + rows.count[row]; pair < last; ++pair)
                    votes += table(features.angular_bin[pair], features.delta_squared[pair]);
                  background[rows.surflet[row]] = votes > 0 && votes >= share * p.vote_pairs;
                }
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
