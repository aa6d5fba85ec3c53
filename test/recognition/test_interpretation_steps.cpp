// Each of the seven steps alone, on hand-made cases.
#include "scene_pieces.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "recognition/interpretation/steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace pcl_surflet;
using namespace pcl_surflet::interpretation;
using namespace pcl_surflet::test;

namespace {

HistogramModel
modelOf(const std::string& label, const SurfletSet& set, ModelRole role = ModelRole::Object)
{
  HistogramModelTrainer trainer;
  trainer.setNumberOfPairs(2000000);
  trainer.setRole(role);
  return trainer.train(label, set);
}

const SurfletSet&
ball()
{
  static const SurfletSet set = sampleShape(Shape::sphere(0.05), 1000, 1);
  return set;
}

const SurfletSet&
rod()
{
  static const SurfletSet set = sampleShape(Shape::cylinder(0.01, 0.2), 1000, 2);
  return set;
}

/** \brief Model 0 is a ball, model 1 a rod. */
const ModelDatabase&
database()
{
  static const ModelDatabase models = [] {
    ModelDatabase d;
    d.add(modelOf("ball", ball()));
    d.add(modelOf("rod", rod()));
    return d;
  }();
  return models;
}

/** \brief A scene and what the steps need of it. */
struct World {
  SurfletSet cells;
  PairSource source;
  SceneModels models;
  SceneData scene;
  InterpretationDiagnostics diagnostics;

  explicit World(const SurfletSet& set, const ModelDatabase& d = database(),
                 bool background = false)
      : cells(set), source(cells),
        models(sceneModels(d, background, source.scale())), scene{cells, source, models}
  {
    diagnostics.models.resize(d.size());
  }
};

Cluster
clusterOf(Indices surflets, std::size_t seeds = 1)
{
  Cluster c;
  c.surflets = std::move(surflets);
  c.seeds = seeds;
  return c;
}

} // namespace

TEST(SceneModels, PairsBeyondTheModelHaveNoValue)
{
  const World w(ball());
  const auto& m = w.models.all[0];
  const auto h = modelOf("ball", ball()).members[0].histogram;
  const double scale = w.source.scale();
  const auto squared = [&](double d) { return static_cast<float>(d * scale * d * scale); };
  EXPECT_EQ(m.bin(7, squared(0.015)), 7u); // five intervals over a delta_max of 0.1
  EXPECT_EQ(m.bin(7, squared(0.025)), 7u + 125);
  EXPECT_EQ(m.bin(7, squared(0.095)), 7u + 4 * 125);
  EXPECT_EQ(m.value(7, squared(0.015)), h[7]);
  EXPECT_EQ(m.bin(7, squared(0.11)), kBeyond);
  EXPECT_EQ(m.value(7, squared(0.11)), 0);
}

TEST(Seeds, HoldWhatIsWithinTheLargestRadiusOfASurflet)
{
  World w(rod());
  DissertationParameters p;
  p.seeds = 20;
  const auto seeds = plantSeeds(w.scene, 1, range(0, 1000), p, w.diagnostics.models[1]);
  ASSERT_EQ(seeds.size(), 20u);
  const double r_max = w.models.all[1].model->r_max;
  const auto neighbours = [&](std::uint32_t c) {
    Indices near;
    for (std::uint32_t i = 0; i < 1000; ++i)
      if (std::hypot(rod().x[i] - rod().x[c], rod().y[i] - rod().y[c], rod().z[i] - rod().z[c]) <=
          r_max)
        near.push_back(i);
    return near;
  };
  std::vector<Indices> expected;
  for (std::uint32_t c = 0; c < 1000; ++c)
    expected.push_back(neighbours(c));
  for (const auto& seed : seeds) // Eq. 5.13: of some surflet, whichever was drawn
    EXPECT_NE(std::find(expected.begin(), expected.end(), seed.surflets), expected.end());
}

TEST(Refinement, ErasesBothSurfletsOfACrosstalkPair)
{
  const auto n = static_cast<std::uint32_t>(ball().size());
  World w(together(ball(), shifted(rod(), 1)));
  Regrouping groups;
  groups.first = {0, 1};
  groups.second = {n, 2}; // too far apart; both on the ball
  featuresOfPairs(w.source, w.models.resolution, groups.first, groups.second, groups.features);
  Indices surflets = {0, 1, 2, n};
  EXPECT_TRUE(eraseCrosstalk(groups, w.models.all[0], surflets));
  EXPECT_EQ(surflets, (Indices{1, 2}));
}

TEST(Preselection, SelectsEachModelsOwnSurflets)
{
  const auto n = static_cast<std::uint32_t>(ball().size());
  World w(together(ball(), shifted(rod(), 1)));
  DissertationParameters p;
  p.pairs = 100000;
  const auto selected = preselect(w.scene, p, w.diagnostics);
  ASSERT_EQ(selected.size(), 2u);
  const auto of_ball = static_cast<std::size_t>(
      std::lower_bound(selected[0].begin(), selected[0].end(), n) - selected[0].begin());
  EXPECT_GT(of_ball, 990u);
  const auto on_rod =
      selected[1].end() - std::lower_bound(selected[1].begin(), selected[1].end(), n);
  EXPECT_GT(on_rod, 950);
  EXPECT_EQ(w.diagnostics.models[0].surflets, selected[0].size());
  EXPECT_GT(w.diagnostics.models[0].threshold, 0);
  EXPECT_GT(w.diagnostics.too_long, 0u) << "pairs of a ball and a rod are longer than both";
}

TEST(Preselection, AHigherThresholdSelectsFewerPairs) // Eq. 5.3
{
  std::uint64_t last = ~std::uint64_t{0};
  for (const double lambda : {0.5, 1.3, 3.0}) {
    World w(together(ball(), shifted(rod(), 1)));
    DissertationParameters p;
    p.pairs = 20000;
    p.lambda_h = lambda;
    preselect(w.scene, p, w.diagnostics);
    const auto pairs = w.diagnostics.models[0].pairs + w.diagnostics.models[1].pairs;
    EXPECT_LT(pairs, last);
    last = pairs;
  }
}

TEST(Preselection, DropsWhatIsMostLikelyBackground) // Eq. 5.9
{
  ModelDatabase models;
  models.add(modelOf("ball", ball()));
  models.add(
      modelOf("floor", sampleShape(Shape::plane(0.07, 0.07), 2000, 3), ModelRole::Background));
  const auto floor = sampleShape(Shape::plane(0.5, 0.5), 4000, 4);
  const auto n = static_cast<std::uint32_t>(floor.size());
  DissertationParameters p;
  p.pairs = 50000;
  p.lambda_h = 0.1;
  const auto onFloor = [&](bool background) {
    World w(together(floor, shifted(ball(), 0, 0, 0.051f)), models, background);
    const auto selected = preselect(w.scene, p, w.diagnostics);
    EXPECT_EQ(w.diagnostics.background > 0, background);
    return std::lower_bound(selected[0].begin(), selected[0].end(), n) - selected[0].begin();
  };
  EXPECT_GT(onFloor(false), 1000);
  EXPECT_LT(onFloor(true), 400);
}

TEST(Preselection, GivesUpWhereAllPairsAreTooLong)
{
  SurfletSet huge = ball();
  for (auto* axis : {&huge.x, &huge.y, &huge.z})
    for (float& v : *axis)
      v *= 1000;
  World w(huge);
  DissertationParameters p;
  p.pairs = 10000;
  p.draws_per_pair = 10;
  const auto selected = preselect(w.scene, p, w.diagnostics);
  EXPECT_TRUE(selected[0].empty() && selected[1].empty());
  EXPECT_GE(w.diagnostics.drawn, 100000u);
  EXPECT_LT(w.diagnostics.drawn, 1000000u);
  EXPECT_GT(double(w.diagnostics.too_long), 0.999 * double(w.diagnostics.drawn));
}

TEST(Seeds, HoldTheNeighbourhoodOfASurflet) // Eq. 5.13
{
  const World w(together(ball(), shifted(ball(), 0.3f)));
  const auto n = static_cast<std::uint32_t>(ball().size());
  DissertationParameters p;
  p.seeds = 40;
  ModelDiagnostics diagnostics;
  const auto seeds = plantSeeds(w.scene, 0, range(100, 2 * n), p, diagnostics);
  ASSERT_EQ(seeds.size(), 40u);
  for (const auto& seed : seeds) {
    ASSERT_FALSE(seed.surflets.empty());
    EXPECT_GE(seed.surflets.front(), 100u) << "not selected";
    EXPECT_EQ(seed.surflets.front() < n, seed.surflets.back() < n) << "one ball";
    EXPECT_TRUE(std::is_sorted(seed.surflets.begin(), seed.surflets.end()));
    // A sphere of the ball's radius about a point of the ball holds a quarter of its surface.
    EXPECT_NEAR(double(seed.surflets.size()), 250, 60);
  }
  p.seeds = 1000;
  EXPECT_EQ(plantSeeds(w.scene, 0, range(0, 5), p, diagnostics).size(), 5u);
  EXPECT_TRUE(plantSeeds(w.scene, 0, {}, p, diagnostics).empty());
}

TEST(Regrouping, JoinsEverySurfletWithOneOther) // Eq. 5.14
{
  const World w(ball());
  Regrouping groups;
  groups.draw(w.scene, range(10, 21), 1, 2);
  ASSERT_EQ(groups.first.size(), 5u);
  Indices used = groups.first;
  used.insert(used.end(), groups.second.begin(), groups.second.end());
  std::sort(used.begin(), used.end());
  EXPECT_EQ(std::unique(used.begin(), used.end()), used.end());
  EXPECT_GE(used.front(), 10u);
  EXPECT_LE(used.back(), 20u);
  const auto first = groups.first;
  groups.draw(w.scene, range(10, 21), 1, 3);
  EXPECT_NE(groups.first, first);
}

TEST(Refinement, KeepsASeedOfOneObject)
{
  const World w(ball());
  Cluster seed = clusterOf(range(0, 600));
  refineSeed(w.scene, 0, 1, {}, seed);
  EXPECT_EQ(seed.surflets.size(), 600u);
  EXPECT_LT(seed.likelihood, 0);
  EXPECT_GT(seed.likelihood, std::log(1e-3));
}

TEST(Refinement, ClearsASeedOfTwoObjectsOfCrosstalk) // Eq. 5.15
{
  const auto n = static_cast<std::uint32_t>(ball().size());
  const World w(together(ball(), shifted(rod(), 0.02f, 0.02f)));
  Cluster seed = clusterOf(range(0, n + 100));
  refineSeed(w.scene, 0, 1, {}, seed);
  const auto rest =
      seed.surflets.end() - std::lower_bound(seed.surflets.begin(), seed.surflets.end(), n);
  EXPECT_GT(seed.surflets.size(), 600u);
  EXPECT_LT(rest, 20) << "of 100 surflets that are not of the ball";
}

TEST(Refinement, LeavesNothingOfAnotherObject)
{
  const World w(rod());
  Cluster seed = clusterOf(range(0, 600));
  refineSeed(w.scene, 0, 1, {}, seed);
  EXPECT_LT(seed.surflets.size(), 60u) << "a ball has no pairs like those of a rod";
}

TEST(Refinement, GivesUpASeedThatNeverSettles)
{
  const World w(together(ball(), shifted(rod(), 0.02f, 0.02f)));
  DissertationParameters p;
  p.max_regroupings = 1;
  Cluster seed = clusterOf(range(0, 1400));
  refineSeed(w.scene, 0, 1, p, seed);
  EXPECT_TRUE(seed.surflets.empty());
}

TEST(Merging, JoinsWhatSeedsHaveInCommon) // Eq. 5.17
{
  std::size_t lone = 0;
  auto best = clusterOf(range(0, 100)), second = clusterOf(range(60, 120)),
       third = clusterOf(range(0, 20)), elsewhere = clusterOf(range(500, 600));
  best.likelihood = -1;
  second.likelihood = -2;
  third.likelihood = -3;
  elsewhere.likelihood = -1.5;
  const auto clusters = mergeSeeds({third, elsewhere, second, best}, 0.3, lone);
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].seeds, 3u);
  Indices expected = range(0, 20), more = range(60, 100);
  expected.insert(expected.end(), more.begin(), more.end());
  EXPECT_EQ(clusters[0].surflets, expected) << "surflets of one seed alone are left out";
  EXPECT_EQ(lone, 1u);
}

TEST(Merging, OverlapMustExceedLambda)
{
  std::size_t lone = 0;
  const ClustersOfModel seeds = {clusterOf(range(0, 100)), clusterOf(range(70, 170))};
  EXPECT_TRUE(mergeSeeds(seeds, 0.3, lone).empty());
  EXPECT_EQ(lone, 2u);
  EXPECT_EQ(mergeSeeds(seeds, 0.29, lone).size(), 1u);
  EXPECT_EQ(lone, 0u);
  EXPECT_TRUE(mergeSeeds({}, 0.3, lone).empty());
}

TEST(Distribution, TheOwnModelMustExplainTheCluster)
{
  const auto n = static_cast<std::uint32_t>(ball().size());
  const World w(together(ball(), shifted(rod(), 1)));
  auto of_ball = clusterOf(range(0, 500)), of_rod = clusterOf(range(n, n + 500));
  EXPECT_TRUE(distributionFits(w.scene, 0, 1, {}, of_ball));
  EXPECT_GT(of_ball.margin, 0);
  EXPECT_FALSE(distributionFits(w.scene, 1, 1, {}, of_ball));
  EXPECT_LT(of_ball.margin, 0);
  EXPECT_TRUE(distributionFits(w.scene, 1, 1, {}, of_rod));
  EXPECT_FALSE(distributionFits(w.scene, 0, 1, {}, of_rod));
  auto single = clusterOf({3});
  EXPECT_FALSE(distributionFits(w.scene, 0, 1, {}, single));
}

TEST(Similarity, DropsSmallClusters)
{
  DissertationParameters p;
  p.min_cluster = 30;
  p.lambda_c = 0.5;
  ClustersOfModel clusters = {clusterOf(range(0, 100)), clusterOf(range(0, 50)),
                              clusterOf(range(0, 49)), clusterOf(range(0, 29))};
  ModelDiagnostics d;
  dropSmallClusters(p, clusters, d);
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_EQ(clusters[1].surflets.size(), 50u);
  EXPECT_EQ(d.died_small, 1u);
  EXPECT_EQ(d.died_relative, 1u);
}

namespace {

/** \brief Surflets in a row, 1 mm from each other; the radii of both models exceed 15 mm. */
SurfletSet
row()
{
  SurfletSet set;
  for (int i = 0; i < 2000; ++i)
    set.push_back({0.001f * float(i), 0, 0, 0, 0, 1});
  return set;
}

} // namespace

TEST(Competition, CollidingClustersOfOneModelMerge) // Eq. 5.18
{
  World w(row());
  std::vector<ClustersOfModel> clusters(2);
  clusters[0] = {clusterOf(range(0, 40), 3), clusterOf(range(30, 70), 4),
                 clusterOf(range(1000, 1040), 2)};
  compete(w.scene, clusters, w.diagnostics);
  ASSERT_EQ(clusters[0].size(), 2u);
  EXPECT_EQ(clusters[0][0].surflets, range(0, 70));
  EXPECT_EQ(clusters[0][0].seeds, 7u);
  EXPECT_EQ(clusters[0][1].seeds, 2u);
  EXPECT_EQ(w.diagnostics.models[0].merged, 1u);
}

TEST(Competition, RivalsNeedTwoOfThreeConditions) // Eq. 5.19-5.21
{
  // Elsewhere, each model has a cluster that sets p_max = 100 and n_max = 10.
  const auto stays = [](Cluster a, Cluster b) {
    World w(row());
    std::vector<ClustersOfModel> clusters(2);
    clusters[0] = {std::move(a), clusterOf(range(1000, 1100), 10)};
    clusters[1] = {std::move(b), clusterOf(range(1500, 1600), 10)};
    compete(w.scene, clusters, w.diagnostics);
    EXPECT_EQ(clusters[0].size() + clusters[1].size(), 3u);
    EXPECT_EQ(w.diagnostics.models[0].lost + w.diagnostics.models[1].lost, 1u);
    return clusters[0].size() == 2 ? 0 : 1;
  };
  const auto sized = [](std::uint32_t p, std::size_t n) { return clusterOf(range(0, p), n); };
  EXPECT_EQ(stays(sized(60, 5), sized(50, 4)), 0); // p and n; p/n is 12 against 12.5
  EXPECT_EQ(stays(sized(60, 5), sized(50, 6)), 0); // p and p/n
  EXPECT_EQ(stays(sized(50, 4), sized(60, 5)), 1);
  EXPECT_EQ(stays(sized(60, 3), sized(50, 2)), 0); // p and n; p/n is 20 against 25
  EXPECT_EQ(stays(sized(60, 9), sized(62, 3)), 1); // n only
  auto better = sized(50, 5), worse = sized(50, 5);
  better.margin = 0.2;
  worse.margin = 0.1;
  EXPECT_EQ(stays(better, worse), 0);
  EXPECT_EQ(stays(worse, better), 1);
}

TEST(Competition, DistantClustersDoNotMeet)
{
  World w(row());
  std::vector<ClustersOfModel> clusters(2);
  clusters[0] = {clusterOf(range(0, 40))};
  clusters[1] = {clusterOf(range(200, 240))};
  compete(w.scene, clusters, w.diagnostics);
  EXPECT_EQ(clusters[0].size() + clusters[1].size(), 2u);
}
