// The seven steps together.
#include "scene_pieces.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/recognition/scene_interpretation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

using namespace pcl_surflet;
using pcl_surflet::test::scaled;

namespace {

constexpr double kLeaf = 0.006;

const std::vector<SceneItem>&
things()
{
  static const std::vector<SceneItem> all = {sceneItem("bottle", *shapeByName("bottle")),
                                             sceneItem("glass", *shapeByName("wine_glass"))};
  return all;
}

ModelDatabase
models(std::size_t count = 2, bool background = false)
{
  HistogramModelTrainer trainer;
  trainer.setNumberOfPairs(1000000);
  ModelDatabase database;
  for (std::size_t i = 0; i < count; ++i)
    database.add(trainer.train(things()[i].label, things()[i].sample(20000, 99)));
  trainer.setRole(ModelRole::Background);
  if (background)
    database.add(trainer.train("floor", sampleShape(Shape::plane(0.14, 0.14), 5000, 5)));
  return database;
}

Scene
sceneOf(Background background, std::uint64_t seed = 3)
{
  SceneOptions options;
  options.background = background;
  options.size = 0.7;
  options.density = 200000;
  options.distance_factor = 2;
  options.seed = seed;
  return generateScene(things(), {}, options);
}

SurfletSet
reduced(const SurfletSet& set)
{
  return reduceToCells(set, kLeaf).cells;
}

double
offset(const Detection& d, const PlacedItem& item)
{
  return std::hypot(d.centroid[0] - item.centroid[0], d.centroid[1] - item.centroid[1],
                    d.centroid[2] - item.centroid[2]);
}

/** \brief Is there a detection of the item's name at its place? The steps as written may find more
 * than that. */
bool
isFound(const PlacedItem& item, const std::vector<Detection>& detections)
{
  return std::any_of(detections.begin(), detections.end(), [&](const Detection& d) {
    return d.label == item.label && offset(d, item) < 0.05;
  });
}

bool
sameDetections(const SceneInterpretation& a, const SceneInterpretation& b)
{
  return std::equal(a.detections.begin(), a.detections.end(), b.detections.begin(),
                    b.detections.end(), [](const Detection& x, const Detection& y) {
                      return x.label == y.label && x.cells == y.cells && x.score == y.score;
                    });
}

} // namespace

TEST(Dissertation, FindsTwoThingsApart)
{
  const auto scene = sceneOf(Background::None);
  const auto cells = reduced(scene.surflets);
  const auto found = interpretByDissertation(cells, models());
  for (const auto& item : scene.items)
    EXPECT_TRUE(isFound(item, found.detections)) << item.label;
  for (const auto& d : found.detections) {
    EXPECT_GE(d.score, 0);
    EXPECT_EQ(d.label, found.diagnostics.models[d.model].label);
    EXPECT_TRUE(std::is_sorted(d.cells.begin(), d.cells.end()));
  }
  EXPECT_EQ(found.diagnostics.models[0].detections + found.diagnostics.models[1].detections,
            found.detections.size());
}

TEST(Dissertation, FindsTwoInstancesOfOneObject)
{
  SceneOptions options;
  options.background = Background::None;
  options.density = 200000;
  options.distance_factor = 4;
  const auto scene = generateScene({things()[0], things()[0]}, {}, options);
  const auto found = interpretByDissertation(reduced(scene.surflets), models());
  for (const auto& item : scene.items)
    EXPECT_TRUE(isFound(item, found.detections)) << item.centroid[0];
}

TEST(Dissertation, ModelledBackgroundIsIgnored)
{
  const auto scene = sceneOf(Background::Plane);
  DissertationParameters p;
  p.background = BackgroundTreatment::Model;
  const auto cells = reduced(scene.surflets);
  const auto found = interpretByDissertation(cells, models(2, true), p);
  EXPECT_GT(found.diagnostics.background, 0u);
  std::size_t on_table = 0, all = 0;
  for (const auto& d : found.detections)
    for (const auto i : d.cells) {
      on_table += std::abs(cells.z[i]) < 1e-6 && cells.nz[i] > 0.99 ? 1 : 0;
      ++all;
    }
  EXPECT_FALSE(found.detections.empty());
  EXPECT_LT(double(on_table), 0.05 * double(all));
}

TEST(Dissertation, ExclusionLeavesWhatIsNotInTheEmptyScene)
{
  SceneOptions options;
  options.size = 0.7;
  options.density = 200000;
  options.seed = 3;
  const auto cells = reduced(sceneOf(Background::Plane).surflets);
  const auto away = cellsAwayFrom(cells, reduced(emptyBackground(options)), kLeaf);
  EXPECT_LT(away.size(), cells.size());
  for (const auto i :
       away) // what looks up is above the table, what stands on it may look elsewhere
    EXPECT_TRUE(cells.z[i] > 0.003 || cells.nz[i] < 0.75) << cells.z[i] << " " << cells.nz[i];
  const auto found = interpretByDissertation(cells.subset(away), models());
  EXPECT_FALSE(found.detections.empty());
  EXPECT_EQ(cellsAwayFrom(cells, {}, kLeaf).size(), cells.size());
  EXPECT_TRUE(cellsAwayFrom({}, cells, kLeaf).empty());
  EXPECT_THROW(cellsAwayFrom(cells, cells, 0), std::invalid_argument);
}

TEST(Dissertation, CellsAwayFromAnEmptySceneAreWhatOneByOneSays)
{
  const auto cloud = [](std::uint64_t seed) {
    CounterRandom random(seed);
    SurfletSet set;
    for (int i = 0; i < 1500; ++i) {
      const auto at = [&] { return static_cast<float>(random.uniform(-1, 1)); };
      set.appendChecked({at(), at(), at(), at(), at(), at()});
    }
    return set;
  };
  const SurfletSet cells = cloud(1), empty = cloud(2);
  constexpr double kDistance = 0.2;
  std::vector<std::uint32_t> expected;
  std::size_t near = 0;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    bool is_near = false, is_background = false;
    for (std::size_t j = 0; j < empty.size(); ++j)
      if (std::hypot(cells.x[i] - empty.x[j], cells.y[i] - empty.y[j], cells.z[i] - empty.z[j]) <=
          kDistance) {
        is_near = true;
        is_background = is_background || cells.nx[i] * empty.nx[j] + cells.ny[i] * empty.ny[j] +
                                                 cells.nz[i] * empty.nz[j] >
                                             0.7F;
      }
    near += is_near;
    if (!is_background)
      expected.push_back(i);
  }
  EXPECT_GT(near, cells.size() - expected.size() + 100) << "normals decide";
  for (const unsigned threads : {1u, 2u, 5u})
    EXPECT_EQ(cellsAwayFrom(cells, empty, kDistance, threads), expected) << threads;
}

TEST(Dissertation, ADatabaseOfOneModelHasNoRival)
{
  const auto scene = sceneOf(Background::None);
  const auto found = interpretByDissertation(reduced(scene.surflets), models(1));
  ASSERT_GE(found.detections.size(), 1u);
  EXPECT_TRUE(std::any_of(found.detections.begin(), found.detections.end(),
                          [&](const auto& d) { return offset(d, scene.items[0]) < 0.05; }));
}

TEST(Dissertation, NothingIsFoundInNothing)
{
  for (std::size_t n : {0, 1, 2}) {
    SurfletSet few;
    for (std::size_t i = 0; i < n; ++i)
      few.push_back({0.01f * float(i), 0, 0, 0, 0, 1});
    EXPECT_TRUE(interpretByDissertation(few, models()).detections.empty());
  }
}

TEST(Dissertation, MuchLargerScenesGiveNothingAndSayWhy)
{
  const auto cells = reduced(sceneOf(Background::None).surflets);
  DissertationParameters p;
  p.pairs = 20000;
  const auto huge = interpretByDissertation(scaled(cells, 1000), models(), p);
  EXPECT_TRUE(huge.detections.empty());
  EXPECT_GT(double(huge.diagnostics.too_long), 0.99 * double(huge.diagnostics.drawn));
}

TEST(Dissertation, ThreadsDoNotMatter)
{
  const auto cells = reduced(sceneOf(Background::Plane).surflets);
  DissertationParameters p;
  p.threads = 1;
  const auto one = interpretByDissertation(cells, models(), p);
  p.threads = 3;
  const auto three = interpretByDissertation(cells, models(), p);
  ASSERT_FALSE(one.detections.empty());
  EXPECT_TRUE(sameDetections(one, three));
  p.seed = 2;
  EXPECT_FALSE(sameDetections(one, interpretByDissertation(cells, models(), p)));
}

TEST(Dissertation, ExtensionsAddPointsAndThreadsDoNotMatter)
{
  const auto cells = reduced(sceneOf(Background::None).surflets);
  const auto cellsFound = [&](bool floating, bool repeated, unsigned threads = 1) {
    DissertationParameters p;
    p.threads = threads;
    p.floating.on = floating;
    p.repetition.on = repeated;
    return interpretByDissertation(cells, models(), p);
  };
  const auto count = [](const SceneInterpretation& found) {
    std::size_t n = 0;
    for (const auto& d : found.detections)
      n += d.cells.size();
    return n;
  };
  const auto plain = cellsFound(false, false), repeated = cellsFound(false, true);
  const auto both = cellsFound(true, true);
  ASSERT_EQ(repeated.detections.size(), plain.detections.size()) << "names stay as they are";
  for (std::size_t i = 0; i < plain.detections.size(); ++i)
    EXPECT_EQ(repeated.detections[i].label, plain.detections[i].label);
  std::size_t regained = 0;
  for (const auto& m : repeated.diagnostics.models)
    regained += m.regained;
  EXPECT_GT(regained, 0u);
  EXPECT_EQ(count(repeated), count(plain) + regained);
  EXPECT_FALSE(sameDetections(both, repeated));
  EXPECT_TRUE(sameDetections(both, cellsFound(true, true, 3)));
}

TEST(Dissertation, MisuseIsRefused)
{
  const auto cells = reduced(sceneOf(Background::None).surflets);
  EXPECT_THROW(interpretByDissertation(cells, {}), DatabaseError);
  DissertationParameters p;
  p.background = BackgroundTreatment::Model;
  EXPECT_THROW(interpretByDissertation(cells, models(), p), DatabaseError);
  const auto refused = [&](auto change) {
    DissertationParameters bad;
    change(bad);
    EXPECT_THROW(interpretByDissertation(cells, models(), bad), std::invalid_argument);
  };
  refused([](auto& b) { b.pairs = 0; });
  refused([](auto& b) { b.pairs = ~std::uint64_t{0}; });
  refused([](auto& b) { b.draws_per_pair = 0; });
  refused([](auto& b) { b.lambda_h = NAN; });
  refused([](auto& b) { b.seeds = 0; });
  refused([](auto& b) { b.max_regroupings = 0; });
  refused([](auto& b) { b.lambda_o = 1; });
  refused([](auto& b) { b.check_regroupings = 0; });
  refused([](auto& b) { b.lambda_c = -0.1; });
  refused([](auto& b) { b.floating.steps = 0; });
  refused([](auto& b) { b.floating.steepness = NAN; });
  refused([](auto& b) { b.repetition.pairs_per_surflet = 0; });
}
