// What a virtual depth sensor measures, against geometry that is known exactly.
#include "depth_pictures.h"

#include "pcl_surflet/core/counter_random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

namespace {

/** \brief Where a line from the origin along \p ray meets a triangle, as a multiple of \p ray.
 * \param margin distance from the nearest edge, in barycentric coordinates; negative outside */
std::optional<double>
hit(const Vec& ray, const Vec& a, const Vec& b, const Vec& c, double& margin)
{
  const Vec e = subtract(b, a), f = subtract(c, a), p = cross(ray, f);
  const double det = dot(e, p);
  if (det == 0)
    return {};
  const Vec t = subtract({0, 0, 0}, a), q = cross(t, e);
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
        EXPECT_NEAR(norm(p), 0.5, 2e-4);
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
    EXPECT_NEAR(norm(scan.frame.toScene(pointOf(scan, i))), 0.5, 2e-4);
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
