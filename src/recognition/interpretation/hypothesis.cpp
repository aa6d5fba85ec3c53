#include "explanation.h"

#include "pcl_surflet/core/counter_random.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace interpretation {
namespace {

constexpr std::uint64_t kExplainStream = std::uint64_t{3} << 40;
constexpr std::uint64_t kCompleteStream = std::uint64_t{4} << 40;
constexpr std::uint64_t kSettleStream = std::uint64_t{5} << 40;
constexpr std::uint64_t kPeelStream = std::uint64_t{7} << 40;
constexpr std::uint64_t kSampleStream = std::uint64_t{6} << 40;

/** \brief The open cells of the place. */
Indices
cellsAt(const OpenCells& open, const std::array<double, 3>& place, double radius)
{
  std::vector<PointIndex> found;
  open.octree.regionSearch(
      {static_cast<float>(place[0]), static_cast<float>(place[1]), static_cast<float>(place[2])},
      radius, found, nullptr);
  Indices cells;
  for (const auto i : found)
    if (!open.taken[static_cast<std::size_t>(i)])
      cells.push_back(static_cast<std::uint32_t>(i));
  std::sort(cells.begin(), cells.end());
  return cells;
}

/** \brief At most \p most of the cells, chosen at random. */
Indices
someOf(Indices cells, std::size_t most, CounterRandom random)
{
  if (cells.size() <= most)
    return cells;
  for (std::size_t i = 0; i < most; ++i)
    std::swap(cells[i], cells[i + random.below(static_cast<std::uint32_t>(cells.size() - i))]);
  cells.resize(most);
  std::sort(cells.begin(), cells.end());
  return cells;
}

/** \brief Sums over regrouped features by which an explanation is judged. */
class Judgement {
public:
  Judgement(const SceneModels& models, std::size_t model)
      : models_(models), model_(model), counts_(models.all[model].h.size(), 0)
  {
  }

  void
  add(const Regrouping& groups)
  {
    for (std::size_t i = 0; i < groups.first.size(); ++i)
      if (groups.features.angular_bin[i] != kNoPairFeature)
        add(groups.features.angular_bin[i], groups.features.delta_squared[i]);
  }
  std::uint64_t
  features() const
  {
    return n_;
  }
  double
  ratio() const
  {
    return n_ == 0 ? 0 : ratio_ / static_cast<double>(n_);
  }
  /** \brief Intersection of the histogram with the model's [Wahl 2007, Eq. 3.7]. */
  double
  fit() const
  {
    double sum = 0;
    for (std::size_t b = 0; b < counts_.size(); ++b)
      sum += std::min<double>(models_.all[model_].h[b],
                              counts_[b] / static_cast<double>(std::max<std::uint64_t>(n_, 1)));
    return sum;
  }

private:
  void
  add(std::uint32_t angular_bin, float delta_squared)
  {
    const double own = models_.all[model_].densityOf(angular_bin, delta_squared);
    double all = 0;
    for (const auto& m : models_.all)
      all += m.densityOf(angular_bin, delta_squared);
    if (models_.all.size() == 1) // nothing to compare with: a density without preference
      all = 1.0 / (models_.resolution.angularBins() * std::sqrt(models_.all[0].longest));
    ratio_ += std::log(own * static_cast<double>(models_.all.size()) / all);
    const auto bin = models_.all[model_].bin(angular_bin, delta_squared);
    if (bin != kBeyond)
      ++counts_[bin];
    ++n_;
  }

  const SceneModels& models_;
  std::size_t model_;
  std::vector<std::uint32_t> counts_;
  double ratio_ = 0;
  std::uint64_t n_ = 0;
};

/** \brief Step 3 on the cells of a place. */
void
refine(const SceneData& scene, std::size_t model, std::uint64_t stream,
       const ExplanationParameters& p, Indices& cells)
{
  Regrouping groups;
  for (unsigned k = 0; k < p.max_regroupings && cells.size() > 1; ++k) {
    groups.draw(scene, cells, p.steps.seed, mix64(stream) + k);
    if (!eraseCrosstalk(groups, scene.models.all[model], cells))
      return;
  }
}

/** \brief Takes back what refinement erased along with crosstalk: all open cells of the place that
 * agree with what was kept [Wahl 2007, Sec. 6.1.3]. */
void
complete(const SceneData& scene, const OpenCells& open, const std::array<double, 3>& centre,
         double radius, std::uint64_t stream, const ExplanationParameters& p, Explanation& e)
{
  CounterRandom random(p.steps.seed, mix64(stream ^ kCompleteStream));
  const Indices candidates = cellsAt(open, centre, radius);
  std::vector<std::uint32_t> first, second;
  for (const auto c : candidates)
    for (unsigned k = 0; k < p.probes; ++k) {
      first.push_back(c);
      second.push_back(e.cells[random.below(static_cast<std::uint32_t>(e.cells.size()))]);
    }
  PairFeatures features;
  featuresOfPairs(scene.source, scene.models.resolution, first, second, features);
  const SceneModel& model = scene.models.all[e.model];
  e.cells.clear();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    unsigned crosstalk = 0;
    for (std::size_t k = i * p.probes; k < (i + 1) * p.probes; ++k)
      crosstalk += isCrosstalk(model, features.angular_bin[k], features.delta_squared[k]) ? 1 : 0;
    if (crosstalk <= p.max_crosstalk * p.probes)
      e.cells.push_back(candidates[i]);
  }
}

/** \brief Mean log-likelihood of each cell's pairs with \p probes random other kept cells. */
std::vector<double>
likelihoodOfCells(const SceneData& scene, const Explanation& e, unsigned probes,
                  CounterRandom random)
{
  std::vector<std::uint32_t> first, second;
  const auto n = static_cast<std::uint32_t>(e.cells.size());
  for (const auto c : e.cells)
    for (unsigned k = 0; k < probes; ++k) {
      first.push_back(c);
      second.push_back(e.cells[random.below(n)]);
    }
  PairFeatures features;
  featuresOfPairs(scene.source, scene.models.resolution, first, second, features);
  const SceneModel& model = scene.models.all[e.model];
  std::vector<double> mean(n, 0.0);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto bin = model.bin(features.angular_bin[i], features.delta_squared[i]);
    const bool usable = features.angular_bin[i] != kNoPairFeature;
    mean[i / probes] += !usable          ? model.expected_log
                        : bin == kBeyond ? scene.models.log_h_min
                                         : model.log_h[bin];
  }
  for (double& v : mean)
    v /= probes;
  return mean;
}

/** \brief Drops the cells that fit worst, a share at a time, until the rest is no longer
 * surprising: its mean log-likelihood comes near what the model expects of its own features. */
void
peel(const SceneData& scene, std::uint64_t stream, const ExplanationParameters& p, Explanation& e)
{
  const double expected = scene.models.all[e.model].expected_log;
  for (unsigned round = 0; round < p.peelings && e.cells.size() >= p.steps.min_cluster; ++round) {
    const auto values = likelihoodOfCells(
        scene, e, p.probes, CounterRandom(p.steps.seed, mix64(stream ^ kPeelStream) + round));
    double mean = 0;
    for (const double v : values)
      mean += v / static_cast<double>(values.size());
    if (expected - mean <= p.max_surprise)
      return;
    auto sorted = values;
    const auto worst =
        static_cast<std::ptrdiff_t>(p.peeled_share * static_cast<double>(sorted.size()));
    std::nth_element(sorted.begin(), sorted.begin() + worst, sorted.end());
    Indices kept;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (values[i] > sorted[static_cast<std::size_t>(worst)])
        kept.push_back(e.cells[i]);
    e.cells = std::move(kept);
  }
}

void
judge(const SceneData& scene, std::uint64_t stream, std::uint64_t features,
      const ExplanationParameters& p, Explanation& e)
{
  Judgement judgement(scene.models, e.model);
  Regrouping groups;
  // A few cells may have no pair with a feature: then the loop must end all the same.
  const std::uint64_t rounds = 1 + 2 * features / std::max<std::uint64_t>(e.cells.size(), 1);
  for (std::uint64_t k = 0; k < rounds && judgement.features() < features; ++k) {
    groups.draw(scene, e.cells, p.steps.seed, mix64(~stream) + k);
    judgement.add(groups);
  }
  e.ratio = judgement.ratio();
  e.fit = judgement.fit();
}

} // namespace

Explanation
settle(const SceneData& scene, const OpenCells& open, std::size_t model,
       const std::array<double, 3>& place, std::uint64_t stream, const ExplanationParameters& p)
{
  Explanation e;
  e.model = model;
  e.place = place;
  const double radius = p.reach * scene.models.all[model].model->r_max;
  for (unsigned k = 0; k < p.recentrings; ++k) {
    e.cells = someOf(cellsAt(open, e.place, radius), p.settling_cells,
                     CounterRandom(p.steps.seed, kSampleStream + stream * 64 + k));
    refine(scene, model, kExplainStream + stream * 64 + k, p, e.cells);
    if (e.cells.size() < p.steps.min_cluster)
      return {};
    e.place = centroidOf(scene.cells, e.cells);
  }
  judge(scene, kSettleStream + stream, std::max<std::uint64_t>(p.features / 8, 1), p, e);
  return e.ratio > 0 ? e : Explanation{};
}

void
confirm(const SceneData& scene, const OpenCells& open, std::uint64_t stream,
        const ExplanationParameters& p, Explanation& e)
{
  const double radius = p.reach * scene.models.all[e.model].model->r_max;
  complete(scene, open, e.place, radius, stream, p, e);
  peel(scene, stream, p, e);
  if (e.cells.size() >= p.steps.min_cluster)
    judge(scene, kExplainStream + stream, p.features, p, e);
}

} // namespace interpretation
} // namespace pcl_surflet
