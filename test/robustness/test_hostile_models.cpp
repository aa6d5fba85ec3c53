// Hostile clouds for the classes of features, models and their comparison (chapters 2 and 3): no
// crash, no endless loop; what comes out is usable, or there is the documented error.
#include "hostile_clouds.h"

#include "pcl_surflet/conversions.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/model_bank_trainer.h"
#include "pcl_surflet/model_search.h"
#include "pcl_surflet/recognition/histogram_classifier.h"
#include "pcl_surflet/recognition/scene_training.h"
#include "pcl_surflet/sensed_surface.h"
#include "pcl_surflet/surflet_pair_feature.h"
#include "pcl_surflet/surflet_pair_histogram.h"
#include "pcl_surflet/view_training.h"

#include <pcl/console/print.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

namespace {

class HostileModels : public testing::Test {
protected:
  void
  SetUp() override
  {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); // errors are what is expected
  }
};

const ModelDatabase&
database()
{
  static const ModelDatabase models = [] {
    HistogramModelTrainer trainer;
    trainer.setNumberOfPairs(100000);
    ModelDatabase d;
    for (const char* name : {"bottle", "torus"})
      d.add(trainer.train(name, sampleShape(*shapeByName(name), 2000, 9)));
    return d;
  }();
  return models;
}

HistogramModelTrainer
quickTrainer()
{
  HistogramModelTrainer trainer;
  trainer.setNumberOfPairs(20000);
  trainer.setMeshSampling(300, 1);
  return trainer;
}

/** \brief A usable model, or the documented error. */
template <typename Train>
void
expectModelOrError(const std::string& name, const Train& train)
{
  try {
    const HistogramModel model = train();
    EXPECT_EQ(model.problem(), "") << name;
  }
  catch (const TrainingError& error) {
    EXPECT_GT(std::string(error.what()).size(), 20U) << name;
  }
  catch (const std::exception& error) {
    ADD_FAILURE() << name << ": " << error.what();
  }
}

/** \brief The points as the corners of triangles, each with the next two. */
TriangleMesh
stripOf(const HostileCloud& cloud)
{
  TriangleMesh mesh;
  for (const auto& p : cloud)
    mesh.vertices.push_back({p.x, p.y, p.z});
  for (std::uint32_t i = 0; i + 2 < cloud.size(); ++i)
    mesh.triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

std::size_t
usable(const HostileCloud& cloud)
{
  return toSurflets(cloud).surflets.size();
}

} // namespace

TEST_F(HostileModels, PairFeatures)
{
  for (const auto& [name, cloud] : hostileClouds())
    for (const std::uint64_t pairs : {0, 1000}) {
      SurfletPairFeature<pcl::PointNormal, pcl::PointNormal> feature;
      feature.setInputCloud(cloud);
      feature.setNumberOfPairs(pairs);
      pcl::PointCloud<SurfletPairSignature> out;
      feature.compute(out);
      const std::size_t m = usable(*cloud),
                        most = pairs > 0 ? pairs : m * (m - std::min(m, 1UL)) / 2;
      EXPECT_EQ(out.size(), std::size_t{out.width} * out.height) << name;
      EXPECT_TRUE(pairs > 0 || out.size() + feature.getNumberOfRejectedPairs() == most) << name;
      EXPECT_LE(out.size(), most) << name;
      for (const auto& p : out) {
        ASSERT_TRUE(std::isfinite(p.alpha) && std::abs(p.beta) <= 1 && std::abs(p.gamma) <= 1)
            << name;
        ASSERT_TRUE(std::isfinite(p.delta) && p.delta > 0) << name << " " << p.delta;
        ASSERT_TRUE(p.index_1 < cloud->size() && p.index_2 < cloud->size()) << name;
        ASSERT_NE(p.index_1, p.index_2) << name;
      }
    }
}

TEST_F(HostileModels, PairHistograms)
{
  for (const auto& [name, cloud] : hostileClouds())
    for (const double delta_max : {0.0, 1e-30, 1.0, 1e30}) {
      SurfletPairHistogramEstimation<pcl::PointNormal, pcl::PointNormal> estimation;
      estimation.setInputCloud(cloud);
      estimation.setDeltaMax(delta_max);
      estimation.setNumberOfPairs(5000);
      pcl::PointCloud<SurfletPairHistogram625> out;
      estimation.compute(out);
      ASSERT_LE(out.size(), 1U) << name;
      if (out.empty())
        continue;
      const auto& h = out[0].histogram;
      EXPECT_NEAR(std::accumulate(std::begin(h), std::end(h), 0.0), 1, 1e-3) << name;
    }
}

TEST_F(HostileModels, TrainedModels)
{
  for (const auto& [name, cloud] : hostileClouds()) {
    const SurfletSet set = toSurflets(*cloud).surflets;
    for (const auto treatment :
         {UnevenDensity::EvenOut, UnevenDensity::Refuse, UnevenDensity::Accept}) {
      auto trainer = quickTrainer();
      trainer.setUnevenDensity(treatment);
      expectModelOrError(name, [&] { return trainer.train("x", set); });
    }
    try {
      EXPECT_EQ(trainForScenes(quickTrainer(), "x", set, 0.1).problem(), "") << name;
    }
    catch (const TrainingError&) {
    }
    catch (const std::invalid_argument&) { // the leaf does not go with the extent
    }
  }
}

TEST_F(HostileModels, TrainedForSensors)
{
  std::size_t trained = 0;
  for (const auto& [name, cloud] : hostileClouds()) {
    const TriangleMesh mesh = stripOf(*cloud);
    for (const double leaf : {0.0, -1.0, 1e-30, 0.2, 1e30, std::nan("")})
      try {
        const SceneItem item = sceneItem("x", mesh);
        const auto model =
            trainForSensors(quickTrainer(), item, sensingFor(item, leaf), leaf, 1, 1);
        EXPECT_EQ(model.problem(), "") << name;
        ++trained;
      }
      catch (const std::exception& error) { // TrainingError, or something does not go together
        const bool documented = dynamic_cast<const TrainingError*>(&error) != nullptr ||
                                dynamic_cast<const std::invalid_argument*>(&error) != nullptr;
        EXPECT_TRUE(documented) << name << " " << leaf << ": " << error.what();
        EXPECT_GT(std::string(error.what()).size(), 20U) << name;
      }
  }
  EXPECT_GT(trained, 2U) << "some are but odd";
}

TEST_F(HostileModels, ModelBanks)
{
  const ModelBank bank = ModelBank::parse("noise 2\nvisible 50\nview\n");
  for (const auto& [name, cloud] : hostileClouds()) {
    ModelBankTrainer trainer(quickTrainer(), bank);
    trainer.setSamplesPerMember(2);
    const SurfletSet set = toSurflets(*cloud).surflets;
    expectModelOrError(name, [&] { return trainer.train("x", set); });
  }
}

TEST_F(HostileModels, ClassifiedAndSearched)
{
  HistogramClassifier classifier(database());
  const ModelSearch search(database());
  for (const auto& [name, cloud] : hostileClouds()) {
    const SurfletSet query = toSurflets(*cloud).surflets;
    for (const bool normalised : {false, true}) {
      classifier.setScaleNormalized(normalised);
      const Classification answer = classifier.classify(query);
      EXPECT_TRUE(answer.ranking.empty() || answer.ranking.size() == database().size()) << name;
      for (const auto& match : answer.ranking) {
        EXPECT_TRUE(std::isfinite(match.score)) << name;
        EXPECT_TRUE(match.posterior >= 0 && match.posterior <= 1) << name;
      }
    }
    for (const auto& hits : {search.search(query, 5), search.searchAll(query, 5)}) {
      EXPECT_LE(hits.size(), database().size()) << name;
      for (const auto& hit : hits)
        EXPECT_TRUE(std::isfinite(hit.score)) << name;
    }
  }
}

TEST_F(HostileModels, NormalsEstimatedFromSensorData)
{
  for (const auto& [name, cloud] : hostileClouds()) {
    pcl::PointCloud<pcl::PointXYZ> points;
    for (const auto& p : *cloud)
      points.push_back({p.x, p.y, p.z});
    points.width = cloud->width;
    points.height = cloud->height;
    points.is_dense = false;
    const auto check = [&, &label = name](const ConvertedSurflets& out) {
      EXPECT_EQ(out.surflets.size() + out.rejected, cloud->size()) << label;
      EXPECT_EQ(out.indices.size(), out.surflets.size()) << label;
      for (std::size_t i = 0; i < out.surflets.size(); ++i)
        ASSERT_NEAR(out.surflets[i].nx * out.surflets[i].nx +
                        out.surflets[i].ny * out.surflets[i].ny +
                        out.surflets[i].nz * out.surflets[i].nz,
                    1, 1e-3)
            << label;
    };
    check(surfletsFromPoints(points, Eigen::Vector3f(0, 0, 10)));
    check(surfletsFromDirections(*cloud));
    if (points.height >= 3)
      check(surfletsFromDepth(points, Eigen::Vector3f(0, 0, 10)));
    const SurfletSet set = toSurflets(*cloud).surflets;
    const auto again = withEstimatedNormals(set, 0.5);
    EXPECT_EQ(again.surflets.size() + again.rejected, set.size()) << name;
  }
}
