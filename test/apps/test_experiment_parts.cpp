// The experiments' machinery: conditions, trials, isolation of what crashes, nearest neighbours.
#include "experiment/chapter3.h"
#include "experiment/chapter3/curves.h"
#include "experiment/chapter3/settings.h"
#include "experiment/collection.h"
#include "experiment/depth_picture.h"
#include "experiment/peers/isolation.h"
#include "experiment/peers/nearest_signature.h"
#include "experiment/trials.h"

#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <set>
#include <stdexcept>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

ExperimentObject
boxObject()
{
  ExperimentObject object;
  object.label = "box";
  object.mesh = scaledToDiameter(meshOfShape(Shape::box(3, 2, 1), 0.5), 1);
  object.spacing = std::sqrt(surfaceArea(object.mesh) / static_cast<double>(kMeshSurflets));
  object.axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  return object;
}

/** \brief Answers by the number of surflets, so that a test can tell which query it was given. */
class Counter : public Recogniser {
public:
  Counter(std::size_t few, Normals normals) : Recogniser("counter", normals), few_(few) {}

  Answer
  classify(const SurfletSet& query) const override
  {
    Answer answer;
    answer.failed = query.size() < few_;
    if (!answer.failed)
      answer.object = query.size() > 2000 ? 0 : 1;
    answer.seconds = 0.5;
    return answer;
  }

private:
  std::size_t few_;
};

Condition
atResolution(double resolution)
{
  Condition c;
  c.resolution = resolution;
  return c;
}

} // namespace

TEST(ExperimentParts, WilsonIntervals)
{
  const auto [low, high] = confidenceInterval(50, 100); // from a published table
  EXPECT_NEAR(low, 0.4038, 1e-4);
  EXPECT_NEAR(high, 0.5962, 1e-4);
  EXPECT_NEAR(confidenceInterval(10, 10).first, 0.7225, 1e-4);
  EXPECT_NEAR(confidenceInterval(0, 10).second, 0.2775, 1e-4);
  EXPECT_NEAR(confidenceInterval(10, 10).second, 1, 1e-12);
  EXPECT_EQ(confidenceInterval(0, 0), std::make_pair(0.0, 1.0));
}

TEST(ExperimentParts, HalfTheResolutionIsAQuarterOfThePoints)
{
  const auto object = boxObject();
  const double full = static_cast<double>(makeQuery(object, {}, 1, false).sampled.size());
  EXPECT_NEAR(full, kMeshSurflets, 0.2 * kMeshSurflets);
  const auto half = makeQuery(object, atResolution(0.5), 1, false).sampled.size();
  EXPECT_NEAR(static_cast<double>(half), full / 4, full / 20);
}

TEST(ExperimentParts, QueriesAreDisturbedAsAsked)
{
  const auto object = boxObject();
  const auto ideal = makeQuery(object, {}, 1, true);
  EXPECT_EQ(ideal.estimated.x, ideal.sampled.x);
  EXPECT_NE(ideal.estimated.nx, ideal.sampled.nx) << "normals estimated anew";
  EXPECT_EQ(makeQuery(object, {}, 1, false).sampled.x, ideal.sampled.x);
  EXPECT_NE(makeQuery(object, {}, 2, false).sampled.x, ideal.sampled.x);
  Condition c;
  c.visible = 0.25;
  EXPECT_EQ(makeQuery(object, c, 1, false).sampled.size(),
            std::lround(0.25 * ideal.sampled.size()));
  c = Condition();
  c.noise = 0.1;
  const auto noisy = makeQuery(object, c, 1, true);
  EXPECT_NE(noisy.sampled.x, ideal.sampled.x);
  EXPECT_EQ(noisy.sampled.nx, noisy.estimated.nx) << "under noise nobody gets the mesh's normals";
  c = Condition();
  c.stretch = {2, 1, 1}; // edges 3:2:1 become 6:2:1
  EXPECT_NEAR(farthestDistance(makeQuery(object, c, 1, false).sampled),
              std::sqrt((36. + 4 + 1) / (9 + 4 + 1)), 0.02);
}

TEST(ExperimentParts, TrialsCountEveryRecogniserOnTheSameQueries)
{
  const std::vector<ExperimentObject> objects = {boxObject(), boxObject()};
  Recognisers recognisers;
  recognisers.push_back(std::make_unique<Counter>(0, Normals::Sampled));
  recognisers.push_back(std::make_unique<Counter>(2000, Normals::Estimated));
  TrialPlan plan;
  plan.settings = {fixedSetting("full", 1, {}),
                   fixedSetting("half", 0.5, atResolution(0.5)),
                   {"", 0, "none", [](std::uint64_t) { return std::optional<Condition>(); }}};
  plan.tests = 3;
  const auto tallies = runTrials(objects, recognisers, plan, [](std::size_t, std::string) {});
  ASSERT_EQ(tallies.size(), 3u);
  const Tally& full = tallies[0][0];
  EXPECT_EQ(full.tests, 6u);
  EXPECT_EQ(full.right, 3u) << "always answers 0";
  EXPECT_EQ(full.confusion[1][0], 3u);
  EXPECT_EQ(full.failed, 0u);
  EXPECT_EQ(full.secondsPerQuery(), 0.5);
  EXPECT_EQ(tallies[1][0].confusion[0][1], 3u);
  EXPECT_EQ(tallies[1][1].failed, 6u) << "the recogniser that asks for more surflets";
  EXPECT_EQ(tallies[1][1].right, 0u) << "a failure is a miss";
  EXPECT_EQ(tallies[2][0].tests, 0u) << "no condition, no test";
  Tally sum(2);
  sum.add(full);
  sum.add(tallies[1][0]);
  EXPECT_EQ(sum.tests, 12u);
  EXPECT_EQ(sum.right, 6u);
}

TEST(ExperimentParts, DistortionsLieInTheirIntervals)
{
  const auto settings = distortionSettings(10);
  const double step = std::sqrt(3.0) * 2.1 / 10;
  std::size_t of_three = 0;
  for (const auto& setting : settings) {
    of_three += setting.series == "3 axes";
    for (const std::uint64_t seed : {1u, 2u}) {
      const auto condition = setting.condition(seed);
      if (!condition)
        continue; // the edge of what few axes can reach
      EXPECT_LE(std::abs(distortionMeasure(condition->stretch) - setting.x), step / 2 + 1e-9);
      const auto touched = std::count_if(condition->stretch.begin(), condition->stretch.end(),
                                         [](double f) { return f != 1; });
      EXPECT_EQ(std::to_string(touched), setting.series.substr(0, 1));
    }
  }
  EXPECT_EQ(of_three, 10u);
  EXPECT_LT(settings.size(), 30u) << "one axis does not reach what three do";
}

TEST(ExperimentParts, ElongationsOfOneAxis)
{
  const auto settings = elongationSettings(4);
  ASSERT_EQ(settings.size(), 12u);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const auto stretch = settings[i].condition(5)->stretch;
    for (std::size_t a = 0; a < 3; ++a)
      if (a == i / 4)
        EXPECT_LE(std::abs(stretch[a] - settings[i].x), 0.2 + 1e-9);
      else
        EXPECT_EQ(stretch[a], 1);
  }
  EXPECT_NEAR(settings.front().x, 0.6, 1e-9);
  EXPECT_NEAR(settings.back().x, 1.8, 1e-9);
}

TEST(ExperimentParts, WhatCrashesIsIsolated)
{
  const auto good = runIsolated([] { return Signatures{{1, 2}, {3, 4}}; });
  ASSERT_TRUE(good);
  EXPECT_EQ(good->signatures, (Signatures{{1, 2}, {3, 4}}));
  EXPECT_TRUE(runIsolated([] { return Signatures{}; })->signatures.empty());
  EXPECT_FALSE(runIsolated([]() -> Signatures { std::abort(); }));
  EXPECT_FALSE(runIsolated([]() -> Signatures {
    std::raise(SIGKILL);
    return {};
  }));
  EXPECT_FALSE(runIsolated([]() -> Signatures { throw std::runtime_error("no"); }));
  EXPECT_FALSE(runIsolated([] { return Signatures(1000, std::vector<float>(1000)); }))
      << "more than can be handed over";
}

TEST(ExperimentParts, WhatNeverEndsIsEnded)
{
  EXPECT_FALSE(runIsolated(
      []() -> Signatures {
        for (volatile bool on = true; on;) {
        }
        return {};
      },
      1));
}

TEST(ExperimentParts, EachMetricHasItsOwnNearest)
{
  const auto nearest = [](const Signatures& known, const std::vector<float>& query, Metric metric) {
    return NearestSignature({{known[0]}, {known[1]}}, {7, 9}, metric).object({query});
  };
  // From the origin (3, 3) is 6 by L1 and 18 by L2; (0, 5) is 5 and 25.
  EXPECT_EQ(nearest({{3, 3}, {0, 5}}, {0, 0}, Metric::L1), 9u);
  EXPECT_EQ(nearest({{3, 3}, {0, 5}}, {0, 0}, Metric::L2), 7u);
  // The full bin of (10, 0.1) differs by more, but relative to its size by less.
  EXPECT_EQ(nearest({{12, 0.1F}, {10, 1}}, {10, 0.1F}, Metric::L2), 9u);
  EXPECT_EQ(nearest({{12, 0.1F}, {10, 1}}, {10, 0.1F}, Metric::ChiSquared), 7u);
}

TEST(ExperimentParts, NearestOfSeveralSignatures)
{
  const NearestSignature nearest({{{0, 0}, {10, 0}}, {{0, 10}}, {}}, {0, 1, 2}, Metric::L2);
  EXPECT_EQ(nearest.object({{5, 5}, {0, 9}}), 1u) << "any of the query's may be nearest";
  EXPECT_EQ(nearest.object({{9, 0}, {0, 8}}), 0u) << "to any of an object's";
  EXPECT_THROW(NearestSignature({{}}, {0}, Metric::L1), std::invalid_argument);
}

namespace {

/** \brief A square of side 2 in the plane z = \p height, smaller by \p margin on each side. */
void
addSquare(TriangleMesh& mesh, float height, float margin)
{
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const float low = -1 + margin, high = 1 - margin;
  for (const auto& [x, y] : {std::pair{low, low}, {high, low}, {high, high}, {low, high}})
    mesh.vertices.push_back({x, y, height});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

DepthPicture
pictureOf(const TriangleMesh& mesh)
{
  SurfletSet vertices;
  for (const auto& v : mesh.vertices)
    vertices.push_back({v[0], v[1], v[2], 0, 0, 1});
  return {vertices, mesh.triangles};
}

} // namespace

TEST(ExperimentParts, TheForemostOfTwoSquaresHidesTheMiddleOfTheOther)
{
  TriangleMesh mesh;
  addSquare(mesh, 0, 0);
  addSquare(mesh, 1, 0.5F);
  const auto picture = pictureOf(mesh);
  for (const auto& [x, y] : {std::pair{0.0F, 0.0F}, {0.48F, -0.48F}, {-0.3F, 0.45F}}) {
    EXPECT_TRUE(picture.shows({x, y, 1, 0, 0, 1})) << "above";
    EXPECT_FALSE(picture.shows({x, y, 0, 0, 0, 1})) << "hidden";
  }
  for (const auto& [x, y] : {std::pair{0.9F, 0.0F}, {-0.52F, 0.52F}, {1.0F, -1.0F}})
    EXPECT_TRUE(picture.shows({x, y, 0, 0, 0, 1})) << "beside it, up to the corners";
  EXPECT_FALSE(picture.shows({0, 0, 1, 0, 0, -1})) << "looks away";
  EXPECT_FALSE(picture.shows({0, 0, 1, 1, 0, 0.01F})) << "grazing";
}

TEST(ExperimentParts, ASlopeDoesNotHideItself)
{
  TriangleMesh mesh; // a square of slope 4 and its vertical wall, seen from the edge
  mesh.vertices = {{0, 0, 0}, {1, 0, 4}, {1, 1, 4}, {0, 1, 0}, {1, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}};
  const auto picture = pictureOf(mesh);
  const float nz = 1 / std::sqrt(17.0F);
  for (int i = 1; i < 500; ++i) {
    const float x = static_cast<float>(i) / 500;
    EXPECT_TRUE(picture.shows({x, 0.37F, 4 * x, -4 * nz, 0, nz})) << x;
    EXPECT_FALSE(picture.shows({x, 0.37F, 4 * x - 0.2F, -4 * nz, 0, nz})) << x;
  }
}

TEST(ExperimentParts, AViewKeepsTheHalfOfABallThatFacesIt)
{
  ExperimentObject ball;
  ball.mesh = scaledToDiameter(meshOfShape(Shape::sphere(1), 0.05), 1);
  ball.spacing = std::sqrt(surfaceArea(ball.mesh) / static_cast<double>(kMeshSurflets));
  Condition c;
  c.view = true;
  const auto whole = makeQuery(ball, {}, 3, false).sampled,
             seen = makeQuery(ball, c, 3, false).sampled;
  EXPECT_NEAR(static_cast<double>(seen.size()), 0.475 * static_cast<double>(whole.size()),
              0.025 * static_cast<double>(whole.size()))
      << "95 % of the facing half: the rim is grazing";
  for (std::size_t i = 0; i < seen.size(); ++i)
    EXPECT_GT(seen[i].z, 0) << "the sensor is above, and normals point to it";
}

TEST(ExperimentParts, NoTwoQueriesHaveOneSeed)
{
  std::set<std::uint64_t> seeds;
  for (std::uint64_t seed = 1; seed < 4; ++seed)
    for (std::size_t setting = 0; setting < 12; ++setting)
      for (std::size_t object = 0; object < 20; ++object)
        for (std::size_t test = 0; test < 50; ++test)
          seeds.insert(querySeed(seed, setting, object, test));
  EXPECT_EQ(seeds.size(), 3u * 12 * 20 * 50);
}

TEST(ExperimentParts, SettingsGoOnWhereAnEarlierRunEnded)
{
  const std::vector<ExperimentObject> objects = {boxObject(), boxObject()};
  /** Remembers what it was asked, by the first coordinate. */
  class Memory : public Recogniser {
  public:
    explicit Memory(std::vector<float>& asked) : Recogniser("memory"), asked_(asked) {}
    Answer
    classify(const SurfletSet& query) const override
    {
      asked_.push_back(query.x.front());
      return {};
    }

  private:
    std::vector<float>& asked_;
  };
  std::vector<float> asked[2];
  for (const std::size_t skip : {0u, 1u}) {
    Recognisers recognisers;
    recognisers.push_back(std::make_unique<Memory>(asked[skip]));
    TrialPlan plan;
    plan.settings.assign(2 - skip, fixedSetting("half", 0.5, atResolution(0.5)));
    plan.tests = 2;
    plan.threads = 1;
    plan.first = skip;
    runTrials(objects, recognisers, plan, [](std::size_t, std::string) {});
  }
  ASSERT_EQ(asked[0].size(), 8u);
  EXPECT_EQ(asked[1], std::vector<float>(asked[0].begin() + 4, asked[0].end()));
}

TEST(ExperimentParts, TheFirstEightConditionsOfThePeersAreThoseTheyChooseBy)
{
  const auto all = peerSettings(), choosing = choosingSettings();
  ASSERT_EQ(all.size(), 12u);
  ASSERT_EQ(choosing.size(), 8u);
  for (std::size_t i = 0; i < choosing.size(); ++i)
    EXPECT_EQ(all[i].name, choosing[i].name);
  const auto both = *all[10].condition(1), view = *all[11].condition(1);
  EXPECT_EQ(both.noise, 0.04);
  EXPECT_EQ(both.visible, 0.5);
  EXPECT_TRUE(view.view);
  EXPECT_EQ(view.noise, 0.003);
}

TEST(ExperimentParts, VariantsAreShapesOfTheirOwnAndOfAnySize)
{
  const auto object = boxObject();
  const auto extent = [](const TriangleMesh& mesh) {
    return farthestDistance(sampleIsoMesh(mesh, 1000, 1));
  };
  double smallest = 10, largest = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const double diameter = extent(variantOf(object, 0.2, seed));
    smallest = std::min(smallest, diameter);
    largest = std::max(largest, diameter);
  }
  EXPECT_GT(smallest, 0.48);
  EXPECT_LT(smallest, 0.65);
  EXPECT_GT(largest, 1.6);
  EXPECT_LT(largest, 2.001);
  // Without variety only the size differs: the share of the area stays.
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto same = scaledToDiameter(variantOf(object, 0, seed), 1);
    EXPECT_NEAR(surfaceArea(same), surfaceArea(object.mesh), 1e-4 * surfaceArea(object.mesh));
    const auto other = scaledToDiameter(variantOf(object, 0.3, seed), 1);
    EXPECT_GT(std::abs(surfaceArea(other) / surfaceArea(object.mesh) - 1), 1e-3);
  }
  EXPECT_EQ(variantOf(object, 0.3, 5).vertices, variantOf(object, 0.3, 5).vertices);
}

TEST(ExperimentParts, CollectionsAreTheSameWhateverTheThreads)
{
  const std::vector<ExperimentObject> objects = {boxObject()};
  const auto ignore = [](std::size_t, const std::string&) {};
  const auto one = makeCollection(objects, {3, 0.2, 1, 1}, ignore);
  const auto two = makeCollection(objects, {3, 0.2, 1, 2}, ignore);
  ASSERT_EQ(one.database.size(), 3u);
  EXPECT_EQ(one.classes, std::vector<std::string>(3, "box"));
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(one.database[i].members[0].histogram, two.database[i].members[0].histogram);
  EXPECT_NE(one.database[0].members[0].histogram, one.database[1].members[0].histogram);
}
