#include "../core/space_clouds.h"
#include "pcl_surflet/octree_region_search.h"

#include <pcl/exceptions.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

#include <gtest/gtest.h>

#include <set>

using namespace pcl_surflet;
using namespace pcl_surflet::testing;

namespace {

using Search = OctreeRegionSearch<pcl::PointXYZ>;
using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

pcl::PointXYZ
toPoint(const Position& p)
{
  return {p[0], p[1], p[2]};
}

PclCloud::Ptr
toPcl(const std::vector<Position>& points)
{
  auto cloud = std::make_shared<PclCloud>();
  for (const auto& p : points)
    cloud->push_back(toPoint(p));
  return cloud;
}

/** \brief Three noisy patches of a sphere and some stray points. */
PclCloud::Ptr
patches()
{
  CounterRandom random(20);
  std::vector<Position> points;
  for (const Position& p : sphereCloud(6000).points)
    if (p[2] > 0.8f || p[2] < -0.7f || p[0] > 0.9f)
      points.push_back(p);
  for (int i = 0; i < 40; ++i)
    points.push_back(
        {float(random.uniform(-3, 3)), float(random.uniform(-3, 3)), float(random.uniform(-3, 3))});
  return toPcl(points);
}

class OctreeRegionSearchTest : public ::testing::TestWithParam<Search::Backend> {};

} // namespace

TEST_P(OctreeRegionSearchTest, AllOverloadsAgreeWithBruteForce)
{
  const Cloud cloud = uniformCloud(2000);
  const auto pcl_cloud = toPcl(cloud.points);
  Search search(GetParam());
  search.setInputCloud(pcl_cloud);
  EXPECT_EQ(search.size(), 2000u);
  pcl::Indices indices;
  std::vector<float> squares;
  for (const int i : {0, 77, 1999}) {
    const Position q = cloud.points[static_cast<std::size_t>(i)];
    const Hits expected = bruteForceRegion(cloud.points, q, 0.2);
    const int count = static_cast<int>(expected.size());
    EXPECT_EQ(search.radiusSearch(toPoint(q), 0.2, indices, squares), count);
    EXPECT_EQ(toHits(indices, squares), expected);
    EXPECT_EQ(search.radiusSearch(i, 0.2, indices, squares), count);
    EXPECT_EQ(toHits(indices, squares), expected);
    EXPECT_EQ(search.radiusSearch(*pcl_cloud, i, 0.2, indices, squares), count);
    EXPECT_EQ(toHits(indices, squares), expected);
    EXPECT_EQ(search.radiusSearchIndices(toPoint(q), 0.2, indices), count);
    EXPECT_EQ(search.nearestKSearch(i, 5, indices, squares), 5);
    EXPECT_EQ(toHits(indices, squares), Hits(expected.begin(), expected.begin() + 5));
    EXPECT_EQ(search.radiusSearch(toPoint(q), 0.2, indices, squares, 7), 7);
    EXPECT_EQ(toHits(indices, squares), Hits(expected.begin(), expected.begin() + 7));
  }
}

TEST_P(OctreeRegionSearchTest, SortedResultsAscend)
{
  const Cloud cloud = uniformCloud(2000);
  Search search(GetParam());
  search.setInputCloud(toPcl(cloud.points));
  search.setSortedResults(true);
  pcl::Indices indices;
  std::vector<float> squares;
  search.radiusSearch(toPoint(cloud.points[3]), 0.3, indices, squares);
  EXPECT_TRUE(std::is_sorted(squares.begin(), squares.end()));
  EXPECT_EQ(indices[0], 3);
  const Hits expected = bruteForceRegion(cloud.points, cloud.points[3], 0.3);
  for (std::size_t i = 0; i < expected.size(); ++i)
    ASSERT_EQ(indices[i], expected[i].second);
}

TEST_P(OctreeRegionSearchTest, SubsetsAndNonFinitePoints)
{
  Cloud cloud = uniformCloud(1000);
  cloud.points[10][2] = std::numeric_limits<float>::quiet_NaN();
  auto subset = std::make_shared<pcl::Indices>();
  for (int i = 0; i < 1000; i += 2)
    subset->push_back(i);
  Search search(GetParam());
  search.setInputCloud(toPcl(cloud.points), subset);
  EXPECT_EQ(search.size(), 499u);
  pcl::Indices indices;
  std::vector<float> squares;
  EXPECT_EQ(search.radiusSearch(pcl::PointXYZ(0.5f, 0.5f, 0.5f), 10, indices, squares), 499);
  for (const int i : indices)
    EXPECT_TRUE(i % 2 == 0 && i != 10);
  // With indices an index query names a position in them.
  EXPECT_GT(search.nearestKSearch(7, 1, indices, squares), 0);
  EXPECT_EQ(indices[0], 14);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(search.radiusSearch(pcl::PointXYZ(nan, 0, 0), 1, indices, squares), 0);
  EXPECT_EQ(search.nearestKSearch(pcl::PointXYZ(nan, 0, 0), 1, indices, squares), 0);
}

TEST_P(OctreeRegionSearchTest, BatchesDoNotDependOnThreads)
{
  const auto cloud = toPcl(uniformCloud(3000).points);
  Search search(GetParam());
  search.setInputCloud(cloud);
  std::vector<pcl::Indices> one, more, plain;
  std::vector<std::vector<float>> d1, dn;
  search.radiusSearch(*cloud, pcl::Indices(), 0.1, one, d1);
  search.setNumberOfThreads(4);
  search.radiusSearch(*cloud, pcl::Indices(), 0.1, more, dn);
  EXPECT_EQ(one, more);
  EXPECT_EQ(d1, dn);
  search.radiusSearchIndices(*cloud, pcl::Indices(), 0.1, plain);
  EXPECT_EQ(plain.size(), 3000u);
  EXPECT_EQ(plain[17].size(), one[17].size());
  search.nearestKSearch(*cloud, {5, 6}, 3, more, dn);
  ASSERT_EQ(more.size(), 2u);
  EXPECT_EQ(more[1][0], 6);
}

TEST_P(OctreeRegionSearchTest, NormalEstimationAgreesWithKdTree)
{
  const auto cloud = patches();
  const auto normals = [&](const pcl::search::Search<pcl::PointXYZ>::Ptr& search, bool radius) {
    pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
    pcl::PointCloud<pcl::Normal> out;
    estimation.setInputCloud(cloud);
    estimation.setSearchMethod(search);
    radius ? estimation.setRadiusSearch(0.15) : estimation.setKSearch(12);
    estimation.compute(out);
    return out;
  };
  for (const bool radius : {true, false}) {
    // Sorted, so that both sum in the same order.
    auto search = std::make_shared<Search>(GetParam(), true);
    const auto a = normals(search, radius);
    const auto b = normals(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>(true), radius);
    ASSERT_EQ(a.size(), cloud->size());
    std::size_t finite = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(std::isnan(a[i].normal_x), std::isnan(b[i].normal_x)) << i;
      if (std::isnan(a[i].normal_x))
        continue;
      ++finite;
      EXPECT_NEAR(a[i].normal_x, b[i].normal_x, 1e-3);
      EXPECT_NEAR(a[i].normal_z, b[i].normal_z, 1e-3);
      EXPECT_NEAR(a[i].curvature, b[i].curvature, 1e-4);
    }
    EXPECT_GT(finite, 1000u);
  }
}

TEST_P(OctreeRegionSearchTest, EuclideanClusterExtractionAgreesWithKdTree)
{
  const auto cloud = patches();
  const auto clusters = [&](const pcl::search::Search<pcl::PointXYZ>::Ptr& search) {
    search->setInputCloud(cloud);
    pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
    std::vector<pcl::PointIndices> found;
    extraction.setInputCloud(cloud);
    extraction.setSearchMethod(search);
    extraction.setClusterTolerance(0.12);
    extraction.setMinClusterSize(20);
    extraction.extract(found);
    std::set<std::set<int>> sets;
    for (const auto& cluster : found)
      sets.insert(std::set<int>(cluster.indices.begin(), cluster.indices.end()));
    return sets;
  };
  const auto expected = clusters(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  EXPECT_EQ(expected.size(), 3u);
  EXPECT_EQ(clusters(std::make_shared<Search>(GetParam())), expected);
  EXPECT_EQ(clusters(std::make_shared<Search>(GetParam(), true)), expected);
}

TEST_P(OctreeRegionSearchTest, StatisticalOutlierRemovalAgreesWithKdTree)
{
  // The filter makes its own search: repeat what it does, with the mean distances by hand.
  const auto cloud = patches();
  const auto mean_distances = [&](pcl::search::Search<pcl::PointXYZ>& search) {
    search.setInputCloud(cloud);
    std::vector<double> means;
    pcl::Indices indices;
    std::vector<float> squares;
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      search.nearestKSearch(static_cast<int>(i), 21, indices, squares);
      double sum = 0;
      for (std::size_t k = 1; k < squares.size(); ++k) // the first is the point itself
        sum += std::sqrt(squares[k]);
      means.push_back(sum / 20);
    }
    return means;
  };
  pcl::search::KdTree<pcl::PointXYZ> kdtree;
  Search search(GetParam());
  EXPECT_EQ(mean_distances(search), mean_distances(kdtree));
}

INSTANTIATE_TEST_SUITE_P(Backends, OctreeRegionSearchTest,
                         ::testing::Values(Search::Octree, Search::AVL, Search::Linear));

TEST(OctreeRegionSearch, PointsComeAndGo)
{
  for (const auto backend : {Search::Octree, Search::AVL}) {
    Search search(backend);
    search.setCellSize(0.1);
    search.setInputCloud(toPcl(uniformCloud(100).points));
    EXPECT_DOUBLE_EQ(search.getCellSize(), 0.1);
    EXPECT_EQ(search.addPoint({1e6f, -1e6f, 0}), 100);
    EXPECT_EQ(search.addPoints(*toPcl({{5, 5, 5}, {NAN, 0, 0}, {5, 5, 6}})), 101);
    EXPECT_EQ(search.addPoint({NAN, 0, 0}), -1);
    EXPECT_EQ(search.addPoint({7, 7, 7}), 104);
    EXPECT_EQ(search.size(), 104u);
    pcl::Indices indices;
    EXPECT_EQ(search.radiusSearchIndices({5, 5, 5.5f}, 0.5, indices), 2);
    EXPECT_TRUE(search.removePoint(103));
    EXPECT_FALSE(search.removePoint(103));
    EXPECT_FALSE(search.removePoint(102));
    EXPECT_TRUE(search.removePoint(0));
    EXPECT_EQ(search.radiusSearchIndices({5, 5, 5.5f}, 0.5, indices), 1);
    EXPECT_EQ(indices[0], 101);
    EXPECT_EQ(search.boxSearch({4, 4, 4}, {8, 8, 8}, indices), 2);
    std::vector<Cell> cells;
    search.getCells(cells);
    std::size_t points = 0;
    for (const Cell& cell : cells)
      points += cell.count;
    EXPECT_EQ(points, search.size());
    search.getCellsInRadius({5, 5, 5}, 0.1, cells);
    EXPECT_EQ(cells.size(), 1u);
  }
}

TEST(OctreeRegionSearch, RangesOfTheLinearBackend)
{
  const Cloud cloud = uniformCloud(3000);
  Search search;
  search.setInputCloud(toPcl(cloud.points));
  std::vector<PlaceRange> ranges;
  const int count = search.radiusSearchRanges({0.5f, 0.5f, 0.5f}, 0.3, ranges);
  EXPECT_EQ(std::size_t(count), bruteForceRegion(cloud.points, {0.5f, 0.5f, 0.5f}, 0.3).size());
  ASSERT_NE(search.linearOctree(), nullptr);
  for (const auto& r : ranges)
    EXPECT_LT(search.linearOctree()->indexAt(r.begin), 3000);
}

TEST(OctreeRegionSearch, MisuseIsNamed)
{
  Search search;
  pcl::Indices indices;
  std::vector<float> squares;
  EXPECT_EQ(search.radiusSearch(pcl::PointXYZ(0, 0, 0), 1, indices, squares), 0);
  EXPECT_THROW(search.addPoint({0, 0, 0}), pcl::PCLException);
  EXPECT_THROW(search.removePoint(0), pcl::PCLException);
  std::vector<Cell> cells;
  EXPECT_THROW(search.getCells(cells), pcl::PCLException);
  EXPECT_THROW(search.setCellSize(-1), pcl::PCLException);
  EXPECT_THROW(search.setDepth(64), pcl::PCLException);
  search.setBackend(Search::AVL);
  std::vector<PlaceRange> ranges;
  EXPECT_THROW(search.radiusSearchRanges({0, 0, 0}, 1, ranges), pcl::PCLException);
  EXPECT_EQ(search.addPoint({0, 0, 0}), 0);
}

TEST(OctreeRegionSearch, NormalsReachTheCells)
{
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  cloud->push_back(pcl::PointNormal(0.1f, 0.1f, 0.1f, 1, 0, 0));
  cloud->push_back(pcl::PointNormal(0.2f, 0.1f, 0.1f, 0, 1, 0));
  OctreeRegionSearch<pcl::PointNormal> search(OctreeRegionSearch<pcl::PointNormal>::Octree);
  search.setCellSize(1);
  search.setInputCloud(cloud);
  std::vector<Cell> cells;
  search.getCells(cells);
  ASSERT_EQ(cells.size(), 1u);
  EXPECT_FLOAT_EQ(cells[0].mean.nx, float(std::sqrt(0.5)));
}
