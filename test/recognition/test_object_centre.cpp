// The middle of an object of which a part is seen.
#include "pcl_surflet/recognition/object_centre.h"

#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

using namespace pcl_surflet;

namespace {

using Point = std::array<double, 3>;

constexpr double kRadius = 0.1; ///< of the sphere, whose r_mean it is

/** \brief What a distant sensor in direction \p to sees of a sphere about \p centre. */
SurfletSet
halfSphere(const Point& centre, const Point& to, double scale = 1)
{
  const SurfletSet whole = sampleShape(Shape::sphere(kRadius), 4000, 3);
  SurfletSet out;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    Surflet s = whole[i];
    if (s.nx * to[0] + s.ny * to[1] + s.nz * to[2] <= 0)
      continue;
    s.x = static_cast<float>(scale * (s.x + centre[0]));
    s.y = static_cast<float>(scale * (s.y + centre[1]));
    s.z = static_cast<float>(scale * (s.z + centre[2]));
    out.push_back(s);
  }
  return out;
}

Point
guessOf(const SurfletSet& cells, const CentreWeights& weights, double r_mean = kRadius)
{
  std::vector<std::uint32_t> all(cells.size());
  std::iota(all.begin(), all.end(), 0U);
  return ObjectCentre::guess(cells, all, r_mean, weights);
}

double
distance(const Point& a, const Point& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

CentreWeights
learned()
{
  ObjectCentre centre(kRadius);
  for (const Point& to : {Point{1, 0, 0}, Point{0, -0.6, 0.8}, Point{-0.6, 0, -0.8}})
    centre.learn(halfSphere({0.3, 0.2, -0.1}, to), {0.3, 0.2, -0.1});
  return centre.weights();
}

} // namespace

TEST(ObjectCentre, AHalfSphereTellsItsCentre)
{
  const Point centre = {-0.5, 2, 0.25};
  const SurfletSet seen = halfSphere(centre, {0.8, 0.6, 0});
  EXPECT_NEAR(distance(guessOf(seen, {}), centre), kRadius / 2, 0.003) << "its middle is R / 2 off";
  EXPECT_LT(distance(guessOf(seen, learned()), centre), 0.003);
}

TEST(ObjectCentre, NothingLearnedIsTheMiddle)
{
  EXPECT_EQ(ObjectCentre(kRadius).weights(), CentreWeights{});
  const SurfletSet seen = halfSphere({1, 2, 3}, {0, 0, 1});
  const Extent extent = computeExtent(seen);
  EXPECT_LT(
      distance(guessOf(seen, {}), {extent.centroid[0], extent.centroid[1], extent.centroid[2]}),
      1e-6);
}

TEST(ObjectCentre, TurnsAndScalesWithTheCells)
{
  const CentreWeights weights = {0.3, -0.2, 0.5, 0.7, -0.4, 0.1, 0.6};
  const SurfletSet cells = sampleShape(*shapeByName("cup"), 500, 1);
  SurfletSet place, large = cells;
  const Point at = guessOf(cells, weights);
  place.push_back(
      {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2]), 0, 0, 1});
  const Surflet turned = randomlyRotated(place, 5)[0];
  EXPECT_LT(distance(guessOf(randomlyRotated(cells, 5), weights), {turned.x, turned.y, turned.z}),
            1e-6);
  for (auto* axis : {&large.x, &large.y, &large.z})
    for (float& v : *axis)
      v *= 1024;
  const Point far = guessOf(large, weights, 1024 * kRadius);
  EXPECT_LT(distance(far, {1024 * at[0], 1024 * at[1], 1024 * at[2]}), 1e-3);
}

TEST(ObjectCentre, IsNeverFarFromItsCells)
{
  const SurfletSet seen = halfSphere({0, 0, 0}, {0, 0, 1});
  CentreWeights wild;
  wild.fill(1e300);
  EXPECT_NEAR(distance(guessOf(seen, wild), guessOf(seen, {})), 2 * kRadius, 1e-6);
  CentreWeights wilder;
  wilder.fill(1.7e308);
  EXPECT_TRUE(std::isfinite(guessOf(seen, wilder)[0]));
  EXPECT_EQ(guessOf(SurfletSet(), wild), Point{});
  EXPECT_EQ(guessOf(seen, learned(), 0), guessOf(seen, {})) << "a model without extent";
}
