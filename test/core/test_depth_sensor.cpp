// What a virtual depth sensor measures, against geometry that is known exactly.
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/depth_buffer.h"
#include "pcl_surflet/core/depth_sensor.h"
#include "pcl_surflet/core/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>

using namespace pcl_surflet;

namespace {

using Vec = std::array<double, 3>;

Vec
minus(const Vec& a, const Vec& b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double
dot(const Vec& a, const Vec& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vec
cross(const Vec& a, const Vec& b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double
length(const Vec& a)
{
  return std::sqrt(dot(a, a));
}

/** \brief An upright square around \p middle, seen along y. */
SensedBody
square(const Vec& middle, double edge, std::uint32_t label)
{
  const auto corner = [&](double x, double z) {
    return TriangleMesh::Point{static_cast<float>(middle[0] + x * edge / 2),
                               static_cast<float>(middle[1]),
                               static_cast<float>(middle[2] + z * edge / 2)};
  };
  SensedBody body;
  body.mesh.vertices = {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
  body.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  body.label = label;
  body.instance = label;
  return body;
}

SensedBody
ball(double radius, std::uint32_t label = 1)
{
  return {meshOfShape(Shape::sphere(radius), radius / 60), label, label};
}

/** \brief Stands at the origin and looks along y, so that the picture's axes are x and -z. */
SensorPose
alongY()
{
  SensorPose pose;
  pose.position = {0, 0, 0};
  pose.target = {0, 1, 0};
  return pose;
}

DepthSensor
small()
{
  DepthSensor sensor;
  sensor.columns = 160;
  sensor.rows = 120;
  return sensor;
}

bool
returned(const DepthScan& scan, std::size_t i)
{
  const bool z = std::isfinite(scan.z[i]);
  EXPECT_EQ(std::isfinite(scan.x[i]), z);
  EXPECT_EQ(std::isfinite(scan.y[i]), z);
  return z;
}

std::size_t
returns(const DepthScan& scan)
{
  std::size_t n = 0;
  for (std::size_t i = 0; i < scan.z.size(); ++i)
    n += returned(scan, i) ? 1 : 0;
  return n;
}

Vec
pointOf(const DepthScan& scan, std::size_t i)
{
  return {scan.x[i], scan.y[i], scan.z[i]};
}

/** \brief Line of sight of pixel \p i, of depth 1, from the definition of a pinhole camera. */
Vec
rayOf(const DepthSensor& s, std::size_t i)
{
  const double half = std::tan(s.opening / 2 * M_PI / 180); // of the picture's width at depth 1
  const double pixel = 2 * half / static_cast<double>(s.columns);
  return {(static_cast<double>(i % s.columns) + 0.5) * pixel - half,
          (static_cast<double>(i / s.columns) + 0.5 - 0.5 * static_cast<double>(s.rows)) * pixel,
          1};
}

/** \brief Where a line from the origin along \p ray meets a triangle, as a multiple of \p ray.
 * \param margin distance from the nearest edge, in barycentric coordinates; negative outside */
std::optional<double>
hit(const Vec& ray, const Vec& a, const Vec& b, const Vec& c, double& margin)
{
  const Vec e = minus(b, a), f = minus(c, a), p = cross(ray, f);
  const double det = dot(e, p);
  if (det == 0)
    return {};
  const Vec t = minus({0, 0, 0}, a), q = cross(t, e);
  const double u = dot(t, p) / det, v = dot(ray, q) / det;
  margin = std::min({u, v, 1 - u - v});
  return dot(f, q) / det;
}

/** \brief Triangles of all sizes around the sensor; some reach behind it. */
std::vector<SensedBody>
soup(std::uint64_t seed, std::uint32_t triangles)
{
  CounterRandom random(seed);
  std::vector<SensedBody> bodies;
  for (std::uint32_t k = 0; k < triangles; ++k) {
    SensedBody body;
    const double size = std::pow(10.0, random.uniform(-2, 0.5));
    const Vec middle = {random.uniform(-1, 1), random.uniform(-0.5, 3), random.uniform(-1, 1)};
    for (int corner = 0; corner < 3; ++corner)
      body.mesh.vertices.push_back({static_cast<float>(middle[0] + size * random.uniform(-1, 1)),
                                    static_cast<float>(middle[1] + size * random.uniform(-1, 1)),
                                    static_cast<float>(middle[2] + size * random.uniform(-1, 1))});
    body.mesh.triangles = {{0, 1, 2}};
    body.label = body.instance = k + 1;
    if (body.mesh.problem().empty())
      bodies.push_back(std::move(body));
  }
  return bodies;
}

/** \brief Nearest hit of a pixel over all triangles; the margin tells whether it is clear. */
struct TrueHit {
  double depth = std::numeric_limits<double>::infinity();
  std::uint32_t label = 0;
  bool clear = true; ///< no edge and no second surface nearby
};

TrueHit
cast(const std::vector<SensedBody>& bodies, const SensorFrame& frame, const Vec& ray)
{
  TrueHit best;
  for (const auto& body : bodies) {
    Vec corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& v = body.mesh.vertices[k];
      corner[k] = frame.toSensor({v[0], v[1], v[2]});
    }
    double margin = -1;
    const auto depth = hit(ray, corner[0], corner[1], corner[2], margin);
    if (!depth || !(*depth > 0))
      continue;
    const bool tie = margin > -1e-6 && std::abs(*depth - best.depth) < 1e-6;
    if (tie || (std::abs(margin) < 1e-6 && *depth < best.depth))
      best.clear = false;
    if (margin < 0 || *depth >= best.depth)
      continue;
    best.depth = *depth;
    best.label = body.label;
  }
  return best;
}

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

std::string
complaint(const std::function<void(DepthSensor&)>& change)
{
  DepthSensor sensor = small();
  change(sensor);
  try {
    sense({square({0, 1, 0}, 1, 1)}, sensor, alongY(), 1);
  }
  catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST(DepthBuffer, SharedEdgesLeaveNoGapAndNothingLeaksOut)
{
  // A fan around an odd place, out to the corners of the picture and beyond.
  const DepthBuffer::Corner middle{13.3, 7.7, 1};
  const std::array<DepthBuffer::Corner, 4> rim = {
      {{-2, -3, 1}, {45, -1, 1}, {43, 31, 1}, {-7, 33, 1}}};
  DepthBuffer buffer(40, 30);
  for (std::uint32_t k = 0; k < 4; ++k)
    buffer.draw({middle, rim[k], rim[(k + 1) % 4]}, k);
  for (std::size_t r = 0; r < 30; ++r)
    for (std::size_t c = 0; c < 40; ++c) {
      EXPECT_NE(buffer.id(c, r), DepthBuffer::nothing) << c << " " << r;
      EXPECT_NEAR(buffer.nearness(c, r), 1, 1e-12);
    }
}

TEST(DepthBuffer, WhatHasNoAreaOrIsElsewhereLeavesNoTrace)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  DepthBuffer buffer(8, 8);
  buffer.draw({{{0, 0, 1}, {7, 7, 1}, {3, 3, 1}}}, 1);
  buffer.draw({{{20, 0, 1}, {27, 0, 1}, {20, 7, 1}}}, 2);
  buffer.draw({{{0, -30, 1}, {7, -30, 1}, {0, -20, 1}}}, 3);
  buffer.draw({{{0, nan, 1}, {7, 0, 1}, {0, 7, 1}}}, 4);
  buffer.draw({{{0.1, 0.1, 1}, {0.9, 0.1, 1}, {0.1, 0.9, 1}}}, 5); // between the pixels
  for (std::size_t i = 0; i < 64; ++i)
    EXPECT_EQ(buffer.id(i % 8, i / 8), DepthBuffer::nothing);
  EXPECT_THROW(DepthBuffer(0, 5), std::invalid_argument);
  EXPECT_THROW(DepthBuffer(1u << 20, 1u << 20), std::invalid_argument);
}

TEST(DepthSensor, PlaneAtKnownDistance)
{
  const DepthSensor sensor = small();
  const DepthScan scan = sense({square({0, 2, 0}, 20, 7)}, sensor, alongY(), 1);
  ASSERT_EQ(scan.z.size(), 160u * 120u);
  for (std::size_t i = 0; i < scan.z.size(); ++i) {
    ASSERT_TRUE(returned(scan, i));
    const Vec ray = rayOf(sensor, i);
    EXPECT_NEAR(scan.z[i], 2, 1e-6);
    EXPECT_NEAR(scan.x[i], 2 * ray[0], 1e-6);
    EXPECT_NEAR(scan.y[i], 2 * ray[1], 1e-6);
    EXPECT_EQ(scan.labels[i], 7u);
    EXPECT_EQ(scan.instances[i], 7u);
  }
  EXPECT_NEAR(scan.x[159] - scan.x[0], 2 * 2 * std::tan(28.5 * M_PI / 180) * 159 / 160, 1e-5)
      << "57 degrees from the left edge of the first pixel to the right edge of the last";
}

TEST(DepthSensor, PointsLieOnTheSceneWhereverTheSensorStands)
{
  for (const Vec& position : {Vec{2, 1, 3}, Vec{-2, 4, -1}, Vec{0.1, 0, -2}}) {
    SensorPose pose;
    pose.position = position;
    const DepthScan scan = sense({ball(0.5)}, small(), pose, 1);
    std::size_t seen = 0;
    for (std::size_t i = 0; i < scan.z.size(); ++i)
      if (returned(scan, i)) {
        ++seen;
        const Vec p = scan.frame.toScene(pointOf(scan, i));
        EXPECT_NEAR(length(p), 0.5, 2e-4);
      }
    EXPECT_GT(seen, 500u);
  }
}

TEST(DepthSensor, SeesTheCapOfABall)
{
  const double r = 0.3, d = 1.5;
  DepthSensor sensor;
  SensorPose pose;
  pose.position = {0, -d, 0};
  const DepthScan scan = sense({ball(r)}, sensor, pose, 1);
  // Tangents from the sensor touch the ball where the height over its middle is r^2 / d.
  double lowest = d, count = 0;
  for (std::size_t i = 0; i < scan.z.size(); ++i)
    if (returned(scan, i)) {
      lowest = std::min(lowest, -scan.frame.toScene(pointOf(scan, i))[1]);
      ++count;
    }
  EXPECT_GT(lowest, r * r / d - 1e-3);
  EXPECT_LT(lowest, r * r / d + 0.03);
  const double focal = 320 / std::tan(28.5 * M_PI / 180);
  const double outline = focal * std::tan(std::asin(r / d)); // a circle about the picture's middle
  EXPECT_NEAR(count / (M_PI * outline * outline), 1, 0.003);
}

TEST(DepthSensor, NearerThingsHideExactlyWhatIsBehindThem)
{
  const DepthSensor sensor = small();
  const auto wall = square({0, 3, 0}, 20, 1), near = square({0.1, 1, -0.05}, 0.4, 2);
  const DepthScan scan = sense({wall, near}, sensor, alongY(), 1),
                  swapped = sense({near, wall}, sensor, alongY(), 1);
  std::size_t hidden = 0;
  for (std::size_t i = 0; i < scan.z.size(); ++i) {
    const Vec ray = rayOf(sensor, i); // meets the plane of the near square at depth 1
    const double x = std::abs(ray[0] - 0.1), z = std::abs(-ray[1] + 0.05);
    if (std::abs(std::max(x, z) - 0.2) < 1e-6)
      continue;
    const bool is_near = std::max(x, z) < 0.2;
    EXPECT_EQ(scan.labels[i], is_near ? 2u : 1u);
    EXPECT_NEAR(scan.z[i], is_near ? 1 : 3, 1e-6);
    EXPECT_EQ(swapped.labels[i], scan.labels[i]) << "whatever comes first";
    hidden += is_near ? 1 : 0;
  }
  EXPECT_GT(hidden, 1000u);
}

TEST(DepthSensor, AgreesWithRaysThroughTrianglesOfAllKinds)
{
  const DepthSensor sensor = small();
  std::size_t compared = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto bodies = soup(seed, 60);
    const DepthScan scan = sense(bodies, sensor, alongY(), 1);
    for (std::size_t i = 0; i < scan.z.size(); i += 7) {
      const TrueHit truth = cast(bodies, scan.frame, rayOf(sensor, i));
      if (!truth.clear)
        continue;
      ++compared;
      ASSERT_EQ(scan.labels[i], truth.label) << seed << " " << i;
      ASSERT_EQ(returned(scan, i), truth.label > 0);
      if (truth.label > 0) {
        ASSERT_NEAR(scan.z[i] / truth.depth, 1, 1e-5) << seed << " " << i;
      }
    }
  }
  EXPECT_GT(compared, 10000u);
}

TEST(DepthSensor, AntipodalViewsSeeComplementaryHalves)
{
  ViewOptions views;
  views.views = ViewSet::Two;
  views.target = {0, 0, 0};
  views.elevation = 0;
  views.azimuth = 30;
  const auto poses = sensorPoses(views);
  ASSERT_EQ(poses.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const DepthScan scan = sense({ball(0.3)}, small(), poses[k], 1);
    EXPECT_GT(returns(scan), 1000u);
    for (std::size_t i = 0; i < scan.z.size(); ++i)
      if (returned(scan, i)) {
        const Vec p = scan.frame.toScene(pointOf(scan, i));
        EXPECT_GT(dot(p, poses[k].position), 0);
        EXPECT_LT(dot(p, poses[1 - k].position), 0);
      }
  }
}

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
    const double angle = std::acos(1 / length(rayOf(sensor, i))) * 180 / M_PI;
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

TEST(DepthSensor, EmptyScenesGiveNothing)
{
  const DepthScan scan = sense({}, small(), alongY(), 1);
  EXPECT_EQ(scan.z.size(), 160u * 120u);
  EXPECT_EQ(returns(scan), 0u);
  EXPECT_EQ(returns(sense({square({0, -1, 0}, 1, 1)}, small(), alongY(), 1)), 0u) << "behind";
  DepthSensor one = small();
  one.columns = one.rows = 1;
  EXPECT_EQ(returns(sense({square({0, 1, 0}, 1, 1)}, one, alongY(), 1)), 1u);
}

TEST(DepthSensor, InsideABallItSeesTheInnerWallEverywhere)
{
  SensorPose pose = alongY();
  pose.position = {0.1, 0, 0};
  const DepthScan scan = sense({ball(0.5)}, small(), pose, 1);
  ASSERT_EQ(returns(scan), scan.z.size());
  for (std::size_t i = 0; i < scan.z.size(); ++i)
    EXPECT_NEAR(length(scan.frame.toScene(pointOf(scan, i))), 0.5, 2e-4);
}

TEST(DepthSensor, AbsurdParametersAreRefused)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(complaint([](DepthSensor&) {}), "");
  for (const double bad : {0.0, -1.0, 180.0, nan})
    EXPECT_NE(complaint([&](DepthSensor& s) { s.opening = bad; }).find("opening"),
              std::string::npos);
  for (const double bad : {-1.0, inf, nan}) {
    EXPECT_NE(complaint([&](DepthSensor& s) { s.noise = bad; }).find("noise"), std::string::npos);
    EXPECT_NE(complaint([&](DepthSensor& s) { s.quantum = bad; }).find("quantum"),
              std::string::npos);
    EXPECT_NE(complaint([&](DepthSensor& s) { s.flying = bad; }).find("flying"), std::string::npos);
    EXPECT_NE(complaint([&](DepthSensor& s) { s.noise_power = bad; }).find("power"),
              std::string::npos);
  }
  for (const double bad : {0.0, 91.0, nan})
    EXPECT_NE(complaint([&](DepthSensor& s) { s.grazing = bad; }).find("grazing"),
              std::string::npos);
  EXPECT_NE(complaint([&](DepthSensor& s) { s.edge = 0; }).find("edges"), std::string::npos);
  EXPECT_NE(complaint([&](DepthSensor& s) { s.baseline = inf; }).find("baseline"),
            std::string::npos);
  EXPECT_NE(complaint([](DepthSensor& s) { s.columns = 0; }).find("pixels"), std::string::npos);
  EXPECT_NE(complaint([](DepthSensor& s) { s.columns = s.rows = 1u << 20; }).find("pixels"),
            std::string::npos);
}

TEST(DepthSensor, UnusablePosesAndMeshesAreRefused)
{
  SensorPose pose = alongY();
  pose.target = pose.position;
  EXPECT_THROW(sense({}, small(), pose, 1), std::invalid_argument);
  pose.target = {0, std::numeric_limits<double>::quiet_NaN(), 0};
  EXPECT_THROW(sense({}, small(), pose, 1), std::invalid_argument);
  SensedBody broken = square({0, 1, 0}, 1, 1);
  broken.mesh.triangles[0][2] = 99;
  EXPECT_THROW(sense({broken}, small(), alongY(), 1), std::invalid_argument);
  broken = square({0, 1, 0}, 1, 1);
  broken.mesh.vertices[1][0] = std::numeric_limits<float>::infinity();
  EXPECT_THROW(sense({broken}, small(), alongY(), 1), std::invalid_argument);
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
    EXPECT_NEAR(length(f.right), 1, 1e-12);
    EXPECT_NEAR(dot(f.right, f.forward), 0, 1e-12);
    EXPECT_NEAR(dot(cross(f.right, f.down), f.forward), 1, 1e-12) << "x, y, z are right-handed";
    EXPECT_LE(f.down[2], 1e-12) << "upright";
    const Vec p = {0.3, -0.2, 1.1}, back = f.toSensor(f.toScene(p));
    EXPECT_LT(length(minus(p, back)), 1e-12);
    // q v q^-1 by its definition: v + 2 w (u x v) + 2 u x (u x v).
    const auto q = f.quaternion();
    EXPECT_GE(q[0], 0);
    const Vec u = {q[1], q[2], q[3]};
    const auto turned = [&](const Vec& v) {
      const Vec a = cross(u, v), b = cross(u, a);
      return Vec{v[0] + 2 * q[0] * a[0] + 2 * b[0], v[1] + 2 * q[0] * a[1] + 2 * b[1],
                 v[2] + 2 * q[0] * a[2] + 2 * b[2]};
    };
    EXPECT_LT(length(minus(turned({1, 0, 0}), f.right)), 1e-12);
    EXPECT_LT(length(minus(turned({0, 1, 0}), f.down)), 1e-12);
    EXPECT_LT(length(minus(turned({0, 0, 1}), f.forward)), 1e-12);
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
      const Vec d = minus(pose.position, o.target);
      EXPECT_NEAR(length(d), 2, 1e-12);
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
    const Vec d = minus(ring[k].position, o.target);
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
