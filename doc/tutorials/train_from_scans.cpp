// Tutorial: models from scans of an object, for scenes that are seen from one side.

#include "tutorial_data.h"

#include "pcl_surflet/conversions.h"
#include "pcl_surflet/recognition/scene_training.h"
#include "pcl_surflet/scene_interpreter.h"
#include "pcl_surflet/sensed_scene.h"

#include <pcl/common/transforms.h>

#include <cstdio>
#include <cstdlib>

namespace {

constexpr double kLeaf = 0.01; // edge of the cells, here and in the scenes to come

using Scan = pcl::PointCloud<pcl::PointNormal>;

/** \brief A scan as a cloud in its sensor's frame, with the sensor's pose in it. */
Scan::Ptr
asCloud(const pcl_surflet::OrientedScan& s)
{
  Scan::Ptr cloud(new Scan);
  const auto points = tutorial::organised(s.scan);
  pcl::copyPointCloud(*points, *cloud);
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    (*cloud)[i].normal_x = s.nx[i];
    (*cloud)[i].normal_y = s.ny[i];
    (*cloud)[i].normal_z = s.nz[i];
  }
  return cloud;
}

/** \brief What you have: scans of the object alone on a turntable, taken every 45 degrees. */
std::vector<Scan::Ptr>
scansOf(const pcl_surflet::SceneItem& item)
{
  pcl_surflet::SceneSensing sensing;
  sensing.sensor = tutorial::camera();
  sensing.views.views = pcl_surflet::ViewSet::One;
  sensing.views.distance = 0.7;
  std::vector<Scan::Ptr> scans;
  for (int k = 0; k < 8; ++k) {
    sensing.views.azimuth = 45 * k;
    scans.push_back(asCloud(pcl_surflet::scansAlone(item, sensing, std::uint64_t(k)).front()));
  }
  return scans;
}

// train: begin
/** \brief A model of the object in \p scans, which lie in their sensors' frames. */
pcl_surflet::HistogramModel
trainedFromScans(const std::string& label, const std::vector<Scan::Ptr>& scans)
{
  std::vector<pcl_surflet::SurfletSet> views;
  Scan together;
  for (const auto& scan : scans) {
    Scan placed; // in the object's frame: the poses come from the turntable, or from registration
    pcl::transformPointCloudWithNormals(*scan, placed, scan->sensor_origin_.head<3>(),
                                        scan->sensor_orientation_);
    views.push_back(pcl_surflet::toSurflets(placed).surflets); // leaves out what is NaN
    together += placed;
  }
  pcl_surflet::HistogramModelTrainer trainer;
  trainer.setResolution({7, 7, 7, 7}); // for scenes
  auto model = pcl_surflet::trainForScenes(trainer, label,
                                           pcl_surflet::toSurflets(together).surflets, kLeaf);
  for (std::size_t k = 0; k < views.size(); ++k)
    pcl_surflet::addView(model, "view " + std::to_string(k), views[k], kLeaf);
  return model;
}
// train: end

/** \brief Bottle and torus on a table, seen by one camera: the points of all that it sees. */
pcl_surflet::Scene
sceneFromOneSide(const std::vector<pcl_surflet::SceneItem>& items)
{
  pcl_surflet::SceneOptions options;
  options.size = 0.6;
  options.density = 20000;
  options.seed = 11;
  pcl_surflet::SceneSensing sensing;
  sensing.sensor = tutorial::camera();
  sensing.sensor.columns = 640;
  sensing.sensor.rows = 480;
  sensing.views.views = pcl_surflet::ViewSet::One;
  const auto scene = pcl_surflet::generateScene(items, {}, options);
  return pcl_surflet::sensedScene(
      scene, pcl_surflet::senseViews(bodiesOf(scene, items, {}, options), sensing, 1));
}

} // namespace

int
main()
{
  std::vector<pcl_surflet::SceneItem> items;
  for (const auto* name : {"bottle", "torus"})
    items.push_back(pcl_surflet::sceneItem(name, *pcl_surflet::shapeByName(name)));
  pcl_surflet::ModelDatabase database;
  for (const auto& item : items)
    database.add(trainedFromScans(item.label, scansOf(item)));

  const auto scene = sceneFromOneSide(items);
  Scan::Ptr cloud(new Scan);
  for (std::size_t i = 0; i < scene.surflets.size(); ++i) {
    const auto s = scene.surflets[i];
    cloud->push_back({s.x, s.y, s.z, s.nx, s.ny, s.nz});
  }

  // interpret: begin
  pcl_surflet::SceneInterpreter<pcl::PointNormal> interpreter;
  interpreter.setInputCloud(cloud);
  interpreter.setDatabase(database);
  interpreter.setLeafSize(kLeaf);
  interpreter.setBackgroundPlanes({pcl_surflet::BackgroundPlane()});
  const auto objects = interpreter.interpret();
  for (const auto& object : objects)
    std::printf("%s: %zu points, looks like %s\n", object.label.c_str(), object.indices.size(),
                database[object.model].members[object.member].condition.c_str());
  // interpret: end

  std::size_t right = 0;
  for (const auto& object : objects) {
    std::size_t own = 0;
    for (const auto i : object.indices)
      own += scene.labels[std::size_t(i)] == object.model + 1 ? 1 : 0;
    right += own > 0.9 * double(object.indices.size()) ? 1 : 0;
  }
  std::printf("%zu of %zu outlined right\n", right, items.size());
  return right == 2 && objects.size() == 2 ? EXIT_SUCCESS : EXIT_FAILURE;
}
