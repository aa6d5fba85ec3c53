// A user's pipeline with PCL's own types: trains, saves, loads and names a cup, and catches what
// the library throws. Clouds go both ways between this file and the library.
#include <pcl_surflet/conversions.h>
#include <pcl_surflet/core/shapes.h>
#include <pcl_surflet/database_file.h>
#include <pcl_surflet/mean_surflet_grid.h>
#include <pcl_surflet/octree_region_search.h>
#include <pcl_surflet/recognition/histogram_classifier.h>
#include <pcl_surflet/recognition/histogram_model_trainer.h>

#include <pcl/point_types.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace {

pcl_surflet::SurfletSet
surfletsOf(const char* name, std::uint64_t seed)
{
  return pcl_surflet::sampleShape(*pcl_surflet::shapeByName(name), 4000, seed);
}

std::string
answerFor(const pcl_surflet::SurfletSet& query, const char* path)
{
  const pcl_surflet::HistogramClassifier classifier(pcl_surflet::loadDatabase(path));
  const auto answer = classifier.classify(query);
  return answer.best() == nullptr ? "nothing" : answer.best()->label;
}

pcl::PointCloud<pcl::PointNormal>::Ptr
cloudOf(const pcl_surflet::SurfletSet& set)
{
  pcl::PointCloud<pcl::PointNormal>::Ptr cloud(new pcl::PointCloud<pcl::PointNormal>);
  for (std::size_t i = 0; i < set.size(); ++i) {
    pcl::PointNormal p;
    p.x = set.x[i];
    p.y = set.y[i];
    p.z = set.z[i];
    p.normal_x = set.nx[i];
    p.normal_y = set.ny[i];
    p.normal_z = set.nz[i];
    cloud->push_back(p);
  }
  return cloud;
}

/** \brief Is \p Error caught by its own type, and by PCL's or std's above it? */
template <typename Error, typename Base, typename Call>
bool
throws(const Call& call)
{
  int caught = 0;
  try {
    call();
  }
  catch (const Error&) {
    ++caught;
  }
  try {
    call();
  }
  catch (const Base&) {
    ++caught;
  }
  return caught == 2;
}

} // namespace

int
main()
{
  const char* path = "pipeline.pcd";
  pcl_surflet::ModelDatabase database;
  const pcl_surflet::HistogramModelTrainer trainer;
  for (const auto* name : {"cup", "bottle", "box"})
    database.add(trainer.train(name, surfletsOf(name, 1)));
  pcl_surflet::saveDatabase(database, path);

  pcl_surflet::MeanSurfletGrid<pcl::PointNormal> grid;
  grid.setInputCloud(cloudOf(surfletsOf("cup", 7)));
  grid.setLeafSize(0.004);
  pcl::PointCloud<pcl::PointNormal> cells; // allocated by the library, freed here
  grid.filter(cells);
  const std::string label = answerFor(pcl_surflet::toSurflets(cells).surflets, path);
  std::remove(path);

  const bool caught =
      throws<pcl_surflet::DatabaseFileError, pcl::PCLException>([&] { // the file is gone
        pcl_surflet::loadDatabase(path);
      }) &&
      throws<pcl_surflet::TrainingError, std::runtime_error>([&] { // nothing to train from
        trainer.train("no", pcl_surflet::SurfletSet());
      }) &&
      throws<pcl::PCLException, std::runtime_error>(
          [&] { pcl_surflet::OctreeRegionSearch<pcl::PointXYZ>().setCellSize(-1); });
  std::printf("%s, exceptions %s\n", label.c_str(), caught ? "caught" : "lost");
  return label == "cup" && caught ? EXIT_SUCCESS : EXIT_FAILURE;
}
