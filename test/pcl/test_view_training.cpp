// Models with members for what a sensor sees.
#include "pcl_surflet/view_training.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/recognition/scene_interpretation.h"
#include "pcl_surflet/recognition/scene_training.h"
#include "pcl_surflet/scene_interpreter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

using namespace pcl_surflet;

namespace {

constexpr double kLeaf = 0.01;

HistogramModelTrainer
sevenIntervals()
{
  HistogramModelTrainer trainer;
  trainer.setResolution({7, 7, 7, 7});
  return trainer;
}

std::vector<SceneItem>
bottleAndGlass()
{
  return {sceneItem("bottle", *shapeByName("bottle")),
          sceneItem("glass", *shapeByName("wine_glass"))};
}

const HistogramModel&
modelOf(std::size_t k)
{
  static const std::vector<HistogramModel> models = [] {
    std::vector<HistogramModel> all;
    for (const auto& item : bottleAndGlass())
      all.push_back(trainForSensors(sevenIntervals(), item, sensingFor(item, kLeaf), kLeaf));
    return all;
  }();
  return models[k];
}

double
distance(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/** \brief Labels found in what one sensor sees of both things; \p members of their models are used.
 */
std::vector<std::string>
foundFromOneSide(std::size_t members)
{
  SceneOptions o;
  o.background = Background::None;
  o.density = 20000;
  const Scene scene = generateScene(bottleAndGlass(), {}, o);
  SceneSensing sensing;
  sensing.views.views = ViewSet::One;
  sensing.sensor.noise = 0.0005;
  const Scene seen =
      sensedScene(scene, senseViews(bodiesOf(scene, bottleAndGlass(), {}, o), sensing, o.seed));
  ModelDatabase database;
  for (std::size_t k = 0; k < 2; ++k) {
    HistogramModel m = modelOf(k);
    m.members.resize(std::min(members, m.members.size()));
    database.add(m);
  }
  ExplanationParameters p;
  p.leaf = kLeaf;
  p.steps.background = BackgroundTreatment::Exclude;
  const auto found =
      interpretByExplanation(reduceToTwoSidedCells(seen.surflets, kLeaf).cells, database, p);
  std::vector<std::string> labels;
  for (const auto& d : found.detections) {
    labels.push_back(d.label);
    EXPECT_EQ(d.member > 0, members > 1) << "a view of it answers, not the whole";
    const auto& model = database[d.model];
    const auto coverage = [&](double area) {
      return detail::coverageOf(d.cells.size(), area, kLeaf);
    };
    EXPECT_NEAR(coverage(model.areaOf(d.member)), 1, 0.3) << "all that one sensor can see";
    EXPECT_LT(coverage(model.surface_area), 0.7) << d.label;
    for (const auto& item : scene.items)
      if (item.label == d.label) {
        EXPECT_LT(distance(d.centre, item.centroid), item.r_mean / 2);
        EXPECT_LT(distance(d.centre, item.centroid), 0.8 * distance(d.centroid, item.centroid));
      }
  }
  return labels;
}

} // namespace

TEST(ViewTraining, AModelHasItsViews)
{
  const auto& bottle = modelOf(0);
  EXPECT_EQ(bottle.problem(), "");
  ASSERT_EQ(bottle.members.size(), 19u) << "whole, 12 views, 6 opposite pairs";
  EXPECT_EQ(bottle.members[0].condition, "complete, cells");
  EXPECT_EQ(bottle.members[1].condition, "seen from 0");
  EXPECT_EQ(bottle.members[2].condition, "seen from 0 and opposite");
  const auto& glass = modelOf(1);
  EXPECT_EQ(glass.members.size(), 37u) << "its foot may be taken for the table";
  EXPECT_EQ(glass.members[2].condition, "seen from 0, no foot");
  for (const auto& m : glass.members)
    EXPECT_NEAR(std::accumulate(m.histogram.begin(), m.histogram.end(), 0.0), 1, 1e-4);
}

TEST(ViewTraining, AViewKnowsTheAreaThatItShows)
{
  const auto& bottle = modelOf(0);
  EXPECT_EQ(bottle.members[0].area, bottle.surface_area);
  for (std::size_t k = 1; k < bottle.members.size(); ++k) {
    const auto& m = bottle.members[k];
    // A body of revolution: less than half from one side, and two sides have nothing in common.
    const bool is_pair = m.condition.find("opposite") != std::string::npos;
    EXPECT_GT(m.area, 0.3 * bottle.surface_area * (is_pair ? 2 : 1)) << m.condition;
    EXPECT_LT(m.area, 0.5 * bottle.surface_area * (is_pair ? 2 : 1)) << m.condition;
  }
}

TEST(ViewTraining, OneSideIsEnoughForModelsWithViewsOnly)
{
  EXPECT_EQ(foundFromOneSide(100), (std::vector<std::string>{"bottle", "glass"}));
  EXPECT_EQ(foundFromOneSide(1), std::vector<std::string>());
}

TEST(ViewTraining, TheUnitDoesNotMatter)
{
  const auto item = bottleAndGlass()[0];
  TriangleMesh large = item.mesh();
  for (auto& v : large.vertices)
    for (float& c : v)
      c *= 1024;
  const auto big = sceneItem("bottle", large);
  const auto a = sensingFor(item, kLeaf), b = sensingFor(big, 1024 * kLeaf);
  EXPECT_EQ(a.sensor.columns, b.sensor.columns);
  EXPECT_NEAR(b.views.distance, 1024 * a.views.distance, 1e-3);
  EXPECT_NEAR(b.normal_radius, 1024 * a.normal_radius, 1e-9);
  EXPECT_THROW(sensingFor(big, kLeaf), std::invalid_argument) << "metres taken for millimetres";
  EXPECT_THROW(sensingFor(item, 0), std::invalid_argument);
  EXPECT_THROW(sensingFor(item, NAN), std::invalid_argument);
  for (const float bad : {NAN, INFINITY}) {
    SceneItem broken = item;
    TriangleMesh mesh = item.mesh();
    mesh.vertices.back()[1] = bad;
    broken.mesh = [mesh] { return mesh; };
    EXPECT_THROW(sensingFor(broken, kLeaf), std::invalid_argument) << bad;
  }
}

TEST(ViewTraining, AViewNeedsAModelAndEnoughCells)
{
  HistogramModel none;
  EXPECT_THROW(addView(none, "view", SurfletSet(), kLeaf), std::invalid_argument);
  HistogramModel bottle = modelOf(0);
  SurfletSet few;
  few.push_back({0, 0, 0, 0, 0, 1});
  EXPECT_THROW(addView(bottle, "view", few, kLeaf), TrainingError);
  EXPECT_THROW(addView(bottle, "view", SurfletSet(), kLeaf), TrainingError);
  EXPECT_THROW(addView(bottle, "view", few, -1), std::invalid_argument);
  EXPECT_EQ(bottle.members.size(), 19u) << "nothing was added";
}
