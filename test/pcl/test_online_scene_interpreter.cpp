// Scans as PCL's clouds: frames and normals.
#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/online_scene_interpreter.h"
#include "pcl_surflet/recognition/scene_training.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

using namespace pcl_surflet;

namespace {

OnlineSceneInterpreter
interpreter()
{
  HistogramModelTrainer trainer;
  trainer.setNumberOfPairs(10000);
  ModelDatabase database;
  database.add(trainer.train("torus", sceneItem("torus", *shapeByName("torus")).sample(1000, 1)));
  OnlineParameters p;
  p.leaf = 0.1;
  return {database, p};
}

pcl::PointCloud<pcl::PointNormal>
onePoint(float x, float y, float z, float nx, float ny, float nz)
{
  pcl::PointCloud<pcl::PointNormal> cloud;
  pcl::PointNormal p;
  p.getVector3fMap() << x, y, z;
  p.getNormalVector3fMap() << nx, ny, nz;
  cloud.push_back(p);
  return cloud;
}

TEST(OnlineSceneInterpreter, TheSensorsPoseMovesAndTurnsTheScan)
{
  auto online = interpreter();
  auto cloud = onePoint(0, 0, 2, 0, 0, -1);
  cloud.sensor_origin_ << 1, 0, 0, 0;
  cloud.sensor_orientation_ = Eigen::AngleAxisf(1.57079633F, Eigen::Vector3f::UnitY());
  online.addScanInSensorFrame(cloud);
  ASSERT_EQ(online.cells().size(), 1U); // z of the sensor is x of the scene
  EXPECT_NEAR(online.cells().x[0], 3, 1e-5);
  EXPECT_NEAR(online.cells().z[0], 0, 1e-5);
  EXPECT_NEAR(online.cells().nx[0], -1, 1e-5);
}

TEST(OnlineSceneInterpreter, NormalsAreTurnedToTheSensor)
{
  auto online = interpreter();
  pcl::PointCloud<pcl::PointXYZ> points;
  pcl::PointCloud<pcl::Normal> normals;
  points.push_back({0, 0, 0});
  normals.push_back({0, 0, 1});
  points.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  normals.push_back({0, 0, 1});
  const auto scan = online.addScan(points, normals, {0, 0, -1});
  EXPECT_EQ(scan.surflets, 1U);
  EXPECT_EQ(scan.rejected, 1U);
  EXPECT_FLOAT_EQ(online.cells().nz[0], -1);
  normals.push_back({0, 0, 1});
  EXPECT_THROW(online.addScan(points, normals, {0, 0, -1}), std::invalid_argument);
}

TEST(OnlineSceneInterpreter, RefusesWhatIsNoPose)
{
  auto online = interpreter();
  auto cloud = onePoint(0, 0, 2, 0, 0, -1);
  cloud.sensor_orientation_.coeffs().setZero();
  EXPECT_THROW(online.addScanInSensorFrame(cloud), std::invalid_argument);
}

} // namespace
