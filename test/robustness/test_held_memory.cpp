// What each class holds in memory: the bounds of doc/memory.md, which this prints the numbers of.
#include "hostile_clouds.h"

#include "pcl_surflet/conversions.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/mean_surflet_grid.h"
#include "pcl_surflet/model_search.h"
#include "pcl_surflet/octree_region_search.h"
#include "pcl_surflet/online_scene_interpreter.h"
#include "pcl_surflet/recognition/histogram_classifier.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/recognition/pose.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <memory>

#include <malloc.h>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

namespace {

double
bytesInUse()
{
  const auto info = ::mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

/** \brief Bytes per unit that what \p make returns holds, printed and at most \p bound. */
template <typename Make>
void
expectAtMost(double bound, const char* what, double units, const Make& make)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers allocate otherwise";
#endif
  const double before = bytesInUse();
  const auto held = make();
  const double each = (bytesInUse() - before) / units;
  std::printf("%-45s %10.1f bytes\n", what, each);
  EXPECT_LE(each, bound) << what;
  EXPECT_GT(each, 0.05 * bound) << what << ": the bound says too little";
}

HistogramModel
modelOf(const char* name, int intervals)
{
  HistogramModelTrainer trainer;
  trainer.setResolution({intervals, intervals, intervals, intervals});
  trainer.setNumberOfPairs(20000);
  return trainer.train(name, sampleShape(*shapeByName(name), 1000, 9));
}

} // namespace

TEST(HeldMemory, RegionSearchPerPoint)
{
  using Search = OctreeRegionSearch<pcl::PointXYZ>;
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  const auto ball = unitBall(200000);
  for (const auto& p : *ball)
    cloud->push_back({p.x, p.y, p.z});
  const std::pair<Search::Backend, const char*> backends[] = {
      {Search::Linear, "region search, linear"},
      {Search::Octree, "region search, octree"},
      {Search::AVL, "region search, AVL"}};
  for (const auto& [backend, name] : backends)
    expectAtMost(backend == Search::Linear ? 24 : 80, name, 200000, [&, b = backend] {
      auto search = std::make_unique<Search>(b);
      search->setInputCloud(cloud);
      return search;
    });
}

TEST(HeldMemory, ReductionPerPoint)
{
  const auto cloud = unitBall(200000);
  expectAtMost(10, "mean surflets, held after filter()", 200000, [&] {
    auto grid = std::make_unique<MeanSurfletGrid<pcl::PointNormal>>();
    grid->setInputCloud(cloud);
    grid->setLeafSize(0.1F);
    HostileCloud out;
    grid->filter(out);
    return grid;
  });
  expectAtMost(32, "SurfletSet and indices, per surflet", 200000,
               [&] { return std::make_unique<ConvertedSurflets>(toSurflets(*cloud)); });
}

TEST(HeldMemory, ModelsPerBinAndMember)
{
  const HistogramModel model = modelOf("torus", 7);
  expectAtMost(5, "HistogramModel, per bin and member", 2401 * 100,
               [&] { return std::vector<HistogramModel>(100, model); });
  ModelDatabase database;
  for (int i = 0; i < 100; ++i) {
    HistogramModel copy = model;
    copy.label += std::to_string(i);
    database.add(std::move(copy));
  }
  expectAtMost(32, "HistogramClassifier, per bin and member", 2401 * 100,
               [&] { return std::make_unique<HistogramClassifier>(database); });
  expectAtMost(20, "ModelSearch, per bin and member", 2401 * 100,
               [&] { return std::make_unique<ModelSearch>(database); });
}

TEST(HeldMemory, OnlineScenesPerCell)
{
  ModelDatabase database;
  database.add(modelOf("torus", 7));
  OnlineParameters parameters;
  parameters.leaf = 0.02;
  const auto cloud = unitBall(100000);
  OnlineSceneInterpreter counted(database, parameters);
  counted.addScan(*cloud, Eigen::Vector3f(0, 0, 5));
  const auto cells = static_cast<double>(counted.cells().size());
  expectAtMost(600, "OnlineSceneInterpreter, per cell", cells, [&] {
    auto online = std::make_unique<OnlineSceneInterpreter>(database, parameters);
    online->addScan(*cloud, Eigen::Vector3f(0, 0, 5));
    return online;
  });
}

TEST(HeldMemory, PoseModels)
{
  const SurfletSet cup = sampleShape(*shapeByName("cup"), 20000, 1);
  expectAtMost(8e6, "PoseModel", 1, [&] { return PoseModel::train("cup", cup); });
}
