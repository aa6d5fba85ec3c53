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

TEST(Conditions, AViewShowsWhatFacesTheSensorAndNothingHides)
{
  const auto ball = sampleShape(Shape::sphere(1), 5000, 1);
  const double spacing = std::sqrt(4 * M_PI / 5000);
  const auto seen = singleView(ball, spacing, 0, 4);
  // Half of the ball faces the sensor, a share of 0.1 of that at a grazing angle.
  EXPECT_NEAR(static_cast<double>(seen.size()) / 5000, 0.45, 0.01);
  const auto e = computeExtent(seen);
  const double length = std::hypot(e.centroid[0], e.centroid[1], e.centroid[2]);
  EXPECT_NEAR(length, 0.55, 0.01) << "a cap of heights 0.1 to 1";
}

TEST(Conditions, AViewHidesWhatLiesBehind)
{
  // A small ball within a large one, both evenly sampled, is seen from nowhere.
  const auto even = [](double radius, std::size_t n) {
    return sampleIsoMesh(meshOfShape(Shape::sphere(radius), radius / 20), n, 1);
  };
  SurfletSet both = even(1, 4000);
  const std::size_t large = both.size();
  const auto small = even(0.5, 1000);
  for (std::size_t i = 0; i < small.size(); ++i)
    both.push_back(small[i]);
  const auto seen = singleView(both, std::sqrt(4 * M_PI / 4000), 0, 4);
  std::size_t inner = 0;
  for (std::size_t i = 0; i < seen.size(); ++i)
    inner += std::hypot(seen.x[i], seen.y[i], seen.z[i]) < 0.75;
  EXPECT_LT(inner, 10u);
  EXPECT_NEAR(static_cast<double>(seen.size() - inner) / static_cast<double>(large), 0.45, 0.02);
}

TEST(Conditions, NoiseOfAViewIsAlongTheLineOfSight)
{
  const auto ball = sampleShape(Shape::sphere(1), 5000, 1);
  const auto clean = singleView(ball, 0.05, 0, 4), noisy = singleView(ball, 0.05, 0.01, 4);
  ASSERT_EQ(clean.size(), noisy.size());
  const auto e = computeExtent(clean); // towards the sensor
  const double length = std::hypot(e.centroid[0], e.centroid[1], e.centroid[2]);
  double largest = 0;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    const double d[3] = {double(noisy.x[i]) - clean.x[i], double(noisy.y[i]) - clean.y[i],
                         double(noisy.z[i]) - clean.z[i]};
    const double along =
        (d[0] * e.centroid[0] + d[1] * e.centroid[1] + d[2] * e.centroid[2]) / length;
    EXPECT_NEAR(std::abs(along), std::hypot(d[0], d[1], d[2]), 1e-3);
    largest = std::max(largest, std::abs(along));
  }
  EXPECT_NEAR(largest, 0.01, 2e-4);
  EXPECT_EQ(clean.nx, noisy.nx);
  EXPECT_THROW(singleView(ball, 0, 0, 1), std::invalid_argument);
}

TEST(Conditions, PrincipalAxesAreThoseOfABoxHoweverItIsTurned)
{
  const auto box = sampleShape(Shape::box(4, 1, 2), 20000, 1);
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const auto turned = randomlyRotated(box, seed);
    SurfletSet frame; // turns like the box: its normals are where the box's own axes went
    for (const auto& axis : {Surflet{0, 0, 0, 1, 0, 0}, {0, 0, 0, 0, 0, 1}, {0, 0, 0, 0, 1, 0}})
      frame.push_back(axis);
    frame = randomlyRotated(frame, seed);
    const auto axes = principalAxes(turned);
    for (std::size_t a = 0; a < 3; ++a) {
      const double along =
          axes[a][0] * frame.nx[a] + axes[a][1] * frame.ny[a] + axes[a][2] * frame.nz[a];
      EXPECT_NEAR(std::abs(along), 1, 1e-3) << "axis " << a << " seed " << seed;
    }
  }
  for (const auto& axis : principalAxes(SurfletSet{}))
    EXPECT_EQ(std::hypot(axis[0], axis[1], axis[2]), 1);
}

TEST(Conditions, StretchingAlongTurnedAxes)
{
  const double h = std::sqrt(0.5);
  const std::array<std::array<double, 3>, 3> axes = {{{h, h, 0}, {-h, h, 0}, {0, 0, 1}}};
  TriangleMesh mesh;
  mesh.vertices = {{1, 1, 0}, {-1, 1, 0}, {0, 0, 3}};
  mesh.triangles = {{0, 1, 2}};
  const auto out = stretched(mesh, axes, {2, 0.5, 1});
  const TriangleMesh::Point expected[] = {{2, 2, 0}, {-0.5, 0.5, 0}, {0, 0, 3}};
  for (std::size_t v = 0; v < 3; ++v)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(out.vertices[v][k], expected[v][k], 1e-6);
  EXPECT_EQ(out.triangles, mesh.triangles);
  EXPECT_THROW(stretched(mesh, axes, {0, 1, 1}), std::invalid_argument);
  EXPECT_THROW(stretched(mesh, axes, {1, std::nan(""), 1}), std::invalid_argument);
}

TEST(Conditions, DistortionIsNegativeWhereItShrinksMore)
{
  EXPECT_EQ(distortionMeasure({1, 1, 1}), 0);
  EXPECT_NEAR(distortionMeasure({1.5, 1, 1}), 0.5, 1e-12);
  EXPECT_NEAR(distortionMeasure({1, 0.5, 1}), -0.5, 1e-12);
  // A mean would not see this one (the reason for the metric).
  EXPECT_NEAR(distortionMeasure({1.5, 0.5, 1}), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(distortionMeasure({0.2, 0.2, 0.2}), -0.8 * std::sqrt(3.0), 1e-12);
}
