// Interpretation by explanation: its parts on hand-made cases, and as a whole.
#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "recognition/interpretation/explanation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

using namespace pcl_surflet;
using namespace pcl_surflet::interpretation;

namespace {

constexpr double kLeaf = 0.006;

const std::vector<SceneItem>&
things()
{
  static const std::vector<SceneItem> all = {
      sceneItem("bottle", *shapeByName("bottle")), sceneItem("glass", *shapeByName("wine_glass")),
      sceneItem("torus", *shapeByName("torus")), sceneItem("die", *shapeByName("cube"))};
  return all;
}

/** \brief Bottle, glass and torus, or only the first \p count of them; the die is unknown. */
ModelDatabase
models(std::size_t count = 3, bool background = false)
{
  HistogramModelTrainer trainer;
  trainer.setResolution({7, 7, 7, 7});
  trainer.setNumberOfPairs(2000000);
  ModelDatabase database;
  for (std::size_t i = 0; i < count; ++i)
    database.add(trainer.train(things()[i].label, things()[i].sample(20000, 99)));
  trainer.setRole(ModelRole::Background);
  if (background)
    database.add(trainer.train("floor", sampleShape(Shape::plane(0.2, 0.2), 5000, 5)));
  return database;
}

SceneOptions
options(Background background = Background::None)
{
  SceneOptions o;
  o.background = background;
  o.size = 0.9;
  o.density = 200000;
  o.seed = 3;
  return o;
}

SurfletSet
reduced(const SurfletSet& set)
{
  return reduceToCells(set, kLeaf).cells;
}

SurfletSet
scaled(SurfletSet set, float factor)
{
  for (auto* axis : {&set.x, &set.y, &set.z})
    for (float& v : *axis)
      v *= factor;
  return set;
}

ExplanationParameters
quick()
{
  ExplanationParameters p;
  p.steps.pairs = 60000;
  p.steps.seeds = 40;
  return p;
}

bool
isFound(const PlacedItem& item, const std::vector<Detection>& detections)
{
  return std::any_of(detections.begin(), detections.end(), [&](const Detection& d) {
    return d.label == item.label &&
           std::hypot(d.centroid[0] - item.centroid[0], d.centroid[1] - item.centroid[1],
                      d.centroid[2] - item.centroid[2]) < 0.02;
  });
}

/** \brief A scene with its models, as the parts need it. */
struct World {
  SurfletSet cells;
  ModelDatabase database;
  PairSource source;
  SceneModels models;
  SceneData scene;
  OpenCells open;

  World(const SurfletSet& set, ModelDatabase d, bool background = false)
      : cells(set), database(std::move(d)), source(cells),
        models(sceneModels(database, background, source.scale())), scene{cells, source, models}
  {
    open.octree.build({cells.x.data(), cells.y.data(), cells.z.data(), 1, cells.size()});
    open.taken.assign(cells.size(), 0);
  }
};

} // namespace

TEST(Explanation, SettlesOnTheObjectNearby)
{
  const auto scene = generateScene({things()[0]}, {}, options());
  World w(reduced(scene.surflets), models());
  const auto& c = scene.items[0].centroid;
  auto e = settle(w.scene, w.open, 0, {c[0] + 0.03, c[1], c[2] - 0.05}, 1, quick());
  ASSERT_FALSE(e.cells.empty());
  EXPECT_LE(e.cells.size(), quick().settling_cells);
  confirm(w.scene, w.open, 1, quick(), e);
  EXPECT_GT(double(e.cells.size()), 0.99 * double(w.cells.size())) << "nothing else is there";
  EXPECT_GT(e.fit, 0.8);
  EXPECT_GT(e.ratio, 0.2);
}

TEST(Explanation, CellsThatAreTakenDoNotCount)
{
  const auto scene = generateScene({things()[0]}, {}, options());
  World w(reduced(scene.surflets), models());
  w.open.taken.assign(w.cells.size(), 1);
  EXPECT_TRUE(settle(w.scene, w.open, 0, scene.items[0].centroid, 1, quick()).cells.empty());
}

TEST(Explanation, AnotherModelFitsWorse)
{
  const auto scene = generateScene({things()[0]}, {}, options());
  World w(reduced(scene.surflets), models());
  auto p = quick();
  for (const std::size_t model : {1, 2}) {
    auto e = settle(w.scene, w.open, model, scene.items[0].centroid, 1, p);
    if (e.cells.empty())
      continue;
    confirm(w.scene, w.open, 1, p, e);
    EXPECT_LT(e.fit, p.min_fit) << model;
  }
}

TEST(BackgroundVote, TellsTheFloorFromWhatStandsOnIt)
{
  const auto scene = generateScene({things()[0], things()[2]}, {}, options(Background::Plane));
  World w(reduced(scene.surflets), models(3, true), true);
  const auto background = voteForBackground(w.scene, w.open.octree, quick());
  std::size_t floor = 0, floor_found = 0, objects = 0, objects_lost = 0;
  for (std::size_t i = 0; i < w.cells.size(); ++i) {
    const bool is_floor = std::abs(w.cells.z[i]) < 1e-5;
    (is_floor ? floor : objects) += 1;
    (is_floor ? floor_found : objects_lost) += background[i] ? 1 : 0;
  }
  EXPECT_GT(double(floor_found), 0.9 * double(floor));
  EXPECT_LT(double(objects_lost), 0.05 * double(objects));
}

TEST(InterpretationByExplanation, FindsEveryThingOnce)
{
  const auto scene = generateScene({things()[0], things()[1], things()[2]}, {}, options());
  const auto found = interpretByExplanation(reduced(scene.surflets), models(), quick());
  EXPECT_EQ(found.detections.size(), 3u);
  std::vector<char> used(reduced(scene.surflets).size(), 0);
  for (const auto& d : found.detections) {
    EXPECT_GE(d.fit, quick().min_fit);
    for (const auto i : d.cells)
      EXPECT_FALSE(used[i]++) << "no cell belongs to two objects";
  }
  for (const auto& item : scene.items)
    EXPECT_TRUE(isFound(item, found.detections)) << item.label;
}

TEST(InterpretationByExplanation, FindsTwoInstancesOfOneObject)
{
  const auto scene = generateScene({things()[0], things()[0]}, {}, options());
  const auto found = interpretByExplanation(reduced(scene.surflets), models(), quick());
  EXPECT_EQ(found.detections.size(), 2u);
  EXPECT_EQ(found.detections.size(), 2u);
  for (const auto& item : scene.items)
    EXPECT_TRUE(isFound(item, found.detections));
}

TEST(InterpretationByExplanation, AnUnknownObjectStaysUnnamed)
{
  const auto scene = generateScene({things()[0]}, {things()[3]}, [] {
    auto o = options();
    o.clutter = 1;
    return o;
  }());
  const auto found = interpretByExplanation(reduced(scene.surflets), models(), quick());
  ASSERT_EQ(found.detections.size(), 1u);
  EXPECT_TRUE(isFound(scene.items[0], found.detections));
}

TEST(InterpretationByExplanation, ModelsTheBackground)
{
  auto p = quick();
  p.steps.background = BackgroundTreatment::Model;
  const auto o = options(Background::Plane);
  const auto scene = generateScene({things()[0], things()[2]}, {}, o);
  const auto found = interpretByExplanation(reduced(scene.surflets), models(3, true), p);
  EXPECT_EQ(found.detections.size(), 2u);
  for (const auto& item : scene.items)
    EXPECT_TRUE(isFound(item, found.detections)) << item.label;
  const auto empty = interpretByExplanation(reduced(emptyBackground(o)), models(3, true), p);
  EXPECT_TRUE(empty.detections.empty());
  EXPECT_THROW(interpretByExplanation({}, models(), p), DatabaseError);
}

TEST(InterpretationByExplanation, ADatabaseOfOneModelHasNoRival)
{
  const auto scene = generateScene({things()[0]}, {}, options());
  const auto found = interpretByExplanation(reduced(scene.surflets), models(1), quick());
  ASSERT_EQ(found.detections.size(), 1u);
  EXPECT_TRUE(isFound(scene.items[0], found.detections));
}

TEST(InterpretationByExplanation, NothingIsFoundInNothingOrAtAnotherMagnitude)
{
  EXPECT_TRUE(interpretByExplanation({}, models(), quick()).detections.empty());
  const auto scene = generateScene({things()[0], things()[2]}, {}, options());
  const auto cells = reduced(scene.surflets);
  for (const float factor : {0.001f, 1000.f})
    EXPECT_TRUE(interpretByExplanation(scaled(cells, factor), models(), quick()).detections.empty())
        << factor;
}

TEST(InterpretationByExplanation, ThreadsDoNotMatter)
{
  const auto scene = generateScene({things()[0], things()[1]}, {}, options());
  const auto cells = reduced(scene.surflets);
  auto p = quick();
  p.steps.threads = 1;
  const auto one = interpretByExplanation(cells, models(), p);
  p.steps.threads = 3;
  const auto three = interpretByExplanation(cells, models(), p);
  ASSERT_FALSE(one.detections.empty());
  ASSERT_EQ(one.detections.size(), three.detections.size());
  for (std::size_t i = 0; i < one.detections.size(); ++i) {
    EXPECT_EQ(one.detections[i].label, three.detections[i].label);
    EXPECT_EQ(one.detections[i].cells, three.detections[i].cells);
    EXPECT_EQ(one.detections[i].fit, three.detections[i].fit);
  }
}

TEST(InterpretationByExplanation, MisuseIsRefused)
{
  const auto refused = [](auto change) {
    ExplanationParameters bad;
    change(bad);
    EXPECT_THROW(interpretByExplanation({}, models(1), bad), std::invalid_argument);
  };
  refused([](auto& b) { b.steps.pairs = 0; });
  refused([](auto& b) { b.reach = 0.9; });
  refused([](auto& b) { b.rounds = 0; });
  refused([](auto& b) { b.settling_cells = 1; });
  refused([](auto& b) { b.recentrings = 0; });
  refused([](auto& b) { b.max_regroupings = 0; });
  refused([](auto& b) { b.probes = 0; });
  refused([](auto& b) { b.max_crosstalk = 2; });
  refused([](auto& b) { b.max_surprise = NAN; });
  refused([](auto& b) { b.peeled_share = 0; });
  refused([](auto& b) { b.features = 0; });
  refused([](auto& b) { b.min_ratio = NAN; });
  refused([](auto& b) { b.min_fit = -1; });
  refused([](auto& b) { b.vote_pairs = 0; });
  refused([](auto& b) { b.vote_share = 0; });
  refused([](auto& b) { b.vote_radius = 0; });
}
