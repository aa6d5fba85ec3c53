#include "steps.h"

#include "pcl_surflet/core/parallel.h"

#include <algorithm>

namespace pcl_surflet {
namespace interpretation {
namespace {

constexpr std::uint64_t kChunk = 1 << 15;        ///< pairs drawn at a time by one thread
constexpr std::size_t kSelectionBlock = 1 << 12; ///< pairs judged at a time by one thread

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

/** \brief Pairs selected from a block of those drawn. */
struct SelectedPairs {
  struct Pair {
    std::size_t object;
    std::uint32_t first, second;
  };
  std::vector<Pair> pairs;
  std::uint64_t background = 0;
};

SelectedPairs
selectFrom(const DrawnPairs& drawn, std::size_t begin, std::size_t end, const SceneModels& models,
           const std::vector<double>& thresholds)
{
  SelectedPairs selected;
  std::vector<float> values(models.all.size());
  for (std::size_t i = begin; i < end; ++i) {
    float best_object = 0, best_background = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] =
          models.all[k].value(drawn.features.angular_bin[i], drawn.features.delta_squared[i]);
      float& best = k < models.objects ? best_object : best_background;
      best = std::max(best, values[k]);
    }
    if (best_background > best_object) { // Eq. 5.9: most likely background
      ++selected.background;
      continue;
    }
    for (std::size_t k = 0; k < models.objects; ++k) // Eq. 5.4, 5.10, 5.11
      if (values[k] > 0 && values[k] >= thresholds[k] && values[k] >= best_object)
        selected.pairs.push_back({k, drawn.first[i], drawn.second[i]});
  }
  return selected;
}

Indices
marked(const std::vector<char>& marks)
{
  Indices out;
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (marks[i])
      out.push_back(static_cast<std::uint32_t>(i));
  return out;
}

/** \brief Surflets of the selected pairs, per object. Pairs are judged in parallel; only the marks
 * are made one after the other. */
std::vector<Indices>
select(const SceneData& scene, const DrawnPairs& drawn, const std::vector<double>& thresholds,
       unsigned threads, InterpretationDiagnostics& diagnostics)
{
  const std::size_t n = drawn.first.size();
  std::vector<SelectedPairs> blocks((n + kSelectionBlock - 1) / kSelectionBlock);
  parallelFor(blocks.size(), threads, [&](std::size_t b, unsigned) {
    const std::size_t begin = b * kSelectionBlock;
    blocks[b] =
        selectFrom(drawn, begin, std::min(n, begin + kSelectionBlock), scene.models, thresholds);
  });
  std::vector<std::vector<char>> chosen(scene.models.objects,
                                        std::vector<char>(scene.cells.size(), 0));
  for (const auto& block : blocks) {
    diagnostics.background += block.background;
    for (const auto& [object, first, second] : block.pairs) {
      chosen[object][first] = chosen[object][second] = 1;
      ++diagnostics.models[scene.models.all[object].index].pairs;
    }
  }
  std::vector<Indices> surflets(chosen.size());
  parallelFor(chosen.size(), threads,
              [&](std::size_t k, unsigned) { surflets[k] = marked(chosen[k]); });
  return surflets;
}

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
  auto selected = select(scene, pairs, thresholds, parameters.threads, diagnostics);
  for (std::size_t k = 0; k < objects; ++k) {
    auto& d = diagnostics.models[scene.models.all[k].index];
    d.threshold = thresholds[k];
    d.surflets = selected[k].size();
  }
  return selected;
}

} // namespace interpretation
} // namespace pcl_surflet
