#include "floating_seeds.h"
#include "steps.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/linear_octree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pcl_surflet {
namespace interpretation {
namespace {

constexpr std::uint64_t kSeedStream = 0x73656564ULL;

/** \brief \p n of \p all, each at most once, in random order. */
std::vector<std::uint32_t>
randomSample(const Indices& all, std::size_t n, CounterRandom random)
{
  std::vector<std::uint32_t> sample = all;
  n = std::min(n, sample.size());
  for (std::size_t i = 0; i < n; ++i) {
    const auto rest = static_cast<std::uint32_t>(sample.size() - i);
    std::swap(sample[i], sample[i + random.below(rest)]);
  }
  sample.resize(n);
  return sample;
}

Indices
ascending(const std::vector<PointIndex>& found)
{
  Indices out(found.begin(), found.end());
  std::sort(out.begin(), out.end());
  return out;
}

Position
rounded(const Place& place)
{
  return {static_cast<float>(place[0]), static_cast<float>(place[1]), static_cast<float>(place[2])};
}

/** \brief Where the centre of a seed of \p model goes among the surflets of \p octree. */
std::vector<Place>
pathOfSeed(const HistogramModel& model, const LinearOctree& octree, const Position& start,
           const FloatingSeeds& parameters)
{
  if (!(model.r_min < model.r_max)) // a sphere: all distances from its middle are alike
    return {{start[0], start[1], start[2]}};
  const SeedEnergy energy(model.r_min, model.r_max, parameters.steepness / model.r_max);
  std::vector<PlaceRange> ranges;
  std::vector<Place> near;
  const auto about = [&](const Place& q) -> const std::vector<Place>& {
    octree.regionRanges(rounded(q), energy.reach(), ranges);
    near.clear();
    for (const auto& r : ranges)
      for (std::uint32_t at = r.begin; at < r.end; ++at) {
        const Position p = octree.positionAt(at);
        near.push_back({p[0], p[1], p[2]});
      }
    return near;
  };
  return floatSeed(energy, about, {start[0], start[1], start[2]}, parameters.steps);
}

/** \brief Mean of \p value (angular bin, squared distance) over the features; -inf without any. */
template <class Value>
double
meanOfFeatures(const Regrouping& groups, const Value& value)
{
  double sum = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < groups.first.size(); ++i) {
    if (groups.features.angular_bin[i] == kNoPairFeature)
      continue;
    sum += value(groups.features.angular_bin[i], groups.features.delta_squared[i]);
    ++n;
  }
  return n == 0 ? -std::numeric_limits<double>::infinity() : sum / static_cast<double>(n);
}

} // namespace

bool
isCrosstalk(const SceneModel& model, std::uint32_t angular_bin, float delta_squared)
{
  return angular_bin != kNoPairFeature && model.value(angular_bin, delta_squared) == 0;
}

bool
eraseCrosstalk(const Regrouping& groups, const SceneModel& model, Indices& surflets)
{
  Indices bad;
  for (std::size_t i = 0; i < groups.first.size(); ++i)
    if (isCrosstalk(model, groups.features.angular_bin[i], groups.features.delta_squared[i])) {
      bad.push_back(groups.first[i]);
      bad.push_back(groups.second[i]);
    }
  std::sort(bad.begin(), bad.end());
  Indices kept;
  std::set_difference(surflets.begin(), surflets.end(), bad.begin(), bad.end(),
                      std::back_inserter(kept));
  surflets = std::move(kept);
  return !bad.empty();
}

void
Regrouping::draw(const SceneData& scene, const Indices& surflets, std::uint64_t seed,
                 std::uint64_t stream)
{
  CounterRandom random(seed, stream);
  std::vector<std::uint32_t> order = surflets;
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
  const auto half = static_cast<std::ptrdiff_t>(order.size() / 2);
  first.assign(order.begin(), order.begin() + half);
  second.assign(order.begin() + half, order.begin() + 2 * half);
  featuresOfPairs(scene.source, scene.models.resolution, first, second, features);
}

double
meanLogLikelihood(const Regrouping& groups, const SceneModel& model, float log_h_min)
{
  return meanOfFeatures(groups, [&](std::uint32_t angular_bin, float delta_squared) -> double {
    const auto bin = model.bin(angular_bin, delta_squared);
    return bin == kBeyond ? log_h_min : model.log_h[bin];
  });
}

double
meanLogDensity(const Regrouping& groups, const SceneModel& model)
{
  return meanOfFeatures(groups, [&](std::uint32_t angular_bin, float delta_squared) {
    return std::log(static_cast<double>(model.densityOf(angular_bin, delta_squared)));
  });
}

ClustersOfModel
plantSeeds(const SceneData& scene, std::size_t model, const Indices& selected,
           const DissertationParameters& parameters, ModelDiagnostics& diagnostics)
{
  ClustersOfModel seeds;
  const std::vector<PointIndex> subset(selected.begin(), selected.end());
  LinearOctree octree;
  const auto& s = scene.cells;
  octree.build({s.x.data(), s.y.data(), s.z.data(), 1, s.size()}, &subset);
  const CounterRandom random(parameters.seed, kSeedStream + model);
  const HistogramModel& m = *scene.models.all[model].model;
  std::vector<PointIndex> found;
  for (const auto c : randomSample(selected, parameters.seeds, random)) {
    Position centre = {s.x[c], s.y[c], s.z[c]};
    if (parameters.floating.on) {
      auto path = pathOfSeed(m, octree, centre, parameters.floating);
      centre = rounded(path.back());
      if (parameters.floating.keep_paths)
        diagnostics.seed_paths.push_back(std::move(path));
    }
    octree.regionSearch(centre, m.r_max, found, nullptr); // Eq. 5.13
    seeds.emplace_back();
    seeds.back().surflets = ascending(found);
  }
  return seeds;
}

void
refineSeed(const SceneData& scene, std::size_t model, std::uint64_t stream,
           const DissertationParameters& parameters, Cluster& seed)
{
  const SceneModel& m = scene.models.all[model];
  Regrouping groups;
  for (unsigned k = 0; k < parameters.max_regroupings && seed.surflets.size() > 1; ++k) {
    groups.draw(scene, seed.surflets, parameters.seed, mix64(stream) + k); // Eq. 5.14
    if (eraseCrosstalk(groups, m, seed.surflets))
      continue;
    seed.likelihood = meanLogLikelihood(groups, m, scene.models.log_h_min); // Eq. 5.16
    return;
  }
  seed.surflets.clear();
}

} // namespace interpretation
} // namespace pcl_surflet
