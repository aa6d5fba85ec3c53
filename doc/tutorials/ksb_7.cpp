// Tutorial: what is in a cloud of a Kinect?

#include "tutorial_data.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/octree_region_search.h"
#include "pcl_surflet/scene_interpreter.h"
#include "pcl_surflet/view_training.h"

#include <pcl/features/normal_3d_omp.h>
#include <pcl/io/pcd_io.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

constexpr double kLeaf = 0.01;

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;

// normals: begin
/** \brief Normals of a cloud in its camera's frame, turned to the camera. */
Normals::Ptr
normalsOf(const Cloud::ConstPtr& cloud)
{
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud); // NaN where nothing returned: no normal there
  estimation.setSearchMethod(std::make_shared<pcl_surflet::OctreeRegionSearch<pcl::PointXYZ>>());
  estimation.setRadiusSearch(0.015); // some three pixels, and more than the noise
  estimation.setViewPoint(0, 0, 0);  // the camera; not its pose in a world, which the file may name
  Normals::Ptr normals(new Normals);
  estimation.compute(*normals);
  for (std::size_t i = 0; i < cloud->size(); ++i) { // seen too flat: which side, nobody knows
    auto& n = (*normals)[i];
    const auto& p = (*cloud)[i];
    const float facing = -(n.normal_x * p.x + n.normal_y * p.y + n.normal_z * p.z) /
                         std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    if (!(facing > 0.087f)) // 85 degrees off
      n.normal_x = n.normal_y = n.normal_z = NAN;
  }
  return normals;
}
// normals: end

// background: begin
/** \brief A model of the empty table, which has no objects on it. */
pcl_surflet::HistogramModel
trainedBackground(const Cloud& empty, double largest_object)
{
  const auto normals = normalsOf(empty.makeShared());
  const auto& middle = empty.at(empty.width / 2, empty.height / 2);
  pcl::Indices near; // a piece as large as the largest object
  for (std::size_t i = 0; i < empty.size(); ++i)
    if ((empty[i].getVector3fMap() - middle.getVector3fMap()).norm() < largest_object / 2)
      near.push_back(pcl::index_t(i));
  pcl_surflet::HistogramModelTrainer trainer;
  trainer.setResolution({7, 7, 7, 7});
  trainer.setRole(pcl_surflet::ModelRole::Background);
  return trainer.train("table", pcl_surflet::reduceToCells(
                                    pcl_surflet::toSurflets(empty, *normals, near).surflets, kLeaf)
                                    .cells);
}
// background: end

/** \brief What the driver gives: the table with and without objects, in the camera's frame. */
struct Captures {
  std::vector<pcl_surflet::SceneItem> items;
  pcl_surflet::DepthScan full, empty;
};

Captures
capture()
{
  Captures c;
  for (const auto* name : {"bottle", "torus", "box"})
    c.items.push_back(pcl_surflet::sceneItem(name, *pcl_surflet::shapeByName(name)));
  pcl_surflet::SceneOptions options;
  options.size = 0.8;
  options.density = 20000;
  options.seed = 7;
  pcl_surflet::DepthSensor kinect = tutorial::camera();
  kinect.columns = 640;
  kinect.rows = 480;
  kinect.noise_power = 2; // as triangulation: four times as much at twice the distance
  kinect.flying = 0.3;
  kinect.grazing = 80;
  pcl_surflet::ViewOptions view;
  view.views = pcl_surflet::ViewSet::One;
  view.distance = 1.1;
  const auto pose = pcl_surflet::sensorPoses(view).front();
  const auto scene = pcl_surflet::generateScene(c.items, {}, options);
  c.full = pcl_surflet::sense(bodiesOf(scene, c.items, {}, options), kinect, pose, 1);
  c.empty = pcl_surflet::sense(backgroundBodies(options), kinect, pose, 2);
  return c;
}

} // namespace

int
main()
{
  const auto captures = capture();
  const std::string path = "ks_7.pcd";
  pcl::io::savePCDFileBinary(path, *tutorial::organised(captures.full));
  const auto empty = tutorial::organised(captures.empty);

  // models: begin
  pcl_surflet::HistogramModelTrainer trainer;
  trainer.setResolution({7, 7, 7, 7});
  pcl_surflet::ModelDatabase database;
  for (const auto& item : captures.items) // your mesh: sceneItem ("cup", *loadSurface (path).mesh)
    database.add(
        pcl_surflet::trainForSensors(trainer, item, pcl_surflet::sensingFor(item, kLeaf), kLeaf));
  database.add(trainedBackground(*empty, database.largestDelta()));
  // models: end

  // interpret: begin
  Cloud::Ptr cloud(new Cloud); // 640 x 480, z forward
  pcl::io::loadPCDFile(path, *cloud);
  pcl_surflet::SceneInterpreter<pcl::PointXYZ, pcl::Normal> interpreter;
  interpreter.setInputCloud(cloud);
  interpreter.setInputNormals(normalsOf(cloud));
  interpreter.setDatabase(database);
  interpreter.setLeafSize(kLeaf);
  interpreter.setBackgroundCloud(empty, normalsOf(empty));
  const auto objects = interpreter.interpret();
  for (const auto& object : objects)
    std::printf("%s at %.2f m, confidence %.2f\n", object.label.c_str(), object.centroid[2],
                object.confidence);
  if (objects.empty())
    std::printf("nothing: %s\n", interpreter.getDiagnostics().reason.c_str());
  // interpret: end

  std::remove(path.c_str());
  std::size_t right = 0;
  for (const auto& object : objects) {
    std::size_t own = 0;
    for (const auto i : object.indices)
      own += captures.full.labels[std::size_t(i)] == object.model + 1 ? 1 : 0;
    right += own > 0.85 * double(object.indices.size()) ? 1 : 0;
  }
  std::printf("%zu of %zu outlined right\n", right, captures.items.size());
  return right == 3 && objects.size() == 3 ? EXIT_SUCCESS : EXIT_FAILURE;
}
