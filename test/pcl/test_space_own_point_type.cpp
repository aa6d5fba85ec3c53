/** \file
 * A user's own point type: PCL_NO_PRECOMPILE brings in the templates' bodies. */
#define PCL_NO_PRECOMPILE
#include "pcl_surflet/mean_surflet_grid.h"
#include "pcl_surflet/octree_region_search.h"

#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>
#include <pcl/search/impl/search.hpp>

#include <gtest/gtest.h>

struct OwnPoint {
  double stamp;
  float x, y, z;
  float normal_x, normal_y, normal_z;
};
POINT_CLOUD_REGISTER_POINT_STRUCT(
    OwnPoint, (double, stamp, stamp)(float, x, x)(float, y, y)(float, z, z)(
                  float, normal_x, normal_x)(float, normal_y, normal_y)(float, normal_z, normal_z))

TEST(OwnPointType, SearchesAndReduces)
{
  auto cloud = std::make_shared<pcl::PointCloud<OwnPoint>>();
  for (int i = 0; i < 100; ++i)
    cloud->push_back({double(i), float(i) * 0.1f, 0.05f, 0.05f, 0, 0, 1});
  pcl_surflet::OctreeRegionSearch<OwnPoint> search;
  search.setInputCloud(cloud);
  pcl::Indices indices;
  std::vector<float> squares;
  EXPECT_EQ(search.radiusSearch((*cloud)[50], 0.25, indices, squares), 5);
  pcl_surflet::MeanSurfletGrid<OwnPoint> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(1.0);
  pcl::PointCloud<OwnPoint> cells;
  grid.filter(cells);
  ASSERT_EQ(cells.size(), 10u);
  EXPECT_EQ(cells[0].stamp, 0);
  EXPECT_FLOAT_EQ(cells[0].normal_z, 1);
}
