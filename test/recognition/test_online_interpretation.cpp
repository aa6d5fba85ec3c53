// Online interpretation: what stays, what changes and what is asked for while a scene grows.
#include "scene_pieces.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/recognition/online_interpretation.h"
#include "pcl_surflet/recognition/scene_training.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

namespace {

constexpr double kLeaf = 0.006;
constexpr float kFar = 2; ///< objects so far apart do not share a region

const std::vector<SceneItem>&
things()
{
  static const std::vector<SceneItem> all = {sceneItem("bottle", *shapeByName("bottle")),
                                             sceneItem("torus", *shapeByName("torus"))};
  return all;
}

const ModelDatabase&
models()
{
  static const ModelDatabase database = [] {
    HistogramModelTrainer trainer;
    trainer.setResolution({7, 7, 7, 7});
    trainer.setNumberOfPairs(1000000);
    ModelDatabase d;
    for (const auto& thing : things())
      d.add(trainForScenes(trainer, thing.label, thing.sample(20000, 99), kLeaf));
    return d;
  }();
  return database;
}

SurfletSet
thingAt(std::size_t thing, float x, std::uint64_t seed = 5)
{
  return shifted(things()[thing].sample(20000, seed), x);
}

constexpr std::array<double, 3> kSensor{0, -2, 0};

/** \brief Ends of rays on a wall at y = 1, from kSensor past (\p x, 0). They have no normals, so
 * that no cells come from them. */
SurfletSet
wallSeenThrough(float x)
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  SurfletSet wall;
  for (int i = -60; i <= 60; ++i)
    for (int k = -120; k <= 120; ++k)
      wall.push_back({1.5F * x + 0.005F * static_cast<float>(i), 1, 0.005F * static_cast<float>(k),
                      nan, nan, nan});
  return wall;
}

OnlineParameters
quick(unsigned threads = 1)
{
  OnlineParameters p;
  p.leaf = kLeaf;
  p.explanation.steps.threads = threads;
  return p;
}

const OnlineDetection*
find(const OnlineInterpretation& online, const std::string& label)
{
  for (const auto& d : online.detections())
    if (d.label == label && d.state != OnlineState::Vanished)
      return &d;
  return nullptr;
}

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

/** \brief Coverage of the bottle, 0 if it is not named. */
double
coverageOfBottle(const OnlineInterpretation& online)
{
  const auto* d = find(online, "bottle");
  return d == nullptr ? 0 : d->coverage;
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

} // namespace
