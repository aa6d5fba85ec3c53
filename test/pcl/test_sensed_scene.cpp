// Scenes as a virtual sensor sees them: normals, several views, objects alone.
#include "pcl_surflet/sensed_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

using namespace pcl_surflet;

namespace {

SceneSensing
coarse(ViewSet views)
{
  SceneSensing sensing;
  sensing.sensor.columns = 240;
  sensing.sensor.rows = 180;
  sensing.views.views = views;
  sensing.normal_radius = 0.015;
  return sensing;
}

std::vector<SceneItem>
things()
{
  return {sceneItem("bottle", *shapeByName("bottle")), sceneItem("ball", Shape::sphere(0.1)),
          sceneItem("box", Shape::box(0.2, 0.2, 0.2))};
}

SceneOptions
table(std::uint64_t seed)
{
  SceneOptions o;
  o.density = 20000;
  o.seed = seed;
  return o;
}

bool
hasNormal(const OrientedScan& s, std::size_t i)
{
  return std::isfinite(s.nx[i]);
}

double
degrees(double cosine)
{
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / M_PI;
}

/** \brief Cosine between the normal of pixel \p i and the way to the sensor. */
double
facing(const OrientedScan& s, std::size_t i)
{
  const DepthScan& p = s.scan;
  return -(p.x[i] * s.nx[i] + p.y[i] * s.ny[i] + p.z[i] * s.nz[i]) /
         std::hypot(p.x[i], p.y[i], p.z[i]);
}

} // namespace

TEST(SensedScene, NormalsOfABallPointOutwardsToEverySensor)
{
  SceneSensing sensing = coarse(ViewSet::Ring24);
  sensing.views.target = {0, 0, 0};
  sensing.sensor.noise = 0.0003;
  const auto surflets =
      sensedSurflets(senseViews({{meshOfShape(Shape::sphere(0.2), 0.01), 1, 1}}, sensing, 1));
  ASSERT_GT(surflets.size(), 20000u);
  std::vector<double> errors;
  for (std::size_t i = 0; i < surflets.size(); ++i) {
    const Surflet s = surflets[i];
    EXPECT_NEAR(std::hypot(s.x, s.y, s.z), 0.2, 0.003);
    errors.push_back(degrees((s.x * s.nx + s.y * s.ny + s.z * s.nz) / std::hypot(s.x, s.y, s.z)));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 2);
  EXPECT_LT(errors[errors.size() * 99 / 100], 15);
}

TEST(SensedScene, EveryNormalFacesItsSensor)
{
  const auto items = things();
  const SceneOptions o = table(2);
  const Scene scene = generateScene(items, {}, o);
  for (const auto& s : senseViews(bodiesOf(scene, items, {}, o), coarse(ViewSet::Two), 1)) {
    std::size_t with = 0, points = 0;
    for (std::size_t i = 0; i < s.scan.z.size(); ++i) {
      points += std::isfinite(s.scan.z[i]) ? 1 : 0;
      if (!hasNormal(s, i))
        continue;
      ++with;
      EXPECT_TRUE(std::isfinite(s.scan.z[i]));
      EXPECT_GT(facing(s, i), 0.08) << "else it may face the wrong way";
      EXPECT_NEAR(std::hypot(s.nx[i], s.ny[i], s.nz[i]), 1, 1e-4);
    }
    // Far away the table is seen in lines that are further apart than neighbours are.
    EXPECT_GT(with, 0.985 * static_cast<double>(points));
  }
}

TEST(SensedScene, LabelsSayWhereThePointsAre)
{
  const auto items = things();
  const SceneOptions o = table(3);
  const Scene complete = generateScene(items, {}, o);
  const Scene scene = sensedScene(
      complete, senseViews(bodiesOf(complete, items, {}, o), coarse(ViewSet::Ring24), 1));
  ASSERT_EQ(scene.items.size(), 3u);
  ASSERT_EQ(scene.labels.size(), scene.surflets.size());
  EXPECT_TRUE(std::is_sorted(scene.instances.begin(), scene.instances.end()));
  std::vector<std::size_t> seen(4, 0);
  for (std::size_t i = 0; i < scene.surflets.size(); ++i) {
    const auto k = scene.instances[i];
    ++seen[k];
    ASSERT_EQ(scene.labels[i], k == 0 ? 0 : scene.items[k - 1].number);
    if (k == 0) {
      EXPECT_NEAR(scene.surflets.z[i], 0, 1e-5);
      continue;
    }
    const auto& c = scene.items[k - 1].centroid;
    EXPECT_LT(std::hypot(scene.surflets.x[i] - c[0], scene.surflets.y[i] - c[1]), 0.15);
    if (scene.items[k - 1].label == "ball") {
      EXPECT_NEAR(std::hypot(scene.surflets.x[i] - c[0], scene.surflets.y[i] - c[1],
                             scene.surflets.z[i] - 0.1),
                  0.1, 0.002);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(scene.items[k].surflets, seen[k + 1]);
    EXPECT_GT(seen[k + 1], 1000u);
    EXPECT_EQ(scene.items[k].centroid, complete.items[k].centroid);
    EXPECT_EQ(scene.items[k].pose, complete.items[k].pose);
  }
}

TEST(SensedScene, ScansOfAnotherSceneAreRefused)
{
  const auto items = things();
  const SceneOptions o = table(3);
  const auto scans =
      senseViews(bodiesOf(generateScene(items, {}, o), items, {}, o), coarse(ViewSet::One), 1);
  EXPECT_THROW(sensedScene(Scene(), scans), std::invalid_argument);
}

TEST(SensedScene, MoreViewsSeeMore)
{
  const auto items = things();
  const SceneOptions o = table(4);
  const auto bodies = bodiesOf(generateScene(items, {}, o), items, {}, o);
  const auto sides = [&](ViewSet views) {
    // Which of the eight octants of directions are there on the ball?
    std::array<bool, 8> side{};
    for (const auto& s : senseViews(bodies, coarse(views), 1))
      for (std::size_t i = 0; i < s.scan.z.size(); ++i)
        if (hasNormal(s, i) && s.scan.instances[i] == 2) {
          const auto n = s.scan.frame.toScene({s.nx[i], s.ny[i], s.nz[i]});
          const auto& p = s.scan.frame.position;
          side[(n[0] > p[0] ? 1 : 0) + (n[1] > p[1] ? 2 : 0) + (n[2] > p[2] ? 4 : 0)] = true;
        }
    return std::count(side.begin() + 4, side.end(), true);
  };
  EXPECT_EQ(sides(ViewSet::Ring24), 4) << "all upper sides";
  EXPECT_GE(sides(ViewSet::Two), sides(ViewSet::One));
}

TEST(SensedScene, TheRingDoesNotSeeTheBottomOfAnObjectAlone)
{
  const SceneItem box = sceneItem("box", Shape::box(0.2, 0.2, 0.2));
  const auto bottom = [&](ViewSet views) {
    const SurfletSet set = senseAlone(box, coarse(views), 1);
    EXPECT_GT(set.size(), 5000u);
    std::size_t n = 0;
    for (std::size_t i = 0; i < set.size(); ++i)
      n += set.nz[i] < -0.9 ? 1 : 0;
    return n;
  };
  EXPECT_EQ(bottom(ViewSet::Ring24), 0u);
  EXPECT_GT(bottom(ViewSet::All24), 500u);
}

TEST(SensedScene, ThreadsDoNotMatter)
{
  const auto items = things();
  SceneOptions o = table(5);
  o.background = Background::Corner;
  const auto bodies = bodiesOf(generateScene(items, {}, o), items, {}, o);
  SceneSensing sensing = coarse(ViewSet::Two);
  sensing.sensor.noise = 0.001;
  sensing.sensor.flying = 0.3;
  sensing.sensor.baseline = 0.1;
  sensing.threads = 1;
  const SurfletSet one = sensedSurflets(senseViews(bodies, sensing, 9));
  sensing.threads = 3;
  const SurfletSet three = sensedSurflets(senseViews(bodies, sensing, 9));
  EXPECT_EQ(one.x, three.x);
  EXPECT_EQ(one.z, three.z);
  EXPECT_EQ(one.nx, three.nx);
  EXPECT_EQ(one.nz, three.nz);
  EXPECT_NE(one.z, sensedSurflets(senseViews(bodies, sensing, 10)).z);
}

TEST(SensedScene, BackgroundsAreSensedToo)
{
  for (const Background background :
       {Background::Plane, Background::Corner, Background::Box, Background::Bowl}) {
    SceneOptions o = table(1);
    o.background = background;
    const SurfletSet set = sensedSurflets(senseViews(backgroundBodies(o), coarse(ViewSet::Two), 1));
    ASSERT_GT(set.size(), 20000u);
    std::size_t upwards = 0;
    for (std::size_t i = 0; i < set.size(); ++i) {
      EXPECT_GT(set.z[i], -1e-4);
      EXPECT_LT(std::max(std::abs(set.x[i]), std::abs(set.y[i])), 0.5 + 1e-4);
      upwards += set.nz[i] > 0.5 ? 1 : 0;
    }
    EXPECT_GT(4 * upwards, set.size()) << "floors are seen from above";
  }
  SceneOptions nothing = table(1);
  nothing.background = Background::None;
  EXPECT_TRUE(backgroundBodies(nothing).empty());
  EXPECT_TRUE(sensedSurflets(senseViews({}, coarse(ViewSet::One), 1)).empty());
}

TEST(SensedScene, NormalsNeedAUsableRadius)
{
  const DepthScan scan = sense({}, coarse(ViewSet::One).sensor, SensorPose(), 1);
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()})
    EXPECT_THROW(withNormals(scan, bad), std::invalid_argument);
  EXPECT_EQ(withNormals(scan, 0.01).nx.size(), scan.z.size());
}

TEST(SensedScene, LonelyPointsHaveNoNormal)
{
  DepthScan scan;
  scan.columns = 2;
  scan.rows = 2;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  scan.x = {0, nan, 1, nan};
  scan.y = {0, nan, 1, nan};
  scan.z = {1, nan, 1, nan};
  scan.labels = scan.instances = {0, 0, 0, 0};
  const OrientedScan s = withNormals(scan, 0.1);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_FALSE(hasNormal(s, i));
  EXPECT_TRUE(sensedSurflets({s}).empty());
}

TEST(SensedScene, ItemsWithoutMeshAreNamed)
{
  SceneItem item = sceneItem("ghost", Shape::sphere(0.1));
  const Scene scene = generateScene({item}, {}, table(1));
  item.mesh = nullptr;
  try {
    bodiesOf(scene, {item}, {}, table(1));
    FAIL();
  }
  catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("ghost"), std::string::npos);
  }
}
