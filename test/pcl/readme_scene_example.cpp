// The lines of the README that interpret a scene, compiled and run: a bottle and a torus on a
// table.

#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/database_file.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/scene_interpreter.h"

#include <pcl/point_types.h>

#include <cstdio>
#include <cstdlib>

namespace {

void
makeDatabase(const char* path)
{
  pcl_surflet::ModelDatabase database;
  pcl_surflet::HistogramModelTrainer trainer;
  trainer.setResolution({7, 7, 7, 7});
  trainer.setNumberOfPairs(1000000);
  for (const auto* name : {"bottle", "torus"})
    database.add(
        trainer.train(name, pcl_surflet::sampleShape(*pcl_surflet::shapeByName(name), 20000, 1)));
  pcl_surflet::saveDatabase(database, path);
}

pcl_surflet::Scene
makeScene()
{
  pcl_surflet::SceneOptions options;
  options.size = 0.6;
  options.density = 100000;
  const auto item = [](const char* name) {
    return pcl_surflet::sceneItem(name, *pcl_surflet::shapeByName(name));
  };
  return pcl_surflet::generateScene({item("bottle"), item("torus")}, {}, options);
}

} // namespace

int
main()
{
  const char* path = "readme_scene_example.pcd";
  makeDatabase(path);
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
  const auto scene = makeScene();
  for (std::size_t i = 0; i < scene.surflets.size(); ++i) {
    const auto s = scene.surflets[i];
    cloud->push_back({s.x, s.y, s.z});
    normals->push_back({s.nx, s.ny, s.nz});
  }

  // README: begin
  pcl_surflet::SceneInterpreter<pcl::PointXYZ, pcl::Normal> interpreter;
  interpreter.setInputCloud(cloud);
  interpreter.setInputNormals(normals);
  interpreter.setDatabase(pcl_surflet::loadDatabase(path));
  interpreter.setBackgroundPlanes({pcl_surflet::BackgroundPlane()}); // the objects stand on a table
  const auto objects = interpreter.interpret();
  for (const auto& object : objects)
    std::printf("%s: %zu points, confidence %.2f\n", object.label.c_str(), object.indices.size(),
                object.confidence);
  pcl::PointCloud<pcl::PointXYZL> labelled;
  interpreter.labelCloud(objects, labelled);
  // README: end

  std::remove(path);
  return objects.size() == 2 && labelled.size() == cloud->size() ? EXIT_SUCCESS : EXIT_FAILURE;
}
