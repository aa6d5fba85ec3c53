// What carries the objects: ignored, sensed before, or found as planes.
#include "two_object_scene.h"

#include <pcl/search/kdtree.h>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

namespace {

/** \brief The same objects on a background. */
struct Backed {
  SceneOptions options;
  Scene scene;

  explicit Backed(Background background)
  {
    options.background = background;
    options.size = 0.6;
    options.density = 100000;
    options.seed = 5;
    scene = generateScene(
        {sceneItem("bottle", *shapeByName("bottle")), sceneItem("torus", *shapeByName("torus"))},
        {}, options);
  }
};

} // namespace

TEST(SceneInterpreter, ABackgroundThatIsIgnoredIsNoObject)
{
  auto interpreter = ready();
  SceneOptions table;
  table.density = 50000;
  interpreter.setInputCloud(cloudOf(emptyBackground(table)));
  EXPECT_TRUE(interpreter.interpret().empty());
  EXPECT_NE(interpreter.getDiagnostics().reason.find("no model explains"), std::string::npos)
      << interpreter.getDiagnostics().reason;
}

TEST(SceneInterpreter, ExcludesAnEmptyScene)
{
  const Backed backed(Background::Bowl);
  auto interpreter = ready();
  interpreter.setInputCloud(cloudOf(backed.scene.surflets));
  interpreter.setBackgroundCloud(cloudOf(emptyBackground(backed.options)));
  expectBoth(interpreter.interpret(), backed.scene);
  EXPECT_GT(interpreter.getDiagnostics().background_points, 30000u);
  // A search of PCL's serves as well, and is used.
  pcl::search::KdTree<pcl::PointNormal>::Ptr tree(new pcl::search::KdTree<pcl::PointNormal>);
  const auto excluded = interpreter.getDiagnostics().background_points;
  interpreter.setSearchMethod(tree);
  expectBoth(interpreter.interpret(), backed.scene);
  EXPECT_TRUE(tree->getInputCloud() != nullptr);
  EXPECT_NEAR(double(interpreter.getDiagnostics().background_points), double(excluded),
              0.001 * double(excluded));
  // The background itself holds no object.
  interpreter.setInputCloud(cloudOf(emptyBackground(backed.options)));
  EXPECT_TRUE(interpreter.interpret().empty());
  EXPECT_EQ(interpreter.getDiagnostics().reason, "all points are background");
}

TEST(SceneInterpreter, ExcludesPlanes)
{
  const Backed backed(Background::Corner);
  auto interpreter = ready();
  interpreter.setInputCloud(cloudOf(backed.scene.surflets));
  BackgroundPlane table, any;
  table.normal = {0, 0, 2};
  interpreter.setBackgroundPlanes({table, any});
  expectBoth(interpreter.interpret(), backed.scene);
  EXPECT_EQ(interpreter.getDiagnostics().planes, 2u);
  BackgroundPlane slope; // there is none that faces this way
  slope.normal = {1, 0, 1};
  interpreter.setBackgroundPlanes({slope});
  interpreter.interpret();
  EXPECT_EQ(interpreter.getDiagnostics().planes, 0u);
  EXPECT_EQ(interpreter.getDiagnostics().background_points, 0u);
}

TEST(SceneInterpreter, WhatStandsOnTheBackgroundKeepsItsUnderside)
{
  const Backed backed(Background::Plane);
  auto interpreter = ready();
  interpreter.setInputCloud(cloudOf(backed.scene.surflets));
  interpreter.setBackgroundPlanes({{}});
  const std::size_t table = std::size_t(
      std::count(backed.scene.labels.begin(), backed.scene.labels.end(), std::uint32_t{0}));
  interpreter.interpret();
  const std::size_t excluded = interpreter.getDiagnostics().background_points;
  EXPECT_GE(excluded, table);
  EXPECT_LT(excluded, table + table / 50) << "what turns up inside the bottle may go";
  ExclusionOptions whatever_it_faces;
  whatever_it_faces.max_angle = M_PI;
  interpreter.setExclusionOptions(whatever_it_faces);
  interpreter.interpret();
  EXPECT_GT(interpreter.getDiagnostics().background_points, excluded + table / 50);
}

TEST(SceneInterpreter, TheBackgroundNeedsNormals)
{
  SceneInterpreter<pcl::PointXYZ, pcl::Normal> interpreter;
  pcl::PointCloud<pcl::PointXYZ>::Ptr points(new pcl::PointCloud<pcl::PointXYZ>(3, 1));
  interpreter.setInputCloud(points);
  interpreter.setInputNormals(
      pcl::PointCloud<pcl::Normal>::Ptr(new pcl::PointCloud<pcl::Normal>(3, 1)));
  interpreter.setDatabase(database());
  interpreter.setBackgroundCloud(points);
  const Quiet quiet;
  EXPECT_TRUE(interpreter.interpret().empty());
  EXPECT_EQ(interpreter.getDiagnostics().status, SceneStatus::NoNormals);
  EXPECT_NE(interpreter.getDiagnostics().reason.find("background"), std::string::npos);
}
