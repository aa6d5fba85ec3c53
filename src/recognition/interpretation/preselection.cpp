#include "steps.h"

#include "pcl_surflet/core/parallel.h"

#include <algorithm>

namespace pcl_surflet {
namespace interpretation {
namespace {

constexpr std::uint64_t kChunk = 1 << 15; ///< pairs drawn at a time by one thread

/** \brief Drawn pairs that have a feature and are short enough, S of Eq. 5.1. */
struct DrawnPairs {
  std::vector<std::uint32_t> first, second;
  PairFeatures features;
  std::uint64_t drawn = 0, too_long = 0, featureless = 0;

  void
  append(const DrawnPairs& other, std::size_t most)
  {
    const std::size_t n = std::min(other.first.size(), most - first.size());
    const auto add = [n](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.begin() + static_cast<std::ptrdiff_t>(n));
    };
    add(first, other.first);
    add(second, other.second);
    add(features.angular_bin, other.features.angular_bin);
    add(features.delta_squared, other.features.delta_squared);
    drawn += other.drawn;
    too_long += other.too_long;
    featureless += other.featureless;
  }
};

/** \brief Pairs number \p begin ... \p begin + kChunk - 1, as far as they are of use. */
DrawnPairs
drawChunk(const SceneData& scene, std::uint64_t begin, std::uint64_t seed)
{
  DrawnPairs all, kept;
  for (const auto& [a, b] : drawPairs(scene.source.size(), kChunk, seed, begin)) {
    all.first.push_back(a);
    all.second.push_back(b);
  }
  featuresOfPairs(scene.source, scene.models.resolution, all.first, all.second, all.features);
  const double limit = scene.models.largest_delta * scene.source.scale();
  const auto longest = static_cast<float>(limit * limit);
  for (std::size_t i = 0; i < all.first.size(); ++i) {
    if (all.features.delta_squared[i] > longest) {
      ++kept.too_long;
      continue;
    }
    if (all.features.angular_bin[i] == kNoPairFeature) {
      ++kept.featureless;
      continue;
    }
    kept.first.push_back(all.first[i]);
    kept.second.push_back(all.second[i]);
    kept.features.angular_bin.push_back(all.features.angular_bin[i]);
    kept.features.delta_squared.push_back(all.features.delta_squared[i]);
  }
  kept.drawn = kChunk;
  return kept;
}

/** \brief Draws until enough pairs are short enough. Chunks are drawn in parallel and used in their
 * order. */
DrawnPairs
drawShortPairs(const SceneData& scene, const DissertationParameters& parameters)
{
  DrawnPairs pairs;
  if (scene.source.size() < 2)
    return pairs;
  const std::uint64_t most = parameters.pairs * parameters.draws_per_pair;
  constexpr std::size_t kRound = 16; // chunks; fixed, so that threads do not matter
  for (std::uint64_t begin = 0; pairs.first.size() < parameters.pairs && begin < most;
       begin += kRound * kChunk) {
    std::vector<DrawnPairs> chunks(kRound);
    parallelFor(kRound, parameters.threads, [&](std::size_t i, unsigned) {
      chunks[i] = drawChunk(scene, begin + i * kChunk, parameters.seed);
    });
    for (const auto& chunk : chunks)
      if (pairs.first.size() < parameters.pairs)
        pairs.append(chunk, parameters.pairs);
  }
  return pairs;
}

/** \brief Hbar: lambda_H times the mean of H over the features that the model can have
 * [Wahl 2007, Eq. 5.3, 5.5]. */
double
threshold(const SceneModel& model, const PairFeatures& features, double lambda_h)
{
  double sum = 0;
  std::uint64_t m = 0;
  for (std::size_t i = 0; i < features.angular_bin.size(); ++i) {
    const float h = model.value(features.angular_bin[i], features.delta_squared[i]);
    sum += h;
    m += h > 0 ? 1 : 0;
  }
  return m == 0 ? 0 : lambda_h * sum / static_cast<double>(m);
}

/** \brief Which surflets occur in selected pairs, per object. */
class Selection {
public:
  Selection(const SceneData& scene, const std::vector<double>& thresholds,
            InterpretationDiagnostics& diagnostics)
      : models_(scene.models), thresholds_(thresholds), diagnostics_(diagnostics),
        chosen_(scene.models.objects, std::vector<char>(scene.cells.size(), 0))
  {
  }

  void
  add(std::uint32_t first, std::uint32_t second, std::uint32_t angular_bin, float delta_squared)
  {
    float best_object = 0, best_background = 0;
    values_.clear();
    for (std::size_t k = 0; k < models_.all.size(); ++k) {
      values_.push_back(models_.all[k].value(angular_bin, delta_squared));
      float& best = k < models_.objects ? best_object : best_background;
      best = std::max(best, values_.back());
    }
    if (best_background > best_object) { // Eq. 5.9: most likely background
      ++diagnostics_.background;
      return;
    }
    for (std::size_t k = 0; k < models_.objects; ++k)
      if (values_[k] > 0 && values_[k] >= thresholds_[k] && values_[k] >= best_object) {
        chosen_[k][first] = chosen_[k][second] = 1; // Eq. 5.4, 5.10, 5.11
        ++diagnostics_.models[models_.all[k].index].pairs;
      }
  }

  Indices
  surflets(std::size_t k) const
  {
    Indices out;
    for (std::size_t i = 0; i < chosen_[k].size(); ++i)
      if (chosen_[k][i])
        out.push_back(static_cast<std::uint32_t>(i));
    return out;
  }

private:
  const SceneModels& models_;
  const std::vector<double>& thresholds_;
  InterpretationDiagnostics& diagnostics_;
  std::vector<std::vector<char>> chosen_;
  std::vector<float> values_;
};

} // namespace

std::vector<Indices>
preselect(const SceneData& scene, const DissertationParameters& parameters,
          InterpretationDiagnostics& diagnostics)
{
  const DrawnPairs pairs = drawShortPairs(scene, parameters); // Eq. 5.1
  diagnostics.drawn = pairs.drawn;
  diagnostics.too_long = pairs.too_long;
  diagnostics.featureless = pairs.featureless;
  const std::size_t objects = scene.models.objects;
  std::vector<double> thresholds(objects);
  parallelFor(objects, parameters.threads, [&](std::size_t k, unsigned) {
    thresholds[k] = threshold(scene.models.all[k], pairs.features, parameters.lambda_h);
  });
  Selection selection(scene, thresholds, diagnostics);
  for (std::size_t i = 0; i < pairs.first.size(); ++i)
    selection.add(pairs.first[i], pairs.second[i], pairs.features.angular_bin[i],
                  pairs.features.delta_squared[i]);
  std::vector<Indices> selected;
  for (std::size_t k = 0; k < objects; ++k) {
    selected.push_back(selection.surflets(k));
    auto& d = diagnostics.models[scene.models.all[k].index];
    d.threshold = thresholds[k];
    d.surflets = selected.back().size();
  }
  return selected;
}

} // namespace interpretation
} // namespace pcl_surflet
