// Scans as PCL's clouds: frames and normals.
#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/online_scene_interpreter.h"
#include "pcl_surflet/recognition/scene_training.h"
#include "pcl_surflet/sensed_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

using namespace pcl_surflet;

namespace {

OnlineSceneInterpreter
interpreter(double leaf = 0.1)
{
  HistogramModelTrainer trainer;
  trainer.setNumberOfPairs(10000);
  ModelDatabase database;
  database.add(trainer.train("torus", sceneItem("torus", *shapeByName("torus")).sample(1000, 1)));
  OnlineParameters p;
  p.leaf = leaf;
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

/** \brief Table and bottle, or the table alone, as a sensor that moves past sees them. */
std::vector<pcl::PointCloud<pcl::PointNormal>>
sensed(bool with_bottle, std::uint64_t seed)
{
  SceneOptions o;
  o.size = 2; // rays past the bottle end on it
  o.density = 20000;
  std::vector<SensedBody> bodies = backgroundBodies(o);
  const std::vector<SceneItem> items = {sceneItem("bottle", *shapeByName("bottle"))};
  o.size = 0.6;
  o.background = Background::None;
  if (with_bottle)
    bodies.push_back(bodiesOf(generateScene(items, {}, o), items, {}, o).at(0));
  SceneSensing sensing;
  sensing.sensor.columns = 200;
  sensing.sensor.rows = 150;
  sensing.sensor.opening = 40;
  sensing.sensor.noise = 0.0005;
  sensing.views.views = ViewSet::Pass;
  sensing.views.distance = 1;
  sensing.views.stops = 6;
  sensing.views.path = 0.6;
  std::vector<pcl::PointCloud<pcl::PointNormal>> clouds;
  for (const auto& s : senseViews(bodies, sensing, seed)) {
    pcl::PointCloud<pcl::PointNormal> cloud;
    for (std::size_t i = 0; i < s.nx.size(); ++i)
      cloud += onePoint(s.scan.x[i], s.scan.y[i], s.scan.z[i], s.nx[i], s.ny[i], s.nz[i]);
    const auto& at = s.scan.frame.position;
    const auto q = s.scan.frame.quaternion();
    cloud.sensor_origin_ = Eigen::Vector4d(at[0], at[1], at[2], 0).cast<float>();
    cloud.sensor_orientation_ = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).cast<float>();
    clouds.push_back(cloud);
  }
  return clouds;
}

/** \brief Cells above \p height. */
std::size_t
above(const OnlineInterpretation& online, float height)
{
  const auto& z = online.cells().z;
  return static_cast<std::size_t>(
      std::count_if(z.begin(), z.end(), [&](float v) { return v > height; }));
}

TEST(OnlineSceneInterpreter, ScansOfWhatStaysTakeNothingAwayAndThoseOfATableTheBottle)
{
  auto online = interpreter(0.006);
  std::size_t vanished = 0;
  for (const std::uint64_t seed : {1, 2})
    for (const auto& cloud : sensed(true, seed))
      vanished += online.addScanInSensorFrame(cloud).vanished_cells;
  const std::size_t before = above(online, 0.02F);
  ASSERT_GT(before, 800U);
  EXPECT_LT(vanished, online.cells().size() / 500);
  for (const auto& cloud : sensed(false, 3))
    online.addScanInSensorFrame(cloud);
  EXPECT_LT(above(online, 0.02F), before / 50);
}

TEST(OnlineSceneInterpreter, RefusesWhatIsNoPose)
{
  auto online = interpreter();
  auto cloud = onePoint(0, 0, 2, 0, 0, -1);
  cloud.sensor_orientation_.coeffs().setZero();
  EXPECT_THROW(online.addScanInSensorFrame(cloud), std::invalid_argument);
}

} // namespace
