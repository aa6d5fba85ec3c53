#include "pcl_surflet/core/cell_tree.h"
#include "pcl_surflet/core/morton_key.h"
#include "pcl_surflet/core/unrestricted_space.h"
#include "space_clouds.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <tuple>

using namespace pcl_surflet;
using namespace pcl_surflet::testing;

namespace {

Surflet
toSurflet(const Position& p, float nx = 0, float ny = 0, float nz = 1)
{
  return {p[0], p[1], p[2], nx, ny, nz};
}

std::vector<Cell>
cellsOf(const UnrestrictedSpace& space)
{
  std::vector<Cell> cells;
  space.forEachCell([&](const Cell& cell) { cells.push_back(cell); });
  return cells;
}

void
expectSameCells(const std::vector<Cell>& a, const std::vector<Cell>& b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].count, b[i].count);
    ASSERT_EQ(a[i].normal_agreement, b[i].normal_agreement);
    ASSERT_EQ(
        std::tie(a[i].mean.x, a[i].mean.y, a[i].mean.z, a[i].mean.nx, a[i].mean.ny, a[i].mean.nz),
        std::tie(b[i].mean.x, b[i].mean.y, b[i].mean.z, b[i].mean.nx, b[i].mean.ny, b[i].mean.nz));
  }
}

class DynamicSpaceTest : public ::testing::TestWithParam<TreeKind> {
protected:
  UnrestrictedSpace
  makeSpace(double cell, int depth)
  {
    UnrestrictedSpace::Options options;
    options.tree = GetParam();
    options.cell = cell;
    options.depth = depth;
    return UnrestrictedSpace(options);
  }
};

} // namespace

TEST_P(DynamicSpaceTest, EqualsBruteForceOnAwkwardClouds)
{
  const std::pair<double, int> sizes[] = {{0.01, 8}, {0.2, 2}, {4, 0}, {0.001, 30}};
  for (const auto& [share, depth] : sizes)
    for (const Cloud& cloud : awkwardClouds(1500)) {
      auto space = makeSpace(share * cloud.extent, depth);
      for (std::size_t i = 0; i < cloud.points.size(); ++i)
        ASSERT_TRUE(space.add(static_cast<PointIndex>(i), toSurflet(cloud.points[i])));
      ASSERT_EQ(space.size(), cloud.points.size());
      expectEqualsBruteForce(space, cloud, 30, static_cast<std::uint64_t>(depth));
      if (HasFatalFailure())
        return;
    }
}

TEST_P(DynamicSpaceTest, EqualsAPlainListAfterAnySequenceOfChanges)
{
  CounterRandom random(7);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const auto& [cell, depth] : {std::pair<double, int>{0.05, 3}, {0.3, 1}, {0.01, 25}}) {
    auto space = makeSpace(cell, depth);
    Cloud list = uniformCloud(0, -1, 1);
    list.points.assign(400, {nan, nan, nan}); // NaN: not there
    for (int step = 0; step < 3000; ++step) {
      const auto id = random.below(400);
      Position& p = list.points[id];
      const bool present = !std::isnan(p[0]);
      if (random.below(step / 500 % 2 == 0 ? 3 : 2) == 0) {
        ASSERT_EQ(space.remove(static_cast<PointIndex>(id)), present);
        p[0] = nan;
      }
      else {
        const Position q = {float(random.uniform(-1, 1)), float(random.uniform(-1, 1)),
                            float(random.uniform(-1, 1))};
        ASSERT_EQ(space.add(static_cast<PointIndex>(id), toSurflet(q)), !present);
        if (!present)
          p = q;
      }
      if (step % 100 == 99) {
        const Position q = {float(random.uniform(-1, 1)), float(random.uniform(-1, 1)), 0};
        std::vector<PointIndex> indices;
        std::vector<float> squares;
        space.regionSearch(q, random.uniform(0, 2), indices, &squares);
        expectEqualsBruteForce(space, list, 2, static_cast<std::uint64_t>(step));
        if (HasFatalFailure())
          return;
      }
    }
    for (PointIndex id = 0; id < 400; ++id)
      space.remove(id);
    EXPECT_EQ(space.size(), 0u);
    EXPECT_EQ(space.cubeCount(), 0u);
  }
}

TEST_P(DynamicSpaceTest, MeanSurfletsDependOnTheSetOfPointsAlone)
{
  CounterRandom random(8);
  const Cloud cloud = uniformCloud(2000, -1, 1);
  auto forward = makeSpace(0.1, 3), backward = makeSpace(0.1, 3);
  const auto surflet = [&](std::size_t i) {
    return toSurflet(cloud.points[i], float(i % 3) / 3, 0.5f, 1.0f / float(1 + i % 7));
  };
  for (std::size_t i = 0; i < 2000; ++i)
    forward.add(static_cast<PointIndex>(i), surflet(i));
  for (std::size_t i = 2000; i-- > 0;)
    backward.add(static_cast<PointIndex>(i), surflet(i));
  expectSameCells(cellsOf(forward), cellsOf(backward));
  for (PointIndex id = 0; id < 1000; ++id) { // out and in again, elsewhere in between
    backward.remove(id);
    backward.add(5000, toSurflet({float(random.uniform()), 3, -40}));
    backward.remove(5000);
    backward.add(id, surflet(static_cast<std::size_t>(id)));
  }
  expectSameCells(cellsOf(forward), cellsOf(backward));
}

TEST_P(DynamicSpaceTest, CellsHoldMeanSurflets)
{
  auto space = makeSpace(1, 4);
  space.add(0, {0.25f, 0.5f, 0.75f, 0, 0, 1});
  space.add(1, {0.75f, 0.25f, 0.5f, 0, 1, 0});
  space.add(2, {5.5f, 0, 0, 0, 0, 1});
  space.add(3, {5.25f, 0, 0, 0, 0, -1});
  space.add(4, {-1.5f, 0, 0, NAN, 0, 1}); // no normal
  const auto cells = cellsOf(space);
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_EQ(space.cubeCount(), 2u);
  EXPECT_FLOAT_EQ(cells[0].mean.x, -1.5f);
  EXPECT_EQ(cells[0].normal_agreement, 0);
  EXPECT_FLOAT_EQ(cells[1].mean.x, 0.5f);
  EXPECT_FLOAT_EQ(cells[1].mean.y, 0.375f);
  EXPECT_FLOAT_EQ(cells[1].mean.ny, float(std::sqrt(0.5)));
  EXPECT_NEAR(cells[1].normal_agreement, std::sqrt(0.5), 1e-6);
  EXPECT_EQ(cells[1].count, 2u);
  EXPECT_EQ(cells[2].normal_agreement, 0);
  EXPECT_EQ(cells[2].mean.nz, 0);
  std::vector<Cell> near;
  space.regionCells({0, 0, 0}, 1.5, near);
  EXPECT_EQ(near.size(), 2u);
  space.regionCells({0, 0, 0}, 1.4, near);
  EXPECT_EQ(near.size(), 1u);
}

TEST_P(DynamicSpaceTest, SpaceHasNoBounds)
{
  auto space = makeSpace(0.01, 8);
  const float big = std::numeric_limits<float>::max();
  const std::vector<Position> points = {{0, 0, 0},        {-0.0f, 0, 0},    {big, big, big},
                                        {-big, big, 0},   {1e10f, 0, 0},    {-1e-40f, 1e-40f, 0},
                                        {3e9f, 1, -2e9f}, {1e18f, 0, 1e18f}};
  Cloud cloud{"no bounds", points, 1e9};
  for (std::size_t i = 0; i < points.size(); ++i)
    ASSERT_TRUE(space.add(static_cast<PointIndex>(i), toSurflet(points[i])));
  for (const Position& q : points)
    for (const double r : {0.0, 1e-3, 1e10, 1e19}) {
      std::vector<PointIndex> indices;
      std::vector<float> squares;
      space.regionSearch(q, r, indices, &squares);
      EXPECT_EQ(toHits(indices, squares), bruteForceRegion(points, q, r)) << q[0] << ' ' << r;
    }
  for (PointIndex id = 0; id < static_cast<PointIndex>(points.size()); ++id)
    EXPECT_TRUE(space.remove(id));
  EXPECT_EQ(space.cubeCount(), 0u);
}

TEST_P(DynamicSpaceTest, ThreadsDoNotChangeTheResult)
{
  const Cloud cloud = uniformCloud(120000, -1, 1);
  auto space = makeSpace(0.02, 3);
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    space.add(static_cast<PointIndex>(i), toSurflet(cloud.points[i]));
  ASSERT_GT(space.cubeCount(), 100u);
  std::vector<PointIndex> one, more;
  std::vector<float> d1, dn;
  space.regionSearch({0, 0, 0}, 0.9, one, &d1);
  for (const unsigned threads : {2u, 5u, 0u}) {
    space.setNumberOfThreads(threads);
    space.regionSearch({0, 0, 0}, 0.9, more, &dn);
    EXPECT_EQ(one, more);
    EXPECT_EQ(d1, dn);
  }
  EXPECT_EQ(toHits(one, d1), bruteForceRegion(cloud.points, {0, 0, 0}, 0.9));
}

TEST_P(DynamicSpaceTest, MisuseIsNamed)
{
  EXPECT_THROW(makeSpace(0, 8), std::invalid_argument);
  EXPECT_THROW(makeSpace(NAN, 8), std::invalid_argument);
  EXPECT_THROW(makeSpace(1, -1), std::invalid_argument);
  EXPECT_THROW(makeSpace(1, 64), std::invalid_argument);
  EXPECT_THROW(makeSpace(1e300, 60), std::invalid_argument);
  auto space = makeSpace(1, 8);
  EXPECT_FALSE(space.add(-1, {}));
  EXPECT_FALSE(space.add(0, {NAN, 0, 0, 0, 0, 1}));
  EXPECT_TRUE(space.add(0, {}));
  EXPECT_FALSE(space.add(0, {}));
  EXPECT_FALSE(space.remove(1));
}

/** The plane of Fig. 4.5: twelve points in a square of 8 x 8 cells, and the region around q that
 * holds points 3, 11, 12 and 6. The figure's exact places are not printed; here each point lies in
 * its cell's middle unless the region must reach it. */
TEST_P(DynamicSpaceTest, WorkedExampleOfChapter442)
{
  const char* digits[] = {"230", "132", "121", "303", "021", "103",
                          "300", "013", "102", "003", "123", "120"};
  const CubeFrame frame{{0, 0, 0}, 8, 3};
  const auto tree = makeCellTree(GetParam(), frame);
  for (int i = 1; i <= 12; ++i) {
    const auto c = PlanarMortonKey::fromDigits(digits[i - 1]).coordinates();
    const float up = i == 6 ? 0.3f : i == 11 ? -0.2f : 0;
    tree->add(i, {float(c[0]) + 0.5f, float(c[1]) + 0.5f + up, 0.5f, 0, 0, 1});
  }
  // Cell 12 spans x 4..6 and y 2..4. Two neighbours are reached: 10 below it and 13 to the right.
  const Position q = {5.2f, 2.6f, 0.5f};
  const auto starts = findStartCells(frame, q, 0.95);
  EXPECT_EQ(starts.depth, 2);
  std::vector<std::string> prefixes;
  for (const auto& cell : starts.cells)
    prefixes.push_back(PlanarMortonKey::fromCoordinates(cell, 2).toString());
  EXPECT_EQ(prefixes, (std::vector<std::string>{"12", "10", "13"}));
  std::vector<PointIndex> indices;
  tree->regionSearch(q, 0.95, indices, nullptr);
  std::sort(indices.begin(), indices.end());
  EXPECT_EQ(indices, (std::vector<PointIndex>{3, 6, 11, 12}));
}

/** Where the list of explored prefixes, read literally, loses a point: below the root 102 the right
 * branch leads to 121 first, whose prefix 12 is explored, and only below it to 103. */
TEST_P(DynamicSpaceTest, KeysBelowAnExploredPrefixAreFound)
{
  const CubeFrame frame{{0, 0, 0}, 8, 3};
  const auto tree = makeCellTree(GetParam(), frame);
  int id = 0;
  for (const char* digits : {"102", "003", "121", "103"}) {
    const auto c = PlanarMortonKey::fromDigits(digits).coordinates();
    tree->add(id++, {float(c[0]) + 0.5f, float(c[1]) + 0.5f, 0.5f, 0, 0, 1});
  }
  std::vector<PointIndex> indices;
  tree->regionSearch({5.4f, 2.1f, 0.5f}, 0.9, indices, nullptr);
  std::sort(indices.begin(), indices.end());
  EXPECT_EQ(indices, (std::vector<PointIndex>{2, 3}));
}

INSTANTIATE_TEST_SUITE_P(Trees, DynamicSpaceTest,
                         ::testing::Values(TreeKind::Octree, TreeKind::AVL));

TEST(StartCells, EightAtMostAndTheyCoverTheRegion)
{
  CounterRandom random(9);
  const CubeFrame frame{{-1, -1, -1}, 2, 6};
  for (int i = 0; i < 2000; ++i) {
    const Position q = {float(random.uniform(-1, 1)), float(random.uniform(-1, 1)),
                        float(random.uniform(-1, 1))};
    const double r = random.uniform(0, 1) * random.uniform(0, 1) * random.uniform(0, 1);
    const auto starts = findStartCells(frame, q, r);
    EXPECT_LE(starts.cells.size(), 8u);
    EXPECT_LE(2 * r, frame.edgeAt(starts.depth));
    if (starts.depth < frame.depth) {
      EXPECT_GT(2.001 * r, frame.edgeAt(starts.depth + 1)); // the deepest such level
    }
    for (int k = 0; k < 20; ++k) { // any place of the sphere lies in one of the cells
      std::array<double, 3> p = {random.uniform(-r, r), random.uniform(-r, r),
                                 random.uniform(-r, r)};
      if (p[0] * p[0] + p[1] * p[1] + p[2] * p[2] > r * r)
        continue;
      bool inside = true;
      for (int a = 0; a < 3; ++a) {
        p[a] += q[a];
        inside = inside && std::abs(p[a]) < 1;
      }
      auto c = frame.coordinates(p);
      for (auto& v : c)
        v >>= frame.depth - starts.depth;
      if (inside) {
        EXPECT_NE(std::find(starts.cells.begin(), starts.cells.end(), c), starts.cells.end());
      }
    }
  }
}
