// Online interpretation: what stays, what changes and what is asked for while a scene grows.
#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/recognition/online_interpretation.h"
#include "pcl_surflet/recognition/scene_training.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

using namespace pcl_surflet;

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
  SurfletSet set = things()[thing].sample(20000, seed);
  for (float& v : set.x)
    v += x;
  return set;
}

SurfletSet
together(SurfletSet a, const SurfletSet& b)
{
  for (std::size_t i = 0; i < b.size(); ++i)
    a.push_back(b[i]);
  return a;
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
    (i % 10 == 0 ? rest : most).push_back(all[i]);
  for (float& z : rest.z) // moves the means
    z += 0.003F;
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

TEST(OnlineInterpretation, AHalfSeenObjectAttractsToItsOtherSide)
{
  const SurfletSet whole = thingAt(0, 0);
  SurfletSet half; // as seen from +x
  for (std::size_t i = 0; i < whole.size(); ++i)
    if (whole.nx[i] > 0.2F)
      half.push_back(whole[i]);
  OnlineInterpretation online(models(), quick());
  online.addScan(half);
  ASSERT_EQ(online.attractors().size(), 1U); // named or not
  EXPECT_LT(online.attractors()[0].view_from[0], -0.9);
  online.addScan(whole);
  EXPECT_TRUE(online.attractors().empty());
  EXPECT_EQ(online.distractors().size(), 1U);
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
  EXPECT_EQ(scan.background, 20000U);
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
  EXPECT_THROW(OnlineInterpretation(ModelDatabase(), quick()), DatabaseError);
}

} // namespace
