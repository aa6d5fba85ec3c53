// A user's own point type, with a field that PCL does not know: pairs, region search and mean
// surflets of a plane whose truth is plain. A filter of the library hands a cloud over that it
// allocated and that is freed here.
#define PCL_NO_PRECOMPILE
#include <pcl_surflet/config.h>
#include <pcl_surflet/mean_surflet_grid.h>
#include <pcl_surflet/octree_region_search.h>
#include <pcl_surflet/surflet_pair_feature.h>

#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>
#include <pcl/search/impl/search.hpp>

#include <cstdio>
#include <cstdlib>
#include <memory>

struct StampedPoint {
  double stamp;
  float x, y, z;
  float normal_x, normal_y, normal_z;

  /** \brief PCL 1.15 asks for it, wherever features are computed. */
  Eigen::Map<const Eigen::Vector3f>
  getVector3fMap() const
  {
    return Eigen::Map<const Eigen::Vector3f>(&x);
  }
};
POINT_CLOUD_REGISTER_POINT_STRUCT(StampedPoint,
                                  (double, stamp, stamp)(float, x, x)(float, y, y)(float, z, z)(
                                      float, normal_x, normal_x)(float, normal_y,
                                                                 normal_y)(float, normal_z,
                                                                           normal_z))

namespace {

void
require(bool truth, const char* what)
{
  if (truth)
    return;
  std::fprintf(stderr, "wrong: %s\n", what);
  std::exit(EXIT_FAILURE);
}

/** \brief 10 x 10 points 0.1 apart in z = 0.05, their normals along z. */
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr
plane()
{
  auto cloud = std::make_shared<pcl::PointCloud<PointT>>();
  for (int i = 0; i < 100; ++i) {
    PointT p{};
    p.x = 0.05f + 0.1f * static_cast<float>(i % 10);
    p.y = 0.05f + 0.1f * static_cast<float>(i / 10);
    p.z = 0.05f;
    p.normal_z = 1;
    cloud->push_back(p);
  }
  return cloud;
}

template <typename PointT>
std::size_t
numberOfCells()
{
  pcl_surflet::MeanSurfletGrid<PointT> grid;
  grid.setInputCloud(plane<PointT>());
  grid.setLeafSize(0.5);
  pcl::PointCloud<PointT> cells; // empty: the filter allocates
  grid.filter(cells);
  return cells.size();
}

} // namespace

int
main()
{
  const auto cloud = plane<StampedPoint>();

  pcl_surflet::SurfletPairFeature<StampedPoint, StampedPoint> feature;
  feature.setInputCloud(cloud);
  pcl::PointCloud<pcl_surflet::SurfletPairSignature> pairs;
  feature.compute(pairs);
  require(pairs.size() == 100 * 99 / 2, "number of pairs");
  for (const auto& pair : pairs)
    require(std::abs(pair.gamma) < 1e-6f, "parallel normals have gamma = 0");

  pcl_surflet::OctreeRegionSearch<StampedPoint> search;
  search.setInputCloud(cloud);
  pcl::Indices found;
  std::vector<float> squares;
  require(search.radiusSearch((*cloud)[55], 0.11, found, squares) == 5,
          "four neighbours and itself");

  require(numberOfCells<StampedPoint>() == 4, "cells of the own type");
  require(numberOfCells<pcl::PointNormal>() == 4, "cells of PCL's type");
  std::printf("pcl_surflet " PCL_SURFLET_VERSION " works\n");
}
