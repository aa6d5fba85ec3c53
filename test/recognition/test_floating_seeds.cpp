// Floating cluster seeds and repetitive clustering: the energy alone, then on hand-made scenes.
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "recognition/interpretation/floating_seeds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace pcl_surflet;
using namespace pcl_surflet::interpretation;

namespace {

Place
randomPlace(CounterRandom& random, double size)
{
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

double
distance(const Place& a, const Place& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

std::vector<Place>
placesOf(const SurfletSet& set)
{
  std::vector<Place> places;
  for (std::size_t i = 0; i < set.size(); ++i)
    places.push_back({set.x[i], set.y[i], set.z[i]});
  return places;
}

/** \brief A box 0.2 high about the origin: nothing of it is within 0.03 of its middle. */
const SurfletSet&
box()
{
  static const SurfletSet set = sampleShape(Shape::box(0.06, 0.1, 0.2), 1500, 3);
  return set;
}

const ModelDatabase&
database()
{
  static const ModelDatabase models = [] {
    HistogramModelTrainer trainer;
    trainer.setNumberOfPairs(1000000);
    ModelDatabase d;
    d.add(trainer.train("box", box()));
    d.add(trainer.train("ball", sampleShape(Shape::sphere(0.05), 1500, 4)));
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

  explicit World(const SurfletSet& set)
      : cells(set), source(cells),
        models(sceneModels(database(), false, source.scale())), scene{cells, source, models}
  {
  }
};

Indices
everything(const SurfletSet& set)
{
  Indices all(set.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

} // namespace

TEST(SeedEnergy, IsOneBetweenTheRadiiAndNothingElsewhere) // Eq. 6.3-6.7
{
  const SeedEnergy sharp(0.03, 0.11, 1000);
  EXPECT_NEAR(sharp.potential(0.07), 1, 1e-12);
  EXPECT_NEAR(sharp.potential(0.05), 1, 1e-6);
  EXPECT_NEAR(sharp.potential(0.09), 1, 1e-6);
  EXPECT_NEAR(sharp.potential(0.03), 0.5, 1e-6);
  EXPECT_NEAR(sharp.potential(0.11), 0.5, 1e-6);
  EXPECT_NEAR(sharp.potential(0.01), 0, 1e-6);
  EXPECT_NEAR(sharp.potential(0.13), 0, 1e-6);
  const SeedEnergy gentle(0.03, 0.11, 20);
  for (double delta = 0; delta < 1; delta += 0.01) {
    EXPECT_LE(gentle.potential(delta), 1 + 1e-12);
    EXPECT_NEAR(gentle.potential(0.07 + delta), gentle.potential(0.07 - delta), 1e-9) << "even";
  }
  EXPECT_LT(std::abs(sharp.potential(sharp.reach())), 1.1e-3);
}

TEST(SeedEnergy, ItsGradientIsTheLimitOfDifferences) // Eq. 6.8-6.12
{
  CounterRandom random(17);
  for (int trial = 0; trial < 200; ++trial) {
    const double r_min = random.uniform(0.01, 0.1), r_max = r_min + random.uniform(0.01, 0.2);
    const SeedEnergy energy(r_min, r_max, random.uniform(1, 60) / r_max);
    std::vector<Place> surflets(30);
    for (auto& p : surflets)
      p = randomPlace(random, 0.3);
    const Place q = randomPlace(random, 0.2);
    const Place gradient = energy.gradient(surflets, q);
    const double length = std::hypot(gradient[0], gradient[1], gradient[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      constexpr double kStep = 1e-6;
      Place before = q, after = q;
      before[axis] -= kStep;
      after[axis] += kStep;
      const double difference =
          (energy.of(surflets, after) - energy.of(surflets, before)) / (2 * kStep);
      EXPECT_NEAR(gradient[axis], difference, 1e-5 * (1 + length)) << trial;
    }
  }
}

TEST(SeedEnergy, StaysFiniteWhereExponentialsDoNot)
{
  const SeedEnergy steep(0.03, 0.11, 1e6);
  const std::vector<Place> surflets = {{0, 0, 0}, {1e30, 0, 0}, {0.03, 0, 0}};
  const Place gradient = steep.gradient(surflets, {0, 0, 0});
  EXPECT_TRUE(std::isfinite(gradient[0]) && std::isfinite(steep.of(surflets, {0, 0, 0})));
  EXPECT_EQ(steep.gradient({{0, 0, 0}}, {0, 0, 0}), (Place{0, 0, 0})) << "no direction";
}

TEST(FloatingSeeds, StepsShrinkAndEndWhereTheEnergyIsFlat) // Eq. 6.13
{
  const auto surflets = placesOf(box());
  const SeedEnergy energy(0.03, 0.115, 100);
  const auto all = [&](const Place&) -> const std::vector<Place>& { return surflets; };
  const auto path = floatSeed(energy, all, {0.03, 0.05, 0.1}, 25);
  ASSERT_EQ(path.size(), 26u);
  for (std::size_t k = 1; k < path.size(); ++k)
    EXPECT_NEAR(distance(path[k], path[k - 1]), 0.03 / static_cast<double>(k), 1e-9);
  EXPECT_GT(energy.of(surflets, path.back()), energy.of(surflets, path.front()));
  const std::vector<Place> nothing;
  const auto none = [&](const Place&) -> const std::vector<Place>& { return nothing; };
  EXPECT_EQ(floatSeed(energy, none, {1, 2, 3}, 25).size(), 1u);
}

TEST(FloatingSeeds, MoveFromTheSurfaceToTheMiddle)
{
  const World w(box());
  DissertationParameters p;
  p.seeds = 60;
  p.floating.keep_paths = true;
  ModelDiagnostics still, moved;
  const auto before = plantSeeds(w.scene, 0, everything(w.cells), p, still);
  p.floating.on = true;
  const auto after = plantSeeds(w.scene, 0, everything(w.cells), p, moved);
  EXPECT_TRUE(still.seed_paths.empty());
  ASSERT_EQ(moved.seed_paths.size(), 60u);
  double from = 0, to = 0, held_before = 0, held_after = 0;
  for (std::size_t i = 0; i < 60; ++i) {
    from += distance(moved.seed_paths[i].front(), {0, 0, 0}) / 60;
    to += distance(moved.seed_paths[i].back(), {0, 0, 0}) / 60;
    held_before += static_cast<double>(before[i].surflets.size()) / 60;
    held_after += static_cast<double>(after[i].surflets.size()) / 60;
  }
  EXPECT_LT(to, 0.5 * from);
  EXPECT_GT(held_after, 1.3 * held_before) << "of 1500";
}

TEST(FloatingSeeds, FollowAMovedScene)
{
  DissertationParameters p;
  p.seeds = 5;
  p.floating.on = p.floating.keep_paths = true;
  SurfletSet shifted = box();
  for (float& x : shifted.x)
    x += 0.5f;
  ModelDiagnostics here, there;
  plantSeeds(World(box()).scene, 0, everything(box()), p, here);
  plantSeeds(World(shifted).scene, 0, everything(box()), p, there);
  for (std::size_t i = 0; i < 5; ++i) {
    Place expected = here.seed_paths[i].back();
    expected[0] += 0.5;
    EXPECT_LT(distance(expected, there.seed_paths[i].back()), 1e-4);
  }
}

TEST(Repetition, RegainsTheBorderOfTheClustersModelOnly)
{
  SurfletSet set = box();
  for (const Surflet s : {Surflet{0.5f, 0, 0, 0, 0, 1}, Surflet{0.5f, 0.01f, 0, 0, 0, 1}})
    set.push_back(s); // out of reach
  const World w(set);
  std::vector<ClustersOfModel> clusters(2);
  Cluster middle;
  for (std::uint32_t i = 0; i < box().size(); ++i)
    if (std::hypot(set.x[i], set.y[i], set.z[i]) < 0.07)
      middle.surflets.push_back(i);
  clusters[0].push_back(middle);
  InterpretationDiagnostics d;
  d.models.resize(2);
  DissertationParameters p;
  repeatClustering(w.scene, p, clusters, d);
  const Indices& after = clusters[0][0].surflets;
  EXPECT_GT(double(after.size()), 0.95 * double(box().size()));
  EXPECT_TRUE(
      std::includes(after.begin(), after.end(), middle.surflets.begin(), middle.surflets.end()));
  EXPECT_LT(after.back(), box().size());
  EXPECT_EQ(d.models[0].regained, after.size() - middle.surflets.size());
  EXPECT_TRUE(clusters[1].empty());
  EXPECT_EQ(d.models[1].regained, 0u);
}
