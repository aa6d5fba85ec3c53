#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/mean_surflet_grid.h"

#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace pcl_surflet;

namespace {

using NormalCloud = pcl::PointCloud<pcl::PointXYZRGBNormal>;

NormalCloud::Ptr
randomCloud(std::size_t n)
{
  CounterRandom random(n);
  auto cloud = std::make_shared<NormalCloud>();
  for (std::size_t i = 0; i < n; ++i) {
    pcl::PointXYZRGBNormal p;
    p.getVector3fMap() << float(random.uniform()), float(random.uniform()), float(random.uniform());
    p.getNormalVector3fMap() << float(random.uniform(-1, 1)), float(random.uniform(-1, 1)), 1.0f;
    p.getNormalVector3fMap().normalize();
    p.r = static_cast<std::uint8_t>(i % 251);
    cloud->push_back(p);
  }
  return cloud;
}

} // namespace

TEST(MeanSurfletGrid, EqualsCoreReduction)
{
  const auto cloud = randomCloud(5000);
  MeanSurfletGrid<pcl::PointXYZRGBNormal> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(0.125);
  NormalCloud out;
  grid.filter(out);
  SurfletSet set;
  for (const auto& p : *cloud)
    set.push_back({p.x, p.y, p.z, p.normal_x, p.normal_y, p.normal_z});
  const auto expected = reduceToCells(set, 0.125);
  ASSERT_EQ(out.size(), expected.cells.size());
  EXPECT_EQ(out.size(), 512u);
  EXPECT_EQ(grid.getCellOfPoint(), expected.cell_of);
  EXPECT_EQ(grid.getPointCounts(), expected.counts);
  for (std::size_t c = 0; c < out.size(); ++c) {
    EXPECT_EQ(out[c].x, expected.cells.x[c]);
    EXPECT_EQ(out[c].normal_y, expected.cells.ny[c]);
    EXPECT_NEAR(out[c].getNormalVector3fMap().norm(), 1, 1e-6);
    std::size_t first = 0;
    while (grid.getCellOfPoint()[first] != c)
      ++first;
    EXPECT_EQ(out[c].r, (*cloud)[first].r);
  }
  EXPECT_EQ(out.width, out.size());
}

TEST(MeanSurfletGrid, RemovedIndicesAreNonFiniteAndCancelledPoints)
{
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  cloud->push_back(pcl::PointNormal(0.1f, 0.1f, 0.1f, 0, 0, 1));
  cloud->push_back(pcl::PointNormal(0.2f, 0.2f, 0.2f, 0, 0, -1));
  cloud->push_back(pcl::PointNormal(1.2f, 0.2f, 0.2f, 0, 0, -1));
  cloud->push_back(pcl::PointNormal(NAN, 0.2f, 0.2f, 0, 0, -1));
  cloud->push_back(pcl::PointNormal(1.3f, 0.2f, 0.2f, NAN, 0, -1));
  cloud->push_back(pcl::PointNormal(5, 5, 5, 1, 0, 0)); // not among the indices
  auto indices = std::make_shared<pcl::Indices>(pcl::Indices{0, 1, 2, 3, 4});
  MeanSurfletGrid<pcl::PointNormal> grid(true);
  grid.setInputCloud(cloud);
  grid.setIndices(indices);
  grid.setLeafSize(1);
  for (int run = 0; run < 2; ++run) { // lists are made anew each time
    pcl::PointCloud<pcl::PointNormal> out;
    grid.filter(out);
    ASSERT_EQ(out.size(), 1u);
    EXPECT_FLOAT_EQ(out[0].x, 1.2f);
    EXPECT_EQ(*grid.getRemovedIndices(), (pcl::Indices{0, 1, 3, 4}));
    EXPECT_EQ(grid.getNumberOfCancelledCells(), 1u);
    EXPECT_EQ(grid.getCellOfPoint()[2], 0u);
    EXPECT_EQ(grid.getCellOfPoint()[5], CellReduction::no_cell);
  }
}

TEST(MeanSurfletGrid, RunTimeFieldsGiveTheSame)
{
  const auto cloud = randomCloud(3000);
  MeanSurfletGrid<pcl::PointXYZRGBNormal> typed;
  typed.setInputCloud(cloud);
  typed.setLeafSize(0.2);
  NormalCloud expected, out;
  typed.filter(expected);
  auto blob = std::make_shared<pcl::PCLPointCloud2>();
  pcl::toPCLPointCloud2(*cloud, *blob);
  MeanSurfletGrid<pcl::PCLPointCloud2> grid;
  grid.setInputCloud(blob);
  grid.setLeafSize(0.2);
  pcl::PCLPointCloud2 result;
  grid.filter(result);
  pcl::fromPCLPointCloud2(result, out);
  ASSERT_EQ(out.size(), expected.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    EXPECT_EQ(out[i].getVector3fMap(), expected[i].getVector3fMap());
    EXPECT_EQ(out[i].getNormalVector3fMap(), expected[i].getNormalVector3fMap());
    EXPECT_EQ(out[i].r, expected[i].r);
  }
  EXPECT_EQ(grid.getCellOfPoint(), typed.getCellOfPoint());
}

TEST(MeanSurfletGrid, ErrorsGiveEmptyOutput)
{
  const auto cloud = randomCloud(10);
  NormalCloud out = *cloud;
  MeanSurfletGrid<pcl::PointXYZRGBNormal> grid;
  grid.setInputCloud(cloud);
  grid.filter(out); // no leaf size
  EXPECT_TRUE(out.empty());
  auto blob = std::make_shared<pcl::PCLPointCloud2>();
  pcl::toPCLPointCloud2(pcl::PointCloud<pcl::PointXYZ>(3, 1), *blob);
  MeanSurfletGrid<pcl::PCLPointCloud2> no_normals;
  no_normals.setInputCloud(blob);
  no_normals.setLeafSize(1);
  pcl::PCLPointCloud2 result;
  no_normals.filter(result);
  EXPECT_EQ(result.width * result.height, 0u);
}
