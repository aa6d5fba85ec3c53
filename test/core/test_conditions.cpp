#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

using namespace pcl_surflet;

namespace {

double
distance(const SurfletSet& a, std::size_t i, const SurfletSet& b, std::size_t j)
{
  return std::hypot(double(a.x[i]) - b.x[j], double(a.y[i]) - b.y[j], double(a.z[i]) - b.z[j]);
}

} // namespace

TEST(Conditions, RotationKeepsDistancesAndReachesAllOrientations)
{
  const auto set = sampleShape(*shapeByName("cup"), 50, 1);
  double mean[3] = {0, 0, 0};
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const auto turned = randomlyRotated(set, seed);
    mean[0] += turned.nx[0];
    mean[1] += turned.ny[0];
    mean[2] += turned.nz[0];
    if (seed % 100 != 0)
      continue;
    for (std::size_t i = 1; i < set.size(); ++i)
      EXPECT_NEAR(distance(turned, 0, turned, i), distance(set, 0, set, i), 1e-6);
    const double along =
        turned.nx[0] * turned.nx[1] + turned.ny[0] * turned.ny[1] + turned.nz[0] * turned.nz[1];
    EXPECT_NEAR(along, set.nx[0] * set.nx[1] + set.ny[0] * set.ny[1] + set.nz[0] * set.nz[1], 1e-5);
  }
  // Mean of 2000 uniform directions: each component has a standard deviation of 0.013.
  for (const double m : mean)
    EXPECT_LT(std::abs(m / 2000), 0.05);
}

TEST(Conditions, NoiseIsUniformAlongTheNormal)
{
  const auto ball = sampleShape(Shape::sphere(1), 20000, 1);
  const auto noisy = displacedAlongNormals(ball, 0.1, 2);
  double sum = 0, squares = 0, largest = 0;
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    const double r = std::hypot(noisy.x[i], noisy.y[i], noisy.z[i]) - 1;
    sum += r;
    squares += r * r;
    largest = std::max(largest, std::abs(r));
  }
  EXPECT_NEAR(sum / 20000, 0, 0.002);
  EXPECT_NEAR(squares / 20000, 0.01 / 3, 1e-4); // variance of a uniform distribution
  EXPECT_LE(largest, 0.1 + 1e-6);
  EXPECT_EQ(noisy.nx, ball.nx);
}

TEST(Conditions, CutLeavesTheShareOnOneSideOfAPlane)
{
  const auto ball = sampleShape(Shape::sphere(1), 10000, 1);
  for (const double visible : {1.0, 0.65, 0.25}) {
    const auto part = cutByRandomPlane(ball, visible, 5);
    EXPECT_EQ(part.size(), static_cast<std::size_t>(std::lround(10000 * visible)));
    // A spherical cap of that share of the area has its centroid (1 - visible) from the centre.
    const auto e = computeExtent(part);
    EXPECT_NEAR(std::hypot(e.centroid[0], e.centroid[1], e.centroid[2]), 1 - visible, 0.02);
  }
  EXPECT_EQ(cutByRandomPlane(ball, 1e-9, 5).size(), 1u);
  EXPECT_EQ(cutByRandomPlane(SurfletSet{}, 0.5, 5).size(), 0u);
  EXPECT_THROW(cutByRandomPlane(ball, std::nan(""), 5), std::invalid_argument);
  EXPECT_THROW(cutByRandomPlane(ball, 0, 5), std::invalid_argument);
}

TEST(Conditions, ScaledMeshHasTheDiameter)
{
  const auto mesh = scaledToDiameter(meshOfShape(Shape::box(1, 2, 2), 0.5), 10);
  SurfletSet vertices;
  for (const auto& v : mesh.vertices)
    vertices.push_back({v[0], v[1], v[2], 0, 0, 1});
  EXPECT_NEAR(farthestDistance(vertices), 10, 1e-4);
  EXPECT_THROW(scaledToDiameter(TriangleMesh{}, 1), std::invalid_argument);
}
