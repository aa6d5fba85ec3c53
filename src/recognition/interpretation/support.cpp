#include "support.h"

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

/** \brief Logarithmic ratios of all pairs as a square matrix; 0 where a pair has no feature. */
void
fillRatios(const SceneModel& model, const Sample& sample, std::vector<float>& ratio)
{
  const std::size_t n = sample.cells.size();
  ratio.resize(n * n);
  std::size_t pair = 0;
  for (std::size_t i = 0; i < n; ++i) {
    ratio[i * n + i] = 0;
    for (std::size_t j = 0; j < i; ++j, ++pair)
      ratio[i * n + j] = ratio[j * n + i] = model.supportOfPair(
          sample.features.angular_bin[pair], sample.features.delta_squared[pair]);
  }
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
    const float* row = ratio.data() + j * n;
    for (std::size_t i = 0; i < n; ++i) // rows, not sums: so the compiler may use vectors
      support[i] += w * row[i];
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
    for (std::size_t i = 0; i < weight.size(); ++i)
      weight[i] = takes_part[i] ? std::clamp(0.5f + slope * (support[i] - threshold), 0.f, 1.f) : 0;
  }
}

/** \brief Intersection of the pairs within the core with the model's histogram. */
double
roughFit(const SceneModel& model, const Sample& sample, const std::vector<float>& weight,
         std::vector<std::uint32_t>& counts)
{
  counts.assign(model.h.size(), 0);
  std::uint32_t total = 0;
  std::size_t pair = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    if (weight[i] <= 0.5f) {
      pair += i;
      continue;
    }
    for (std::size_t j = 0; j < i; ++j, ++pair)
      if (weight[j] > 0.5f && sample.features.angular_bin[pair] != kNoPairFeature) {
        const auto b =
            model.bin(sample.features.angular_bin[pair], sample.features.delta_squared[pair]);
        ++total;
        if (b != kBeyond)
          ++counts[b];
      }
  }
  double sum = 0;
  for (std::size_t b = 0; b < counts.size(); ++b)
    sum += std::min<double>(model.h[b], counts[b] / std::max(1.0, static_cast<double>(total)));
  return sum;
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
  s.cells = total * static_cast<double>(sample.population) /
            static_cast<double>(sample.cells.size());
  return s;
}

} // namespace

Indices
cellsWithin(const LinearOctree& octree, const Centre& centre, double radius,
            std::vector<PlaceRange>& ranges)
{
  octree.regionRanges({static_cast<float>(centre[0]), static_cast<float>(centre[1]),
                       static_cast<float>(centre[2])},
                      radius, ranges);
  Indices cells;
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
  sample.cells = cellsWithin(octree, centre, radius, m.ranges);
  sample.population = sample.cells.size();
  // The octree keeps neighbours together, so every so manieth cell is an even choice.
  const std::size_t n = std::min(most, sample.population);
  for (std::size_t i = 0; i < n; ++i)
    sample.cells[i] = sample.cells[(2 * i + 1) * sample.population / (2 * n)];
  sample.cells.resize(n);
  m.first.clear();
  m.second.clear();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      m.first.push_back(sample.cells[i]);
      m.second.push_back(sample.cells[j]);
    }
  featuresOfPairs(scene.source, scene.models.resolution, m.first, m.second, sample.features);
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
  fillRatios(model, sample, m.ratio);
  settleWeights(m.ratio, m.weight, m.support);
  Segment s = summary(scene, sample, m.weight, m.support);
  s.model = model_index;
  s.rough_fit = roughFit(model, sample, m.weight, m.counts);
  return s;
}

void
supportOf(const SceneData& scene, const SceneModel& model, const Indices& cells,
          const Indices& core, unsigned probes, SupportMemory& m, std::vector<CellSupport>& out)
{
  m.first.clear();
  m.second.clear();
  const std::size_t n = core.size();
  for (const auto c : cells) {
    const std::size_t start = static_cast<std::size_t>(mix64(c) % n);
    for (unsigned k = 0; k < probes; ++k) {
      m.first.push_back(c);
      m.second.push_back(core[(start + k * n / probes) % n]);
    }
  }
  featuresOfPairs(scene.source, scene.models.resolution, m.first, m.second, m.features);
  out.clear();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    float sum = 0;
    for (std::size_t k = i * probes; k < (i + 1) * probes; ++k)
      sum += model.supportOfPair(m.features.angular_bin[k], m.features.delta_squared[k]);
    if (sum > 0)
      out.push_back({cells[i], sum / static_cast<float>(probes)});
  }
}

double
fitOf(const SceneData& scene, const SceneModel& model, const Indices& cells, std::uint64_t features,
      std::uint64_t stream, SupportMemory& m)
{
  const auto n = static_cast<std::uint32_t>(cells.size());
  CounterRandom random(stream);
  m.first.clear();
  m.second.clear();
  for (std::uint64_t i = 0; i < features; ++i) {
    m.first.push_back(cells[static_cast<std::size_t>(i % n)]);
    m.second.push_back(cells[random.below(n)]);
  }
  featuresOfPairs(scene.source, scene.models.resolution, m.first, m.second, m.features);
  m.counts.assign(model.h.size(), 0);
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < m.features.angular_bin.size(); ++i) {
    if (m.features.angular_bin[i] == kNoPairFeature)
      continue;
    ++total;
    const auto b = model.bin(m.features.angular_bin[i], m.features.delta_squared[i]);
    if (b != kBeyond)
      ++m.counts[b];
  }
  double sum = 0;
  for (std::size_t b = 0; b < m.counts.size(); ++b)
    sum += std::min<double>(model.h[b], m.counts[b] / std::max(1.0, static_cast<double>(total)));
  return sum;
}

} // namespace interpretation
} // namespace pcl_surflet
