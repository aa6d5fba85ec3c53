// Parts of online interpretation: cells that can be taken back, free space, groups, memory.
#include "failing_allocation.h"
#include "scene_pieces.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/recognition/scene_training.h"
#include "recognition/online/attention.h"
#include "recognition/online/free_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <set>

using namespace pcl_surflet;
using namespace pcl_surflet::online;
using pcl_surflet::test::shifted;
using pcl_surflet::test::together;

namespace {

constexpr double kLeaf = 0.1;

/** \brief Surflets at random in a box of edge 2 about the origin, normals at random. */
SurfletSet
cloud(std::size_t n, std::uint64_t seed)
{
  CounterRandom random(seed);
  SurfletSet set;
  for (std::size_t i = 0; i < n; ++i) {
    const auto at = [&] { return static_cast<float>(random.uniform(-1, 1)); };
    set.appendChecked({at(), at(), at(), at(), at(), at()});
  }
  return set;
}

Indices
added(OnlineCells& cells, const SurfletSet& set)
{
  for (std::size_t i = 0; i < set.size(); ++i)
    cells.add(set, i);
  return cells.takeChanged(0.25, 0.35);
}

/** \brief NaN equals NaN. */
bool
sameBits(const std::vector<float>& a, const std::vector<float>& b)
{
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

bool
sameCells(const SurfletSet& a, const SurfletSet& b)
{
  return sameBits(a.x, b.x) && sameBits(a.y, b.y) && sameBits(a.z, b.z) && sameBits(a.nx, b.nx) &&
         sameBits(a.ny, b.ny) && sameBits(a.nz, b.nz);
}

} // namespace

TEST(OnlineCells, WhatIsTakenBackNeverWas)
{
  OnlineCells cells(kLeaf, 0.3), untroubled(kLeaf, 0.3);
  for (auto* c : {&cells, &untroubled}) {
    c->begin();
    added(*c, cloud(3000, 1));
  }
  const SurfletSet before = cells.means();
  cells.begin();
  const auto changed = added(cells, cloud(3000, 2));
  EXPECT_GT(cells.means().size(), before.size());
  for (std::uint32_t c = 0; c < 100; ++c)
    cells.remove(c);
  cells.setBackground(changed.back(), true);
  cells.rollBack();
  EXPECT_TRUE(sameCells(cells.means(), before));
  for (auto* c : {&cells, &untroubled})
    c->begin();
  EXPECT_EQ(added(cells, cloud(2000, 3)), added(untroubled, cloud(2000, 3)));
  EXPECT_TRUE(sameCells(cells.means(), untroubled.means()));
  EXPECT_EQ(cells.near({{0, 0, 0}}, 5), untroubled.near({{0, 0, 0}}, 5));
}

TEST(OnlineCells, NearHoldsAllWithinReachAndLittleElse)
{
  constexpr double kBlock = 0.3, kReach = 0.5;
  OnlineCells cells(kLeaf, kBlock);
  cells.begin();
  added(cells, cloud(8000, 4));
  CounterRandom random(5);
  std::size_t within = 0;
  for (int k = 0; k < 30; ++k) {
    const Place q = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const auto found = cells.near({q, {9, 9, 9}}, kReach);
    const std::set<std::uint32_t> is_found(found.begin(), found.end());
    for (std::uint32_t c = 0; c < cells.means().size(); ++c) {
      const Place at = cells.placeOf(c);
      const double d = std::hypot(at[0] - q[0], at[1] - q[1], at[2] - q[2]);
      within += d <= kReach;
      if (d <= kReach) {
        ASSERT_EQ(is_found.count(c), 1U) << d;
      }
      if (d > kReach + 2 * kBlock * std::sqrt(3.0)) { // a block's diagonal at either end
        ASSERT_EQ(is_found.count(c), 0U) << d;
      }
    }
  }
  EXPECT_GT(within, 1000U);
}

TEST(OnlineCells, WhatIsRemovedIsGoneAndItsNumberToo)
{
  OnlineCells cells(kLeaf, 0.3);
  SurfletSet one;
  one.push_back({0.05F, 0.05F, 0.05F, 0, 0, 1});
  cells.begin();
  added(cells, one);
  cells.begin();
  cells.remove(0);
  EXPECT_FALSE(cells.takesPart(0));
  EXPECT_TRUE(std::isnan(cells.means().x[0]));
  cells.begin();
  EXPECT_TRUE(cells.near({{0, 0, 0}}, 1).empty());
  EXPECT_EQ(added(cells, one), Indices{1});
  EXPECT_EQ(cells.near({{0, 0, 0}}, 1), Indices{1});
}

namespace {

/** \brief Rays from the origin along z, in a square grid of directions, that end at z = \p depth.
 */
SurfletSet
rays(float depth, float half = 0.5F)
{
  SurfletSet ends;
  for (float x = -half; x <= half; x += 0.02F)
    for (float y = -half; y <= half; y += 0.02F)
      ends.push_back({x * depth, y * depth, depth, 0, 0, -1});
  return ends;
}

} // namespace

TEST(FreeSpace, IsInFrontOfWhatEndsRaysAndNowhereElse)
{
  const FreeSpace space(rays(2), {0, 0, 0}, kLeaf, kLeaf, 3);
  EXPECT_TRUE(space.isSeenThrough({0, 0, 1}));
  EXPECT_TRUE(space.isSeenThrough({0.2, -0.1, 1.5}));
  EXPECT_FALSE(space.isSeenThrough({0, 0, 1.95})) << "too near to the end";
  EXPECT_FALSE(space.isSeenThrough({0, 0, 2.5})) << "behind";
  EXPECT_FALSE(space.isSeenThrough({0, 0, -1})) << "behind the sensor";
  EXPECT_FALSE(space.isSeenThrough({1, 0, 1})) << "beside the picture";
  EXPECT_FALSE(space.isSeenThrough({0, 0, 0.05})) << "at the sensor";
  EXPECT_TRUE(space.looksAt({0, 0, 1}, 0.1));
  EXPECT_TRUE(space.looksAt({0.7, 0, 1}, 0.3)) << "a part is in the picture";
  EXPECT_FALSE(space.looksAt({1, 0, 1}, 0.1));
}

TEST(FreeSpace, OneRayThatEndsEarlierHides)
{
  SurfletSet ends = rays(2);
  ends.push_back({0.02F, 0, 0.8F, 0, 0, -1});
  const FreeSpace hidden(ends, {0, 0, 0}, kLeaf, kLeaf, 3);
  EXPECT_FALSE(hidden.isSeenThrough({0, 0, 1}));
  EXPECT_FALSE(hidden.isSeenThrough({0, 0, 0.8}));
  EXPECT_TRUE(hidden.isSeenThrough({0.4, 0.4, 1}));
}

TEST(FreeSpace, FewRaysTellNothing)
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  SurfletSet ends;
  for (int k = 0; k < 3; ++k) {
    ends.push_back({0.01F * static_cast<float>(k), 0, 2, 0, 0, -1});
    ends.push_back({nan, 0, 2, 0, 0, -1});
    ends.push_back({0, 0, 0, 0, 0, -1});
  }
  EXPECT_TRUE(FreeSpace(ends, {0, 0, 0}, kLeaf, kLeaf, 3).isSeenThrough({0, 0, 1}));
  EXPECT_FALSE(FreeSpace(ends, {0, 0, 0}, kLeaf, kLeaf, 4).isSeenThrough({0, 0, 1}));
  EXPECT_FALSE(FreeSpace({}, {0, 0, 0}, kLeaf, kLeaf, 1).isSeenThrough({0, 0, 1}));
}

TEST(Groups, AreAsIfSoughtAfresh)
{
  // Sparse enough for many groups, some of them wide; cells come, go, and get explained.
  OnlineCells cells(kLeaf, 0.3);
  std::set<std::uint32_t> explained;
  const IsOpen is_open = [&](std::uint32_t c) { return explained.count(c) == 0; };
  constexpr double kWidest = 0.7;
  Groups groups;
  CounterRandom random(6);
  std::size_t most = 0, with_several = 0;
  for (std::uint64_t round = 0; round < 12; ++round) {
    cells.begin();
    std::vector<CellKey> changed, all;
    for (const auto c : added(cells, cloud(150, 10 + round)))
      changed.push_back(cells.keyOf(c));
    const auto n = static_cast<std::uint32_t>(cells.means().size());
    for (int k = 0; k < 40; ++k) {
      const auto c = random.below(n);
      changed.push_back(cells.keyOf(c));
      if (k % 3 == 0 && cells.takesPart(c))
        cells.remove(c);
      else if (explained.insert(c).second == false)
        explained.erase(c);
    }
    groups = regrouped(cells, groups, changed, kLeaf, kWidest, is_open);
    for (std::uint32_t c = 0; c < n; ++c)
      all.push_back(cells.keyOf(c));
    const Groups fresh = regrouped(cells, {}, all, kLeaf, kWidest, is_open);
    ASSERT_EQ(groups.size(), fresh.size()) << round;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      EXPECT_EQ(groups[g]->cells, fresh[g]->cells);
      with_several += groups[g]->cells.size() > 3;
    }
    most = std::max(most, groups.size());
  }
  EXPECT_GT(most, 10U);
  EXPECT_GT(with_several, 10U);
}

TEST(Groups, NeighboursAreOneAndWideOnesNone)
{
  OnlineCells cells(kLeaf, 0.3);
  SurfletSet row;
  for (int k = 0; k < 5; ++k)
    row.push_back({0.05F + 0.1F * static_cast<float>(k), 0.05F, 0.05F, 0, 0, 1});
  row.push_back({2.05F, 0.05F, 0.05F, 0, 0, 1});
  cells.begin();
  std::vector<CellKey> changed;
  for (const auto c : added(cells, row))
    changed.push_back(cells.keyOf(c));
  const IsOpen all = [](std::uint32_t) { return true; };
  const Groups two = regrouped(cells, {}, changed, kLeaf, 0.4, all);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[0]->cells, (Indices{0, 1, 2, 3, 4}));
  EXPECT_NEAR(two[0]->patch.centre[0], 0.25, 1e-6);
  EXPECT_NEAR(two[0]->patch.radius, 0.2, 1e-6);
  const Groups narrow = regrouped(cells, {}, changed, kLeaf, 0.3, all);
  ASSERT_EQ(narrow.size(), 1U);
  EXPECT_EQ(narrow[0]->cells, Indices{5});
}

namespace {

constexpr double kSceneLeaf = 0.01;

SurfletSet
thing(const char* name, float x)
{
  return shifted(sceneItem(name, *shapeByName(name)).sample(4000, 5), x);
}

OnlineInterpretation
interpretation()
{
  HistogramModelTrainer trainer;
  trainer.setResolution({7, 7, 7, 7});
  trainer.setNumberOfPairs(100000);
  trainer.setNumberOfThreads(1);
  ModelDatabase database;
  for (const char* name : {"bottle", "torus"})
    database.add(trainForScenes(trainer, name, thing(name, 0), kSceneLeaf, 1, 1));
  OnlineParameters p;
  p.leaf = kSceneLeaf;
  p.explanation.steps.threads = 1;
  p.explanation.features = 2000;
  return {database, p};
}

} // namespace

TEST(OnlineMemory, AScanThatRunsOutOfItNeverWas)
{
  auto online = interpretation(), untroubled = interpretation();
  const SurfletSet first = together(thing("bottle", 0), thing("torus", 0.4F));
  const SurfletSet second = together(thing("torus", 0.9F), rays(2));
  for (auto* o : {&online, &untroubled})
    o->addScan(first, {0, 0, -3});
  const SurfletSet before = online.cells();
  const auto detections = online.detections();
  std::size_t failures = 0;
  bool is_done = false;
  for (long most = 0; !is_done; most += 1 + most / 3) {
    test::allocations_left = most;
    try {
      online.addScan(second, {0, 0, -3});
      is_done = true;
    }
    catch (const std::bad_alloc&) {
      ++failures;
    }
    test::allocations_left = -1;
    if (is_done)
      break;
    ASSERT_TRUE(sameCells(online.cells(), before)) << most;
    ASSERT_EQ(online.detections().size(), detections.size()) << most;
    for (std::size_t k = 0; k < detections.size(); ++k) {
      ASSERT_EQ(online.detections()[k].id, detections[k].id) << most;
      ASSERT_EQ(online.detections()[k].cells, detections[k].cells) << most;
      ASSERT_EQ(online.detections()[k].state, detections[k].state) << most;
    }
  }
  EXPECT_GT(failures, 10U);
  untroubled.addScan(second, {0, 0, -3});
  EXPECT_TRUE(sameCells(online.cells(), untroubled.cells()));
  ASSERT_EQ(online.detections().size(), untroubled.detections().size());
  for (std::size_t k = 0; k < online.detections().size(); ++k) {
    EXPECT_EQ(online.detections()[k].cells, untroubled.detections()[k].cells);
    EXPECT_EQ(online.detections()[k].id, untroubled.detections()[k].id);
    EXPECT_EQ(online.detections()[k].state, untroubled.detections()[k].state);
  }
}
