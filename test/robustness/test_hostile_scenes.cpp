// Hostile clouds for the classes of space, scenes and poses (chapters 4 to 6): no crash, no endless
// loop; what comes out has the right size, or there is the documented error.
#include "hostile_clouds.h"

#include "pcl_surflet/conversions.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/mean_surflet_grid.h"
#include "pcl_surflet/octree_region_search.h"
#include "pcl_surflet/online_scene_interpreter.h"
#include "pcl_surflet/pose_estimator.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/scene_interpreter.h"

#include <pcl/common/point_tests.h>
#include <pcl/console/print.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

namespace {

class HostileScenes : public testing::Test {
protected:
  void
  SetUp() override
  {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); // errors are what is expected
  }
};

using Search = OctreeRegionSearch<pcl::PointNormal>;

/** \brief A ball of diameter 2, the size of most hostile clouds. */
const ModelDatabase&
database()
{
  static const ModelDatabase models = [] {
    HistogramModelTrainer trainer;
    trainer.setResolution({7, 7, 7, 7});
    trainer.setNumberOfPairs(100000);
    ModelDatabase d;
    d.add(trainer.train("ball", toSurflets(*unitBall(5000)).surflets));
    return d;
  }();
  return models;
}

/** \brief Every index once, all within \p size. */
void
expectIndices(pcl::Indices found, std::size_t size, const std::string& name)
{
  std::sort(found.begin(), found.end());
  EXPECT_TRUE(std::adjacent_find(found.begin(), found.end()) == found.end()) << name;
  EXPECT_TRUE(found.empty() ||
              (found.front() >= 0 && static_cast<std::size_t>(found.back()) < size))
      << name;
}

/** \brief Points within the radius, by the formula that the class documents. */
pcl::Indices
bruteForce(const HostileCloud& cloud, const pcl::PointNormal& q, double radius)
{
  pcl::Indices found;
  const auto squared = static_cast<float>(radius) * static_cast<float>(radius);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float dx = cloud[i].x - q.x, dy = cloud[i].y - q.y, dz = cloud[i].z - q.z;
    if (pcl::isFinite(cloud[i]) && (dx * dx + dy * dy) + dz * dz <= squared)
      found.push_back(static_cast<pcl::index_t>(i));
  }
  return found;
}

} // namespace

TEST_F(HostileScenes, RegionSearch)
{
  for (const auto& [cloud_name, cloud] : hostileClouds())
    for (const auto backend : {Search::Linear, Search::Octree, Search::AVL}) {
      const std::string name =
          cloud_name + ", backend " + std::to_string(static_cast<int>(backend));
      Search search(backend);
      search.setInputCloud(cloud);
      EXPECT_LE(search.size(), cloud->size()) << name;
      for (std::size_t i = 0; i < cloud->size(); i += 41)
        for (const double radius : {0.0, 1e-35, 0.3, 1e5, 1e25}) {
          pcl::Indices found;
          std::vector<float> squared;
          const auto& q = (*cloud)[i];
          const int n = search.radiusSearch(q, radius, found, squared);
          ASSERT_EQ(found.size(), static_cast<std::size_t>(n)) << name;
          ASSERT_EQ(squared.size(), found.size()) << name;
          expectIndices(found, cloud->size(), name);
          if (pcl::isFinite(q) && radius >= 0.3 && radius < 1e10) { // squares are normal numbers
            std::sort(found.begin(), found.end());
            ASSERT_EQ(found, bruteForce(*cloud, q, radius)) << name << ", radius " << radius;
          }
          const int k = search.nearestKSearch(q, 5, found, squared);
          EXPECT_TRUE(k >= 0 && k <= 5) << name;
          expectIndices(found, cloud->size(), name);
        }
    }
}

TEST_F(HostileScenes, RegionSearchWithPointsThatComeAndGo)
{
  for (const auto& [cloud_name, cloud] : hostileClouds())
    for (const auto backend : {Search::Octree, Search::AVL}) {
      const std::string name =
          cloud_name + ", backend " + std::to_string(static_cast<int>(backend));
      Search search(backend);
      std::vector<pcl::index_t> added;
      for (const auto& p : *cloud)
        if (const auto index = search.addPoint(p); index >= 0)
          added.push_back(index);
      EXPECT_EQ(search.size(), added.size()) << name;
      std::vector<Cell> cells;
      search.getCells(cells);
      EXPECT_LE(cells.size(), added.size()) << name;
      for (const auto index : added)
        EXPECT_TRUE(search.removePoint(index)) << name;
      EXPECT_EQ(search.size(), 0U) << name;
    }
}

TEST_F(HostileScenes, MeanSurflets)
{
  for (const auto& [name, cloud] : hostileClouds())
    for (const float leaf : {0.1F, 1e-35F, 1e30F}) {
      MeanSurfletGrid<pcl::PointNormal> grid(true);
      grid.setInputCloud(cloud);
      grid.setLeafSize(leaf);
      HostileCloud out;
      grid.filter(out);
      EXPECT_LE(out.size(), cloud->size()) << name;
      EXPECT_EQ(grid.getPointCounts().size(), out.size()) << name;
      const auto& counts = grid.getPointCounts();
      EXPECT_LE(std::accumulate(counts.begin(), counts.end(), std::size_t{0}), cloud->size())
          << name;
      for (const auto& p : out)
        EXPECT_TRUE(pcl::isFinite(p) && std::abs(p.getNormalVector3fMap().norm() - 1) < 1e-3F)
            << name << ", leaf " << leaf;
    }
}

TEST_F(HostileScenes, InterpretedScenes)
{
  for (const auto& [name, cloud] : hostileClouds())
    for (const auto method : {Method::Explanation, Method::Dissertation})
      for (const bool plane : {false, true}) {
        SceneInterpreter<pcl::PointNormal> interpreter;
        interpreter.setInputCloud(cloud);
        interpreter.setDatabase(database());
        interpreter.setMethod(method);
        if (plane)
          interpreter.setBackgroundPlanes({BackgroundPlane()});
        const auto objects = interpreter.interpret();
        for (const auto& object : objects)
          expectIndices(object.indices, cloud->size(), name);
        EXPECT_TRUE(!objects.empty() || !interpreter.getDiagnostics().reason.empty()) << name;
        pcl::PointCloud<pcl::PointXYZL> labelled;
        interpreter.labelCloud(objects, labelled);
        EXPECT_EQ(labelled.size(), cloud->size()) << name;
      }
}

TEST_F(HostileScenes, OnlineScenes)
{
  OnlineParameters parameters;
  parameters.leaf = 0.1;
  for (const auto& [name, cloud] : hostileClouds()) {
    OnlineSceneInterpreter online(database(), parameters);
    for (int scan = 0; scan < 2; ++scan) {
      const OnlineScan result = online.addScan(*cloud, Eigen::Vector3f(0, 0, 5));
      EXPECT_EQ(result.surflets + result.rejected + result.background, cloud->size()) << name;
      EXPECT_EQ(result.cells, online.cells().size()) << name;
    }
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(online.addScan(*cloud, Eigen::Vector3f(nan, 0, 0)), std::invalid_argument);
    for (const auto& d : online.detections())
      for (const auto cell : d.cells)
        EXPECT_LT(cell, online.cells().size()) << name;
  }
}

TEST_F(HostileScenes, Poses)
{
  const auto model = PoseModel::train("ball", toSurflets(*unitBall(5000)).surflets);
  for (const auto& [name, cloud] : hostileClouds()) {
    PoseEstimator<pcl::PointNormal> estimator;
    estimator.setInputCloud(cloud);
    estimator.setModels({model});
    estimator.setViewpoints({Eigen::Vector3f(0, 0, 10)});
    std::vector<SceneDetection> detections(2);
    for (auto& d : detections)
      d.label = "ball";
    detections[0].indices.resize(cloud->size());
    std::iota(detections[0].indices.begin(), detections[0].indices.end(), 0);
    const auto poses = estimator.estimate(detections);
    EXPECT_TRUE(poses.empty() || poses.size() == 2) << name;
    for (const auto& pose : poses)
      EXPECT_TRUE(pose.status == PoseStatus::Found ? toIsometry(pose.motion).matrix().allFinite()
                                                   : !pose.reason.empty())
          << name;
    try {
      PoseModel::train("x", toSurflets(*cloud).surflets);
    }
    catch (const PoseModelError&) {
    }
  }
}

/** Ten million points need some 2 GB; by default a hundredth of it:
 * PCL_SURFLET_HUGE_POINTS=10000000 test_hostile_scenes --gtest_filter='*HugeClouds' */
TEST_F(HostileScenes, HugeClouds)
{
  const char* asked = std::getenv("PCL_SURFLET_HUGE_POINTS");
  const std::size_t n = asked != nullptr ? std::strtoull(asked, nullptr, 10) : 100000;
  const auto cloud = unitBall(n);
  Search search;
  search.setInputCloud(cloud);
  EXPECT_EQ(search.size(), n);
  pcl::Indices found;
  std::vector<float> squared;
  EXPECT_EQ(search.radiusSearch((*cloud)[0], 3, found, squared), static_cast<int>(n));
  MeanSurfletGrid<pcl::PointNormal> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(0.05F);
  HostileCloud cells;
  grid.filter(cells);
  const auto& counts = grid.getPointCounts();
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::size_t{0}), n);
  HistogramModelTrainer trainer;
  trainer.setNumberOfPairs(100000);
  // No ball: its exact largest distance takes n^1.5, a quarter of an hour for 10 million points.
  EXPECT_EQ(trainer.train("huge", sampleShape(*shapeByName("cup"), n, 3)).problem(), "");
  SceneInterpreter<pcl::PointNormal> interpreter;
  interpreter.setInputCloud(cloud);
  interpreter.setDatabase(database());
  const auto objects = interpreter.interpret();
  std::size_t found_points = 0;
  for (const auto& object : objects)
    found_points += object.indices.size();
  EXPECT_GT(found_points, n / 2) << interpreter.getDiagnostics().reason;
}
