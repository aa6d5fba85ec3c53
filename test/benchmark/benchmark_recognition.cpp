// Training against the normals a user has to estimate first, classification against the descriptor
// a user would take instead. Wall time; training with all threads on both sides, classification
// with one.

#include "ratio_reporter.h"

#include "pcl_surflet/conversions.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/recognition/histogram_classifier.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"

#include <pcl/features/normal_3d_omp.h>
#include <pcl/features/vfh.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

using namespace pcl_surflet;
using Cloud = pcl::PointCloud<pcl::PointNormal>;

namespace {

Cloud::Ptr
cloudOf(const std::string& name, std::size_t points)
{
  const auto s = sampleShape(*shapeByName(name), points, 3);
  Cloud::Ptr cloud(new Cloud);
  for (std::size_t i = 0; i < s.size(); ++i) {
    pcl::PointNormal p;
    p.x = s.x[i];
    p.y = s.y[i];
    p.z = s.z[i];
    p.normal_x = s.nx[i];
    p.normal_y = s.ny[i];
    p.normal_z = s.nz[i];
    cloud->push_back(p);
  }
  return cloud;
}

void
peerNormals(benchmark::State& state)
{
  const auto cloud = cloudOf("cup", 100000);
  for (auto _ : state) {
    pcl::NormalEstimationOMP<pcl::PointNormal, pcl::Normal> estimation;
    estimation.setInputCloud(cloud);
    estimation.setKSearch(20);
    pcl::PointCloud<pcl::Normal> normals;
    estimation.compute(normals);
    benchmark::DoNotOptimize(normals);
  }
}

void
train(benchmark::State& state)
{
  const auto cloud = cloudOf("cup", 100000);
  const HistogramModelTrainer trainer; // 10,000,000 pairs
  for (auto _ : state)
    benchmark::DoNotOptimize(trainer.train("cup", toSurflets(*cloud).surflets));
}

void
peerVfh(benchmark::State& state)
{
  const auto cloud = cloudOf("cup", 4000);
  for (auto _ : state) {
    pcl::VFHEstimation<pcl::PointNormal, pcl::PointNormal> estimation;
    estimation.setInputCloud(cloud);
    estimation.setInputNormals(cloud);
    estimation.setSearchMethod(
        pcl::search::KdTree<pcl::PointNormal>::Ptr(new pcl::search::KdTree<pcl::PointNormal>));
    pcl::PointCloud<pcl::VFHSignature308> descriptor;
    estimation.compute(descriptor);
    benchmark::DoNotOptimize(descriptor);
  }
}

/** \brief Twenty models: every shape, and some of them in another size. */
ModelDatabase
twentyModels()
{
  ModelDatabase database;
  HistogramModelTrainer trainer;
  trainer.setNumberOfPairs(200000);
  const auto names = shapeNames();
  for (std::size_t i = 0; i < 20; ++i) {
    auto model = trainer.train(names[i % names.size()],
                               sampleShape(*shapeByName(names[i % names.size()]), 3000, i));
    model.label += std::to_string(i);
    const double factor = 1 + 0.01 * static_cast<double>(i);
    for (double* length : {&model.delta_max, &model.r_mean, &model.r_max, &model.r_min})
      *length *= factor;
    database.add(model);
  }
  return database;
}

void
classify(benchmark::State& state)
{
  const auto cloud = cloudOf("cup", 4000);
  const HistogramClassifier classifier(twentyModels());
  for (auto _ : state)
    benchmark::DoNotOptimize(classifier.classify(toSurflets(*cloud).surflets));
}

} // namespace

int
main(int argc, char** argv)
{
  benchmark::RegisterBenchmark("train/peer_NormalEstimationOMP_100k", peerNormals)->UseRealTime();
  benchmark::RegisterBenchmark("train/trainer_100k_10M_pairs", train)->UseRealTime();
  benchmark::RegisterBenchmark("classify/peer_VFHEstimation_4000", peerVfh)->UseRealTime();
  benchmark::RegisterBenchmark("classify/20_models_4000", classify)->UseRealTime();
  return pcl_surflet_benchmark::runWithRatios(argc, argv);
}
