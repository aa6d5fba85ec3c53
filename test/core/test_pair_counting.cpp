#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/instruction_set.h"
#include "pcl_surflet/core/pair_counting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

using namespace pcl_surflet;

namespace {

const std::vector<InstructionSet> kSets = {InstructionSet::Scalar, InstructionSet::Baseline,
                                           InstructionSet::Avx2, InstructionSet::Avx512};

/** \brief Restores the automatic choice of kernels at the end of a test. */
struct KernelGuard {
  ~KernelGuard() { selectInstructionSet(InstructionSet::Automatic); }
};

/** \brief A cloud with a bit of everything: random surflets, a plane, duplicates. */
SurfletSet
mixedCloud(std::size_t n, std::uint64_t seed)
{
  CounterRandom random(seed);
  SurfletSet set;
  while (set.size() < n) {
    const double z = random.uniform(-1, 1), t = random.uniform(0, 2 * M_PI);
    const double s = std::sqrt(1 - z * z);
    const bool flat = random.below(4) == 0;
    set.push_back({float(random.uniform(-1, 1)), float(random.uniform(-1, 1)),
                   flat ? 0.f : float(random.uniform(-1, 1)), flat ? 0.f : float(s * std::cos(t)),
                   flat ? 0.f : float(s * std::sin(t)), flat ? 1.f : float(z)});
    if (random.below(10) == 0)
      set.push_back(set[random.below(static_cast<std::uint32_t>(set.size()))]);
  }
  return set;
}

PairHistogram
bruteForce(const SurfletSet& set, const Resolution& r, double delta_max)
{
  PairHistogram h(r);
  for (std::size_t i = 0; i < set.size(); ++i)
    for (std::size_t j = i + 1; j < set.size(); ++j) {
      const auto f = computePairFeature(set[i], set[j]);
      if (!f) {
        ++h.rejected;
        continue;
      }
      ++h.counts[static_cast<std::size_t>(binIndex(*f, r, delta_max))];
      ++h.features;
    }
  return h;
}

/** \brief Features that lie in different bins of two histograms of the same pairs. */
std::uint64_t
moved(const PairHistogram& a, const PairHistogram& b)
{
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < a.counts.size(); ++i)
    sum += a.counts[i] > b.counts[i] ? a.counts[i] - b.counts[i] : b.counts[i] - a.counts[i];
  return sum / 2;
}

} // namespace

TEST(PairCounting, AllPairsEqualTheReference)
{
  KernelGuard guard;
  const auto set = mixedCloud(1449, 5); // 2^20 pairs
  const PairSource source(set);
  for (const Resolution r : {Resolution{5, 5, 5, 5}, Resolution{8, 8, 8, 8}, Resolution{1, 2, 3, 4},
                             Resolution{4, 7, 1, 9}, Resolution{64, 3, 3, 3}}) {
    const auto expected = bruteForce(set, r, 2.5);
    for (const auto instructions : kSets) {
      if (!selectInstructionSet(instructions))
        continue;
      const auto h = countAllPairs(source, r, 2.5, 2);
      EXPECT_EQ(h.features + h.rejected, 1449u * 1448 / 2);
      EXPECT_EQ(h.rejected, expected.rejected) << activeInstructionSet();
      // Single precision may put a pair within rounding of a border into the next bin.
      EXPECT_LE(moved(h, expected), 2u) << r.toString() << " " << activeInstructionSet();
    }
  }
}

TEST(PairCounting, EveryInstructionSetGivesTheSameBits)
{
  KernelGuard guard;
  const auto set = mixedCloud(3001, 6);
  const PairSource source(set);
  const Resolution r{7, 6, 5, 8};
  ASSERT_TRUE(selectInstructionSet(InstructionSet::Scalar));
  const auto all = countAllPairs(source, r, 2.0, 1);
  const auto drawn = countDrawnPairs(source, r, 2.0, 1000003, 17, 1);
  const auto sample = drawFeatures(source, r, 10007, 17);
  for (const auto instructions : kSets) {
    if (!selectInstructionSet(instructions))
      continue;
    for (const unsigned threads : {1u, 2u, 5u}) {
      EXPECT_EQ(countAllPairs(source, r, 2.0, threads).counts, all.counts);
      const auto again = countDrawnPairs(source, r, 2.0, 1000003, 17, threads);
      EXPECT_EQ(again.counts, drawn.counts);
      EXPECT_EQ(again.rejected, drawn.rejected);
      const auto features = drawFeatures(source, r, 10007, 17, threads);
      EXPECT_EQ(features.angular_bin, sample.angular_bin);
      EXPECT_EQ(features.delta_squared, sample.delta_squared);
    }
  }
}

TEST(PairCounting, DrawnPairsAreThePairsThatDrawPairsNames)
{
  const auto set = mixedCloud(500, 7);
  const Resolution r;
  const std::uint64_t n = 9001;
  PairHistogram expected(r);
  for (const auto& [i, j] : drawPairs(set.size(), n, 3)) {
    const auto f = computePairFeature(set[i], set[j]);
    if (f)
      ++expected.counts[static_cast<std::size_t>(binIndex(*f, r, 2.0))];
    else
      ++expected.rejected;
  }
  const auto h = countDrawnPairs(PairSource(set), r, 2.0, n, 3);
  EXPECT_EQ(h.features + h.rejected, n);
  EXPECT_EQ(h.rejected, expected.rejected);
  EXPECT_LE(moved(h, expected), 2u);
}

TEST(PairCounting, SharesAddUpToTheWhole)
{
  const Resolution r{5, 5, 5, 5};
  constexpr std::uint64_t kDrawn = 50000;
  for (const std::size_t n : {3u, 300u, 301u}) {
    const PairSource source(mixedCloud(n, 11));
    const auto all = countAllPairs(source, r, 2.0),
               drawn = countDrawnPairs(source, r, 2.0, kDrawn, 4);
    for (const std::size_t parts : {1u, 2u, 3u, 20u}) {
      PairHistogram all_sum(r), drawn_sum(r);
      for (std::size_t part = 0; part < parts; ++part) {
        const auto share = countAllPairs(source, r, 2.0, 2, {part, parts});
        all_sum.merge(share);
        if (n >= 300 && parts <= 3) {
          EXPECT_NEAR(double(share.features + share.rejected) * double(parts),
                      double(all.features + all.rejected), 0.02 * double(all.features))
              << "shares are alike";
        }
        drawn_sum.merge(countDrawnPairs(source, r, 2.0, kDrawn, 4, 2, {part, parts}));
      }
      EXPECT_EQ(all_sum.counts, all.counts) << n << ", " << parts;
      EXPECT_EQ(all_sum.rejected, all.rejected) << n << ", " << parts;
      EXPECT_EQ(drawn_sum.counts, drawn.counts) << n << ", " << parts;
      EXPECT_EQ(drawn_sum.features, drawn.features) << n << ", " << parts;
      EXPECT_EQ(drawn_sum.rejected, drawn.rejected) << n << ", " << parts;
    }
  }
}

TEST(PairCounting, SampleMapsToTheBinsOfTheHistogram)
{
  const auto set = mixedCloud(500, 8);
  const PairSource source(set);
  const Resolution r{5, 4, 5, 6};
  const auto sample = drawFeatures(source, r, 50000, 4);
  for (const double delta_max : {0.5, 1.7, 3.0}) {
    std::vector<std::uint32_t> bins;
    sample.bins(delta_max, bins);
    PairHistogram h(r);
    for (const auto b : bins)
      ++h.counts.at(b);
    EXPECT_EQ(h.counts, countDrawnPairs(source, r, delta_max, 50000, 4).counts);
  }
}

TEST(PairCounting, StreamedPairsAreAFairSample)
{
  KernelGuard guard;
  const auto set = mixedCloud(2000, 12);
  const PairSource source(set);
  const auto all = countAllPairs(source, {}, 2.0);
  const std::uint64_t n = 100500;
  const auto h = countStreamedPairs(source, {}, 2.0, n, 21, 3);
  EXPECT_EQ(h.features + h.rejected, n);
  double chi2 = 0, filled = 0;
  for (std::size_t b = 0; b < h.counts.size(); ++b) {
    const double expected = double(all.counts[b]) / double(all.features) * double(h.features);
    if (expected < 5)
      continue;
    chi2 += (double(h.counts[b]) - expected) * (double(h.counts[b]) - expected) / expected;
    ++filled;
  }
  EXPECT_GT(filled, 300);
  EXPECT_LT(chi2, filled + 5 * std::sqrt(2 * filled));
  ASSERT_TRUE(selectInstructionSet(InstructionSet::Scalar));
  EXPECT_EQ(countStreamedPairs(source, {}, 2.0, n, 21, 1).counts, h.counts);
  EXPECT_NE(countStreamedPairs(source, {}, 2.0, n, 22, 1).counts, h.counts);
  EXPECT_EQ(countStreamedPairs(source, {}, 2.0, 17, 21, 1).features, 17u);
}

TEST(DrawPairs, UniformOverPairsOfDifferentSurflets)
{
  const std::size_t m = 11;
  const std::uint64_t n = 440000;
  std::vector<double> hits(m * m, 0);
  for (const auto& [i, j] : drawPairs(m, n, 99)) {
    ASSERT_NE(i, j);
    ++hits[i * m + j];
  }
  const double expected = double(n) / (m * (m - 1));
  double chi2 = 0;
  for (std::size_t k = 0; k < m * m; ++k)
    if (k / m != k % m)
      chi2 += (hits[k] - expected) * (hits[k] - expected) / expected;
  // 109 degrees of freedom: mean 109, standard deviation 14.8.
  EXPECT_LT(chi2, 109 + 4 * 14.8);
  EXPECT_GT(chi2, 109 - 4 * 14.8);
}

TEST(DrawPairs, AnyPieceOfTheSequence)
{
  const auto all = drawPairs(1000, 20000, 1);
  const auto tail = drawPairs(1000, 10000, 1, 9999);
  EXPECT_TRUE(std::equal(tail.begin(), tail.end(), all.begin() + 9999));
  EXPECT_NE(all, drawPairs(1000, 20000, 2));
  EXPECT_TRUE(drawPairs(1, 10, 1).empty());
}

TEST(PairCounting, RigidMotionAndScaleChangeNothingButRounding)
{
  const auto set = mixedCloud(1500, 9);
  const auto h = countAllPairs(PairSource(set), {}, 2.0);
  // A quarter turn about z, exact in floating point, far from the origin and scaled.
  SurfletSet turned;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const auto s = set[i];
    turned.push_back({-s.y * 1024 + 4096, s.x * 1024 - 65536, s.z * 1024, -s.ny, s.nx, s.nz});
  }
  const auto g = countAllPairs(PairSource(turned), {}, 2.0 * 1024);
  EXPECT_EQ(g.features + g.rejected, h.features + h.rejected);
  EXPECT_LE(moved(h, g), 1124250u / 2000);
}

TEST(PairCounting, AbsurdScales)
{
  for (const float scale : {1e-30f, 1e-15f, 1e15f, 1e30f}) {
    auto set = mixedCloud(300, 10);
    const auto expected = countAllPairs(PairSource(set), {}, 2.0);
    for (auto* column : {&set.x, &set.y, &set.z})
      for (float& c : *column)
        c *= scale;
    const auto h = countAllPairs(PairSource(set), {}, 2.0 * scale);
    EXPECT_EQ(h.rejected, expected.rejected) << scale;
    EXPECT_LE(moved(h, expected), 20u) << scale;
  }
}

TEST(PairCounting, FeaturesOfGivenPairsAreThoseOfDrawnOnes)
{
  const auto set = mixedCloud(700, 11);
  const PairSource source(set);
  const std::uint64_t n = 10001; // more than two blocks, and a remainder
  std::vector<std::uint32_t> first, second;
  for (const auto& [a, b] : drawPairs(set.size(), n, 3)) {
    first.push_back(a);
    second.push_back(b);
  }
  for (const auto kernels : {InstructionSet::Scalar, InstructionSet::Baseline, InstructionSet::Avx2,
                             InstructionSet::Avx512}) {
    if (!selectInstructionSet(kernels))
      continue;
    const auto drawn = drawFeatures(source, {}, n, 3);
    PairFeatures given;
    featuresOfPairs(source, {}, first, second, given);
    ASSERT_EQ(given.angular_bin.size(), n);
    std::vector<std::uint32_t> bins, expected;
    drawn.bins(1.5, expected);
    for (std::size_t i = 0; i < n; ++i) {
      if (given.angular_bin[i] == kNoPairFeature)
        continue;
      bins.push_back(given.angular_bin[i]);
      for (int k = 0; k < 4; ++k)
        bins.back() += given.delta_squared[i] >= deltaBorder(k, {}, 1.5, source.scale()) ? 125 : 0;
    }
    EXPECT_EQ(n - bins.size(), drawn.rejected);
    EXPECT_EQ(bins, expected);
  }
  selectInstructionSet(InstructionSet::Automatic);
  PairFeatures self;
  featuresOfPairs(source, {}, {5}, {5}, self);
  EXPECT_EQ(self.angular_bin[0], kNoPairFeature);
  EXPECT_THROW(featuresOfPairs(source, {}, {1, 2}, {1}, self), std::invalid_argument);
}

TEST(PairCounting, RowsHaveTheFeaturesOfTheirPairs)
{
  const auto set = mixedCloud(200, 12);
  const PairSource source(set);
  std::vector<std::uint32_t> indices, first, second;
  for (std::uint32_t i = 0; i < 60; ++i)
    indices.push_back(3 * i + 1);
  PairRows rows;
  rows.setPartners(source, indices);
  const std::size_t lengths[] = {1, 0, 16, 17, 60, 5, 31}; // with and without remainders
  for (std::uint32_t r = 0; r < 7; ++r) {
    const std::size_t begin = 60 - lengths[r];
    rows.addRow(5 * r, begin, lengths[r]);
    for (std::size_t k = begin; k < 60; ++k) {
      first.push_back(5 * r);
      second.push_back(indices[k]);
    }
  }
  for (const auto kernels : kSets)
    for (const Resolution resolution : {Resolution{7, 7, 7, 7}, Resolution{4, 3, 9, 2}}) {
      if (!selectInstructionSet(kernels))
        continue;
      PairFeatures expected, found;
      featuresOfPairs(source, resolution, first, second, expected);
      featuresOfRows(source, resolution, rows, found);
      EXPECT_EQ(found.angular_bin, expected.angular_bin) << activeInstructionSet();
      EXPECT_EQ(found.delta_squared, expected.delta_squared) << activeInstructionSet();
    }
  selectInstructionSet(InstructionSet::Automatic);
  PairFeatures out;
  rows.addRow(0, 59, 2);
  EXPECT_THROW(featuresOfRows(source, {}, rows, out), std::invalid_argument) << "too long";
  rows.clearRows();
  featuresOfRows(source, {}, rows, out);
  EXPECT_TRUE(out.angular_bin.empty());
  rows.surflet.push_back(0);
  EXPECT_THROW(featuresOfRows(source, {}, rows, out), std::invalid_argument) << "no length";
}

TEST(PairCounting, TinyAndDegenerateSets)
{
  SurfletSet set;
  EXPECT_EQ(countAllPairs(PairSource(set), {}, 1.0).features, 0u);
  EXPECT_EQ(countDrawnPairs(PairSource(set), {}, 1.0, 100, 1).features, 0u);
  EXPECT_EQ(drawFeatures(PairSource(set), {}, 100, 1).size(), 0u);
  set.push_back({1, 2, 3, 0, 0, 1});
  EXPECT_EQ(countAllPairs(PairSource(set), {}, 1.0).features, 0u);
  set.push_back({1, 2, 3, 0, 0, 1});
  const auto duplicates = countAllPairs(PairSource(set), {}, 1.0);
  EXPECT_EQ(duplicates.features, 0u);
  EXPECT_EQ(duplicates.rejected, 1u);
  set.push_back({2, 2, 3, 0, 0, 1});
  EXPECT_EQ(countAllPairs(PairSource(set), {}, 1.0).features, 2u);
}

TEST(PairCounting, MisuseThrows)
{
  const PairSource source(mixedCloud(10, 1));
  EXPECT_THROW(countAllPairs(source, {}, 0.0), std::invalid_argument);
  EXPECT_THROW(countAllPairs(source, {}, std::nan("")), std::invalid_argument);
  EXPECT_THROW(countDrawnPairs(source, {0, 5, 5, 5}, 1.0, 10, 1), std::invalid_argument);
  EXPECT_THROW(countAllPairs(source, {}, 1.0, 1, {2, 2}), std::invalid_argument);
  EXPECT_THROW(countDrawnPairs(source, {}, 1.0, 10, 1, 1, {0, 0}), std::invalid_argument);
  EXPECT_THROW(drawFeatures(source, {65, 5, 5, 5}, 10, 1), std::invalid_argument);
}
