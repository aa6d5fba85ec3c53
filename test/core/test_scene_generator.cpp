#include "pcl_surflet/core/scene_generator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

using namespace pcl_surflet;

namespace {

const std::vector<SceneItem>&
household()
{
  static const std::vector<SceneItem> items = [] {
    std::vector<SceneItem> all;
    for (const char* name : {"bottle", "carafe", "cup", "wine_glass", "torus"})
      all.push_back(sceneItem(name, *shapeByName(name)));
    return all;
  }();
  return items;
}

SceneOptions
sparse(std::uint64_t seed = 1)
{
  SceneOptions options;
  options.density = 20000;
  options.seed = seed;
  return options;
}

/** \brief Surflets of instance \p k, counted from 0. */
SurfletSet
instance(const Scene& scene, std::uint32_t k)
{
  SurfletSet out;
  for (std::size_t i = 0; i < scene.surflets.size(); ++i)
    if (scene.instances[i] == k + 1)
      out.push_back(scene.surflets[i]);
  return out;
}

double
centroidDistance(const PlacedItem& a, const PlacedItem& b)
{
  return std::hypot(a.centroid[0] - b.centroid[0], a.centroid[1] - b.centroid[1],
                    a.centroid[2] - b.centroid[2]);
}

/** \brief What generateScene() says about bad options. */
std::string
complaint(const SceneOptions& options, const std::vector<SceneItem>& objects = household())
{
  try {
    generateScene(objects, {}, options);
  }
  catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

/** \brief How far (\p x, \p y, \p z) is above the bowl of opening 1. */
double
aboveBowl(double x, double y, double z)
{
  return 0.75 - std::hypot(x, y, z - 0.75);
}

} // namespace

TEST(SceneGenerator, EverySurfletBearsItsSource)
{
  const auto scene = generateScene(household(), {}, sparse());
  ASSERT_EQ(scene.items.size(), household().size());
  ASSERT_EQ(scene.labels.size(), scene.surflets.size());
  ASSERT_EQ(scene.instances.size(), scene.surflets.size());
  EXPECT_EQ(std::count(scene.labels.begin(), scene.labels.end(), 0u), 20000); // 1 square metre
  EXPECT_TRUE(std::is_sorted(scene.instances.begin(), scene.instances.end()));
  for (std::size_t k = 0; k < scene.items.size(); ++k) {
    const auto& item = scene.items[k];
    EXPECT_EQ(item.label, household()[k].label);
    EXPECT_EQ(item.number, k + 1);
    EXPECT_NEAR(double(item.surflets), household()[k].area * 20000, 0.51);
    EXPECT_EQ(std::count(scene.labels.begin(), scene.labels.end(), item.number),
              std::ptrdiff_t(item.surflets));
    const auto extent = computeExtent(instance(scene, std::uint32_t(k)));
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR(extent.centroid[a], item.centroid[a], 1e-5);
  }
}

TEST(SceneGenerator, PosesLeadFromTheItemToTheScene)
{
  const std::vector<SceneItem> egg = {sceneItem("egg", Shape::ellipsoid(0.05, 0.07, 0.1))};
  for (const Posture posture : {Posture::Upright, Posture::Lying, Posture::Leaning}) {
    auto options = sparse(7);
    options.posture = posture;
    const auto scene = generateScene(egg, {}, options);
    const auto& m = scene.items[0].pose;
    const auto set = instance(scene, 0);
    for (std::size_t i = 0; i < set.size(); ++i) {
      const double d[3] = {set.x[i] - m[3], set.y[i] - m[7], set.z[i] - m[11]};
      double p[3];
      for (std::size_t k = 0; k < 3; ++k) // rotation transposed
        p[k] = m[k] * d[0] + m[4 + k] * d[1] + m[8 + k] * d[2];
      EXPECT_NEAR(std::hypot(p[0] / 0.05, p[1] / 0.07, p[2] / 0.1), 1, 1e-4);
    }
  }
}

TEST(SceneGenerator, PosturesTiltTheUprightAxis)
{
  std::set<int> seen;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    auto options = sparse(seed);
    EXPECT_NEAR(generateScene(household(), {}, options).items[0].pose[10], 1, 1e-12);
    options.posture = Posture::Lying;
    EXPECT_NEAR(generateScene(household(), {}, options).items[0].pose[10], 0, 1e-12);
    options.posture = Posture::Leaning;
    const double cosine = generateScene(household(), {}, options).items[0].pose[10];
    EXPECT_GE(cosine, std::cos(M_PI / 4) - 1e-12);
    EXPECT_LE(cosine, std::cos(M_PI / 12) + 1e-12);
    options.posture = Posture::Mixed;
    for (const auto& item : generateScene(household(), {}, options).items)
      seen.insert(item.pose[10] > 0.99 ? 0 : item.pose[10] < 0.01 ? 1 : 2);
  }
  EXPECT_EQ(seen.size(), 3u);
}

TEST(SceneGenerator, ALongTableIsAsWideAsItIsTold)
{
  for (const auto background : {Background::Plane, Background::Box}) {
    auto options = sparse(4);
    options.background = background;
    options.size = 3;
    options.width = 0.5;
    const auto scene = generateScene({household()[0], household()[2]}, {}, options);
    const auto& s = scene.surflets;
    const auto [left, right] = std::minmax_element(s.x.begin(), s.x.end());
    const auto [front, rear] = std::minmax_element(s.y.begin(), s.y.end());
    EXPECT_NEAR(*right - *left, 3, 0.02);
    EXPECT_NEAR(*rear - *front, 0.5, 0.01);
    const double floor = std::count_if(s.nz.begin(), s.nz.end(), [](float n) { return n == 1; });
    EXPECT_NEAR(floor / (options.density * 1.5), 1, background == Background::Plane ? 0.02 : 0.05);
    EXPECT_EQ(backgroundBodies(options).size(), 1u);
  }
  auto narrow = sparse(4);
  narrow.width = 0.01;
  EXPECT_THROW(generateScene(household(), {}, narrow), std::invalid_argument);
}

TEST(SceneGenerator, PairsStandAtTheirDistanceEvenIfTheyIntersect) // Fig. 5.5
{
  const std::vector<SceneItem> pair = {household()[0], household()[2]};
  for (const double factor : {0.0, 0.5, 3.0}) {
    auto options = sparse(3);
    options.size = 2;
    options.spacing = Spacing::Pair;
    options.distance_factor = factor;
    const auto scene = generateScene(pair, {}, options);
    const double radius =
        std::min(computeExtent(instance(scene, 0)).r_max, computeExtent(instance(scene, 1)).r_max);
    const auto &a = scene.items[0].centroid, &b = scene.items[1].centroid;
    EXPECT_NEAR(std::hypot(a[0] - b[0], a[1] - b[1]), factor * radius, 1e-4);
  }
}

TEST(SceneGenerator, ItemsKeepTheDistanceOfTheirBoundingSpheres) // Eq. 5.22
{
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    for (const double factor : {0.0, 1.0, 2.0}) {
      auto options = sparse(seed);
      options.distance_factor = factor;
      const auto scene = generateScene(household(), {}, options);
      std::vector<Extent> extents;
      for (std::uint32_t k = 0; k < scene.items.size(); ++k)
        extents.push_back(computeExtent(instance(scene, k)));
      for (std::size_t i = 0; i < extents.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
          const double* a = extents[i].centroid;
          const double* b = extents[j].centroid;
          EXPECT_GE(std::hypot(a[0] - b[0], a[1] - b[1]) + 1e-5,
                    factor * std::min(extents[i].r_max, extents[j].r_max));
        }
    }
}

TEST(SceneGenerator, ApartNeverIntersects)
{
  // Upright cylinders of different height: Eq. 5.22 alone would let them overlap.
  std::vector<SceneItem> items(4, sceneItem("disk", Shape::cylinder(0.1, 0.02)));
  auto options = sparse();
  options.distance_factor = 0;
  for (options.seed = 1; options.seed <= 20; ++options.seed) {
    const auto scene = generateScene(items, {}, options);
    for (std::size_t i = 0; i < items.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GT(centroidDistance(scene.items[i], scene.items[j]), 0.19);
  }
}

TEST(SceneGenerator, PiledItemsMeetWithoutEnteringEachOther)
{
  const std::vector<SceneItem> balls(6, sceneItem("ball", Shape::sphere(0.05)));
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    auto options = sparse(seed);
    options.spacing = Spacing::Pile;
    options.density = 200000;
    const auto scene = generateScene(balls, {}, options);
    for (std::size_t i = 1; i < balls.size(); ++i) {
      double nearest = 1;
      for (std::size_t j = 0; j < i; ++j)
        nearest = std::min(nearest, centroidDistance(scene.items[i], scene.items[j]));
      EXPECT_NEAR(nearest, 0.1, 0.004) << "seed " << seed << " ball " << i;
    }
  }
}

TEST(SceneGenerator, GapSeparatesPiledItems)
{
  const std::vector<SceneItem> two(2, sceneItem("ball", Shape::sphere(0.05)));
  auto options = sparse();
  options.spacing = Spacing::Pile;
  options.density = 200000;
  options.gap = 0.03;
  const auto scene = generateScene(two, {}, options);
  EXPECT_NEAR(centroidDistance(scene.items[0], scene.items[1]), 0.13, 0.004);
}

TEST(SceneGenerator, ItemsRestOnTheBackground)
{
  auto options = sparse(3);
  options.posture = Posture::Mixed;
  for (const auto background : {Background::None, Background::Plane, Background::Corner}) {
    options.background = background;
    const auto scene = generateScene(household(), {}, options);
    for (std::uint32_t k = 0; k < scene.items.size(); ++k) {
      const auto z = instance(scene, k).z;
      EXPECT_NEAR(*std::min_element(z.begin(), z.end()), 0, 1e-6);
    }
  }
  options.background = Background::Bowl;
  options.present = 2;
  const auto scene = generateScene(household(), {}, options);
  for (std::uint32_t k = 0; k < 2; ++k) {
    const auto set = instance(scene, k);
    double lowest = 1;
    for (std::size_t i = 0; i < set.size(); ++i)
      lowest = std::min(lowest, aboveBowl(set.x[i], set.y[i], set.z[i]));
    EXPECT_NEAR(lowest, 0, 1e-6);
  }
}

TEST(SceneGenerator, BackgroundsAreSeenFromInside)
{
  struct Case {
    Background background;
    double area;
  };
  const double rim = 0.75 - std::sqrt(0.75 * 0.75 - 0.25);
  for (const Case& c :
       {Case{Background::None, 0}, Case{Background::Plane, 1}, Case{Background::Corner, 1.3},
        Case{Background::Box, 2.2}, Case{Background::Bowl, 2 * M_PI * 0.75 * rim}}) {
    auto options = sparse();
    options.background = c.background;
    const auto set = emptyBackground(options);
    EXPECT_NEAR(double(set.size()), c.area * 20000, 1);
    for (std::size_t i = 0; i < set.size(); ++i) {
      // A point above the middle sees the front of everything.
      const double d[3] = {-set.x[i], -set.y[i], 0.25 - set.z[i]};
      EXPECT_GT(d[0] * set.nx[i] + d[1] * set.ny[i] + d[2] * set.nz[i], 0);
      if (c.background == Background::Bowl) {
        EXPECT_NEAR(aboveBowl(set.x[i], set.y[i], set.z[i]), 0, 1e-6);
      }
    }
  }
}

TEST(SceneGenerator, TheEmptyBackgroundIsSensedAnew)
{
  const auto options = sparse();
  const auto scene = generateScene(household(), {}, options);
  const auto empty = emptyBackground(options);
  ASSERT_EQ(empty.size(), 20000u);
  EXPECT_NE(empty.x[0], scene.surflets.x[0]);
  EXPECT_EQ(empty.x, emptyBackground(options).x);
}

TEST(SceneGenerator, ChoosesWhatIsPresentAndWhatIsClutter)
{
  const std::vector<SceneItem> unknown = {sceneItem("die", *shapeByName("cube")),
                                          sceneItem("cone", *shapeByName("cone"))};
  std::set<std::string> seen;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    auto options = sparse(seed);
    options.present = 2;
    options.clutter = 1;
    const auto scene = generateScene(household(), unknown, options);
    ASSERT_EQ(scene.items.size(), 3u);
    EXPECT_FALSE(scene.items[0].clutter || scene.items[1].clutter);
    EXPECT_NE(scene.items[0].number, scene.items[1].number);
    EXPECT_TRUE(scene.items[2].clutter);
    EXPECT_EQ(scene.items[2].number, scene.items[2].label == "die" ? 6u : 7u);
    for (const auto& item : scene.items)
      seen.insert(item.label);
  }
  EXPECT_EQ(seen.size(), household().size() + unknown.size());
}

TEST(SceneGenerator, OneSeedGivesOneScene)
{
  const auto a = generateScene(household(), {}, sparse(5));
  const auto b = generateScene(household(), {}, sparse(5));
  const auto c = generateScene(household(), {}, sparse(6));
  EXPECT_EQ(a.surflets.x, b.surflets.x);
  EXPECT_EQ(a.surflets.nz, b.surflets.nz);
  EXPECT_NE(a.items[0].centroid, c.items[0].centroid);
}

TEST(SceneGenerator, NoiseMovesSurfletsAlongTheirNormals)
{
  auto options = sparse();
  const auto clean = generateScene(household(), {}, options);
  options.noise = 0.002;
  const auto noisy = generateScene(household(), {}, options);
  ASSERT_EQ(clean.surflets.size(), noisy.surflets.size());
  double largest = 0;
  for (std::size_t i = 0; i < 20000; ++i) {
    EXPECT_EQ(noisy.surflets.x[i], clean.surflets.x[i]);
    largest = std::max(largest, double(std::abs(noisy.surflets.z[i])));
  }
  EXPECT_LE(largest, 0.002 + 1e-7);
  EXPECT_GT(largest, 0.0019);
  EXPECT_EQ(noisy.items[0].pose, clean.items[0].pose);
}

TEST(SceneGenerator, SaysWhatIsWrong)
{
  const auto with = [](double SceneOptions::*member, double value) {
    SceneOptions options = sparse();
    options.*member = value;
    return complaint(options);
  };
  EXPECT_NE(with(&SceneOptions::size, 0).find("size must be positive"), std::string::npos);
  EXPECT_NE(with(&SceneOptions::density, NAN).find("density must be"), std::string::npos);
  EXPECT_NE(with(&SceneOptions::density, 1e15).find("lower the density"), std::string::npos);
  EXPECT_NE(with(&SceneOptions::density, 1e-3).find("raise the density"), std::string::npos);
  EXPECT_NE(with(&SceneOptions::noise, -1).find("noise must be"), std::string::npos);
  EXPECT_NE(with(&SceneOptions::gap, -1).find("gap must be"), std::string::npos);
  EXPECT_NE(with(&SceneOptions::wall_height, -1).find("wall_height"), std::string::npos);
  EXPECT_NE(with(&SceneOptions::size, 0.3).find("do not fit"), std::string::npos);
  EXPECT_NE(with(&SceneOptions::distance_factor, 100).find("do not fit"), std::string::npos);
  EXPECT_NE(complaint(sparse(), {SceneItem{"ghost", 0, {}}}).find("'ghost' has no surface"),
            std::string::npos);
  EXPECT_THROW(sceneItem("nothing", TriangleMesh{}), std::invalid_argument);
}

TEST(SceneGenerator, NothingOnNothingIsAnEmptyScene)
{
  auto options = sparse();
  options.background = Background::None;
  EXPECT_TRUE(generateScene({}, {}, options).surflets.empty());
  EXPECT_TRUE(emptyBackground(options).empty());
}
