// The experiments' machinery: conditions, trials, isolation of what crashes, nearest neighbours.
#include "experiment/chapter3.h"
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
  object.spacing = std::sqrt(surfaceArea(object.mesh) / static_cast<double>(kSamplingSize));
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
  EXPECT_NEAR(full, kSamplingSize, 0.2 * kSamplingSize);
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
