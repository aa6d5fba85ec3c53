// Online interpretation: ids, where to look next, and what a scan must not do.
#include "online_pieces.h"

#include "pcl_surflet/core/cell_reduction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

namespace {

/** \brief Coverage of the bottle, 0 if it is not named. */
double
coverageOfBottle(const OnlineInterpretation& online)
{
  const auto* d = find(online, "bottle");
  return d == nullptr ? 0 : d->coverage;
}

/** \brief What users see, as text that differs if a bit does. */
std::string
stateOf(const OnlineInterpretation& online)
{
  std::ostringstream text;
  text << std::hexfloat;
  const SurfletSet& c = online.cells();
  for (std::size_t i = 0; i < c.size(); ++i)
    text << c.x[i] << c.y[i] << c.z[i] << c.nx[i] << c.ny[i] << c.nz[i] << '\n';
  for (const auto& d : online.detections()) {
    text << d.id << ' ' << d.label << static_cast<int>(d.state) << d.fit << d.coverage;
    for (const auto i : d.cells)
      text << ' ' << i;
  }
  for (const auto& a : online.attractors())
    text << 'a' << a.id << a.centre[0] << a.radius;
  for (const auto& d : online.distractors())
    text << 'd' << d.id << d.centre[0] << d.radius;
  return text.str();
}

} // namespace

TEST(OnlineInterpretation, ALaterObjectIsNewAndTheOtherIsKept)
{
  OnlineInterpretation online(models(), quick());
  const auto first = online.addScan(thingAt(0, 0));
  EXPECT_EQ(first.interpreted_cells, first.cells);
  ASSERT_NE(find(online, "bottle"), nullptr);
  const auto id = find(online, "bottle")->id;

  const auto second = online.addScan(thingAt(1, kFar));
  EXPECT_EQ(second.interpreted_cells, second.cells - first.cells);
  ASSERT_EQ(online.detections().size(), 2U);
  EXPECT_EQ(find(online, "bottle")->id, id);
  EXPECT_EQ(find(online, "bottle")->state, OnlineState::Kept);
  ASSERT_NE(find(online, "torus"), nullptr);
  EXPECT_EQ(find(online, "torus")->state, OnlineState::New);
  EXPECT_NE(find(online, "torus")->id, id);
}

TEST(OnlineInterpretation, IdsOutliveAnotherLookAtTheSame)
{
  OnlineInterpretation online(models(), quick());
  const SurfletSet all = thingAt(0, 0);
  SurfletSet most, rest;
  for (std::size_t i = 0; i < all.size(); ++i)
    (i % 4 == 0 ? rest : most).push_back(all[i]);
  for (float& z : rest.z) // moves the means
    z += 0.006F;
  online.addScan(most);
  ASSERT_NE(find(online, "bottle"), nullptr);
  const auto id = find(online, "bottle")->id;
  const auto scan = online.addScan(rest);
  EXPECT_GT(scan.changed_cells, 0U);
  ASSERT_EQ(online.detections().size(), 1U);
  EXPECT_EQ(online.detections()[0].id, id);
  EXPECT_EQ(online.detections()[0].state, OnlineState::Updated);
}

TEST(OnlineInterpretation, TheSameScanAgainChangesNothing)
{
  OnlineInterpretation online(models(), quick());
  online.addScan(thingAt(0, 0));
  const auto again = online.addScan(thingAt(0, 0));
  EXPECT_EQ(again.changed_cells, 0U);
  EXPECT_EQ(again.interpreted_cells, 0U);
  EXPECT_EQ(online.detections().at(0).state, OnlineState::Kept);
}

TEST(OnlineInterpretation, EndsAsTheBatch)
{
  const SurfletSet a = thingAt(0, 0), b = thingAt(1, 0.4F);
  OnlineInterpretation online(models(), quick());
  online.addScan(a);
  online.addScan(b);
  const auto batch =
      interpretByExplanation(reduceToTwoSidedCells(together(a, b), kLeaf).cells, models());
  std::multiset<std::string> expected, found;
  for (const auto& d : batch.detections)
    expected.insert(d.label);
  for (const auto& d : online.detections())
    found.insert(d.label);
  EXPECT_EQ(found, expected);
  EXPECT_EQ(found, (std::multiset<std::string>{"bottle", "torus"}));
}

TEST(OnlineInterpretation, ThreadsDoNotMatter)
{
  OnlineInterpretation one(models(), quick(1)), three(models(), quick(3));
  for (auto* online : {&one, &three}) {
    online->addScan(thingAt(0, 0));
    online->addScan(thingAt(1, 0.4F));
  }
  ASSERT_EQ(one.detections().size(), three.detections().size());
  for (std::size_t k = 0; k < one.detections().size(); ++k) {
    EXPECT_EQ(one.detections()[k].cells, three.detections()[k].cells);
    EXPECT_EQ(one.detections()[k].fit, three.detections()[k].fit);
  }
}

TEST(OnlineInterpretation, ALookFromWhereAnAttractorSaysTellsMore)
{
  for (const double angle : {0.0, 1.0, 2.5, 4.0}) {
    const double x = std::cos(angle), y = std::sin(angle);
    const SurfletSet first = facing(thingAt(0, 0), x, y);
    OnlineInterpretation follows(models(), quick()), stays(models(), quick());
    follows.addScan(first);
    stays.addScan(first);
    ASSERT_EQ(follows.attractors().size(), 1U) << angle; // named or not
    const auto& from = follows.attractors()[0].view_from;
    EXPECT_LT(from[0] * x + from[1] * y, -0.9) << angle;

    follows.addScan(facing(thingAt(0, 0, 6), from[0], from[1]));
    stays.addScan(facing(thingAt(0, 0, 6), x, y));
    EXPECT_GT(coverageOfBottle(follows), coverageOfBottle(stays) + 0.25) << angle;
    EXPECT_TRUE(follows.attractors().empty()) << angle;
    ASSERT_EQ(follows.distractors().size(), 1U) << angle;
    EXPECT_EQ(follows.distractors()[0].id, find(follows, "bottle")->id);
    EXPECT_EQ(stays.attractors().size(), 1U) << angle;
  }
}

TEST(OnlineInterpretation, WhatNothingExplainsAttractsUntilItIsTakenAway)
{
  ModelDatabase only_torus;
  only_torus.add(models()[1]);
  OnlineInterpretation online(only_torus, quick());
  online.addScan(thingAt(0, 0));
  ASSERT_EQ(online.attractors().size(), 1U);
  EXPECT_EQ(online.attractors()[0].id, 0U);
  EXPECT_NEAR(online.attractors()[0].centre[0], 0, 0.01);
  online.addScan(thingAt(1, kFar));
  EXPECT_EQ(online.attractors().size(), 1U) << "far away, nothing changed";
  EXPECT_EQ(online.distractors().size(), 1U);
  online.addScan(wallSeenThrough(0), kSensor);
  EXPECT_TRUE(online.attractors().empty());
}

TEST(OnlineInterpretation, AScanThatThrowsOrIsCancelledNeverWas)
{
  enum class Does { Work, Throw, Cancel } does = Does::Work;
  OnlineParameters p = quick();
  p.explanation.steps.progress = [&](double done) {
    if (done > 0.3 && does == Does::Throw)
      throw std::runtime_error("no more");
    return does != Does::Cancel;
  };
  OnlineInterpretation online(models(), p), untroubled(models(), quick());
  const SurfletSet first = together(thingAt(0, 0), thingAt(1, 0.5F));
  const SurfletSet second = together(wallSeenThrough(0), thingAt(0, 0.25F));
  for (auto* o : {&online, &untroubled})
    o->addScan(first, kSensor);
  const std::string before = stateOf(online);
  does = Does::Throw;
  EXPECT_THROW(online.addScan(second, kSensor), std::runtime_error);
  EXPECT_EQ(stateOf(online), before);
  does = Does::Cancel;
  EXPECT_TRUE(online.addScan(second, kSensor).cancelled);
  EXPECT_EQ(stateOf(online), before);
  does = Does::Work;
  for (auto* o : {&online, &untroubled})
    EXPECT_GT(o->addScan(second, kSensor).vanished_cells, 0U);
  EXPECT_EQ(stateOf(online), stateOf(untroubled));
  for (auto* o : {&online, &untroubled})
    o->addScan(first, kSensor);
  EXPECT_EQ(stateOf(online), stateOf(untroubled));
}

TEST(OnlineInterpretation, ThinWallsKeepBothSides)
{
  SurfletSet wall;
  for (int i = 0; i < 100; ++i) {
    const float y = 0.001F + 0.00004F * static_cast<float>(i);
    wall.push_back({0.001F, y, 0.003F, 1, 0, 0});
    wall.push_back({0.002F, y, 0.003F, -1, 0, 0});
  }
  OnlineInterpretation online(models(), quick());
  EXPECT_EQ(online.addScan(wall).cells, 2U);
  EXPECT_FLOAT_EQ(online.cells().nx[0], 1);
  EXPECT_FLOAT_EQ(online.cells().nx[1], -1);
}

TEST(OnlineInterpretation, TheEmptySceneIsLeftOut)
{
  OnlineParameters p = quick();
  p.empty_scene = thingAt(1, kFar);
  OnlineInterpretation online(models(), p);
  const auto scan = online.addScan(together(thingAt(0, 0), thingAt(1, kFar)));
  EXPECT_GT(scan.background, 1000U);
  EXPECT_EQ(scan.background + scan.changed_cells, scan.cells);
  EXPECT_EQ(scan.interpreted_cells, scan.changed_cells);
  EXPECT_EQ(find(online, "torus"), nullptr);
  EXPECT_NE(find(online, "bottle"), nullptr);
}

TEST(OnlineInterpretation, TakesWhatIsEmptyNotFiniteOrAbsurd)
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  OnlineInterpretation online(models(), quick());
  EXPECT_EQ(online.addScan({}).cells, 0U);
  SurfletSet bad;
  bad.push_back({nan, 0, 0, 0, 0, 1});
  bad.push_back({0, 0, 0, 0, 0, 0});
  bad.push_back({1e30F, 0, 0, 0, 0, 1});
  const auto scan = online.addScan(bad);
  EXPECT_EQ(scan.rejected, 3U);
  EXPECT_EQ(scan.cells, 0U);
  EXPECT_TRUE(online.detections().empty());
}

TEST(OnlineInterpretation, RefusesWrongParameters)
{
  OnlineParameters p = quick();
  p.leaf = 0;
  EXPECT_THROW(OnlineInterpretation(models(), p), std::invalid_argument);
  p = quick();
  p.explanation.min_fit = 2;
  EXPECT_THROW(OnlineInterpretation(models(), p), std::invalid_argument);
  p = quick();
  p.stale = -1;
  EXPECT_THROW(OnlineInterpretation(models(), p), std::invalid_argument);
  p = quick();
  p.behind = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(OnlineInterpretation(models(), p), std::invalid_argument);
  p = quick();
  p.rays = 0;
  EXPECT_THROW(OnlineInterpretation(models(), p), std::invalid_argument);
  EXPECT_THROW(OnlineInterpretation(ModelDatabase(), quick()), DatabaseError);
  OnlineInterpretation online(models(), quick());
  EXPECT_THROW(online.addScan({}, {0, std::numeric_limits<double>::infinity(), 0}),
               std::invalid_argument);
}
