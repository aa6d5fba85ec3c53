/** \file
 * Point types and histograms of a user's own: PCL_NO_PRECOMPILE brings in the templates' bodies,
 * which takes a while to compile, so nothing else is tested here. */
#define PCL_NO_PRECOMPILE
#include "pcl_surflet/core/pair_counting.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/core/surflet_pair.h"
#include "pcl_surflet/surflet_pair_feature.h"
#include "pcl_surflet/surflet_pair_histogram.h"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include <gtest/gtest.h>

/** \brief A point type PCL does not know. */
struct MyPoint {
  PCL_ADD_POINT4D;
  PCL_ADD_NORMAL4D;
  float temperature;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
// clang-format off
POINT_CLOUD_REGISTER_POINT_STRUCT (MyPoint,
  (float, x, x) (float, y, y) (float, z, z)
  (float, normal_x, normal_x) (float, normal_y, normal_y) (float, normal_z, normal_z)
  (float, temperature, temperature))
// clang-format on

using namespace pcl_surflet;

namespace {

pcl::PointCloud<MyPoint>::Ptr
cloudOf(const SurfletSet& set)
{
  pcl::PointCloud<MyPoint>::Ptr cloud(new pcl::PointCloud<MyPoint>);
  for (std::size_t i = 0; i < set.size(); ++i) {
    MyPoint p{};
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

SurfletPairHistogram625
histogramOf(const SurfletSet& set, double delta_max = 0)
{
  SurfletPairHistogramEstimation<MyPoint, MyPoint> estimation;
  estimation.setInputCloud(cloudOf(set));
  estimation.setDeltaMax(delta_max);
  pcl::PointCloud<SurfletPairHistogram625> descriptor;
  estimation.compute(descriptor);
  return descriptor.at(0);
}

const SurfletSet kCone = sampleShape(*shapeByName("cone"), 50, 1);

} // namespace

TEST(OwnTypes, PairsOfAPointType)
{
  SurfletPairFeature<MyPoint, MyPoint> feature;
  feature.setInputCloud(cloudOf(kCone));
  pcl::PointCloud<SurfletPairSignature> pairs;
  feature.compute(pairs);
  ASSERT_EQ(pairs.size(), 50u * 49 / 2);
  for (const auto& p : pairs) {
    const auto f = computePairFeature(kCone[p.index_1], kCone[p.index_2]);
    ASSERT_TRUE(f);
    EXPECT_NEAR(p.alpha, f->alpha, 1e-5);
    EXPECT_NEAR(p.beta, f->beta, 1e-6);
    EXPECT_NEAR(p.gamma, f->gamma, 1e-6);
    EXPECT_FLOAT_EQ(p.delta, static_cast<float>(f->delta));
  }
}

TEST(OwnTypes, HistogramOfAPointType)
{
  const auto histogram = histogramOf(kCone, 0.4);
  const auto expected = countAllPairs(PairSource(kCone), {}, 0.4).normalized();
  for (std::size_t b = 0; b < 625; ++b)
    EXPECT_FLOAT_EQ(histogram.histogram[b], static_cast<float>(expected[b])) << b;
}

TEST(OwnTypes, HistogramOfAnotherResolution)
{
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  SurfletPairHistogramEstimation<MyPoint, MyPoint, pcl::Histogram<16>> small;
  small.setInputCloud(cloudOf(kCone));
  small.setDeltaMax(0.4);
  pcl::PointCloud<pcl::Histogram<16>> descriptor;
  small.compute(descriptor); // 625 bins do not fit
  EXPECT_TRUE(descriptor.empty());
  small.setResolution({2, 2, 2, 2});
  small.compute(descriptor);
  ASSERT_EQ(descriptor.size(), 1u);
  const auto expected = countAllPairs(PairSource(kCone), {2, 2, 2, 2}, 0.4).normalized();
  for (std::size_t b = 0; b < 16; ++b)
    EXPECT_FLOAT_EQ(descriptor[0].histogram[b], static_cast<float>(expected[b])) << b;
}

TEST(OwnTypes, NearestNeighbourSearchComparesAllBins)
{
  pcl::PointCloud<SurfletPairHistogram625>::Ptr library(
      new pcl::PointCloud<SurfletPairHistogram625>);
  const std::vector<std::string> names = {"box", "sphere", "torus", "cone", "cup", "bottle"};
  for (const auto& name : names)
    library->push_back(histogramOf(sampleShape(*shapeByName(name), 1500, 1)));
  pcl::KdTreeFLANN<SurfletPairHistogram625> tree;
  tree.setInputCloud(library);
  for (std::size_t i = 0; i < names.size(); ++i) {
    pcl::Indices found(1);
    std::vector<float> distance(1);
    const auto query = histogramOf(sampleShape(*shapeByName(names[i]), 1500, 2));
    ASSERT_EQ(tree.nearestKSearch(query, 1, found, distance), 1);
    EXPECT_EQ(found[0], static_cast<int>(i));
    float expected = 0;
    for (std::size_t b = 0; b < 625; ++b)
      expected += std::pow(query.histogram[b] - (*library)[i].histogram[b], 2.f);
    EXPECT_NEAR(distance[0], expected, 1e-6);
  }
}
