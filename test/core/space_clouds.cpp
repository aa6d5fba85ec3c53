#include "space_clouds.h"

#include <gtest/gtest.h>

namespace pcl_surflet {
namespace testing {

namespace {

void
expectRegion(const RegionIndex& index, const Cloud& cloud, const Position& q, double radius)
{
  const Hits expected = bruteForceRegion(cloud.points, q, radius);
  std::vector<PointIndex> indices = {7, 8, 9}; // results replace what was there
  std::vector<float> squares = {1};
  index.regionSearch(q, radius, indices, &squares);
  ASSERT_EQ(indices.size(), squares.size());
  ASSERT_EQ(toHits(indices, squares), expected) << cloud.name << " r = " << radius;
  index.regionSearch(q, radius, indices, nullptr);
  std::sort(indices.begin(), indices.end());
  ASSERT_EQ(indices, sortedIndices(expected)) << cloud.name << " r = " << radius;
}

void
expectNearest(const RegionIndex& index, const Cloud& cloud, const Position& q, std::size_t k)
{
  Hits expected = bruteForceRegion(cloud.points, q, std::numeric_limits<double>::infinity());
  expected.resize(std::min(k, expected.size()));
  std::vector<PointIndex> indices;
  std::vector<float> squares;
  index.nearestSearch(q, k, indices, squares);
  ASSERT_TRUE(std::is_sorted(squares.begin(), squares.end()));
  ASSERT_EQ(toHits(indices, squares), expected) << cloud.name << " k = " << k;
}

void
expectBox(const RegionIndex& index, const Cloud& cloud, const Position& low, const Position& high)
{
  std::vector<PointIndex> expected, indices;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    bool inside = true;
    for (int a = 0; a < 3; ++a)
      inside = inside && low[a] <= cloud.points[i][a] && cloud.points[i][a] <= high[a];
    if (inside)
      expected.push_back(static_cast<PointIndex>(i));
  }
  index.boxSearch(low, high, indices);
  std::sort(indices.begin(), indices.end());
  ASSERT_EQ(indices, expected) << cloud.name;
}

} // namespace

void
expectEqualsBruteForce(const RegionIndex& index, const Cloud& cloud, int queries,
                       std::uint64_t seed)
{
  CounterRandom random(seed);
  for (int i = 0; i < queries; ++i) {
    const Position q = queryCentre(cloud, random);
    expectRegion(index, cloud, q, queryRadius(cloud, q, random));
    expectNearest(index, cloud, q, random.below(40));
    Position high = queryCentre(cloud, random), low = q;
    for (int a = 0; a < 3; ++a)
      if (low[a] > high[a])
        std::swap(low[a], high[a]);
    expectBox(index, cloud, low, high);
    if (::testing::Test::HasFatalFailure())
      return;
  }
}

} // namespace testing
} // namespace pcl_surflet
