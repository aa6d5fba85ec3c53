#include "support.h"

#include "kernels/pair_kernels.h"
#include "pcl_surflet/core/counter_random.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace interpretation {
namespace {

constexpr unsigned kIterations = 10;
/** \brief A weight rises from 0 to 1 over this interval of support, halved thrice. */
constexpr float kFirstSlope = 1;
constexpr unsigned kSlopeDoublings = 3;
constexpr float kSettled = 0.005f;          ///< share of the weight that may still change
constexpr std::size_t kPairsInCache = 4096; ///< whose indices and features stay in the cache

/** \brief Columns and distances of what is in m.features, see Sample. */
void
columnsOf(const PairFeatures& features, std::uint32_t angular_bins,
          std::vector<std::uint32_t>& column, std::vector<float>& delta)
{
  const std::size_t n = features.angular_bin.size();
  column.resize(n);
  delta.resize(n);
  for (std::size_t i = 0; i < n; ++i) { // kNoPairFeature is the largest number
    column[i] = std::min(features.angular_bin[i], angular_bins);
    delta[i] = std::sqrt(features.delta_squared[i]);
  }
}

/** \brief SceneModel::supportIndex() of many pairs. */
void
indicesOf(const SceneModel& model, const std::vector<std::uint32_t>& column,
          const std::vector<float>& delta, std::vector<std::uint32_t>& index)
{
  index.resize(column.size());
  for (std::size_t i = 0; i < column.size(); ++i)
    index[i] = model.supportIndex(column[i], delta[i]);
}

/** \brief Support of all pairs of the sample as a square matrix. */
void
fillRatios(const SceneModel& model, std::size_t n, const std::vector<std::uint32_t>& index,
           std::vector<float>& ratio)
{
  ratio.resize(n * n);
  std::size_t pair = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j, ++pair)
      ratio[i * n + j] = model.support[index[pair]];
    ratio[i * n + i] = 0;
  }
  constexpr std::size_t kBlock = 16; // blocks stay in the cache
  for (std::size_t b = 0; b < n; b += kBlock)
    for (std::size_t i = b; i < n; ++i)
      for (std::size_t j = b; j < std::min(i, b + kBlock); ++j)
        ratio[j * n + i] = ratio[i * n + j];
}

/** \brief Support of every cell by all by their weights. \return sum of the weights */
float
sumSupport(const std::vector<float>& ratio, const std::vector<float>& weight,
           std::vector<float>& support)
{
  const std::size_t n = weight.size();
  float total = 0;
  std::fill(support.begin(), support.end(), 0.f);
  for (std::size_t j = 0; j < n; ++j) {
    const float w = weight[j];
    if (w == 0)
      continue;
    total += w;
    kernels::active().addWeighted(ratio.data() + j * n, w, n, support.data());
  }
  if (total > 0)
    for (float& s : support)
      s /= total;
  return total;
}

/** \brief Lets the weights settle; cells whose weight is zero take no part. */
void
settleWeights(const std::vector<float>& ratio, std::vector<float>& weight,
              std::vector<float>& support)
{
  std::vector<char> takes_part(weight.size());
  for (std::size_t i = 0; i < weight.size(); ++i)
    takes_part[i] = weight[i] > 0 ? 1 : 0;
  for (unsigned k = 0; k < kIterations; ++k) {
    const float total = sumSupport(ratio, weight, support);
    if (!(total > 2))
      return;
    float mean = 0;
    for (std::size_t i = 0; i < weight.size(); ++i)
      mean += weight[i] * support[i];
    // Among strangers everybody's support is poor at first: who is above the mean stays.
    const float threshold = std::min(0.f, mean / total);
    const float slope = kFirstSlope * static_cast<float>(1u << std::min(k, kSlopeDoublings));
    float change = 0;
    for (std::size_t i = 0; i < weight.size(); ++i) {
      const float w =
          takes_part[i] ? std::clamp(0.5f + slope * (support[i] - threshold), 0.f, 1.f) : 0;
      change += std::abs(w - weight[i]);
      weight[i] = w;
    }
    if (k >= kSlopeDoublings && change < kSettled * total)
      return;
  }
}

/** \brief Overlap of the model with the histogram of the counted indices. */
double
overlapOfCounts(const SceneModel& model, const std::vector<std::uint32_t>& counts,
                std::vector<float>& histogram)
{
  const std::size_t bins = model.angular_bins, row = bins + 1;
  std::uint64_t total = 0;
  for (std::size_t begin = 0; begin < counts.size(); begin += row)
    for (std::size_t a = 0; a < bins; ++a)
      total += counts[begin + a];
  if (total == 0)
    return 0;
  const float share = 1 / static_cast<float>(total);
  histogram.assign(model.members.front().size(), 0.f);
  for (std::size_t k = 0; k * bins < model.h.size(); ++k)
    for (std::size_t a = 0; a < bins; ++a)
      histogram[k * bins + a] = share * static_cast<float>(counts[k * row + a]);
  return bestOverlap(model, histogram).share;
}

/** \brief Fit of the few pairs within the core. */
double
roughFit(const SceneModel& model, const std::vector<std::uint32_t>& index,
         const std::vector<float>& weight, std::vector<std::uint32_t>& counts,
         std::vector<float>& histogram)
{
  counts.assign(model.support.size(), 0);
  std::size_t pair = 0;
  for (std::size_t i = 0; i < weight.size(); pair += i, ++i)
    if (weight[i] > 0.5f)
      for (std::size_t j = 0; j < i; ++j)
        counts[index[pair + j]] += weight[j] > 0.5f ? 1 : 0;
  return overlapOfCounts(model, counts, histogram);
}

/** \brief Lays cells of \p core out in windows of \p probes, each spread evenly over it.
 * \return number of windows */
std::size_t
layWindows(const Indices& core, unsigned probes, Indices& out)
{
  const std::size_t windows = std::max<std::size_t>(1, core.size() / probes);
  out.resize(windows * probes);
  for (std::size_t w = 0; w < windows; ++w)
    for (std::size_t k = 0; k < probes; ++k)
      out[w * probes + k] = core[(w + k * core.size() / probes) % core.size()];
  return windows;
}

std::uint32_t
angularBins(const SceneData& scene)
{
  return static_cast<std::uint32_t>(scene.models.resolution.angularBins());
}

/** \brief Indices of the pairs in m.rows in the model's support. */
void
indicesOfRows(const SceneData& scene, const SceneModel& model, SupportMemory& m)
{
  featuresOfRows(scene.source, scene.models.resolution, m.rows, m.features);
  columnsOf(m.features, angularBins(scene), m.column, m.delta);
  indicesOf(model, m.column, m.delta, m.index);
}

/** \brief Weighs in what the weights have settled on. */
Segment
summary(const SceneData& scene, const Sample& sample, const std::vector<float>& weight,
        const std::vector<float>& support)
{
  Segment s;
  double total = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    if (weight[i] == 0)
      continue;
    const auto cell = sample.cells[i];
    total += weight[i];
    s.support += static_cast<double>(weight[i]) * support[i];
    s.centre[0] += static_cast<double>(weight[i]) * scene.cells.x[cell];
    s.centre[1] += static_cast<double>(weight[i]) * scene.cells.y[cell];
    s.centre[2] += static_cast<double>(weight[i]) * scene.cells.z[cell];
    if (weight[i] > 0.5f)
      s.core.push_back(cell);
  }
  if (total == 0)
    return s;
  s.support /= total;
  for (double& c : s.centre)
    c /= total;
  s.cells =
      total * static_cast<double>(sample.population) / static_cast<double>(sample.cells.size());
  return s;
}

Position
positionOf(const Centre& c)
{
  return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}

} // namespace

std::size_t
cellsIn(const std::vector<PlaceRange>& ranges)
{
  std::size_t sum = 0;
  for (const auto& r : ranges)
    sum += r.end - r.begin;
  return sum;
}

void
spreadOver(const LinearOctree& octree, const std::vector<PlaceRange>& ranges, std::size_t n,
           Indices& out)
{
  const std::uint64_t total = cellsIn(ranges);
  std::uint64_t before = 0;
  const PlaceRange* range = ranges.data();
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::uint64_t at = (2 * i + 1) * total / (2 * n);
    for (; at - before >= range->end - range->begin; ++range)
      before += range->end - range->begin;
    const auto place = range->begin + static_cast<std::uint32_t>(at - before);
    out.push_back(static_cast<std::uint32_t>(octree.indexAt(place)));
  }
}

Indices
cellsWithin(const LinearOctree& octree, const Centre& centre, double radius,
            std::vector<PlaceRange>& ranges)
{
  octree.regionRanges(positionOf(centre), radius, ranges);
  Indices cells;
  cells.reserve(cellsIn(ranges));
  for (const auto& r : ranges)
    for (std::uint32_t at = r.begin; at < r.end; ++at)
      cells.push_back(static_cast<std::uint32_t>(octree.indexAt(at)));
  return cells;
}

void
drawSample(const SceneData& scene, const LinearOctree& octree, const Centre& centre, double radius,
           std::size_t most, SupportMemory& m)
{
  Sample& sample = m.sample;
  octree.regionRanges(positionOf(centre), radius, m.ranges);
  sample.population = cellsIn(m.ranges);
  const std::size_t n = std::min(most, sample.population);
  sample.cells.clear();
  spreadOver(octree, m.ranges, n, sample.cells);
  m.rows.setPartners(scene.source, sample.cells);
  m.rows.clearRows();
  for (std::size_t i = 1; i < n; ++i)
    m.rows.addRow(sample.cells[i], 0, i);
  featuresOfRows(scene.source, scene.models.resolution, m.rows, m.features);
  columnsOf(m.features, angularBins(scene), sample.column, sample.delta);
}

Segment
segment(const SceneData& scene, std::size_t model_index, const Centre& centre, double radius,
        SupportMemory& m)
{
  const SceneModel& model = scene.models.all[model_index];
  const Sample& sample = m.sample;
  const std::size_t n = sample.cells.size();
  m.weight.resize(n);
  m.support.assign(n, 0.f);
  for (std::size_t i = 0; i < n; ++i) {
    const auto c = sample.cells[i];
    const double x = scene.cells.x[c] - centre[0], y = scene.cells.y[c] - centre[1],
                 z = scene.cells.z[c] - centre[2];
    m.weight[i] = x * x + y * y + z * z <= radius * radius ? 1.f : 0.f;
  }
  indicesOf(model, sample.column, sample.delta, m.index);
  fillRatios(model, n, m.index, m.ratio);
  settleWeights(m.ratio, m.weight, m.support);
  Segment s = summary(scene, sample, m.weight, m.support);
  s.model = model_index;
  // Most segments are hopeless without it.
  if (s.core.size() > 2 && s.support > 0 && s.cells >= kLeastCoverage * model.expected_cells)
    s.rough_fit = roughFit(model, m.index, m.weight, m.counts, m.histogram);
  return s;
}

void
supportOf(const SceneData& scene, const SceneModel& model, const Indices& cells,
          const Indices& core, unsigned probes, SupportMemory& m, std::vector<CellSupport>& out)
{
  out.clear();
  if (core.empty())
    return;
  const std::size_t windows = layWindows(core, probes, m.partners);
  m.rows.setPartners(scene.source, m.partners);
  const std::size_t block = std::max<std::size_t>(1, kPairsInCache / probes);
  for (std::size_t begin = 0; begin < cells.size(); begin += block) {
    const std::size_t end = std::min(cells.size(), begin + block);
    m.rows.clearRows();
    for (std::size_t i = begin; i < end; ++i)
      m.rows.addRow(cells[i], mix64(cells[i]) % windows * probes, probes);
    indicesOfRows(scene, model, m);
    for (std::size_t i = begin, pair = 0; i < end; ++i) {
      float sum = 0;
      for (const std::size_t last = pair + probes; pair < last; ++pair)
        sum += model.support[m.index[pair]];
      if (sum > 0)
        out.push_back({cells[i], sum / static_cast<float>(probes)});
    }
  }
}

Overlap
fitOf(const SceneData& scene, const SceneModel& model, const Indices& cells, std::uint64_t features,
      std::uint64_t seed)
{
  const PairSource source(scene.cells.subset(cells));
  const auto counted = countStreamedPairs(source, scene.models.resolution, model.model->delta_max,
                                          features, seed, 1);
  std::vector<float> histogram(model.members.front().size(), 0.f);
  const auto total = static_cast<double>(counted.features);
  for (std::size_t b = 0; b < counted.counts.size() && total > 0; ++b)
    histogram[b] = static_cast<float>(static_cast<double>(counted.counts[b]) / total);
  return bestOverlap(model, histogram);
}

} // namespace interpretation
} // namespace pcl_surflet
