#include "pcl_surflet/core/linear_octree.h"
#include "space_clouds.h"

#include <gtest/gtest.h>

#include <stdexcept>

using namespace pcl_surflet;
using namespace pcl_surflet::testing;

namespace {

PointArray
asArray(const std::vector<Position>& points)
{
  const float* p = points.empty() ? nullptr : points[0].data();
  return {p, p + 1, p + 2, 3, points.size()};
}

LinearOctree
makeOctree(const std::vector<Position>& points, InstructionSet set = InstructionSet::Automatic)
{
  LinearOctree octree;
  LinearOctree::Options options;
  options.instruction_set = set;
  octree.setOptions(options);
  octree.build(asArray(points));
  return octree;
}

class LinearOctreeTest : public ::testing::TestWithParam<InstructionSet> {
protected:
  void
  SetUp() override
  {
    if (!isSupported(GetParam()))
      GTEST_SKIP() << "this machine lacks the instruction set";
  }
};

} // namespace

TEST_P(LinearOctreeTest, EqualsBruteForceOnAwkwardClouds)
{
  for (const std::size_t n : {5000, 1024, 300, 17})
    for (const Cloud& cloud : awkwardClouds(n)) {
      const auto octree = makeOctree(cloud.points, GetParam());
      ASSERT_EQ(octree.size(), cloud.points.size());
      expectEqualsBruteForce(octree, cloud, 60, n);
      if (HasFatalFailure())
        return;
    }
}

TEST_P(LinearOctreeTest, SameResultsInTheSameOrderAsTheScalarKernel)
{
  const Cloud cloud = uniformCloud(20000);
  const auto scalar = makeOctree(cloud.points, InstructionSet::Scalar);
  const auto other = makeOctree(cloud.points, GetParam());
  CounterRandom random(5);
  std::vector<PointIndex> a, b;
  std::vector<float> da, db;
  for (int i = 0; i < 300; ++i) {
    const Position q = queryCentre(cloud, random);
    const double r = queryRadius(cloud, q, random);
    scalar.regionSearch(q, r, a, &da);
    other.regionSearch(q, r, b, &db);
    ASSERT_EQ(a, b);
    ASSERT_EQ(da, db);
    other.regionSearch(q, r, b, nullptr);
    ASSERT_EQ(a, b);
  }
}

TEST_P(LinearOctreeTest, RangesHoldWhatRegionSearchFinds)
{
  for (const Cloud& cloud : awkwardClouds(2000)) {
    const auto octree = makeOctree(cloud.points, GetParam());
    CounterRandom random(6);
    for (int i = 0; i < 40; ++i) {
      const Position q = queryCentre(cloud, random);
      const double r = queryRadius(cloud, q, random);
      std::vector<PlaceRange> ranges;
      octree.regionRanges(q, r, ranges);
      std::vector<PointIndex> found;
      for (std::size_t k = 0; k < ranges.size(); ++k) {
        ASSERT_LT(ranges[k].begin, ranges[k].end);
        if (k > 0) {
          ASSERT_LT(ranges[k - 1].end, ranges[k].begin);
        }
        for (auto place = ranges[k].begin; place < ranges[k].end; ++place) {
          found.push_back(octree.indexAt(place));
          ASSERT_EQ(octree.positionAt(place), cloud.points[found.back()]);
        }
      }
      std::sort(found.begin(), found.end());
      ASSERT_EQ(found, sortedIndices(bruteForceRegion(cloud.points, q, r))) << cloud.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, LinearOctreeTest,
                         ::testing::Values(InstructionSet::Scalar, InstructionSet::Avx2,
                                           InstructionSet::Avx512));

TEST(LinearOctree, RadiusIsInclusive)
{
  const auto octree = makeOctree({{0, 0, 0}, {3, 4, 0}});
  std::vector<PointIndex> indices;
  octree.regionSearch({0, 0, 0}, 5, indices, nullptr);
  EXPECT_EQ(indices.size(), 2u);
  octree.regionSearch({0, 0, 0}, 4.999, indices, nullptr);
  EXPECT_EQ(indices.size(), 1u);
  octree.regionSearch({3, 4, 0}, 0, indices, nullptr);
  EXPECT_EQ(indices, std::vector<PointIndex>{1});
}

TEST(LinearOctree, NonFinitePointsAreLeftOut)
{
  Cloud cloud = uniformCloud(1000);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  cloud.points[3][1] = nan;
  cloud.points[500][2] = inf;
  cloud.points[999] = {-inf, nan, 0};
  const auto octree = makeOctree(cloud.points);
  EXPECT_EQ(octree.size(), 997u);
  std::vector<PointIndex> indices;
  octree.regionSearch({0, 0, 0}, inf, indices, nullptr);
  EXPECT_EQ(indices.size(), 997u);
  octree.boxSearch({-inf, -inf, -inf}, {inf, inf, inf}, indices);
  EXPECT_EQ(indices.size(), 997u);
}

TEST(LinearOctree, SubsetsNameTheUsersIndices)
{
  Cloud cloud = uniformCloud(1000);
  LinearOctree octree;
  std::vector<PointIndex> subset;
  for (PointIndex i = 990; i >= 0; i -= 3)
    subset.push_back(i);
  const PointArray points = asArray(cloud.points);
  octree.build(points, &subset);
  for (PointIndex i = 0; i < 1000; ++i)
    if (i % 3 != 0 || i > 990)
      cloud.points[i][0] = std::numeric_limits<float>::quiet_NaN();
  const auto q = Position{0.5f, 0.5f, 0.5f};
  std::vector<PointIndex> indices;
  octree.regionSearch(q, 0.4, indices, nullptr);
  std::sort(indices.begin(), indices.end());
  EXPECT_EQ(indices, sortedIndices(bruteForceRegion(cloud.points, q, 0.4)));
  subset.push_back(1000);
  EXPECT_THROW(octree.build(points, &subset), std::out_of_range);
}

TEST(LinearOctree, UselessQueriesFindNothing)
{
  const auto octree = makeOctree(uniformCloud(100).points);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<PointIndex> indices = {1};
  std::vector<float> squares = {1};
  for (const auto& [x, r] : {std::pair<float, double>{0.5f, -1.0}, {0.5f, NAN}, {nan, 1.0}}) {
    octree.regionSearch({x, 0.5f, 0.5f}, r, indices, &squares);
    EXPECT_TRUE(indices.empty());
    EXPECT_TRUE(squares.empty());
  }
  octree.nearestSearch({nan, 0, 0}, 3, indices, squares);
  EXPECT_TRUE(indices.empty());
  octree.nearestSearch({0, 0, 0}, 0, indices, squares);
  EXPECT_TRUE(indices.empty());
}

TEST(LinearOctree, TwentyBytesPerPoint)
{
  for (const Cloud& cloud : {uniformCloud(84000), sphereCloud(84000), clusteredCloud(84000)}) {
    const auto octree = makeOctree(cloud.points);
    EXPECT_LE(octree.memoryUsage(), 20 * cloud.points.size()) << cloud.name;
  }
}
