// The ten lines of the README, compiled and run: trains two models and classifies a cloud with
// them.

#include "pcl_surflet/conversions.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/database_file.h"
#include "pcl_surflet/recognition/histogram_classifier.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"

#include <pcl/common/io.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/point_types.h>

#include <cstdio>
#include <cstdlib>

namespace {

/** \brief A sensed half of a cup: points without normals, seen from +x. */
pcl::PointCloud<pcl::PointXYZ>::Ptr
sensedCloud()
{
  const auto cup = pcl_surflet::sampleShape(*pcl_surflet::shapeByName("cup"), 8000, 7);
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  for (std::size_t i = 0; i < cup.size(); ++i)
    if (cup.nx[i] > 0)
      cloud->push_back({cup.x[i], cup.y[i], cup.z[i]});
  return cloud;
}

void
makeDatabase(const char* path)
{
  pcl_surflet::ModelDatabase database;
  pcl_surflet::HistogramModelTrainer trainer;
  for (const auto* name : {"cup", "bottle", "box"})
    database.add(
        trainer.train(name, pcl_surflet::sampleShape(*pcl_surflet::shapeByName(name), 8000, 1)));
  pcl_surflet::saveDatabase(database, path);
}

} // namespace

int
main()
{
  const char* path = "readme_example.pcd";
  makeDatabase(path);
  const auto cloud = sensedCloud();

  // README: begin
  pcl::PointCloud<pcl::Normal> normals; // you have this already
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setKSearch(20);
  estimation.setViewPoint(10, 0, 0); // your sensor's place: normals must point outwards
  estimation.compute(normals);

  const auto database = pcl_surflet::loadDatabase(path);
  const pcl_surflet::HistogramClassifier classifier(database);
  pcl::PointCloud<pcl::PointNormal> oriented;
  pcl::concatenateFields(*cloud, normals, oriented);
  const auto answer = classifier.classify(pcl_surflet::toSurflets(oriented).surflets);
  if (const auto* best = answer.best())
    std::printf("%s (posterior %.3f)\n", best->label.c_str(), best->posterior);
  // README: end

  std::remove(path);
  return answer.best() != nullptr && answer.best()->label == "cup" ? EXIT_SUCCESS : EXIT_FAILURE;
}
