#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pcl_surflet;

namespace {

double
bruteForceFarthest(const SurfletSet& set)
{
  double best = 0;
  for (std::size_t i = 0; i < set.size(); ++i)
    for (std::size_t j = i + 1; j < set.size(); ++j) {
      const double x = double(set.x[i]) - set.x[j], y = double(set.y[i]) - set.y[j],
                   z = double(set.z[i]) - set.z[j];
      best = std::max(best, x * x + y * y + z * z);
    }
  return std::sqrt(best);
}

SurfletSet
transformed(SurfletSet set, float scale, float shift)
{
  for (auto* column : {&set.x, &set.y, &set.z})
    for (float& c : *column)
      c = c * scale + shift;
  return set;
}

} // namespace

TEST(FarthestDistance, EqualsBruteForceOnAllShapes)
{
  for (const auto& name : shapeNames())
    for (const std::size_t n : {2, 3, 17, 100, 1500}) {
      const auto set = sampleShape(*shapeByName(name), n, 3);
      EXPECT_NEAR(farthestDistance(set) / bruteForceFarthest(set), 1, 1e-6) << name << " " << n;
    }
}

TEST(FarthestDistance, DegenerateClouds)
{
  SurfletSet set;
  EXPECT_EQ(farthestDistance(set), 0);
  set.push_back({1, 2, 3, 0, 0, 1});
  EXPECT_EQ(farthestDistance(set), 0);
  for (int i = 0; i < 100; ++i)
    set.push_back({1, 2, 3, 0, 0, 1});
  EXPECT_EQ(farthestDistance(set), 0);
  for (int i = 0; i < 100; ++i)
    set.push_back({1 + float(i), 2, 3, 0, 0, 1});
  EXPECT_NEAR(farthestDistance(set), 99, 1e-4);
}

TEST(FarthestDistance, AbsurdScaleAndOffset)
{
  const auto set = sampleShape(*shapeByName("bottle"), 500, 1);
  for (const float scale : {1e-30f, 1e30f})
    EXPECT_NEAR(farthestDistance(transformed(set, scale, 0)) / (scale * farthestDistance(set)), 1,
                1e-5);
  const auto far = transformed(set, 1000, 1e6f);
  EXPECT_NEAR(farthestDistance(far) / bruteForceFarthest(far), 1, 1e-6);
}

TEST(Extent, SphereAndBallOfKnownRadii)
{
  const auto set = transformed(sampleShape(Shape::sphere(0.5), 20000, 4), 1, 7);
  const Extent e = computeExtent(set);
  for (const double c : e.centroid)
    EXPECT_NEAR(c, 7, 0.01);
  EXPECT_NEAR(e.r_mean, 0.5, 0.001);
  EXPECT_NEAR(e.r_max, 0.5, 0.02);
  EXPECT_NEAR(e.r_min, 0.5, 0.02);
}

TEST(SurfaceDensity, TellsEvenFromUneven)
{
  for (const auto& name : shapeNames())
    EXPECT_LT(surfaceDensity(sampleShape(*shapeByName(name), 5000, 2)).contrast, kUnevenContrast)
        << name;
  // One half of a sphere nine times as dense as the other.
  const auto sphere = sampleShape(Shape::sphere(1), 10000, 5);
  SurfletSet uneven;
  for (std::size_t i = 0; i < sphere.size(); ++i)
    if (sphere.z[i] > 0 || i % 9 == 0)
      uneven.push_back(sphere[i]);
  EXPECT_GT(surfaceDensity(uneven).contrast, kUnevenContrast);
}

TEST(SurfaceDensity, SpacingOfAKnownDensity)
{
  // n points on unit area: the expected area holding 8 neighbours is 8 / n.
  const std::size_t n = 20000;
  const auto density = surfaceDensity(sampleShape(Shape::plane(1, 1), n, 6));
  EXPECT_NEAR(density.spacing / std::sqrt(8.0 / (M_PI * n)), 1, 0.1);
  EXPECT_GT(density.widest, density.spacing);
  EXPECT_EQ(surfaceDensity(SurfletSet{}).contrast, 1);
}
