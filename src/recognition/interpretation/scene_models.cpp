#include "scene_models.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>

namespace pcl_surflet {
namespace interpretation {
namespace {

/** \brief Fills SceneModel::support and what belongs to it. */
void
fillSupport(const Histogram& penalised, const std::vector<float>& chance, double scale,
            SceneModel& m)
{
  const int intervals = m.model->resolution.delta;
  m.intervals_per_length = static_cast<float>(intervals / (m.model->delta_max * scale));
  m.last_row = static_cast<float>(intervals);
  std::size_t bin = 0;
  for (int k = 0; k < intervals; ++k) {
    // Distances of points on a sphere have the density 2 d / D^2.
    const double share = (2.0 * k + 1) / (static_cast<double>(intervals) * intervals);
    for (std::size_t a = 0; a < chance.size(); ++a, ++bin) {
      const double ratio = std::log(penalised[bin] / (share * chance[a]));
      m.support.push_back(std::clamp(static_cast<float>(ratio), -kMostSupport, kMostSupport));
      m.expected_support += penalised[bin] * m.support.back();
    }
    m.support.push_back(0);
  }
  m.support.insert(m.support.end(), chance.size(), -kMostSupport);
  m.support.push_back(0);
}

std::vector<float>
countedChanceAngles(const Resolution& resolution)
{
  constexpr std::uint32_t kSurflets = 700; // 245,000 pairs: seven per cent for an average bin
  CounterRandom random(1);
  const auto direction = [&]() -> std::array<float, 3> {
    const double z = random.uniform(-1, 1), phi = random.uniform(0, 2 * M_PI),
                 r = std::sqrt(1 - z * z);
    return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
            static_cast<float>(z)};
  };
  SurfletSet set;
  std::vector<std::uint32_t> first, second;
  for (std::uint32_t i = 0; i < kSurflets; ++i) {
    const auto p = direction(), n = direction();
    set.push_back({p[0], p[1], p[2], n[0], n[1], n[2]});
    for (std::uint32_t j = 0; j < i; ++j) {
      first.push_back(i);
      second.push_back(j);
    }
  }
  PairFeatures features;
  featuresOfPairs(PairSource(set), resolution, first, second, features);
  std::vector<float> chance(static_cast<std::size_t>(resolution.angularBins()), 0.5f);
  float total = 0.5f * static_cast<float>(chance.size());
  for (const auto bin : features.angular_bin)
    if (bin != kNoPairFeature) {
      chance[bin] += 1;
      total += 1;
    }
  for (float& c : chance)
    c /= total;
  return chance;
}

} // namespace

const std::vector<float>&
chanceAngles(const Resolution& resolution)
{
  // A quarter of the training of views, when it was counted for each of them.
  static std::mutex mutex;
  static std::map<std::array<int, 3>, std::vector<float>> known;
  const std::lock_guard<std::mutex> lock(mutex);
  const std::array<int, 3> key = {resolution.alpha, resolution.beta, resolution.gamma};
  const auto found = known.find(key);
  return found != known.end() ? found->second
                              : known.emplace(key, countedChanceAngles(resolution)).first->second;
}

SceneModel
sceneModel(const HistogramModel& model, double h_min, double scale,
           const std::vector<float>& chance)
{
  SceneModel m;
  m.model = &model;
  // Pairs are judged by the complete object: what a sensor sees of it is a part.
  const auto& complete = model.members.front().histogram;
  const Histogram raw(complete.begin(), complete.end());
  const Histogram penalised = penalize(raw, h_min);
  m.h.assign(raw.begin(), raw.end());
  for (const auto& member : model.members) {
    m.members.push_back(member.histogram);
    m.members.back().resize((raw.size() + kOverlapBlock - 1) / kOverlapBlock * kOverlapBlock, 0.f);
  }
  for (const double v : penalised) {
    m.log_h.push_back(static_cast<float>(std::log(v)));
    m.expected_log += v * std::log(v);
  }
  const double delta_max = model.delta_max;
  for (int k = 0; k + 1 < model.resolution.delta; ++k)
    m.border.push_back(deltaBorder(k, model.resolution, delta_max, scale));
  const double width = delta_max * scale / model.resolution.delta;
  for (const double v : penalised)
    m.density.push_back(static_cast<float>(v / width));
  m.least_density = static_cast<float>(h_min / width);
  m.longest = static_cast<float>(delta_max * scale * delta_max * scale);
  m.angular_bins = static_cast<std::uint32_t>(model.resolution.angularBins());
  fillSupport(penalised, chance, scale, m);
  return m;
}

Overlap
bestOverlap(const SceneModel& model, const std::vector<float>& histogram)
{
  Overlap best;
  for (std::size_t k = 0; k < model.members.size(); ++k) {
    const float* a = model.members[k].data();
    const float* b = histogram.data();
    float lanes[kOverlapBlock] = {}; // so the compiler may use vectors of any width
    for (std::size_t i = 0; i < histogram.size(); i += kOverlapBlock)
      for (std::size_t l = 0; l < kOverlapBlock; ++l)
        lanes[l] += std::min(a[i + l], b[i + l]);
    double share = 0;
    for (const float lane : lanes)
      share += lane;
    if (share > best.share)
      best = {share, k};
  }
  return best;
}

SceneModels
sceneModels(const ModelDatabase& database, bool with_background, double scale, unsigned threads)
{
  SceneModels models;
  models.resolution = database.resolution();
  const double h_min = database.penaltyMinimum();
  models.log_h_min = static_cast<float>(std::log(h_min));
  std::vector<std::size_t> order;
  for (const auto role : {ModelRole::Object, ModelRole::Background}) {
    for (std::size_t i = 0; i < database.size(); ++i)
      if (database[i].role == role && (role == ModelRole::Object || with_background))
        order.push_back(i);
    if (role == ModelRole::Object)
      models.objects = order.size();
  }
  const auto& chance = chanceAngles(models.resolution);
  models.all.resize(order.size());
  parallelFor(order.size(), threads, [&](std::size_t k, unsigned) {
    models.all[k] = sceneModel(database[order[k]], h_min, scale, chance);
    models.all[k].index = order[k];
  });
  for (std::size_t i = 0; i < models.objects; ++i)
    models.largest_delta = std::max(models.largest_delta, models.all[i].model->delta_max);
  return models;
}

} // namespace interpretation
} // namespace pcl_surflet
