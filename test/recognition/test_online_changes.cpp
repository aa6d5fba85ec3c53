// Online interpretation: what vanishes, moves, waits or is sought again when the scene changes.
#include "online_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

namespace {

/** \brief Height below which this share of a thing's surface lies. */
float
heightOf(const SurfletSet& set, double share)
{
  std::vector<float> z = set.z;
  std::sort(z.begin(), z.end());
  return z[static_cast<std::size_t>(share * static_cast<double>(z.size() - 1))];
}

/** \brief What lies between two shares of the surface, from below. */
SurfletSet
slice(const SurfletSet& set, double low, double high)
{
  const float from = heightOf(set, low), to = heightOf(set, high);
  SurfletSet part;
  for (std::size_t i = 0; i < set.size(); ++i)
    if (set.z[i] >= from && (set.z[i] < to || high == 1))
      part.push_back(set[i]);
  return part;
}

/** \brief Rays from kSensor that pass the bottle above \p height. */
SurfletSet
raysAbove(float height)
{
  SurfletSet rays;
  const SurfletSet wall = wallSeenThrough(0);
  for (std::size_t i = 0; i < wall.size(); ++i)
    if (wall.z[i] > 1.5F * height)
      rays.push_back(wall[i]);
  return rays;
}

} // namespace

TEST(OnlineInterpretation, WhatIsTakenAwayEnds)
{
  OnlineInterpretation online(models(), quick());
  online.addScan(together(thingAt(0, 0), thingAt(1, kFar)), kSensor);
  ASSERT_NE(find(online, "bottle"), nullptr);
  ASSERT_NE(find(online, "torus"), nullptr);
  const auto bottle = find(online, "bottle")->id, torus = find(online, "torus")->id;
  const auto scan = online.addScan(wallSeenThrough(0), kSensor);
  EXPECT_GT(scan.vanished_cells, 1000U);
  EXPECT_EQ(find(online, "bottle"), nullptr);
  ASSERT_NE(find(online, "torus"), nullptr);
  EXPECT_EQ(find(online, "torus")->id, torus);
  EXPECT_EQ(find(online, "torus")->state, OnlineState::Kept);
  EXPECT_EQ(online.detections().back().id, bottle);
  EXPECT_EQ(online.detections().back().state, OnlineState::Vanished);
  online.addScan({});
  EXPECT_EQ(online.detections().size(), 1U) << "told once";
}

TEST(OnlineInterpretation, NobodyTakesAwayWhatHidesTheWallOrIsHidden)
{
  OnlineParameters never = quick();
  never.behind = 0;
  OnlineInterpretation online(models(), quick()), blind(models(), quick()), off(models(), never);
  for (auto* o : {&online, &blind, &off})
    o->addScan(thingAt(0, 0));
  EXPECT_EQ(blind.addScan(wallSeenThrough(0)).vanished_cells, 0U) << "from nowhere";
  EXPECT_EQ(off.addScan(wallSeenThrough(0), kSensor).vanished_cells, 0U);
  EXPECT_EQ(online.addScan(wallSeenThrough(0), {0, 3, 0}).vanished_cells, 0U) << "hidden by it";
  EXPECT_EQ(online.addScan(wallSeenThrough(1), kSensor).vanished_cells, 0U) << "beside it";
  EXPECT_NE(find(online, "bottle"), nullptr);
}

TEST(OnlineInterpretation, WhatIsMovedGetsAnotherId)
{
  OnlineInterpretation online(models(), quick());
  online.addScan(thingAt(0, 0), kSensor);
  ASSERT_NE(find(online, "bottle"), nullptr);
  const auto id = find(online, "bottle")->id;
  online.addScan(together(wallSeenThrough(0), thingAt(0, 0.5F)), kSensor);
  ASSERT_NE(find(online, "bottle"), nullptr);
  EXPECT_NE(find(online, "bottle")->id, id);
  EXPECT_NEAR(find(online, "bottle")->centroid[0], 0.5, 0.01);
  ASSERT_EQ(online.detections().size(), 2U);
  EXPECT_EQ(online.detections()[1].id, id);
  EXPECT_EQ(online.detections()[1].state, OnlineState::Vanished);
}

TEST(OnlineInterpretation, ASureDetectionWaitsUntilATenthHasChangedInAll)
{
  const SurfletSet all = thingAt(0, 0);
  OnlineParameters eager = quick();
  eager.stale = 0;
  OnlineInterpretation patient(models(), quick()), impatient(models(), eager);
  for (auto* online : {&patient, &impatient}) {
    online->addScan(slice(all, 0, 0.88));
    ASSERT_EQ(online->distractors().size(), 1U) << "sure";
  }
  const auto cells = find(patient, "bottle")->cells.size();
  const auto kept = patient.addScan(slice(all, 0.88, 0.94));
  const auto sought = impatient.addScan(slice(all, 0.88, 0.94));
  ASSERT_GT(kept.changed_cells, 0U);
  EXPECT_EQ(kept.interpreted_cells, 0U);
  EXPECT_EQ(kept.kept, 1U);
  EXPECT_EQ(find(patient, "bottle")->cells.size(), cells);
  EXPECT_EQ(sought.sought, 1U);
  EXPECT_GT(find(impatient, "bottle")->cells.size(), cells);
  const auto enough = patient.addScan(slice(all, 0.94, 1));
  EXPECT_LT(enough.changed_cells, cells / 10) << "not by itself";
  EXPECT_EQ(enough.sought, 1U);
  EXPECT_GT(find(patient, "bottle")->cells.size(), cells);
}

TEST(OnlineInterpretation, WhatIsInDoubtDoesNotWait)
{
  OnlineParameters doubting = quick();
  doubting.coverage = 1;
  OnlineInterpretation online(models(), doubting);
  const SurfletSet most = facing(thingAt(0, 0), 1, 0, -0.6);
  online.addScan(slice(most, 0, 0.97));
  ASSERT_NE(find(online, "bottle"), nullptr);
  ASSERT_EQ(online.attractors().size(), 1U);
  ASSERT_EQ(online.attractors()[0].id, find(online, "bottle")->id);
  EXPECT_EQ(online.addScan(slice(most, 0.97, 1)).sought, 1U);
}

TEST(OnlineInterpretation, AKeptDetectionLosesTheCellsThatAreGone)
{
  OnlineInterpretation online(models(), quick());
  online.addScan(thingAt(0, 0));
  ASSERT_EQ(online.distractors().size(), 1U) << "sure";
  const auto cells = find(online, "bottle")->cells.size();
  const auto scan = online.addScan(raysAbove(heightOf(thingAt(0, 0), 0.95)), kSensor);
  EXPECT_GT(scan.vanished_cells, 20U);
  ASSERT_NE(find(online, "bottle"), nullptr);
  EXPECT_EQ(find(online, "bottle")->state, OnlineState::Kept);
  EXPECT_LT(find(online, "bottle")->cells.size(), cells);
  for (const auto c : find(online, "bottle")->cells)
    ASSERT_TRUE(std::isfinite(online.cells().x[c]));
}

TEST(OnlineInterpretation, WhatIsLeftOfTheVanishedIsThereForTheNext)
{
  const SurfletSet all = thingAt(0, 0);
  OnlineInterpretation online(models(), quick());
  online.addScan(all);
  const auto cells = find(online, "bottle")->cells.size();
  online.addScan(raysAbove(heightOf(all, 0.25)), kSensor);
  ASSERT_EQ(find(online, "bottle"), nullptr) << "too little is left";
  online.addScan(all);
  ASSERT_NE(find(online, "bottle"), nullptr);
  EXPECT_GT(20 * find(online, "bottle")->cells.size(), 19 * cells);
}
