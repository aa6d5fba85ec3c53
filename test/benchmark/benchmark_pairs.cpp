// Feature + bin per surflet pair against pcl::computePairFeatures (which computes the same four
// numbers, without binning) on the same 80,000-surflet cloud; one thread.

#include "ratio_reporter.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/instruction_set.h"
#include "pcl_surflet/core/pair_counting.h"

#include <pcl/features/pfh_tools.h>

#include <cmath>

using namespace pcl_surflet;

namespace {

constexpr std::size_t kSurflets = 80000;
constexpr std::uint64_t kPairs = 1 << 20;

const SurfletSet&
cloud()
{
  static const SurfletSet set = [] {
    SurfletSet s;
    CounterRandom random(1);
    for (std::size_t i = 0; i < kSurflets; ++i) {
      const double z = random.uniform(-1, 1), t = random.uniform(0, 2 * M_PI);
      const double r = std::sqrt(1 - z * z), x = r * std::cos(t), y = r * std::sin(t);
      const double bump = 1 + 0.2 * std::sin(5 * t) * r; // a knobbly ball
      s.push_back(
          {float(bump * x), float(bump * y), float(bump * z), float(x), float(y), float(z)});
    }
    return s;
  }();
  return set;
}

void
peerComputePairFeatures(benchmark::State& state)
{
  const auto pairs = drawPairs(kSurflets, kPairs, 7);
  std::vector<Eigen::Vector4f> points, normals;
  for (std::size_t i = 0; i < kSurflets; ++i) {
    const auto s = cloud()[i];
    points.emplace_back(s.x, s.y, s.z, 0.f);
    normals.emplace_back(s.nx, s.ny, s.nz, 0.f);
  }
  for (auto _ : state) {
    float sum = 0;
    for (const auto& [i, j] : pairs) {
      float f1 = 0, f2 = 0, f3 = 0, f4 = 0;
      pcl::computePairFeatures(points[i], normals[i], points[j], normals[j], f1, f2, f3, f4);
      sum += f1 + f2 + f3 + f4;
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPairs));
}

void
reference(benchmark::State& state)
{
  const auto pairs = drawPairs(kSurflets, kPairs, 7);
  for (auto _ : state) {
    int sum = 0;
    for (const auto& [i, j] : pairs)
      if (const auto f = computePairFeature(cloud()[i], cloud()[j]))
        sum += binIndex(*f, {}, 2.4);
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPairs));
}

using Counter = PairHistogram (*)(const PairSource&, const Resolution&, double, std::uint64_t,
                                  std::uint64_t, unsigned);

PairHistogram
countAllDrawn(const PairSource& source, const Resolution& resolution, double delta_max,
              std::uint64_t n, std::uint64_t seed, unsigned threads)
{
  return countDrawnPairs(source, resolution, delta_max, n, seed, threads);
}

void
counting(benchmark::State& state, InstructionSet set, Counter count, std::uint64_t n)
{
  if (!selectInstructionSet(set)) {
    state.SkipWithError("this processor has no such instruction set");
    return;
  }
  const PairSource source(cloud());
  for (auto _ : state)
    benchmark::DoNotOptimize(count(source, {}, 2.4, n, 7, 1));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
  selectInstructionSet(InstructionSet::Automatic);
}

} // namespace

int
main(int argc, char** argv)
{
  benchmark::RegisterBenchmark("pairs/peer_pcl_computePairFeatures", peerComputePairFeatures);
  benchmark::RegisterBenchmark("pairs/reference_double", reference);
  const std::pair<const char*, InstructionSet> sets[] = {{"scalar", InstructionSet::Scalar},
                                                         {"baseline", InstructionSet::Baseline},
                                                         {"avx2", InstructionSet::Avx2},
                                                         {"avx512", InstructionSet::Avx512}};
  for (const auto& [name, set] : sets) {
    benchmark::RegisterBenchmark((std::string("pairs/random_") + name).c_str(), counting, set,
                                 countAllDrawn, kPairs);
    benchmark::RegisterBenchmark((std::string("pairs/streamed_") + name).c_str(), counting, set,
                                 countStreamedPairs, 10 * kPairs);
  }
  return pcl_surflet_benchmark::runWithRatios(argc, argv);
}
