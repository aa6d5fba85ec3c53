#include "../test_files.h"

#include "pcl_surflet/conversions.h"
#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/pair_counting.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/core/surflet_pair.h"
#include "pcl_surflet/surflet_pair_feature.h"
#include "pcl_surflet/surflet_pair_histogram.h"

#include <pcl/common/io.h>
#include <pcl/common/transforms.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <limits>

using namespace pcl_surflet;
using Points = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Pairs = pcl::PointCloud<SurfletPairSignature>;
using Feature = SurfletPairFeature<pcl::PointXYZ, pcl::Normal>;
using Estimation = SurfletPairHistogramEstimation<pcl::PointXYZ, pcl::Normal>;
using Descriptor = pcl::PointCloud<SurfletPairHistogram625>;

namespace {

struct Oriented {
  Points::Ptr points{new Points};
  Normals::Ptr normals{new Normals};
};

Oriented
cloudOf(const SurfletSet& set)
{
  Oriented cloud;
  for (std::size_t i = 0; i < set.size(); ++i) {
    cloud.points->push_back({set.x[i], set.y[i], set.z[i]});
    cloud.normals->push_back({set.nx[i], set.ny[i], set.nz[i]});
  }
  return cloud;
}

Oriented
shapeCloud(const std::string& name, std::size_t n, std::uint64_t seed = 1)
{
  return cloudOf(sampleShape(*shapeByName(name), n, seed));
}

Feature
featureOf(const Oriented& cloud)
{
  Feature feature;
  feature.setInputCloud(cloud.points);
  feature.setInputNormals(cloud.normals);
  return feature;
}

Descriptor
describe(const Oriented& cloud, double delta_max = 0)
{
  Estimation estimation;
  estimation.setInputCloud(cloud.points);
  estimation.setInputNormals(cloud.normals);
  estimation.setDeltaMax(delta_max);
  Descriptor descriptor;
  estimation.compute(descriptor);
  return descriptor;
}

void
expectSamePairs(const Pairs& a, const Pairs& b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].alpha, b[i].alpha);
    EXPECT_EQ(a[i].beta, b[i].beta);
    EXPECT_EQ(a[i].gamma, b[i].gamma);
    EXPECT_EQ(a[i].delta, b[i].delta);
    EXPECT_EQ(a[i].index_1, b[i].index_1);
    EXPECT_EQ(a[i].index_2, b[i].index_2);
  }
}

} // namespace

TEST(SurfletPairFeature, AllPairsOnceWithTheReferenceFeature)
{
  const auto cloud = shapeCloud("cup", 60);
  Pairs pairs;
  auto feature = featureOf(cloud);
  feature.compute(pairs);
  EXPECT_EQ(pairs.size() + feature.getNumberOfRejectedPairs(), 60u * 59 / 2);
  EXPECT_EQ(pairs.height, 1u);
  const auto set = toSurflets(*cloud.points, *cloud.normals,
                              [] {
                                pcl::Indices all(60);
                                for (int i = 0; i < 60; ++i)
                                  all[static_cast<std::size_t>(i)] = i;
                                return all;
                              }())
                       .surflets;
  for (const auto& p : pairs) {
    ASSERT_LT(p.index_1, p.index_2);
    const auto f = computePairFeature(set[p.index_1], set[p.index_2]);
    ASSERT_TRUE(f);
    EXPECT_FLOAT_EQ(p.alpha, static_cast<float>(f->alpha));
    EXPECT_FLOAT_EQ(p.beta, static_cast<float>(f->beta));
    EXPECT_FLOAT_EQ(p.gamma, static_cast<float>(f->gamma));
    EXPECT_FLOAT_EQ(p.delta, static_cast<float>(f->delta));
  }
}

TEST(SurfletPairFeature, DrawnPairsAreSeededAndIndependentOfThreads)
{
  const auto cloud = shapeCloud("bottle", 3000);
  auto feature = featureOf(cloud);
  feature.setNumberOfPairs(100000);
  feature.setNumberOfThreads(1);
  Pairs one, four, other;
  feature.compute(one);
  EXPECT_EQ(one.size(), 100000u);
  feature.setNumberOfThreads(4);
  feature.compute(four);
  expectSamePairs(one, four);
  feature.setSeed(2);
  feature.compute(other);
  EXPECT_NE(one[0].index_1 * 4000 + one[0].index_2, other[0].index_1 * 4000 + other[0].index_2);
}

TEST(SurfletPairFeature, MaximumDistance)
{
  const auto cloud = shapeCloud("bottle", 300);
  auto feature = featureOf(cloud);
  Pairs all, near, drawn;
  feature.compute(all);
  feature.setMaximumDistance(0.05);
  feature.compute(near);
  const auto expected =
      std::count_if(all.begin(), all.end(), [](const auto& p) { return p.delta <= 0.05f; });
  EXPECT_EQ(near.size(), static_cast<std::size_t>(expected));
  feature.setNumberOfPairs(5000);
  feature.compute(drawn);
  EXPECT_EQ(drawn.size(), 5000u);
  for (const auto& p : drawn)
    EXPECT_LE(p.delta, 0.05f);
  feature.setMaximumDistance(1e-9); // hopeless: ends all the same
  feature.compute(drawn);
  EXPECT_LT(drawn.size(), 5000u);
}

TEST(SurfletPairFeature, IndicesEqualTheSubCloud)
{
  const auto cloud = shapeCloud("torus", 100);
  pcl::IndicesPtr indices(new pcl::Indices);
  Oriented sub;
  for (int i = 3; i < 100; i += 7) {
    indices->push_back(i);
    sub.points->push_back((*cloud.points)[static_cast<std::size_t>(i)]);
    sub.normals->push_back((*cloud.normals)[static_cast<std::size_t>(i)]);
  }
  auto feature = featureOf(cloud);
  feature.setIndices(indices);
  Pairs with_indices, of_sub;
  feature.compute(with_indices);
  featureOf(sub).compute(of_sub);
  ASSERT_EQ(with_indices.size(), of_sub.size());
  for (std::size_t k = 0; k < of_sub.size(); ++k) {
    EXPECT_EQ(with_indices[k].alpha, of_sub[k].alpha);
    EXPECT_EQ(with_indices[k].index_1, static_cast<std::uint32_t>((*indices)[of_sub[k].index_1]));
    EXPECT_EQ(with_indices[k].index_2, static_cast<std::uint32_t>((*indices)[of_sub[k].index_2]));
  }
}

TEST(SurfletPairFeature, PointNormalCloudsAreInputAndNormalsAtOnce)
{
  const auto cloud = shapeCloud("cone", 50);
  pcl::PointCloud<pcl::PointNormal>::Ptr both(new pcl::PointCloud<pcl::PointNormal>);
  pcl::concatenateFields(*cloud.points, *cloud.normals, *both);
  SurfletPairFeature<pcl::PointNormal, pcl::PointNormal> feature;
  feature.setInputCloud(both);
  Pairs a, b;
  feature.compute(a);
  featureOf(cloud).compute(b);
  expectSamePairs(a, b);
}

TEST(SurfletPairFeature, BadPointsTakePartInNoPair)
{
  auto cloud = shapeCloud("cone", 40);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  (*cloud.points)[3].x = nan;
  (*cloud.points)[4].z = std::numeric_limits<float>::infinity();
  (*cloud.normals)[5].normal_y = nan;
  (*cloud.normals)[6] = pcl::Normal(0, 0, 0);
  (*cloud.normals)[7].getNormalVector3fMap() *= 250; // not unit: used with unit length
  Pairs pairs, reference;
  featureOf(cloud).compute(pairs);
  EXPECT_EQ(pairs.size(), 36u * 35 / 2);
  for (const auto& p : pairs)
    for (const auto i : {p.index_1, p.index_2})
      EXPECT_TRUE(i < 3 || i > 6);
  featureOf(shapeCloud("cone", 40)).compute(reference);
  for (const auto& p : pairs)
    for (const auto& q : reference)
      if (p.index_1 == 7 && q.index_1 == 7 && p.index_2 == q.index_2) {
        EXPECT_NEAR(p.gamma, q.gamma, 1e-5);
      }
}

TEST(SurfletPairFeature, MisuseGivesAnEmptyOutput)
{
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  Pairs pairs(3, 1);
  Feature nothing;
  nothing.compute(pairs);
  EXPECT_TRUE(pairs.empty());

  const auto cloud = shapeCloud("cone", 10);
  const auto emptyAfter = [&](const std::function<void(Feature&)>& misuse) {
    auto feature = featureOf(cloud);
    misuse(feature);
    Pairs out(3, 1);
    feature.compute(out);
    return out.empty();
  };
  EXPECT_FALSE(emptyAfter([](Feature&) {}));
  EXPECT_TRUE(emptyAfter([](Feature& f) { f.setMaximumDistance(-1); }));
  EXPECT_TRUE(emptyAfter([](Feature& f) { f.setMaximumDistance(std::nan("")); }));
  EXPECT_TRUE(emptyAfter([](Feature& f) { f.setInputNormals(nullptr); }));
  EXPECT_TRUE(emptyAfter([&](Feature& f) { f.setInputNormals(shapeCloud("cone", 9).normals); }));
  EXPECT_TRUE(emptyAfter([&](Feature& f) { f.setSearchSurface(shapeCloud("cone", 10).points); }));
  EXPECT_TRUE(emptyAfter([](Feature& f) {
    f.setIndices(pcl::IndicesPtr(new pcl::Indices{0, 1, 99}));
  }));
  EXPECT_TRUE(emptyAfter([](Feature& f) {
    f.setIndices(pcl::IndicesPtr(new pcl::Indices{-1, 1}));
  }));
  Pairs out;
  featureOf(cloudOf({})).compute(out);
  EXPECT_TRUE(out.empty());
  featureOf(shapeCloud("cone", 1)).compute(out);
  EXPECT_TRUE(out.empty());
  featureOf(shapeCloud("plane", 70000)).compute(out); // 2.4e9 pairs
  EXPECT_TRUE(out.empty());
}

TEST(SurfletPairHistogram, EqualsTheCountsAndSumsToOne)
{
  const auto cloud = shapeCloud("ellipsoid", 800);
  const auto descriptor = describe(cloud, 0.4);
  ASSERT_EQ(descriptor.size(), 1u);
  const auto set = sampleShape(*shapeByName("ellipsoid"), 800, 1);
  const auto h = countAllPairs(PairSource(set), {}, 0.4).normalized();
  double sum = 0;
  for (std::size_t b = 0; b < 625; ++b) {
    EXPECT_FLOAT_EQ(descriptor[0].histogram[b], static_cast<float>(h[b]));
    sum += descriptor[0].histogram[b];
  }
  EXPECT_NEAR(sum, 1, 1e-5);
}

TEST(SurfletPairHistogram, RigidMotionChangesNothingMeasuredScaleNeither)
{
  auto cloud = shapeCloud("cup", 1200);
  const auto before = describe(cloud);
  Eigen::Affine3f motion = Eigen::Translation3f(3, -2, 5) *
                           Eigen::AngleAxisf(1.1f, Eigen::Vector3f(1, 2, -1).normalized());
  for (auto& p : *cloud.points)
    p.getVector3fMap() = motion * p.getVector3fMap() * 1.f;
  for (auto& n : *cloud.normals)
    n.getNormalVector3fMap() = motion.linear() * n.getNormalVector3fMap();
  const auto after = describe(cloud);
  for (auto& p : *cloud.points)
    p.getVector3fMap() *= 40;
  const auto scaled = describe(cloud);
  double moved = 0, stretched = 0;
  for (std::size_t b = 0; b < 625; ++b) {
    moved += std::abs(before[0].histogram[b] - after[0].histogram[b]) / 2;
    stretched += std::abs(scaled[0].histogram[b] - after[0].histogram[b]) / 2;
  }
  // Pairs of exactly antiparallel normals lie on the seam of alpha, where rounding decides.
  EXPECT_LT(moved, 0.02);
  EXPECT_LT(stretched, 1e-3);
}

TEST(SurfletPairHistogram, WritesAPcdOfOneFieldThatReadsBack)
{
  const test::TemporaryDirectory directory;
  const auto path = directory.path("descriptor.pcd");
  const auto descriptor = describe(shapeCloud("cup", 500));
  ASSERT_EQ(pcl::io::savePCDFileBinary(path, descriptor), 0);
  const std::string header = test::readFile(path);
  EXPECT_NE(header.find("FIELDS surflet_pairs\n"), std::string::npos);
  EXPECT_NE(header.find("COUNT 625\n"), std::string::npos);
  Descriptor back;
  ASSERT_EQ(pcl::io::loadPCDFile(path, back), 0);
  EXPECT_TRUE(std::equal(back[0].histogram, back[0].histogram + 625, descriptor[0].histogram));
}

TEST(SurfletPairHistogram, MisuseGivesAnEmptyOutput)
{
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const auto cloud = shapeCloud("cup", 500);
  const auto emptyAfter = [&](const std::function<void(Estimation&)>& misuse) {
    Estimation estimation;
    estimation.setInputCloud(cloud.points);
    estimation.setInputNormals(cloud.normals);
    misuse(estimation);
    Descriptor descriptor(2, 1);
    estimation.compute(descriptor);
    return descriptor.empty();
  };
  EXPECT_FALSE(emptyAfter([](Estimation&) {}));
  EXPECT_TRUE(emptyAfter([](Estimation& e) { e.setDeltaMax(INFINITY); }));
  EXPECT_TRUE(emptyAfter([](Estimation& e) { e.setDeltaMax(-1); }));
  EXPECT_TRUE(emptyAfter([](Estimation& e) { e.setDeltaMax(std::nan("")); }));
  EXPECT_TRUE(emptyAfter([](Estimation& e) { e.setNumberOfPairs(0); }));
  EXPECT_TRUE(emptyAfter([](Estimation& e) { e.setResolution({625, 1, 1, 1}); }));
  EXPECT_TRUE(emptyAfter([](Estimation& e) { e.setResolution({-5, -5, 5, 5}); }));
  Estimation without_normals;
  without_normals.setInputCloud(cloud.points);
  Descriptor none(2, 1);
  without_normals.compute(none);
  EXPECT_TRUE(none.empty());
  EXPECT_TRUE(describe(shapeCloud("cup", 1)).empty());
}
