#include "pcl_surflet/core/pair_counting.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

using namespace pcl_surflet;

namespace {

HistogramModelTrainer
quickTrainer()
{
  HistogramModelTrainer trainer;
  trainer.setNumberOfPairs(200000);
  trainer.setMeshSampling(800, 2);
  return trainer;
}

double
difference(const HistogramModel& a, const HistogramModel& b)
{
  double sum = 0;
  for (std::size_t i = 0; i < a.members[0].histogram.size(); ++i)
    sum += std::abs(a.members[0].histogram[i] - b.members[0].histogram[i]);
  return sum / 2;
}

std::string
errorOf(const std::function<void()>& action)
{
  try {
    action();
  }
  catch (const TrainingError& e) {
    return e.what();
  }
  return "no error";
}

} // namespace

TEST(Training, SphereHasItsAnalyticModel)
{
  const double radius = 0.3;
  HistogramModelTrainer trainer;
  trainer.setNumberOfPairs(2000000);
  const auto model = trainer.train("ball", sampleShape(Shape::sphere(radius), 20000, 1));
  EXPECT_TRUE(model.problem().empty()) << model.problem();
  EXPECT_NEAR(model.delta_max, 2 * radius, 1e-3 * radius);
  EXPECT_NEAR(model.r_mean, radius, 0.01 * radius);
  EXPECT_NEAR(model.r_max, radius, 0.03 * radius);
  EXPECT_NEAR(model.r_min, radius, 0.03 * radius);
  // On a sphere delta^2 is uniform in [0, (2R)^2] (Archimedes), beta = 0 and gamma = -delta / 2R.
  const auto& r = model.resolution;
  for (int d = 0; d < r.delta; ++d) {
    double share = 0;
    for (int a = 0; a < r.angularBins(); ++a)
      share += model.members[0].histogram[static_cast<std::size_t>(d * r.angularBins() + a)];
    EXPECT_NEAR(share, (2 * d + 1) / 25.0, 0.003) << d;
  }
  for (int b = 0; b < r.bins(); ++b) {
    const int beta = b / r.alpha % r.beta;
    if (beta != 2) {
      EXPECT_EQ(model.members[0].histogram[static_cast<std::size_t>(b)], 0);
    }
  }
}

TEST(Training, FewPairsAreAllTaken)
{
  auto trainer = quickTrainer();
  const auto set = sampleShape(Shape::cylinder(0.1, 0.2), 500, 2);
  const auto model = trainer.train("can", set);
  const auto all = countAllPairs(PairSource(set), {}, model.delta_max);
  EXPECT_EQ(model.members[0].features, all.features);
  const auto h = all.normalized();
  for (std::size_t b = 0; b < h.size(); ++b)
    EXPECT_FLOAT_EQ(model.members[0].histogram[b], static_cast<float>(h[b]));
}

TEST(Training, MeshAndPointsOfOneShapeAgree)
{
  auto trainer = quickTrainer();
  for (const auto* name : {"torus", "cone", "ellipsoid"}) {
    const auto shape = *shapeByName(name);
    const auto from_points = trainer.train(name, sampleShape(shape, 20000, 3));
    const auto from_mesh = trainer.train(name, meshOfShape(shape, 0.01));
    EXPECT_LT(difference(from_points, from_mesh), 0.08) << name;
    EXPECT_NEAR(from_mesh.surface_area / areaOfShape(shape), 1, 0.02);
    EXPECT_NEAR(from_mesh.delta_max / from_points.delta_max, 1, 0.02);
    EXPECT_GT(
        difference(from_points, trainer.train("other", sampleShape(*shapeByName("cup"), 20000, 3))),
        0.2);
  }
}

TEST(Training, SameSeedSameModelForAnyNumberOfThreads)
{
  const auto set = sampleShape(*shapeByName("cup"), 5000, 4);
  auto trainer = quickTrainer();
  trainer.setNumberOfThreads(1);
  const auto one = trainer.train("cup", set);
  const auto mesh_one = trainer.train("cup", meshOfShape(Shape::cone(0.1, 0.2), 0.02));
  trainer.setNumberOfThreads(4);
  EXPECT_EQ(one.members[0].histogram, trainer.train("cup", set).members[0].histogram);
  EXPECT_EQ(mesh_one.members[0].histogram,
            trainer.train("cup", meshOfShape(Shape::cone(0.1, 0.2), 0.02)).members[0].histogram);
  trainer.setSeed(2);
  EXPECT_NE(one.members[0].histogram, trainer.train("cup", set).members[0].histogram);
}

TEST(Training, SeveralProcessesTrainTheModelOfOne)
{
  constexpr std::size_t kParts = 3;
  const auto torus = Shape::torus(0.1, 0.04);
  const SurfletSet points = sampleShape(torus, 5000, 1);
  const TriangleMesh mesh = meshOfShape(torus, 0.02);
  const auto same = [&](const auto& data) {
    const HistogramModel alone = quickTrainer().train("torus", data);
    HistogramModelTrainer trainer = quickTrainer();
    std::vector<PairHistogram> shares;
    const auto keep = [&](const PairHistogram& own) { return shares.emplace_back(own), own; };
    for (std::size_t part = 0; part < kParts; ++part) {
      trainer.setPairShare({part, kParts}, keep);
      EXPECT_NE(trainer.train("torus", data).members[0].histogram, alone.members[0].histogram)
          << "a share alone is another histogram";
    }
    ASSERT_EQ(shares.size(), kParts);
    trainer.setPairShare({1, kParts}, [&](PairHistogram own) {
      own.merge(shares[0]);
      own.merge(shares[2]);
      return own;
    });
    const HistogramModel together = trainer.train("torus", data);
    EXPECT_EQ(together.members[0].histogram, alone.members[0].histogram);
    EXPECT_EQ(together.members[0].features, alone.members[0].features);
    EXPECT_EQ(together.delta_max, alone.delta_max);
  };
  same(points);
  same(mesh);
}

TEST(Training, UnevenDensityIsEvenedOutRefusedOrAccepted)
{
  // A bottle whose lower half is nine times as dense as its upper half.
  const auto bottle = sampleShape(*shapeByName("bottle"), 40000, 5);
  SurfletSet uneven;
  for (std::size_t i = 0; i < bottle.size(); ++i)
    if (bottle.z[i] < 0.1 || i % 9 == 0)
      uneven.push_back(bottle[i]);
  auto trainer = quickTrainer();
  const auto even = trainer.train("bottle", bottle);
  const auto mended = trainer.train("bottle", uneven);
  trainer.setUnevenDensity(UnevenDensity::Accept);
  const auto biased = trainer.train("bottle", uneven);
  EXPECT_LT(difference(even, mended), 0.6 * difference(even, biased));
  trainer.setUnevenDensity(UnevenDensity::Refuse);
  EXPECT_NE(errorOf([&] { trainer.train("bottle", uneven); }).find("reduce the cloud"),
            std::string::npos);
}

TEST(Training, UnusableDataIsRefusedWithAReason)
{
  const auto trainer = quickTrainer();
  SurfletSet set;
  EXPECT_NE(errorOf([&] { trainer.train("nothing", set); }).find("too few"), std::string::npos);
  for (int i = 0; i < 10; ++i)
    set.push_back({1, 1, 1, 0, 0, 1});
  EXPECT_NE(errorOf([&] { trainer.train("point", set); }).find("coincide"), std::string::npos);
  SurfletSet line;
  for (int i = 0; i < 10; ++i)
    line.push_back({0, 0, float(i), 0, 0, 1});
  EXPECT_NE(errorOf([&] { trainer.train("line", line); }).find("no pair"), std::string::npos);
  EXPECT_NE(errorOf([&] { trainer.train("empty", TriangleMesh{}); }), "no error");
  const auto good = sampleShape(Shape::sphere(1), 100, 1);
  EXPECT_NE(errorOf([&] { trainer.train("", good); }).find("label"), std::string::npos);
  EXPECT_NE(errorOf([&] { trainer.train(std::string(64, 'x'), good); }).find("63"),
            std::string::npos);
  EXPECT_NE(errorOf([&] { trainer.train("a\nb", good); }).find("control"), std::string::npos);
}

TEST(Training, MisusedParametersThrow)
{
  HistogramModelTrainer trainer;
  EXPECT_THROW(trainer.setResolution({0, 1, 1, 1}), std::invalid_argument);
  EXPECT_THROW(trainer.setNumberOfPairs(0), std::invalid_argument);
  EXPECT_THROW(trainer.setMeshSampling(1, 1), std::invalid_argument);
  EXPECT_THROW(trainer.setMeshSampling(10, 0), std::invalid_argument);
  EXPECT_THROW(trainer.setPairShare({1, 1}, nullptr), std::invalid_argument);
}

TEST(HistogramModel, NamesWhatIsWrong)
{
  const auto good = quickTrainer().train("ball", sampleShape(Shape::sphere(1), 100, 1));
  const auto problemAfter = [&](const std::function<void(HistogramModel&)>& damage) {
    HistogramModel model = good;
    damage(model);
    return model.problem();
  };
  EXPECT_EQ(problemAfter([](HistogramModel&) {}), "");
  EXPECT_NE(problemAfter([](auto& m) { m.delta_max = 0; }).find("delta_max"), std::string::npos);
  EXPECT_NE(problemAfter([](auto& m) { m.r_mean = std::numeric_limits<double>::quiet_NaN(); }), "");
  EXPECT_NE(problemAfter([](auto& m) { m.r_max = 9; }).find("radii"), std::string::npos);
  EXPECT_NE(problemAfter([](auto& m) { m.members.clear(); }).find("no histogram"),
            std::string::npos);
  EXPECT_NE(problemAfter([](auto& m) { m.members[0].histogram.pop_back(); }).find("624"),
            std::string::npos);
  EXPECT_NE(problemAfter([](auto& m) { m.members[0].histogram[3] = -1; }).find("negative"),
            std::string::npos);
  EXPECT_NE(problemAfter([](auto& m) { m.members[0].histogram[3] += 0.5f; }).find("sum"),
            std::string::npos);
}
