// What a real sensor does wrong: noise, quanta, grazing surfaces, flying points, shadows.
#include "depth_pictures.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

namespace {

double
deviation(const DepthScan& scan, double truth, double& mean)
{
  double sum = 0, squares = 0, n = 0;
  for (const float z : scan.z) {
    sum += z - truth;
    squares += (z - truth) * (z - truth);
    ++n;
  }
  mean = sum / n;
  return std::sqrt(squares / n - mean * mean);
}

} // namespace

TEST(DepthSensor, NoiseHasItsDeviationAndGrowsWithDepth)
{
  DepthSensor sensor = small();
  sensor.noise = 0.002;
  double mean = 0;
  // 19,200 pixels: the deviation is known within 0.5 % (one standard error).
  const DepthScan flat = sense({square({0, 2, 0}, 20, 1)}, sensor, alongY(), 5);
  EXPECT_NEAR(deviation(flat, 2, mean), 0.002, 0.00005);
  EXPECT_NEAR(mean, 0, 0.00007);
  sensor.noise_power = 2;
  EXPECT_NEAR(deviation(sense({square({0, 2, 0}, 20, 1)}, sensor, alongY(), 5), 2, mean), 0.008,
              0.0002);
  EXPECT_NEAR(deviation(sense({square({0, 1, 0}, 20, 1)}, sensor, alongY(), 5), 1, mean), 0.002,
              0.00005);
  for (std::size_t i = 0; i < flat.z.size(); ++i) { // points stay on their lines of sight
    EXPECT_NEAR(flat.x[i], flat.z[i] * rayOf(sensor, i)[0], 1e-6);
    EXPECT_NEAR(flat.y[i], flat.z[i] * rayOf(sensor, i)[1], 1e-6);
  }
}

TEST(DepthSensor, SeedsDecideAboutNoise)
{
  DepthSensor sensor = small();
  sensor.noise = 0.001;
  sensor.flying = 0.5;
  const std::vector<SensedBody> bodies = {square({0, 2, 0}, 20, 1), square({0, 1, 0}, 0.3, 2)};
  const DepthScan one = sense(bodies, sensor, alongY(), 1),
                  same = sense(bodies, sensor, alongY(), 1),
                  other = sense(bodies, sensor, alongY(), 2);
  EXPECT_EQ(one.z, same.z);
  EXPECT_EQ(one.labels, same.labels);
  EXPECT_NE(one.z, other.z);
}

TEST(DepthSensor, DepthsAreMultiplesOfTheQuantum)
{
  DepthSensor sensor = small();
  sensor.quantum = 0.01;
  sensor.noise = 0.003;
  SensorPose pose;
  pose.position = {0, -1, 0.3};
  const DepthScan scan = sense({ball(0.3)}, sensor, pose, 1);
  ASSERT_GT(returns(scan), 1000u);
  for (std::size_t i = 0; i < scan.z.size(); ++i)
    if (returned(scan, i)) {
      EXPECT_NEAR(scan.z[i] / 0.01, std::round(scan.z[i] / 0.01), 1e-4);
    }
}

TEST(DepthSensor, NothingReturnsFromGrazingSurfaces)
{
  DepthSensor sensor = small();
  sensor.opening = 120;
  sensor.grazing = 50;
  const DepthScan scan = sense({square({0, 1, 0}, 20, 1)}, sensor, alongY(), 1);
  std::size_t missing = 0;
  for (std::size_t i = 0; i < scan.z.size(); ++i) {
    const double angle = std::acos(1 / norm(rayOf(sensor, i))) * 180 / M_PI;
    if (std::abs(angle - 50) > 1e-6) {
      EXPECT_EQ(returned(scan, i), angle < 50) << angle;
    }
    missing += angle > 50 ? 1 : 0;
  }
  EXPECT_GT(missing, 1000u);
  // What returns nothing still hides what is behind it.
  SensedBody floor; // the plane z = -0.1, seen at a grazing angle
  floor.mesh.vertices = {{-9, 0.1f, -0.1f}, {9, 0.1f, -0.1f}, {9, 90, -0.1f}, {-9, 90, -0.1f}};
  floor.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto hidden = square({0, 4, -1.1}, 1.8, 2); // below the floor
  EXPECT_EQ(returns(sense({floor, hidden}, sensor, alongY(), 1)),
            returns(sense({floor}, sensor, alongY(), 1)));
}

TEST(DepthSensor, FlyingPointsLieBetweenBothSidesOfEdges)
{
  DepthSensor sensor = small();
  sensor.flying = 0.5;
  const std::vector<SensedBody> bodies = {square({0, 2, 0}, 20, 1), square({0, 1, 0}, 0.4, 2)};
  const DepthScan scan = sense(bodies, sensor, alongY(), 1);
  sensor.flying = 0;
  const DepthScan still = sense(bodies, sensor, alongY(), 1);
  std::size_t at_edges = 0, flying = 0;
  for (std::size_t i = 0; i < scan.z.size(); ++i) {
    const std::size_t c = i % 160, r = i / 160;
    const auto differs = [&](bool inside, std::size_t k) {
      return inside && still.labels[k] != still.labels[i];
    };
    const bool edge = differs(c > 0, i - 1) || differs(c < 159, i + 1) || differs(r > 0, i - 160) ||
                      differs(r < 119, i + 160);
    at_edges += edge ? 1 : 0;
    if (scan.labels[i] != 0) {
      EXPECT_EQ(scan.z[i], still.z[i]);
      continue;
    }
    ++flying;
    EXPECT_TRUE(edge);
    EXPECT_GE(scan.z[i], 1 - 1e-6);
    EXPECT_LE(scan.z[i], 2 + 1e-6);
    EXPECT_EQ(scan.instances[i], 0u);
  }
  ASSERT_GT(at_edges, 200u);
  EXPECT_NEAR(static_cast<double>(flying) / static_cast<double>(at_edges), 0.5, 0.1);
}

TEST(DepthSensor, TheProjectorsShadowIsMissing)
{
  DepthSensor sensor = small();
  const auto wall = square({0, 2, 0}, 20, 1), near = square({0, 1, 0}, 0.3, 2);
  for (const double baseline : {0.2, -0.2}) {
    sensor.baseline = baseline;
    const DepthScan scan = sense({wall, near}, sensor, alongY(), 1);
    // Projected from beside the camera to twice the distance, and beyond what it lights at all.
    const double lit = 2 * std::tan(28.5 * M_PI / 180), slack = 0.04;
    std::size_t shadow = 0;
    for (std::size_t i = 0; i < scan.z.size(); ++i) {
      if (std::abs(rayOf(sensor, i)[0]) < 0.17 && std::abs(rayOf(sensor, i)[1]) < 0.17)
        continue; // the near square or its border
      const double x = 2 * rayOf(sensor, i)[0], z = 2 * rayOf(sensor, i)[1];
      const double inside = 0.3 - std::max(std::abs(x + baseline), std::abs(z));
      const double beyond = std::abs(x - baseline) - lit;
      if (std::abs(inside) < slack || std::abs(beyond) < slack)
        continue;
      EXPECT_EQ(returned(scan, i), inside < 0 && beyond < 0) << x << " " << z;
      shadow += inside > 0 ? 1 : 0;
    }
    EXPECT_GT(shadow, 100u);
  }
}

TEST(DepthSensor, TheProjectorLightsAllOfASlopeThatNothingShadows)
{
  DepthSensor sensor = small();
  sensor.baseline = 0.6;
  SensorPose pose;
  pose.position = {0, -1.5, 0.7};
  const DepthScan lit = sense({ball(0.2)}, sensor, pose, 1);
  sensor.baseline = 0;
  const DepthScan all = sense({ball(0.2)}, sensor, pose, 1);
  // About a phase of the moon: camera and projector are 20 degrees apart.
  const double share = static_cast<double>(returns(lit)) / static_cast<double>(returns(all));
  EXPECT_NEAR(share, (1 + std::cos(20 * M_PI / 180)) / 2, 0.015);
}
