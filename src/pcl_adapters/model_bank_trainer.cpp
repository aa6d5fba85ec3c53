#include "pcl_surflet/model_bank_trainer.h"

#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/pair_counting.h"
#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/recognition/histogram_classifier.h"
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

/** \brief Floor of empty bins when misfits are measured; the default of a database. */
const double kFloor = PenaltyParameters().floor;

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

/** \brief The lengths that conditions need, in the unit of the data. */
struct Lengths {
  double delta_max, spacing;
  double normal_radius; ///< in spacings
};

SurfletSet
disturbed(const BankCondition& condition, const SurfletSet& sampling, const Lengths& lengths,
          std::uint64_t seed)
{
  const double noise = condition.noise * lengths.delta_max;
  SurfletSet set = sampling;
  if (condition.view)
    set = singleView(set, lengths.spacing, noise, mix64(seed + 1));
  else if (noise > 0)
    set = displacedAlongNormals(set, noise, mix64(seed + 1));
  if (condition.visible < 1)
    set = cutByRandomPlane(set, condition.visible, mix64(seed + 2));
  if (condition.view || noise > 0)
    set = withEstimatedNormals(set, lengths.normal_radius * lengths.spacing, 1).surflets;
  return set;
}

/** \brief Mean of some misfits, and the multiple of it that 97.5 % of them stay below. */
struct Calibration {
  double mean = 0, limit = 0;
};

Calibration
calibrated(std::vector<double> misfits)
{
  misfits.erase(
      std::remove_if(misfits.begin(), misfits.end(), [](double m) { return !std::isfinite(m); }),
      misfits.end());
  if (misfits.empty())
    return {};
  const double mean =
      std::accumulate(misfits.begin(), misfits.end(), 0.0) / static_cast<double>(misfits.size());
  const auto rank = static_cast<std::size_t>(0.975 * static_cast<double>(misfits.size()));
  std::nth_element(misfits.begin(), misfits.begin() + static_cast<std::ptrdiff_t>(rank),
                   misfits.end());
  return mean > 0 ? Calibration{mean, misfits[rank] / mean} : Calibration{};
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
  if (!(base.spacing > 0))
    throw TrainingError("'" + label + "': " + std::to_string(even.size()) +
                        " points are too few to be trained under the conditions of a bank; give "
                        "more points, or train without bank");
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

ModelBankTrainer::Counted
ModelBankTrainer::count(const BankCondition& condition, const Base& base, double delta_max,
                        std::uint64_t seed) const
{
  const Resolution& resolution = trainer_.getResolution();
  const std::vector<PairHistogram> none(std::size_t{samples_} * condition.members,
                                        PairHistogram(resolution));
  Counted counted{none, none, std::vector<double>(none.size())};
  parallelFor(none.size(), trainer_.getNumberOfThreads(), [&](std::size_t t, unsigned) {
    const auto own = mix64(seed + t);
    const SurfletSet& sampling = base.samplings[t % base.samplings.size()];
    const SurfletSet left =
        disturbed(condition, sampling, {delta_max, base.spacing, bank_.normal_radius}, own);
    const PairSource source(left);
    counted.left[t] = static_cast<double>(left.size()) / static_cast<double>(sampling.size());
    counted.rich[t] = countDrawnPairs(source, resolution, delta_max, kPairs, mix64(own), 1);
    counted.like_queries[t] =
        countDrawnPairs(source, resolution, delta_max,
                        HistogramClassifier::defaultFeatures(resolution), mix64(own + 3), 1);
  });
  return counted;
}

void
ModelBankTrainer::addCondition(HistogramModel& model, const Base& base, std::size_t c) const
{
  const BankCondition& condition = bank_.conditions[c];
  const auto counted = count(condition, base, model.delta_max,
                             mix64(mix64(trainer_.getSeed() ^ kBankStream) ^ (c + 1)));
  const auto groups = groupHistograms(counted.rich, condition.members);
  if (groups.empty())
    throw TrainingError("'" + model.label + "': the condition '" + condition.name(0, 1) +
                        "' leaves nothing that has a feature; give more points or leave the "
                        "condition out of the bank");
  const auto calibration =
      calibrated(leftOutMisfits(counted.like_queries, counted.rich, groups, kFloor));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto h = groups[g].sum.normalized();
    double left = 0;
    for (const auto k : groups[g].parts)
      left += counted.left[k] / static_cast<double>(groups[g].parts.size());
    model.members.push_back({condition.name(g, groups.size()),
                             std::vector<float>(h.begin(), h.end()), groups[g].sum.features,
                             calibration.mean, calibration.limit, left * model.surface_area});
  }
}

void
ModelBankTrainer::calibrateComplete(HistogramModel& model, const Base& base) const
{
  const auto counted =
      count({}, base, model.delta_max, mix64(mix64(trainer_.getSeed() ^ kBankStream)));
  ModelMember& complete = model.members.front();
  const std::vector<double> h(complete.histogram.begin(), complete.histogram.end());
  std::vector<double> misfits;
  for (const auto& sample : counted.like_queries)
    misfits.push_back(misfit(sample, h, kFloor));
  const auto calibration = calibrated(misfits);
  complete.misfit = calibration.mean;
  complete.misfit_limit = calibration.limit;
}

void
ModelBankTrainer::addMembers(HistogramModel& model, const Base& base) const
{
  calibrateComplete(model, base);
  for (std::size_t c = 0; c < bank_.conditions.size(); ++c)
    addCondition(model, base, c);
}

} // namespace pcl_surflet
