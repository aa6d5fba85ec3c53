// The memory that doc/memory.md states: peak of what a call allocates, beside its input.

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/depth_sensor.h"
#include "pcl_surflet/core/linear_octree.h"
#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/core/unrestricted_space.h"
#include "pcl_surflet/recognition/histogram_classifier.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/recognition/pose.h"
#include "pcl_surflet/recognition/scene_interpretation.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <functional>
#include <malloc.h>
#include <new>

namespace {

std::atomic<std::size_t> live{0}, peak{0};

} // namespace

void*
operator new(std::size_t size)
{
  void* p = std::malloc(size == 0 ? 1 : size);
  if (p == nullptr)
    throw std::bad_alloc();
  const std::size_t now = live += malloc_usable_size(p);
  for (std::size_t before = peak; before < now && !peak.compare_exchange_weak(before, now);) {
  }
  return p;
}

void
operator delete(void* p) noexcept
{
  live -= p == nullptr ? 0 : malloc_usable_size(p);
  std::free(p);
}

void
operator delete(void* p, std::size_t) noexcept
{
  operator delete(p);
}

using namespace pcl_surflet;

namespace {

/** \brief Most bytes that \p call holds at a time. */
double
peakOf(const std::function<void()>& call)
{
  const std::size_t before = live;
  peak = before;
  call();
  return static_cast<double>(peak - before);
}

SurfletSet
bottle(std::size_t n)
{
  return sampleShape(*shapeByName("bottle"), n, 1);
}

HistogramModelTrainer
trainerOf(int bins)
{
  HistogramModelTrainer trainer;
  trainer.setResolution({bins, bins, bins, bins});
  trainer.setNumberOfPairs(1000000);
  trainer.setNumberOfThreads(2);
  return trainer;
}

ModelDatabase
databaseOf(int bins)
{
  ModelDatabase database;
  for (const auto* name : {"bottle", "torus"})
    database.add(trainerOf(bins).train(name, sampleShape(*shapeByName(name), 20000, 1)));
  return database;
}

/** \brief Bytes of \p call over \p n are at most \p bound, and not less than a third of it, or the
 * page states too much. */
void
expectBytes(const char* what, double n, double bound, const std::function<void()>& call)
{
  const double bytes = peakOf(call) / n;
  ::testing::Test::RecordProperty(what, std::to_string(bytes));
  EXPECT_LE(bytes, bound) << what;
  EXPECT_GE(bytes, bound / 3) << what;
}

} // namespace

TEST(Memory, PerSurflet)
{
  for (const std::size_t n : {50000u, 400000u}) {
    const SurfletSet set = bottle(n);
    const double count = static_cast<double>(n);
    expectBytes("SurfletSet", count, 25, [&] { const SurfletSet copy = set; });
    expectBytes("PairSource", count, 60, [&] { const PairSource source(set); });
    expectBytes("training", count, 120, [&] { trainerOf(5).train("bottle", set); });
    expectBytes("cells", count, 60, [&] { reduceToTwoSidedCells(set, 0.005); });
  }
}

TEST(Memory, OfSearches)
{
  const SurfletSet set = bottle(400000);
  const double n = static_cast<double>(set.size());
  const PointArray points{set.x.data(), set.y.data(), set.z.data(), 1, set.size()};
  LinearOctree octree;
  expectBytes("Linear, building", n, 60, [&] { octree.build(points); });
  EXPECT_LE(double(octree.memoryUsage()) / n, 20);
}

TEST(Memory, OfModels)
{
  const ModelDatabase database = databaseOf(7);
  expectBytes("classifier per bin", 2 * 2401, 40, [&] { HistogramClassifier c(database); });
  expectBytes("pose model", 1, 12e6, [&] { PoseModel::train("bottle", bottle(20000)); });
}

TEST(Memory, OfAScene)
{
  const ModelDatabase database = databaseOf(7);
  SceneOptions options;
  options.density = 50000;
  const Scene scene = generateScene(
      {sceneItem("bottle", *shapeByName("bottle")), sceneItem("torus", *shapeByName("torus"))}, {},
      options);
  const SurfletSet cells = reduceToTwoSidedCells(scene.surflets, 0.006).cells;
  ExplanationParameters parameters;
  parameters.leaf = 0.006;
  parameters.steps.threads = 2;
  expectBytes("interpretation", double(cells.size()), 600,
              [&] { interpretByExplanation(cells, database, parameters); });
}

TEST(Memory, OfADepthPicture)
{
  const std::vector<SensedBody> bodies{{meshOfShape(Shape::sphere(0.2), 0.02), 1, 1}};
  expectBytes("pixel", 640 * 480, 60, [&] { sense(bodies, DepthSensor(), SensorPose(), 1); });
}
