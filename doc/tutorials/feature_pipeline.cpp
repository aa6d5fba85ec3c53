// Tutorial: SurfletPairFeature in a pipeline of PCL.

#include "tutorial_data.h"

#include "pcl_surflet/conversions.h"
#include "pcl_surflet/model_bank_trainer.h"
#include "pcl_surflet/recognition/histogram_classifier.h"
#include "pcl_surflet/surflet_pair_feature.h"

#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/filter.h>
#include <pcl/filters/voxel_grid.h>

#include <cstdio>
#include <cstdlib>

namespace {

// training: begin
/** \brief Models of what a camera sees of each object: eight members for views of it. */
pcl_surflet::ModelDatabase
trainedDatabase(const std::vector<std::string>& names)
{
  const auto bank = pcl_surflet::ModelBank::parse("normals 4\nview noise 0.3 members 8\n");
  const pcl_surflet::ModelBankTrainer trainer(pcl_surflet::HistogramModelTrainer(), bank);
  pcl_surflet::ModelDatabase database;
  for (const auto& name : names) {
    const auto shape = pcl_surflet::shapeByName(name); // your mesh: pcl_surflet::loadSurface()
    database.add(trainer.train(name, pcl_surflet::meshOf(*shape, 5000)));
  }
  return database;
}
// training: end

// criterion: begin
/** \brief Most of the pairs' histogram that a member of \p model shares [Wahl 2007, Eq. 3.7]. */
double
likeness(const pcl::PointCloud<pcl_surflet::SurfletPairSignature>& pairs,
         const pcl_surflet::HistogramModel& model)
{
  pcl_surflet::Histogram counts(static_cast<std::size_t>(model.resolution.bins()));
  for (const auto& p : pairs) {
    const pcl_surflet::PairFeature f{p.alpha, p.beta, p.gamma, p.delta};
    counts[std::size_t(pcl_surflet::binIndex(f, model.resolution, model.delta_max))] +=
        1.0 / double(pairs.size());
  }
  double best = 0;
  for (const auto& member : model.members)
    best = std::max(best, pcl_surflet::intersection(
                              {member.histogram.begin(), member.histogram.end()}, counts));
  return best;
}
// criterion: end

/** \brief Whether both ways name the object in \p raw rightly. */
bool
namedRightly(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& raw, const std::string& truth,
             const pcl_surflet::ModelDatabase& database)
{
  // pipeline: begin
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  pcl::Indices kept;
  pcl::removeNaNFromPointCloud(*raw, *cloud, kept);

  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(0.004f, 0.004f, 0.004f);
  pcl::PointCloud<pcl::PointXYZ>::Ptr thinned(new pcl::PointCloud<pcl::PointXYZ>);
  grid.filter(*thinned);

  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(thinned);
  estimation.setRadiusSearch(0.015);
  estimation.setViewPoint(0, 0, 0); // the camera: normals must point outwards
  pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
  estimation.compute(*normals);

  pcl_surflet::SurfletPairFeature<pcl::PointXYZ, pcl::Normal> feature; // as pcl::VFHEstimation
  feature.setInputCloud(thinned);
  feature.setInputNormals(normals);
  feature.setNumberOfPairs(20000);
  pcl::PointCloud<pcl_surflet::SurfletPairSignature> pairs;
  feature.compute(pairs); // (alpha, beta, gamma, delta) and the two indices of each pair
  // pipeline: end

  // classification: begin
  std::string most_alike; // by hand
  double most = 0;
  for (std::size_t i = 0; i < database.size(); ++i)
    if (const double l = likeness(pairs, database[i]); l > most) {
      most = l;
      most_alike = database[i].label;
    }

  pcl::Indices all(thinned->size()); // or let the classifier draw pairs itself
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = pcl::index_t(i);
  const pcl_surflet::HistogramClassifier classifier(database);
  const auto answer =
      classifier.classify(pcl_surflet::toSurflets(*thinned, *normals, all).surflets);
  std::printf("%s: most alike %s (%.2f of the histogram), classified as %s (%s, posterior %.3f)\n",
              truth.c_str(), most_alike.c_str(), most, answer.ranking.front().label.c_str(),
              answer.ranking.front().condition.c_str(), answer.ranking.front().posterior);
  // classification: end
  return most_alike == truth && answer.ranking.front().label == truth;
}

} // namespace

int
main()
{
  const std::vector<std::string> names{"bottle", "cup", "box", "torus"};
  const auto database = trainedDatabase(names);
  bool right = true;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto cloud =
        tutorial::seenAlone(*pcl_surflet::shapeByName(names[i]), 70.0 * double(i), i);
    right = namedRightly(cloud, names[i], database) && right;
  }
  return right ? EXIT_SUCCESS : EXIT_FAILURE;
}
