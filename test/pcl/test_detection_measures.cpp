// What is told about a detection: confidence and coverage.
#include "two_object_scene.h"

#include "pcl_surflet/recognition/scene_training.h"

#include <cmath>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

TEST(SceneInterpreter, CellsConfidenceAndCoverageOfADetection)
{
  auto models = database();
  HistogramModel torus = models[1];
  torus.surface_area = areaOfShape(*shapeByName("torus"));
  models.replace(torus);
  auto interpreter = ready();
  interpreter.setDatabase(models);
  const auto found = interpreter.interpret();
  ASSERT_EQ(found.size(), 2u);
  for (const auto& d : found) {
    if (d.label == "bottle")
      EXPECT_TRUE(std::isnan(d.coverage)) << "its area is unknown";
    else
      EXPECT_NEAR(d.coverage, 1, 0.1);
    EXPECT_GT(d.confidence, 0);
    EXPECT_LE(d.confidence, 1);
    double x = 0;
    for (const auto c : d.cells)
      x += interpreter.getCells().x[c];
    EXPECT_NEAR(x / double(d.cells.size()), d.centroid[0], 1e-5);
  }
  EXPECT_EQ(interpreter.getCells().size(), interpreter.getDiagnostics().cells);
}

TEST(SceneInterpreter, CoverageIsOfTheAreaThatTrainingForScenesFinds)
{
  HistogramModelTrainer trainer;
  trainer.setResolution({7, 7, 7, 7});
  ModelDatabase models;
  for (const char* name : {"bottle", "torus"})
    models.add(trainForScenes(trainer, name, sampleShape(*shapeByName(name), 20000, 9), 0.008));
  auto interpreter = ready();
  interpreter.setDatabase(models);
  const auto found = interpreter.interpret();
  ASSERT_EQ(found.size(), 2u);
  for (const auto& d : found)
    EXPECT_NEAR(d.coverage, 1, 0.1) << d.label;
}

TEST(SceneInterpreter, CellsAreThoseThatAllModelsWereTrainedFor)
{
  HistogramModelTrainer trainer;
  HistogramModel small = trainForScenes(trainer, "small", sampleShape(Shape::sphere(0.1), 20000, 1),
                                        0.01),
                 large = trainForScenes(trainer, "large", sampleShape(Shape::sphere(0.2), 20000, 1),
                                        0.01);
  EXPECT_EQ(small.leaf, 0.01);
  const auto leafOf = [](const HistogramModel& a, const HistogramModel& b, double given) {
    ModelDatabase database;
    database.add(a);
    database.add(b);
    return detail::leafOf(given, database);
  };
  EXPECT_EQ(leafOf(small, large, 0), 0.01);
  EXPECT_EQ(leafOf(small, large, 0.02), 0.02) << "who asks for others gets them";
  small.leaf = 0;
  EXPECT_NEAR(leafOf(small, large, 0), 0.4 / 50, 1e-4) << "one was trained for none";
  small.leaf = 0.02;
  EXPECT_NEAR(leafOf(small, large, 0), 0.4 / 50, 1e-4) << "they differ";
}

TEST(SceneInterpreter, ConfidenceGrowsWithFitAndMargin)
{
  Detection d;
  d.margin = 0.1;
  d.fit = 0.83;
  d.cells.resize(300);
  const double usual = detail::confidenceOf(d, 30);
  EXPECT_NEAR(usual, 1 / (1 + std::exp(18.4 - 19.7 * 0.83 - 12.5 * 0.1)), 1e-12);
  Detection better = d, nearer = d, best = d, alone = d;
  better.margin = 0.2;
  nearer.fit = 0.9;
  for (const auto& e : {better, nearer})
    EXPECT_GT(detail::confidenceOf(e, 30), usual);
  best.fit = 0.95;
  best.margin = 0.3;
  EXPECT_GT(detail::confidenceOf(best, 30), 0.8);
  alone.margin = std::nan("");
  alone.fit = 0.95;
  EXPECT_GT(detail::confidenceOf(alone, 30), 0.9) << "a database of one model has no rivals";
  Detection twin = alone;
  twin.margin = 0;
  EXPECT_NEAR(detail::confidenceOf(twin, 30), 1 / (1 + std::exp(18.4 - 19.7 * 0.95)), 1e-12)
      << "another model fits as well, which is not to have none";
  alone.fit = 0.7;
  EXPECT_LT(detail::confidenceOf(alone, 30), 0.1);
  EXPECT_EQ(detail::confidenceOf(Detection(), 30), 0);
}

TEST(SceneInterpreter, ConfidenceWithoutFitGrowsWithScoreAndCells)
{
  Detection d;
  d.score = 0.1;
  d.cells.resize(300);
  const double usual = detail::confidenceOf(d, 30);
  EXPECT_NEAR(usual, 1 / (1 + std::exp(-1.0)) / 1.1, 1e-12);
  Detection better = d, larger = d;
  better.score = 0.2;
  larger.cells.resize(3000);
  for (const auto& e : {better, larger})
    EXPECT_GT(detail::confidenceOf(e, 30), usual);
  d.score = -1e9;
  EXPECT_EQ(detail::confidenceOf(d, 30), 0);
  d.score = 1e9;
  EXPECT_LE(detail::confidenceOf(d, 30), 1);
}
