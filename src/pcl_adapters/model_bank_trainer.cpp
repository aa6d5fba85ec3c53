#include "pcl_surflet/model_bank_trainer.h"

#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/pair_counting.h"
#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/sensed_surface.h"
#include "recognition/histogram_clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pcl_surflet {
namespace {

/** \brief Samplings that take turns in being disturbed: one would leave its mark on all members. */
constexpr unsigned kSamplings = 8;

/** \brief Pairs drawn of a disturbed sample: far more than the bins, and a millisecond. */
constexpr std::uint64_t kPairs = 100000;

/** \brief The eighth neighbour of a surflet of an even cloud is so many spacings away: within that
 * radius lie pi r^2 = 9 spacings squared. */
constexpr double kEighthNeighbour = 1.69;

/** \brief Keeps the draws of banks apart from those of other things with the same seed. */
constexpr std::uint64_t kBankStream = 0x62616e6bULL;

/** \brief \p count surflets drawn without replacement, in their order; all if there are no more. */
SurfletSet
thinned(const SurfletSet& set, std::size_t count, std::uint64_t seed)
{
  if (set.size() <= count)
    return set;
  CounterRandom random(seed);
  std::vector<std::uint32_t> order(set.size());
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = 0; i < count; ++i)
    std::swap(order[i], order[i + random.below(static_cast<std::uint32_t>(set.size() - i))]);
  order.resize(count);
  std::sort(order.begin(), order.end());
  return set.subset(order);
}

} // namespace

ModelBankTrainer::ModelBankTrainer(HistogramModelTrainer trainer, ModelBank bank)
    : trainer_(std::move(trainer)), bank_(std::move(bank))
{
}

void
ModelBankTrainer::setSamplesPerMember(unsigned samples)
{
  if (samples == 0)
    throw std::invalid_argument("pcl_surflet: at least one sample per member");
  samples_ = samples;
}

HistogramModel
ModelBankTrainer::train(const std::string& label, const SurfletSet& surflets) const
{
  HistogramModel model = trainer_.train(label, surflets);
  if (bank_.conditions.empty())
    return model;
  const SurfletSet even = trainer_.evened(label, surflets);
  const std::size_t wanted = trainer_.getMeshSurflets();
  Base base;
  for (unsigned k = 0; k < (even.size() > wanted ? kSamplings : 1); ++k)
    base.samplings.push_back(
        thinned(even, wanted, mix64(mix64(trainer_.getSeed() ^ kBankStream) + k)));
  base.spacing = surfaceDensity(base.samplings.front()).spacing / kEighthNeighbour;
  addMembers(model, base);
  return model;
}

HistogramModel
ModelBankTrainer::train(const std::string& label, const TriangleMesh& mesh) const
{
  HistogramModel model = trainer_.train(label, mesh);
  if (bank_.conditions.empty())
    return model;
  Base base;
  for (unsigned k = 0; k < kSamplings; ++k)
    base.samplings.push_back(sampleIsoMesh(mesh, trainer_.getMeshSurflets(),
                                           mix64(mix64(trainer_.getSeed() ^ kBankStream) + k)));
  base.spacing = std::sqrt(model.surface_area / static_cast<double>(trainer_.getMeshSurflets()));
  addMembers(model, base);
  return model;
}

SurfletSet
ModelBankTrainer::disturbed(const BankCondition& condition, const SurfletSet& sampling,
                            double delta_max, double spacing, std::uint64_t seed) const
{
  const double noise = condition.noise * delta_max;
  SurfletSet set = sampling;
  if (condition.view)
    set = singleView(set, spacing, noise, mix64(seed + 1));
  else if (noise > 0)
    set = displacedAlongNormals(set, noise, mix64(seed + 1));
  if (condition.visible < 1)
    set = cutByRandomPlane(set, condition.visible, mix64(seed + 2));
  if (condition.view || noise > 0)
    set = withEstimatedNormals(set, bank_.normal_radius * spacing, 1).surflets;
  return set;
}

void
ModelBankTrainer::addMembers(HistogramModel& model, const Base& base) const
{
  const Resolution& resolution = trainer_.getResolution();
  for (std::size_t c = 0; c < bank_.conditions.size(); ++c) {
    const BankCondition& condition = bank_.conditions[c];
    std::vector<PairHistogram> histograms(std::size_t{samples_} * condition.members,
                                          PairHistogram(resolution));
    parallelFor(histograms.size(), trainer_.getNumberOfThreads(), [&](std::size_t t, unsigned) {
      const auto seed = mix64(mix64(mix64(trainer_.getSeed() ^ kBankStream) ^ (c + 1)) + t);
      const SurfletSet set = disturbed(condition, base.samplings[t % base.samplings.size()],
                                       model.delta_max, base.spacing, seed);
      histograms[t] =
          countDrawnPairs(PairSource(set), resolution, model.delta_max, kPairs, mix64(seed), 1);
    });
    const auto groups = groupHistograms(histograms, condition.members);
    if (groups.empty())
      throw TrainingError("'" + model.label + "': the condition '" + condition.name(0, 1) +
                          "' leaves nothing that has a feature; give more points or leave the "
                          "condition out of the bank");
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const auto h = groups[g].normalized();
      model.members.push_back({condition.name(g, groups.size()),
                               std::vector<float>(h.begin(), h.end()), groups[g].features});
    }
  }
}

} // namespace pcl_surflet
