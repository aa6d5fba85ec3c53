// The parts of interpretation by explanation, on hand-made cases.
#include "explanation_pieces.h"
#include "scene_pieces.h"

#include "recognition/interpretation/explanation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

using namespace pcl_surflet;
using namespace pcl_surflet::interpretation;
using namespace pcl_surflet::test;

namespace {

/** \brief A scene with its models, as the parts need it. */
struct World {
  SurfletSet cells;
  ModelDatabase database;
  PairSource source;
  SceneModels models;
  SceneData scene;
  ExplanationParameters parameters = quick();
  bool cancelled = false;
  ProgressReport progress{parameters.steps.progress, cancelled};
  InterpretationDiagnostics diagnostics;
  Explaining work;

  World(const SurfletSet& set, ModelDatabase d, bool background = false)
      : cells(set), database(std::move(d)), source(cells),
        models(sceneModels(database, background, source.scale())), scene{cells, source, models},
        diagnostics(emptyDiagnostics(database)), work(scene, parameters, progress, diagnostics)
  {
  }

  /** \brief What settles of a model at a place. */
  Segment
  at(std::size_t model, const Centre& centre)
  {
    const double radius = work.radiusOf(model);
    drawSample(scene, work.open, centre, radius, parameters.settling_cells, work.memory[0]);
    return segment(scene, model, centre, radius, work.memory[0]);
  }
};

/** \brief Share of \p cells that come from item 0 of a scene whose cells nearer to x = 0 than to
 * the other are its own. */
std::size_t
left(const SurfletSet& cells, const Indices& some)
{
  return static_cast<std::size_t>(
      std::count_if(some.begin(), some.end(), [&](std::uint32_t i) { return cells.x[i] < 0; }));
}

/** \brief Support of a pair, as loops over pairs look it up. */
float
supportOfPair(const SceneModel& m, std::uint32_t column, float delta)
{
  return m.support[m.supportIndex(column, delta)];
}

} // namespace

TEST(Support, ChanceIsADistributionOfAngles)
{
  const auto chance = chanceAngles({5, 5, 5, 5});
  ASSERT_EQ(chance.size(), 125u);
  EXPECT_NEAR(std::accumulate(chance.begin(), chance.end(), 0.0), 1, 1e-4);
  // A mirror turns alpha into its negative.
  const auto share = [&](std::size_t alpha) {
    double sum = 0;
    for (std::size_t k = alpha; k < chance.size(); k += 5)
      sum += chance[k];
    return sum;
  };
  EXPECT_NEAR(share(0), share(4), 0.02);
  EXPECT_NEAR(share(1), share(3), 0.02);
}

TEST(Support, ATableIsTheLimitedLogarithmOfTheRatio)
{
  const auto database = models(1);
  const auto chance = chanceAngles(database.resolution());
  const SceneModel m = sceneModel(database[0], 1e-5, 2.0, chance);
  const double delta_max = database[0].delta_max;
  for (const std::uint32_t angle : {0u, 100u, 342u})
    for (const int k : {0, 3, 6}) {
      const double h = m.h[static_cast<std::size_t>(k) * 343 + angle];
      const float delta = static_cast<float>((k + 0.5) / 7 * delta_max * 2.0);
      const double expected =
          std::clamp(std::log(std::max(h, 1e-5) / (chance[angle] * (2 * k + 1) / 49.0)), -3.0, 3.0);
      EXPECT_NEAR(supportOfPair(m, angle, delta), expected, 0.02) << angle << " " << k;
    }
  EXPECT_EQ(supportOfPair(m, 5, static_cast<float>(delta_max * 2.01)), -kMostSupport) << "too long";
  EXPECT_EQ(supportOfPair(m, 343, 0.01f), 0) << "no feature";
  EXPECT_EQ(supportOfPair(m, 343, 1e30f), 0) << "no feature";
}

TEST(Support, SamplesAreEvenAndTheirPairsInOrder)
{
  const auto scene = generateScene({things()[0]}, {}, options());
  World w(reduced(scene.surflets), models(1));
  const auto& c = scene.items[0].centroid;
  auto& memory = w.work.memory[0];
  drawSample(w.scene, w.work.open, c, 10, 50, memory);
  ASSERT_EQ(memory.sample.cells.size(), 50u);
  EXPECT_EQ(memory.sample.population, w.cells.size());
  const auto& cells = memory.sample.cells;
  EXPECT_EQ(std::set<std::uint32_t>(cells.begin(), cells.end()).size(), 50u) << "each once";
  ASSERT_EQ(memory.sample.delta.size(), 50u * 49 / 2);
  const auto a = cells[3], b = cells[1]; // pair number 3 * 2 / 2 + 1
  const double d = std::hypot(w.cells.x[a] - w.cells.x[b], w.cells.y[a] - w.cells.y[b],
                              w.cells.z[a] - w.cells.z[b]);
  EXPECT_NEAR(memory.sample.delta[4], d * w.source.scale(), 1e-5);
  drawSample(w.scene, w.work.open, {9, 9, 9}, 0.1, 50, memory);
  EXPECT_TRUE(memory.sample.cells.empty());
  EXPECT_TRUE(w.at(0, {9, 9, 9}).core.empty());
}

TEST(Support, WhatSupportsEachOtherIsOneOfTwoTouchingThings)
{
  auto torus = things()[2].sample(30000, 4), die = things()[3].sample(15000, 5);
  torus = shifted(torus, -*std::max_element(torus.x.begin(), torus.x.end()));
  die = shifted(die, -*std::min_element(die.x.begin(), die.x.end()));
  World w(reduced(together(torus, die)), models());
  const auto middle = centroidOf(torus, [&] {
    Indices all(torus.size());
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }());
  const Segment s = w.at(2, {middle[0] + 0.03, middle[1], middle[2]});
  ASSERT_GT(s.core.size(), 20u);
  EXPECT_GT(double(left(w.cells, s.core)), 0.95 * double(s.core.size()));
  EXPECT_GT(s.rough_fit, 0.4);
}

TEST(Support, TheSupportOfACellIsTheMeanOverItsProbes)
{
  const auto scene = generateScene({things()[0]}, {}, options());
  World w(reduced(scene.surflets), models(1));
  std::vector<CellSupport> out;
  auto& memory = w.work.memory[0];
  const Indices core = {5, 100, 400, 700};
  supportOf(w.scene, w.models.all[0], {42}, core, 4, memory, out);
  double sum = 0;
  for (const auto i : core) {
    PairFeatures f;
    featuresOfPairs(w.source, w.models.resolution, {42}, {i}, f);
    sum += supportOfPair(w.models.all[0], std::min(f.angular_bin[0], 343u),
                         std::sqrt(f.delta_squared[0]));
  }
  ASSERT_EQ(out.size(), sum > 0 ? 1u : 0u);
  if (!out.empty()) {
    EXPECT_NEAR(out[0].support, sum / 4, 1e-4);
  }
}

TEST(Explanation, CompletesTheObjectNearby)
{
  const auto scene = generateScene({things()[0]}, {}, options());
  World w(reduced(scene.surflets), models());
  const auto& c = scene.items[0].centroid;
  const auto e = lookClosely(w.work, w.at(0, {c[0] + 0.03, c[1], c[2] - 0.05}), w.work.memory[0]);
  EXPECT_GT(double(e.cells.size()), 0.9 * double(w.cells.size())) << "nothing else is there";
  const auto judged = lookClosely(w.work, {w.at(0, c)});
  ASSERT_EQ(judged.size(), 1u);
  EXPECT_GT(judged[0].fit, 0.85);
}

TEST(Explanation, CellsThatAreTakenDoNotCount)
{
  const auto scene = generateScene({things()[0]}, {}, options());
  World w(reduced(scene.surflets), models());
  const Segment before = w.at(0, scene.items[0].centroid);
  w.work.openExcept(std::vector<char>(w.cells.size(), 1));
  EXPECT_TRUE(lookClosely(w.work, before, w.work.memory[0]).cells.empty());
}

TEST(Explanation, AnotherModelFitsWorse)
{
  const auto scene = generateScene({things()[0]}, {}, options());
  World w(reduced(scene.surflets), models());
  for (const std::size_t model : {1, 2})
    for (const auto& e : lookClosely(w.work, {w.at(model, scene.items[0].centroid)}))
      EXPECT_LT(e.fit, w.parameters.min_fit) << model;
}

TEST(Explanation, OneOfTheSameIsKept)
{
  const auto scene = generateScene({things()[0]}, {}, options());
  World w(reduced(scene.surflets), models());
  const Segment s = w.at(0, scene.items[0].centroid);
  EXPECT_EQ(lookClosely(w.work, {s, s, s}).size(), 1u);
}

TEST(Explanation, TheScanComesToEveryObject)
{
  const auto scene = generateScene({things()[0], things()[2]}, {}, options());
  World w(reduced(scene.surflets), models());
  const auto found = scan(w.work);
  for (const std::size_t k : {0, 1}) {
    const auto& c = scene.items[k].centroid;
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](const Segment& s) {
      return s.model == (k == 0 ? 0u : 2u) &&
             std::hypot(s.centre[0] - c[0], s.centre[1] - c[1], s.centre[2] - c[2]) < 0.02;
    })) << k;
  }
}

TEST(TrainForScenes, AModelIsOfWhatSupportsItself)
{
  HistogramModelTrainer trainer;
  trainer.setResolution({7, 7, 7, 7});
  const auto surflets = things()[2].sample(20000, 99);
  const auto m = trainForScenes(trainer, "torus", surflets, kLeaf);
  EXPECT_EQ(m.problem(), "");
  EXPECT_EQ(m.members.size(), 1u);
  // All of a torus supports itself: the area is that of the torus within the scatter of cells.
  EXPECT_NEAR(m.surface_area, things()[2].area, 0.15 * things()[2].area);
  const auto again = trainForScenes(trainer, "torus", surflets, kLeaf, 1, 1);
  EXPECT_EQ(again.members[0].histogram, m.members[0].histogram) << "threads do not matter";
  const auto other = trainForScenes(trainer, "torus", surflets, kLeaf, 2);
  EXPECT_NE(other.members[0].histogram, m.members[0].histogram) << "other orientations";
}

TEST(TrainForScenes, TooLargeCellsAreRefused)
{
  HistogramModelTrainer trainer;
  const auto surflets = things()[0].sample(2000, 99);
  EXPECT_THROW(trainForScenes(trainer, "bottle", surflets, 0.1), TrainingError);
  EXPECT_THROW(trainForScenes(trainer, "bottle", surflets, 0), std::invalid_argument);
  EXPECT_THROW(trainForScenes(trainer, "bottle", {}, 0.01), TrainingError);
}

TEST(BackgroundVote, TellsTheFloorFromWhatStandsOnIt)
{
  const auto scene = generateScene({things()[0], things()[2]}, {}, options(Background::Plane));
  World w(reduced(scene.surflets), models(3, true), true);
  const auto background = voteForBackground(w.scene, w.work.open, quick());
  std::size_t floor = 0, floor_found = 0, objects = 0, objects_lost = 0;
  for (std::size_t i = 0; i < w.cells.size(); ++i) {
    const bool is_floor = std::abs(w.cells.z[i]) < 1e-5;
    (is_floor ? floor : objects) += 1;
    (is_floor ? floor_found : objects_lost) += background[i] ? 1 : 0;
  }
  EXPECT_GT(double(floor_found), 0.9 * double(floor));
  EXPECT_LT(double(objects_lost), 0.05 * double(objects));
}

TEST(BackgroundVote, LearnsTheFloorFromLongPairs)
{
  auto o = options(Background::Plane);
  o.size = 1.2;
  const auto scene = generateScene({things()[0], things()[2]}, {}, o);
  World w(reduced(scene.surflets), models(3));
  const auto background = voteForUniformBackground(w.scene, w.work.open, quick());
  ASSERT_EQ(background.size(), w.cells.size());
  std::size_t floor = 0, floor_found = 0, objects = 0, objects_lost = 0;
  for (std::size_t i = 0; i < w.cells.size(); ++i) {
    const bool is_floor = std::abs(w.cells.z[i]) < 1e-5;
    (is_floor ? floor : objects) += 1;
    (is_floor ? floor_found : objects_lost) += background[i] ? 1 : 0;
  }
  EXPECT_GT(double(floor_found), 0.9 * double(floor));
  EXPECT_LT(double(objects_lost), 0.1 * double(objects));
  World lone(reduced(generateScene({things()[0]}, {}, options()).surflets), models(3));
  EXPECT_TRUE(voteForUniformBackground(lone.scene, lone.work.open, quick()).empty())
      << "no pair is longer than the bottle";
}
