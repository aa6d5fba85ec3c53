#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/pair_counting.h"
#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/core/surflet_pair.h"
#include "pcl_surflet/surflet_pair_feature.h"
#include "pcl_surflet/surflet_pair_histogram.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace detail {
namespace {

/** \brief Output clouds larger than this do not fit PCL's 32-bit indices. */
constexpr std::uint64_t kMostPairs = 0x7fffffff;
constexpr std::uint64_t kDrawsPerPair = 100;
constexpr std::uint64_t kDrawsAtATime = 1 << 16;

SurfletPairSignature
signature(const PairFeature& f, std::uint32_t i, std::uint32_t j)
{
  return {static_cast<float>(f.alpha),
          static_cast<float>(f.beta),
          static_cast<float>(f.gamma),
          static_cast<float>(f.delta),
          i,
          j};
}

/** \brief Features of some pairs, in order. */
struct PairBlock {
  std::vector<SurfletPairSignature> signatures;
  std::uint64_t rejected = 0;
};

class PairComputation {
public:
  PairComputation(const SurfletSet& surflets, double maximum_distance)
      : surflets_(surflets), longest_(maximum_distance > 0 ? maximum_distance : INFINITY)
  {
  }

  void
  add(std::uint32_t i, std::uint32_t j, PairBlock& block) const
  {
    const auto f = computePairFeature(surflets_[i], surflets_[j]);
    if (!f || !std::isfinite(static_cast<float>(f->delta))) // too long for the output
      ++block.rejected;
    else if (f->delta <= longest_)
      block.signatures.push_back(signature(*f, i, j));
  }

private:
  const SurfletSet& surflets_;
  double longest_;
};

/** \brief Appends block after block, in order, until \p most signatures are there. */
std::uint64_t
append(std::vector<PairBlock>& blocks, std::uint64_t most, std::vector<SurfletPairSignature>& out)
{
  std::uint64_t rejected = 0;
  for (auto& block : blocks) {
    const auto room = most - out.size();
    const auto n = std::min<std::uint64_t>(room, block.signatures.size());
    out.insert(out.end(), block.signatures.begin(),
               block.signatures.begin() + static_cast<std::ptrdiff_t>(n));
    rejected += block.rejected;
  }
  return rejected;
}

std::vector<SurfletPairSignature>
allPairs(const PairComputation& computation, std::size_t m, unsigned threads,
         std::uint64_t& rejected)
{
  std::vector<PairBlock> rows(m);
  parallelFor(m, threads, [&](std::size_t i, unsigned) {
    for (std::size_t j = i + 1; j < m; ++j)
      computation.add(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), rows[i]);
  });
  std::vector<SurfletPairSignature> out;
  rejected = append(rows, kMostPairs, out);
  return out;
}

std::vector<SurfletPairSignature>
drawnPairs(const PairComputation& computation, std::size_t m, const PairFeatureRequest& request,
           std::uint64_t& rejected)
{
  std::vector<SurfletPairSignature> out;
  const std::uint64_t wanted = std::min(request.pairs, kMostPairs);
  // A round draws what is missing; without a distance limit the first one is nearly enough.
  for (std::uint64_t first = 0; out.size() < wanted && first < kDrawsPerPair * wanted;) {
    const std::uint64_t n = wanted - out.size() + kDrawsAtATime / 64;
    std::vector<PairBlock> blocks((n + kDrawsAtATime - 1) / kDrawsAtATime);
    parallelFor(blocks.size(), request.threads, [&](std::size_t b, unsigned) {
      const std::uint64_t begin = b * kDrawsAtATime;
      for (const auto& [i, j] :
           drawPairs(m, std::min(kDrawsAtATime, n - begin), request.seed, first + begin))
        computation.add(i, j, blocks[b]);
    });
    rejected += append(blocks, wanted, out);
    first += n;
  }
  return out;
}

} // namespace

std::uint64_t
countablePairs(std::size_t m)
{
  if (m < 2 || m >= (std::size_t{1} << 29))
    return 0;
  const std::uint64_t pairs = std::uint64_t{m} * (m - 1) / 2;
  return pairs <= kMostPairs ? pairs : 0;
}

std::vector<SurfletPairSignature>
computePairSignatures(const SurfletSet& surflets, const PairFeatureRequest& request,
                      std::uint64_t& rejected)
{
  rejected = 0;
  if (surflets.size() < 2)
    return {};
  const PairComputation computation(surflets, request.maximum_distance);
  if (request.pairs == 0)
    return allPairs(computation, surflets.size(), request.threads, rejected);
  return drawnPairs(computation, surflets.size(), request, rejected);
}

std::string
requestProblem(const HistogramRequest& request, int bins)
{
  if (auto problem = request.resolution.problem(); !problem.empty())
    return problem;
  if (request.resolution.bins() != bins)
    return "Resolution " + request.resolution.toString() + " has " +
           std::to_string(request.resolution.bins()) + " bins, the output point type " +
           std::to_string(bins) + ".";
  if (!(request.delta_max >= 0) || !std::isfinite(request.delta_max))
    return "delta_max must be positive and finite, or 0 to be measured.";
  if (request.pairs == 0)
    return "The number of pairs must be positive.";
  return {};
}

std::vector<float>
computePairHistogram(const SurfletSet& surflets, const HistogramRequest& request)
{
  const double delta_max = request.delta_max > 0 ? request.delta_max : farthestDistance(surflets);
  if (surflets.size() < 2 || !(delta_max > 0))
    return {};
  const PairSource source(surflets);
  const std::uint64_t m = surflets.size();
  const auto counted = m * (m - 1) / 2 <= request.pairs
                           ? countAllPairs(source, request.resolution, delta_max, request.threads)
                           : countDrawnPairs(source, request.resolution, delta_max, request.pairs,
                                             request.seed, request.threads);
  if (counted.features == 0)
    return {};
  const auto h = counted.normalized();
  return {h.begin(), h.end()};
}

} // namespace detail
} // namespace pcl_surflet
