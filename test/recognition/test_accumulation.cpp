// Several interpretations voted into one, on hand-made runs.
#include "scene_pieces.h"

#include "pcl_surflet/recognition/scene_accumulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

using namespace pcl_surflet;
using pcl_surflet::test::range;

namespace {

using Cells = std::vector<std::uint32_t>;

/** \brief A hundred cells in a row. */
const SurfletSet&
row()
{
  static const SurfletSet set = [] {
    SurfletSet s;
    for (int i = 0; i < 100; ++i)
      s.push_back({static_cast<float>(i), 0, 0, 0, 0, 1});
    return s;
  }();
  return set;
}

Detection
detection(std::size_t model, Cells cells, double score = 1)
{
  Detection d;
  d.model = model;
  d.label = "model " + std::to_string(model);
  d.cells = std::move(cells);
  d.score = score;
  d.fit = 0.8;
  d.seeds = 2;
  return d;
}

SceneInterpretation
run(std::vector<Detection> detections)
{
  SceneInterpretation r;
  r.detections = std::move(detections);
  r.diagnostics.drawn = 7;
  return r;
}

std::vector<Detection>
merged(const std::vector<SceneInterpretation>& runs, const AccumulationParameters& p = {})
{
  return mergeInterpretations(row(), runs, p).detections;
}

} // namespace

TEST(Accumulation, CellsOfOverlappingDetectionsOfOneNameUnite)
{
  const auto all = merged({run({detection(0, range(0, 20), 1), detection(1, range(60, 70))}),
                           run({detection(0, range(10, 30), 3), detection(1, range(60, 70))})});
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].cells, range(0, 30));
  EXPECT_EQ(all[0].label, "model 0");
  EXPECT_DOUBLE_EQ(all[0].score, 2) << "mean";
  EXPECT_DOUBLE_EQ(all[0].fit, 0.8);
  EXPECT_DOUBLE_EQ(all[0].centroid[0], 14.5);
  EXPECT_EQ(all[0].seeds, 4u);
  EXPECT_EQ(all[0].votes, 1);
  EXPECT_EQ(all[1].cells, range(60, 70));
}

TEST(Accumulation, TheOrderOfCellsDoesNotMatter)
{
  Cells backwards = range(10, 30);
  std::reverse(backwards.begin(), backwards.end());
  const auto all = merged({run({detection(0, backwards)}), run({detection(0, range(0, 20))})});
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].cells, range(0, 30));
}

TEST(Accumulation, WhatFewRunsFindGoes)
{
  const std::vector<SceneInterpretation> runs = {
      run({detection(0, range(0, 20)), detection(1, range(40, 60))}),
      run({detection(0, range(0, 20))}), run({detection(0, range(0, 20))})};
  ASSERT_EQ(merged(runs).size(), 1u);
  AccumulationParameters p;
  p.min_votes = 0.3;
  ASSERT_EQ(merged(runs, p).size(), 2u);
  EXPECT_NEAR(merged(runs, p)[1].votes, 1.0 / 3, 1e-12);
}

TEST(Accumulation, TwoDetectionsOfOneRunAreOneVote)
{
  const auto all = merged({run({detection(0, range(0, 20)), detection(0, range(15, 35))}),
                           run({detection(0, range(10, 30))}), run({})});
  ASSERT_EQ(all.size(), 1u) << "the second run connects them";
  EXPECT_NEAR(all[0].votes, 2.0 / 3, 1e-12);
  EXPECT_EQ(all[0].cells, range(0, 35));
}

TEST(Accumulation, InstancesApartStayApart)
{
  const auto two = run({detection(0, range(0, 20)), detection(0, range(50, 70))});
  EXPECT_EQ(merged({two, two}).size(), 2u);
}

TEST(Accumulation, OfRivalsTheOneOfMoreVotesStays)
{
  const auto all = merged({run({detection(0, range(0, 20), 9)}), run({detection(1, range(5, 25))}),
                           run({detection(1, range(5, 25))}), run({detection(0, range(0, 20), 9)}),
                           run({detection(1, range(5, 25))})});
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].model, 1u);
  const auto tied =
      merged({run({detection(0, range(0, 20), 1)}), run({detection(1, range(5, 25), 2)})});
  ASSERT_EQ(tied.size(), 1u);
  EXPECT_EQ(tied[0].model, 1u) << "the better score";
}

TEST(Accumulation, ACellHasOneOwner)
{
  const auto all = merged({run({detection(0, range(0, 50)), detection(1, range(48, 90))}),
                           run({detection(0, range(0, 50)), detection(1, range(50, 90))})});
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].cells, range(0, 50)) << "48 and 49 have more votes there";
  EXPECT_EQ(all[1].cells, range(50, 90));
}

TEST(Accumulation, CellsMayNeedVotesOfTheirOwn)
{
  AccumulationParameters p;
  p.min_cell_share = 0.6;
  const auto all = merged({run({detection(0, range(0, 20))}), run({detection(0, range(5, 25))}),
                           run({detection(0, range(5, 20))})},
                          p);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].cells, range(5, 20));
}

TEST(Accumulation, OneRunIsLeftAsItIs)
{
  const auto one = run({detection(0, range(0, 20)), detection(1, range(0, 20))});
  const auto same = mergeInterpretations(row(), {one}, {});
  EXPECT_EQ(same.detections.size(), 2u);
  EXPECT_EQ(same.diagnostics.drawn, 7u);
  EXPECT_TRUE(mergeInterpretations(row(), {}, {}).detections.empty());
}

TEST(Accumulation, EveryRunHasASeedOfItsOwnAndTheFirstTheGiven)
{
  std::set<std::uint64_t> seeds;
  for (std::size_t k = 0; k < 100; ++k)
    seeds.insert(seedOfRun(5, k));
  EXPECT_EQ(seeds.size(), 100u);
  EXPECT_EQ(seedOfRun(5, 0), 5u);
  EXPECT_NE(seedOfRun(5, 1), seedOfRun(6, 1));
}

TEST(Accumulation, RunsUntilABudgetIsSpent)
{
  std::vector<std::uint64_t> seeds;
  const auto interpret = [&](std::uint64_t seed) {
    seeds.push_back(seed);
    const auto n = static_cast<std::uint32_t>(seeds.size());
    return run({detection(0, range(0, 10 + 10 * n))});
  };
  std::size_t runs = 0;
  const auto found = [&](const AccumulationParameters& p,
                         const std::function<bool(std::size_t)>& may_go_on = {}) {
    seeds.clear();
    return accumulateInterpretations(row(), interpret, 9, p, may_go_on, &runs).detections;
  };
  AccumulationParameters p;
  EXPECT_EQ(found(p)[0].cells.size(), 20u);
  EXPECT_EQ(seeds, std::vector<std::uint64_t>{9});
  p.runs = 6;
  EXPECT_EQ(found(p)[0].cells.size(), 70u);
  EXPECT_EQ(runs, 6u);
  EXPECT_EQ(seeds[3], seedOfRun(9, 3));
  EXPECT_EQ(found(p, [](std::size_t so_far) { return so_far < 4; })[0].cells.size(), 50u);
  EXPECT_EQ(runs, 4u);
  p.cells = 35;
  EXPECT_EQ(found(p)[0].cells.size(), 40u) << "the first that is enough";
  EXPECT_EQ(runs, 3u);
}

TEST(Accumulation, ACancelledRunEndsAll)
{
  std::size_t calls = 0, runs = 0;
  AccumulationParameters p;
  p.runs = 5;
  const auto result = accumulateInterpretations(
      row(),
      [&](std::uint64_t) {
        auto r = run({detection(0, range(0, 20))});
        r.diagnostics.cancelled = ++calls == 2;
        return r;
      },
      1, p, {}, &runs);
  EXPECT_EQ(runs, 2u);
  EXPECT_TRUE(result.diagnostics.cancelled);
  EXPECT_TRUE(result.detections.empty());
}

TEST(Accumulation, MisuseIsRefused)
{
  const auto refused = [](auto change) {
    AccumulationParameters p;
    change(p);
    EXPECT_THROW(mergeInterpretations(row(), {}, p), std::invalid_argument);
  };
  refused([](auto& p) { p.runs = 0; });
  refused([](auto& p) { p.min_overlap = 1; });
  refused([](auto& p) { p.min_overlap = std::nan(""); });
  refused([](auto& p) { p.min_votes = 1.1; });
  refused([](auto& p) { p.min_cell_share = -1; });
  EXPECT_THROW(merged({run({detection(0, range(90, 101))}), run({})}), std::invalid_argument);
}
