#include "evaluation/measures.h"

#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>

#include <malloc.h>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr int kNeighbours = 20;

/** \brief A line such as "VmHWM:   1234 kB" of the process's status, in bytes; negative if absent.
 */
double
statusBytes(const std::string& name)
{
  std::ifstream status("/proc/self/status");
  std::string key;
  double value = 0;
  for (std::string line; status >> key; std::getline(status, line))
    if (key == name + ":" && status >> value)
      return 1024 * value;
  return -1;
}

template <class Point>
typename pcl::PointCloud<Point>::Ptr
cloudOf(const SurfletSet& set)
{
  typename pcl::PointCloud<Point>::Ptr cloud(new pcl::PointCloud<Point>);
  cloud->resize(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    (*cloud)[i].x = set.x[i];
    (*cloud)[i].y = set.y[i];
    (*cloud)[i].z = set.z[i];
  }
  return cloud;
}

} // namespace

double
secondsOf(const std::function<void()>& work)
{
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double
bytesOf(const std::function<void()>& work)
{
  malloc_trim(0); // what was freed before must not hide what is needed now
  std::ofstream("/proc/self/clear_refs") << 5; // resets the peak
  const double before = statusBytes("VmRSS");
  work();
  const double peak = statusBytes("VmHWM");
  return before < 0 || peak < before ? -1 : peak - before;
}

double
normalEstimationSeconds(const SurfletSet& cells, unsigned threads)
{
  const auto cloud = cloudOf<pcl::PointXYZ>(cells);
  return secondsOf([&] {
    pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(threads);
    estimation.setInputCloud(cloud);
    estimation.setKSearch(kNeighbours);
    pcl::PointCloud<pcl::Normal> normals;
    estimation.compute(normals);
  });
}

double
voxelGridSeconds(const SurfletSet& scene, double leaf)
{
  const auto cloud = cloudOf<pcl::PointNormal>(scene);
  return secondsOf([&] {
    const auto edge = static_cast<float>(leaf);
    pcl::VoxelGrid<pcl::PointNormal> grid;
    grid.setInputCloud(cloud);
    grid.setLeafSize(edge, edge, edge);
    pcl::PointCloud<pcl::PointNormal> cells;
    grid.filter(cells);
  });
}

} // namespace apps
} // namespace pcl_surflet
