// Where sensors stand and how their frames lie.
#include "depth_pictures.h"

#include "pcl_surflet/core/counter_random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

TEST(DepthSensor, APassGoesThereAndBackOnTheOtherSide)
{
  ViewOptions views;
  views.views = ViewSet::Pass;
  views.target = {1, 2, 3};
  views.distance = 5;
  views.elevation = 0;
  views.path = 4;
  views.stops = 6;
  const auto poses = sensorPoses(views);
  ASSERT_EQ(poses.size(), 6u);
  const double x[] = {-1, 1, 3, 3, 1, -1};
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(poses[k].target[0], x[k], 1e-12);
    EXPECT_NEAR(poses[k].position[0], x[k], 1e-12);
    EXPECT_NEAR(poses[k].position[1], k < 3 ? -3 : 7, 1e-12);
    EXPECT_NEAR(poses[k].position[2], 3, 1e-12);
  }
  views.stops = 1;
  EXPECT_THROW(sensorPoses(views), std::invalid_argument);
  views.stops = 2;
  views.path = -1;
  EXPECT_THROW(sensorPoses(views), std::invalid_argument);
}

TEST(SensorFrame, AxesAndQuaternionAgree)
{
  CounterRandom random(3);
  for (int k = 0; k < 200; ++k) {
    SensorPose pose;
    pose.position = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (k % 4 == 0) // straight down
      pose.target = {pose.position[0], pose.position[1], -5};
    const SensorFrame f(pose);
    EXPECT_NEAR(norm(f.right), 1, 1e-12);
    EXPECT_NEAR(dot(f.right, f.forward), 0, 1e-12);
    EXPECT_NEAR(dot(cross(f.right, f.down), f.forward), 1, 1e-12) << "x, y, z are right-handed";
    EXPECT_LE(f.down[2], 1e-12) << "upright";
    const Vec p = {0.3, -0.2, 1.1}, back = f.toSensor(f.toScene(p));
    EXPECT_LT(norm(subtract(p, back)), 1e-12);
    // q v q^-1 by its definition: v + 2 w (u x v) + 2 u x (u x v).
    const auto q = f.quaternion();
    EXPECT_GE(q[0], 0);
    const Vec u = {q[1], q[2], q[3]};
    const auto turned = [&](const Vec& v) {
      const Vec a = cross(u, v), b = cross(u, a);
      return Vec{v[0] + 2 * q[0] * a[0] + 2 * b[0], v[1] + 2 * q[0] * a[1] + 2 * b[1],
                 v[2] + 2 * q[0] * a[2] + 2 * b[2]};
    };
    EXPECT_LT(norm(subtract(turned({1, 0, 0}), f.right)), 1e-12);
    EXPECT_LT(norm(subtract(turned({0, 1, 0}), f.down)), 1e-12);
    EXPECT_LT(norm(subtract(turned({0, 0, 1}), f.forward)), 1e-12);
  }
}

TEST(SensorPoses, AreWhereTheirSetSays)
{
  ViewOptions o;
  o.target = {1, 2, 3};
  o.distance = 2;
  o.azimuth = 10;
  for (const auto& [views, count] :
       {std::pair{ViewSet::One, 1u}, std::pair{ViewSet::Two, 2u}, std::pair{ViewSet::Ring24, 24u},
        std::pair{ViewSet::All24, 24u}}) {
    o.views = views;
    const auto poses = sensorPoses(o);
    ASSERT_EQ(poses.size(), count);
    Vec sum{0, 0, 0};
    for (const auto& pose : poses) {
      EXPECT_EQ(pose.target, o.target);
      const Vec d = subtract(pose.position, o.target);
      EXPECT_NEAR(norm(d), 2, 1e-12);
      for (std::size_t k = 0; k < 3; ++k)
        sum[k] += d[k];
    }
    if (count > 1) {
      EXPECT_LT(std::hypot(sum[0], sum[1]) / count, 0.05) << "from all sides";
    }
  }
  o.views = ViewSet::Ring24;
  const auto ring = sensorPoses(o);
  for (std::size_t k = 0; k < 24; ++k) {
    const Vec d = subtract(ring[k].position, o.target);
    EXPECT_NEAR(std::asin(d[2] / 2) * 180 / M_PI, k % 2 == 0 ? 45 : 25, 1e-9);
    const double azimuth = std::atan2(d[1], d[0]) * 180 / M_PI;
    EXPECT_NEAR(std::remainder(azimuth - 10 - 30.0 * static_cast<double>(k / 2), 360), 0, 1e-9);
  }
}

TEST(SensorPoses, AbsurdPlacesAreRefused)
{
  const auto refused = [](const std::function<void(ViewOptions&)>& change) {
    ViewOptions o;
    change(o);
    EXPECT_THROW(sensorPoses(o), std::invalid_argument);
  };
  refused([](ViewOptions& o) { o.distance = 0; });
  refused([](ViewOptions& o) { o.distance = std::numeric_limits<double>::infinity(); });
  refused([](ViewOptions& o) { o.elevation = 90; });
  refused([](ViewOptions& o) { o.second_elevation = -90; });
  refused([](ViewOptions& o) { o.target[1] = std::numeric_limits<double>::quiet_NaN(); });
  refused([](ViewOptions& o) { o.azimuth = std::numeric_limits<double>::infinity(); });
}
