#include "pcl_surflet/core/pair_counting.h"

#include "kernels/pair_kernels.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <stdexcept>

namespace pcl_surflet {
namespace {

using kernels::BinMap;
using kernels::DrawnBlock;
using kernels::kCounterCopies;
using kernels::kDrawBlock;

void
checkMapping(const Resolution& resolution, double delta_max)
{
  if (const auto problem = resolution.problem(); !problem.empty())
    throw std::invalid_argument("pcl_surflet: " + problem);
  if (!(delta_max > 0) || !std::isfinite(delta_max))
    throw std::invalid_argument("pcl_surflet: delta_max must be positive and finite");
}

kernels::Columns
columnsOf(const SurfletSet& s)
{
  return {s.x.data(), s.y.data(), s.z.data(), s.nx.data(), s.ny.data(), s.nz.data()};
}

/** \brief Block number \p block of the pairs drawn with \p seed, \p n pairs of \p m surflets long.
 */
DrawnBlock
drawnBlock(const float* records, std::size_t m, std::uint64_t block, std::uint64_t n,
           std::uint64_t seed)
{
  const CounterRandom random(seed, block);
  const std::uint64_t a = random.at(0), b = random.at(1);
  return {records,
          static_cast<std::uint32_t>(m),
          {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(a >> 32),
           static_cast<std::uint32_t>(b)},
          static_cast<std::uint32_t>(std::min<std::uint64_t>(n, kDrawBlock))};
}

/** \brief From the kernels' counter indices to PairFeatures::angular_bin. */
void
toAngularBins(std::vector<std::uint32_t>& bins)
{
  for (auto& bin : bins)
    bin = bin == kernels::kNoFeature ? kNoPairFeature : bin / kCounterCopies;
}

/** \brief Counters of one worker: 32 bits wide for speed, added to the 64-bit histogram before they
 * can overflow. */
class WorkerCounts {
public:
  explicit WorkerCounts(const Resolution& resolution)
      : histogram_(resolution), counts_(kCounterCopies * (histogram_.counts.size() + 1), 0)
  {
  }

  /** \brief The counters, with room for \p pairs more. */
  std::uint32_t*
  reserve(std::uint64_t pairs)
  {
    if (pairs_ + pairs > 0xffffffffu)
      flush();
    pairs_ += pairs;
    return counts_.data();
  }

  const PairHistogram&
  finish()
  {
    flush();
    return histogram_;
  }

private:
  void
  flush()
  {
    const std::size_t bins = histogram_.counts.size();
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      const std::size_t b = i / kCounterCopies;
      if (b == bins) {
        histogram_.rejected += counts_[i];
        continue;
      }
      histogram_.counts[b] += counts_[i];
      histogram_.features += counts_[i];
    }
    std::fill(counts_.begin(), counts_.end(), 0u);
    pairs_ = 0;
  }

  PairHistogram histogram_;
  std::vector<std::uint32_t> counts_;
  std::uint64_t pairs_ = 0;
};

/** \brief Runs \p work(item, counts of the worker) over the items of \p share, which are every
 * parts-th, and sums the counts. */
template <class Work>
PairHistogram
countParallel(std::size_t all, unsigned threads, const PairShare& share,
              const Resolution& resolution, const Work& work)
{
  if (share.part >= share.parts)
    throw std::invalid_argument("pcl_surflet: the share of the pairs is none of its parts");
  const std::size_t items = all > share.part ? (all - share.part - 1) / share.parts + 1 : 0;
  threads = static_cast<unsigned>(std::min<std::size_t>(resolveThreads(threads), items));
  std::vector<WorkerCounts> workers(std::max(threads, 1u), WorkerCounts(resolution));
  parallelFor(items, threads, [&](std::size_t item, unsigned worker) {
    work(share.part + item * share.parts, workers[worker]);
  });
  PairHistogram sum(resolution);
  for (auto& worker : workers)
    sum.merge(worker.finish());
  return sum;
}

/** \brief 0 ... m - 1 in random order (Fisher-Yates). */
std::vector<std::uint32_t>
shuffledIndices(std::size_t m, std::uint64_t seed)
{
  std::vector<std::uint32_t> order(m);
  std::iota(order.begin(), order.end(), 0u);
  CounterRandom random(seed, ~std::uint64_t{1});
  for (std::size_t i = m; i > 1; --i)
    std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
  return order;
}

} // namespace

PairSource::PairSource(const SurfletSet& set) : unit_(toUnitScale(set))
{
  const std::size_t n = set.size();
  if (n >= (std::size_t{1} << 29))
    throw std::length_error("pcl_surflet: 2^29 surflets or more; reduce the cloud first");
  storage_.reset(new float[8 * n + 8]); // left unset: every record is written below
  void* aligned = storage_.get();
  std::size_t space = (8 * n + 8) * sizeof(float);
  auto* record = static_cast<float*>(std::align(32, 8 * n * sizeof(float), aligned, space));
  records_ = record;
  const auto columns = columnsOf(unit_.set);
  for (std::size_t i = 0; i < n; ++i, record += 8) {
    record[0] = columns.x[i];
    record[1] = columns.y[i];
    record[2] = columns.z[i];
    record[3] = columns.nx[i];
    record[4] = columns.ny[i];
    record[5] = columns.nz[i];
    record[6] = record[7] = 0;
  }
}

PairHistogram
countAllPairs(const PairSource& source, const Resolution& resolution, double delta_max,
              unsigned threads, const PairShare& share)
{
  checkMapping(resolution, delta_max);
  const BinMap map(resolution, delta_max * source.scale());
  const auto columns = columnsOf(source.columns());
  const std::size_t m = source.size();
  const std::size_t shifts = m > 1 ? m - 1 : 0;
  // Surflet i meets i + shift: both sides stream through memory. An item joins a short and a long
  // shift, so all items cost the same.
  const auto work = [&](std::size_t item, WorkerCounts& counts) {
    const std::size_t longer = item + 1, shorter = shifts - item;
    for (const std::size_t shift : {longer, shorter}) {
      kernels::active().countStream(columns, columns.from(shift), m - shift, map,
                                    counts.reserve(m - shift));
      if (longer == shorter)
        break;
    }
  };
  return countParallel((shifts + 1) / 2, threads, share, resolution, work);
}

PairHistogram
countDrawnPairs(const PairSource& source, const Resolution& resolution, double delta_max,
                std::uint64_t n, std::uint64_t seed, unsigned threads, const PairShare& share)
{
  checkMapping(resolution, delta_max);
  if (source.size() < 2)
    return PairHistogram(resolution);
  const BinMap map(resolution, delta_max * source.scale());
  const auto work = [&](std::size_t block, WorkerCounts& counts) {
    const auto drawn =
        drawnBlock(source.records(), source.size(), block, n - block * kDrawBlock, seed);
    kernels::active().countDrawn(drawn, map, counts.reserve(drawn.n));
  };
  return countParallel((n + kDrawBlock - 1) / kDrawBlock, threads, share, resolution, work);
}

PairHistogram
countStreamedPairs(const PairSource& source, const Resolution& resolution, double delta_max,
                   std::uint64_t n, std::uint64_t seed, unsigned threads)
{
  checkMapping(resolution, delta_max);
  const std::size_t m = source.size();
  if (m < 2)
    return PairHistogram(resolution);
  const BinMap map(resolution, delta_max * source.scale());
  const SurfletSet shuffled = source.columns().subset(shuffledIndices(m, seed));
  const auto columns = columnsOf(shuffled);
  const CounterRandom shifts(seed, ~std::uint64_t{0});
  const auto work = [&](std::size_t item, WorkerCounts& counts) {
    const std::size_t shift = 1 + shifts.at(item) % (m - 1);
    const std::size_t pairs = std::min<std::uint64_t>(n - item * m, m);
    const std::size_t straight = std::min(pairs, m - shift);
    const auto& kernel = kernels::active();
    kernel.countStream(columns, columns.from(shift), straight, map, counts.reserve(straight));
    if (pairs > straight) // the rest wraps around to the front
      kernel.countStream(columns.from(straight), columns, pairs - straight, map,
                         counts.reserve(pairs - straight));
  };
  return countParallel((n + m - 1) / m, threads, PairShare(), resolution, work);
}

FeatureSample
drawFeatures(const PairSource& source, const Resolution& resolution, std::uint64_t n,
             std::uint64_t seed, unsigned threads)
{
  checkMapping(resolution, 1.0);
  FeatureSample sample;
  sample.resolution = resolution;
  sample.scale = source.scale();
  if (source.size() < 2)
    return sample;
  sample.angular_bin.resize(n);
  sample.delta_squared.resize(n);
  const BinMap map(resolution, 1.0);
  parallelFor((n + kDrawBlock - 1) / kDrawBlock, threads, [&](std::size_t block, unsigned) {
    const auto drawn =
        drawnBlock(source.records(), source.size(), block, n - block * kDrawBlock, seed);
    kernels::active().featuresDrawn(drawn, map, sample.angular_bin.data() + block * kDrawBlock,
                                    sample.delta_squared.data() + block * kDrawBlock);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (sample.angular_bin[i] == kernels::kNoFeature)
      continue;
    sample.angular_bin[kept] = sample.angular_bin[i] / kCounterCopies;
    sample.delta_squared[kept++] = sample.delta_squared[i];
  }
  sample.rejected = n - kept;
  sample.angular_bin.resize(kept);
  sample.delta_squared.resize(kept);
  return sample;
}

void
FeatureSample::bins(double delta_max, std::vector<std::uint32_t>& out) const
{
  // The same comparisons as in the counting kernels, so that both agree.
  out = angular_bin;
  const auto stride = static_cast<std::uint32_t>(resolution.angularBins());
  for (int k = 0; k + 1 < resolution.delta; ++k) {
    const float border = kernels::squaredDeltaBorder(k, resolution.delta, delta_max * scale);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] += delta_squared[i] >= border ? stride : 0;
  }
}

void
featuresOfPairs(const PairSource& source, const Resolution& resolution,
                const std::vector<std::uint32_t>& first, const std::vector<std::uint32_t>& second,
                PairFeatures& out)
{
  checkMapping(resolution, 1.0);
  if (first.size() != second.size())
    throw std::invalid_argument("pcl_surflet: pairs need as many first as second surflets");
  const BinMap map(resolution, 1.0);
  const std::size_t n = first.size();
  out.angular_bin.resize(n);
  out.delta_squared.resize(n);
  for (std::size_t i = 0; i < n; i += kDrawBlock) {
    const auto block = static_cast<std::uint32_t>(std::min<std::size_t>(n - i, kDrawBlock));
    kernels::active().featuresGiven({source.records(), first.data() + i, second.data() + i, block},
                                    map, out.angular_bin.data() + i, out.delta_squared.data() + i);
  }
  toAngularBins(out.angular_bin);
}

void
PairRows::clearRows()
{
  surflet.clear();
  begin.clear();
  count.clear();
}

void
PairRows::addRow(std::uint32_t s, std::size_t first, std::size_t n)
{
  surflet.push_back(s);
  begin.push_back(static_cast<std::uint32_t>(first));
  count.push_back(static_cast<std::uint32_t>(n));
}

void
PairRows::setPartners(const PairSource& source, const std::vector<std::uint32_t>& indices)
{
  number_ = indices.size();
  const auto copy = [&](const std::vector<float>& from, std::vector<float>& to) {
    to.resize(number_ + kernels::kRowPadding);
    for (std::size_t i = 0; i < number_; ++i)
      to[i] = from[indices[i]];
  };
  const SurfletSet& s = source.columns();
  copy(s.x, partners_.x);
  copy(s.y, partners_.y);
  copy(s.z, partners_.z);
  copy(s.nx, partners_.nx);
  copy(s.ny, partners_.ny);
  copy(s.nz, partners_.nz);
}

void
featuresOfRows(const PairSource& source, const Resolution& resolution, const PairRows& rows,
               PairFeatures& out)
{
  checkMapping(resolution, 1.0);
  const std::size_t n = rows.surflet.size();
  if (rows.begin.size() != n || rows.count.size() != n)
    throw std::invalid_argument("pcl_surflet: rows of pairs need a surflet, a begin and a count");
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < n; pairs += rows.count[i], ++i)
    if (std::size_t{rows.begin[i]} + rows.count[i] > rows.numberOfPartners())
      throw std::invalid_argument("pcl_surflet: a row of pairs ends behind the last partner");
  const BinMap map(resolution, 1.0);
  out.angular_bin.resize(pairs + kernels::kRowPadding);
  out.delta_squared.resize(pairs + kernels::kRowPadding);
  kernels::active().featuresOfRows({source.records(), rows.surflet.data(),
                                    columnsOf(rows.partners()), rows.begin.data(),
                                    rows.count.data(), n},
                                   map, out.angular_bin.data(), out.delta_squared.data());
  out.angular_bin.resize(pairs);
  out.delta_squared.resize(pairs);
  toAngularBins(out.angular_bin);
}

float
deltaBorder(int k, const Resolution& resolution, double delta_max, double scale)
{
  return kernels::squaredDeltaBorder(k, resolution.delta, delta_max * scale);
}

std::vector<std::pair<std::uint32_t, std::uint32_t>>
drawPairs(std::size_t m, std::uint64_t n, std::uint64_t seed, std::uint64_t first)
{
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  if (m < 2)
    return pairs;
  pairs.reserve(n);
  std::vector<std::uint32_t> a(kDrawBlock), b(kDrawBlock);
  std::uint64_t skip = first % kDrawBlock;
  for (std::uint64_t block = first / kDrawBlock; pairs.size() < n; ++block, skip = 0) {
    const auto drawn = drawnBlock(nullptr, m, block, kDrawBlock, seed);
    kernels::active().drawIndices(drawn, a.data(), b.data());
    for (std::uint64_t i = skip; i < kDrawBlock && pairs.size() < n; ++i)
      pairs.emplace_back(a[i], b[i]);
  }
  return pairs;
}

} // namespace pcl_surflet
