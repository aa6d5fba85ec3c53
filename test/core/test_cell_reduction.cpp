#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/counter_random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

using namespace pcl_surflet;

namespace {

SurfletSet
randomSet(std::size_t n, double low, double high, std::uint64_t seed)
{
  CounterRandom random(seed);
  SurfletSet set;
  for (std::size_t i = 0; i < n; ++i)
    set.appendChecked({float(random.uniform(low, high)), float(random.uniform(low, high)),
                       float(random.uniform(low, high)), float(random.uniform(-0.5, 1)),
                       float(random.uniform(-0.5, 1)), float(random.uniform(-0.5, 1))});
  return set;
}

using Cell = std::array<double, 3>;

/** \brief The reduction by definition: a map from cell to its members. */
std::map<Cell, std::vector<std::size_t>>
membersByCell(const SurfletSet& set, double leaf)
{
  std::map<Cell, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < set.size(); ++i)
    members[{std::floor(set.x[i] / leaf), std::floor(set.y[i] / leaf), std::floor(set.z[i] / leaf)}]
        .push_back(i);
  return members;
}

void
expectEqualsDefinition(const SurfletSet& set, double leaf)
{
  CellReductionOptions options;
  options.leaf = leaf;
  options.min_mean_normal = 0;
  const CellReduction result = reduceToCells(set, options);
  const auto members = membersByCell(set, leaf);
  ASSERT_EQ(result.cells.size(), members.size());
  ASSERT_EQ(result.cell_of.size(), set.size());
  for (const auto& [cell, indices] : members) {
    const auto c = result.cell_of[indices[0]];
    ASSERT_LT(c, result.cells.size());
    EXPECT_EQ(result.counts[c], indices.size());
    double sum[6] = {};
    for (const auto i : indices) {
      EXPECT_EQ(result.cell_of[i], c);
      const Surflet s = set[i];
      const float values[6] = {s.x, s.y, s.z, s.nx, s.ny, s.nz};
      for (int k = 0; k < 6; ++k)
        sum[k] += values[k];
    }
    const double n = static_cast<double>(indices.size());
    const double length = std::sqrt(sum[3] * sum[3] + sum[4] * sum[4] + sum[5] * sum[5]);
    EXPECT_EQ(result.cells.x[c], float(sum[0] / n));
    EXPECT_EQ(result.cells.y[c], float(sum[1] / n));
    EXPECT_EQ(result.cells.z[c], float(sum[2] / n));
    EXPECT_EQ(result.cells.nx[c], float(sum[3] / length));
    EXPECT_EQ(result.cells.ny[c], float(sum[4] / length));
    EXPECT_EQ(result.cells.nz[c], float(sum[5] / length));
  }
}

} // namespace

// Leaves are powers of two so that x / leaf and x * (1 / leaf) name the same cell.
TEST(CellReduction, EqualsDefinition)
{
  expectEqualsDefinition(randomSet(5000, -1, 1, 1), 0.125);
  expectEqualsDefinition(randomSet(5000, -1, 1, 2), 1.0 / 8192);      // 64-bit keys
  expectEqualsDefinition(randomSet(3000, -1, 1, 3), 1.0 / (1 << 24)); // keys of several words
  expectEqualsDefinition(randomSet(1000, 1e6, 1e6 + 64, 4), 4);
  expectEqualsDefinition(randomSet(1000, -1, 1, 5), 1024); // eight cells around the origin
  expectEqualsDefinition(randomSet(1, -1, 1, 6), 0.5);
}

TEST(CellReduction, CellsDoNotDependOnTheRestOfTheSet)
{
  const SurfletSet set = randomSet(2000, 0, 1, 7);
  SurfletSet more = set;
  more.push_back({-100, -200, -300, 0, 0, 1});
  const CellReductionOptions options{0.1, 0};
  const auto a = reduceToCells(set, options), b = reduceToCells(more, options);
  ASSERT_EQ(a.cells.size() + 1, b.cells.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    EXPECT_EQ(a.cells.x[a.cell_of[i]], b.cells.x[b.cell_of[i]]);
    EXPECT_EQ(a.cells.nz[a.cell_of[i]], b.cells.nz[b.cell_of[i]]);
  }
}

TEST(CellReduction, CancellingNormalsAreLeftOutAndCounted)
{
  SurfletSet set;
  set.push_back({0.1f, 0.1f, 0.1f, 0, 0, 1});
  set.push_back({0.2f, 0.2f, 0.2f, 0, 0, -1});
  set.push_back({1.1f, 0.1f, 0.1f, 1, 0, 0});
  set.push_back({1.3f, 0.1f, 0.1f, 0, 1, 0});
  const auto result = reduceToCells(set, 1.0);
  EXPECT_EQ(result.cancelled_cells, 1u);
  EXPECT_EQ(result.cancelled_surflets, 2u);
  ASSERT_EQ(result.cells.size(), 1u);
  EXPECT_FLOAT_EQ(result.cells.x[0], 1.2f);
  EXPECT_FLOAT_EQ(result.cells.nx[0], float(std::sqrt(0.5)));
  EXPECT_EQ(result.cell_of,
            (std::vector<std::uint32_t>{CellReduction::no_cell, CellReduction::no_cell, 0, 0}));
}

/** \brief Both sides of a wall of thickness \p thickness with the given normal, within a unit cube.
 */
SurfletSet
wall(const std::array<double, 3>& normal, double thickness, std::size_t n, std::uint64_t seed)
{
  CounterRandom random(seed);
  SurfletSet set;
  const auto& m = normal;
  for (std::size_t i = 0; i < n; ++i) {
    const double side = i % 2 ? 1 : -1;
    double p[3], along = 0;
    for (int a = 0; a < 3; ++a) {
      p[a] = random.uniform(-0.4, 0.4);
      along += p[a] * m[static_cast<std::size_t>(a)];
    }
    for (std::size_t a = 0; a < 3; ++a)
      p[a] += 0.5 + (side * thickness / 2 - along) * m[a];
    set.push_back({float(p[0]), float(p[1]), float(p[2]), float(side * m[0]), float(side * m[1]),
                   float(side * m[2])});
  }
  return set;
}

TEST(CellReduction, AWallBecomesOneCellOnEachSide)
{
  for (const auto& normal : {std::array<double, 3>{0, 0, 1},
                             {0.6, 0, 0.8},
                             {0, -1, 0},
                             {std::sqrt(1 / 3.), std::sqrt(1 / 3.), -std::sqrt(1 / 3.)}}) {
    const SurfletSet set = wall(normal, 0.01, 200, 3);
    EXPECT_EQ(reduceToCells(set, 1.0).cells.size(), 0u);
    const auto two = reduceToTwoSidedCells(set, 1.0);
    ASSERT_EQ(two.cells.size(), 2u);
    EXPECT_EQ(two.cancelled_cells, 0u);
    EXPECT_EQ(two.counts, (std::vector<std::uint32_t>{100, 100}));
    for (std::size_t i = 0; i < set.size(); ++i) {
      const auto c = two.cell_of[i];
      EXPECT_GT(set.nx[i] * two.cells.nx[c] + set.ny[i] * two.cells.ny[c] +
                    set.nz[i] * two.cells.nz[c],
                0.999);
    }
    double gap = 0;
    const double d[3] = {two.cells.x[0] - two.cells.x[1], two.cells.y[0] - two.cells.y[1],
                         two.cells.z[0] - two.cells.z[1]};
    for (std::size_t a = 0; a < 3; ++a)
      gap += d[a] * normal[a];
    EXPECT_NEAR(std::abs(gap), 0.01, 1e-6) << "each side keeps its place";
  }
}

TEST(CellReduction, CellsBehindAWallKeepOrderAndMembers)
{
  SurfletSet set = wall({0, 0, 1}, 0.01, 100, 4);
  for (const float x : {1.5f, -0.5f}) // one cell behind, one in front
    set.push_back({x, 0.5f, 0.5f, 1, 0, 0});
  const auto two = reduceToTwoSidedCells(set, 1.0);
  ASSERT_EQ(two.cells.size(), 4u);
  EXPECT_EQ(two.counts, (std::vector<std::uint32_t>{1, 50, 50, 1}));
  EXPECT_EQ(two.cell_of[100], 3u);
  EXPECT_EQ(two.cell_of[101], 0u);
  EXPECT_FLOAT_EQ(two.cells.x[3], 1.5f);
}

TEST(CellReduction, EdgesAndCornersAreNotSplit)
{
  SurfletSet set; // a cube's corner, the hardest: its mean normal is 0.58 long
  for (int i = 0; i < 30; ++i)
    set.push_back(
        {0.5f, 0.5f, 0.5f, i % 3 == 0 ? 1.f : 0.f, i % 3 == 1 ? 1.f : 0.f, i % 3 == 2 ? 1.f : 0.f});
  EXPECT_EQ(reduceToTwoSidedCells(set, 1.0).cells.size(), 1u);
}

TEST(CellReduction, NonFiniteSurfletsBelongToNoCell)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  SurfletSet set = randomSet(10, 0, 1, 8);
  set.push_back({nan, 0, 0, 0, 0, 1});
  set.push_back({0, -inf, 0, 0, 0, 1});
  set.push_back({0, 0, 0, 0, nan, 1});
  set.push_back({inf, -inf, 0, 0, 0, 1});
  const auto result = reduceToCells(set, 10);
  EXPECT_EQ(result.rejected, 4u);
  ASSERT_EQ(result.counts, (std::vector<std::uint32_t>{10}));
  for (std::size_t i = 0; i < set.size(); ++i)
    EXPECT_EQ(result.cell_of[i], i < 10 ? 0u : CellReduction::no_cell);
}

TEST(CellReduction, EmptyAndMisuse)
{
  EXPECT_TRUE(reduceToCells(SurfletSet(), 1).cells.empty());
  const SurfletSet set = randomSet(2, -1e30, 1e30, 9);
  const double inf = std::numeric_limits<double>::infinity();
  for (const double leaf : {0.0, -1.0, inf, double(NAN), 1e-3})
    EXPECT_THROW(reduceToCells(set, leaf), std::invalid_argument) << leaf;
  for (const auto& bad : {CellReductionOptions{1.0, 1.5, 0}, {1.0, 0.1, 1.5}, {1.0, 0.1, -0.1}})
    EXPECT_THROW(reduceToCells(SurfletSet(), bad), std::invalid_argument);
  EXPECT_TRUE(reduceToTwoSidedCells(SurfletSet(), 1).cells.empty());
  SurfletSet without; // without any direction there are no sides
  for (int i = 0; i < 5; ++i)
    without.push_back({0, 0, 0, 0, 0, 0});
  EXPECT_TRUE(reduceToTwoSidedCells(without, 1).cells.empty());
}
