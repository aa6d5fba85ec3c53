#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/database_file.h"
#include "pcl_surflet/model_bank_trainer.h"
#include "pcl_surflet/recognition/histogram_classifier.h"
#include "pcl_surflet/sensed_surface.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pcl_surflet;

namespace {

constexpr std::size_t kSurflets = 1200;

const char* const kBank = "noise 3\nvisible 30 members 4\nview noise 0.3 members 3\n";

HistogramModelTrainer
quickTrainer()
{
  HistogramModelTrainer trainer;
  trainer.setNumberOfPairs(200000);
  trainer.setMeshSampling(kSurflets, 2);
  return trainer;
}

TriangleMesh
meshOf(const std::string& name)
{
  return scaledToDiameter(meshOfShape(*shapeByName(name), 0.02), 1);
}

HistogramModel
trained(const std::string& name, const std::string& bank = kBank)
{
  return ModelBankTrainer(quickTrainer(), ModelBank::parse(bank)).train(name, meshOf(name));
}

const ModelDatabase&
shapes()
{
  static const ModelDatabase database = [] {
    ModelDatabase d;
    for (const auto* name : {"cup", "bottle", "torus", "cone"})
      d.add(trained(name));
    return d;
  }();
  return database;
}

double
spacingOf(const TriangleMesh& mesh)
{
  return std::sqrt(surfaceArea(mesh) / static_cast<double>(kSurflets));
}

SurfletSet
noisy(const std::string& name, double noise, std::uint64_t seed)
{
  const auto mesh = meshOf(name);
  const auto moved = displacedAlongNormals(sampleIsoMesh(mesh, kSurflets, seed), noise, seed + 1);
  return withEstimatedNormals(moved, 3 * spacingOf(mesh), 1).surflets;
}

} // namespace

TEST(ModelBankTrainer, TheFirstMemberIsCleanAndCompleteTheOthersFollowTheBank)
{
  const auto model = trained("cup");
  EXPECT_EQ(model.problem(), "");
  ASSERT_EQ(model.members.size(), 9u);
  const auto plain = quickTrainer().train("cup", meshOf("cup"));
  EXPECT_EQ(model.members[0].histogram, plain.members[0].histogram);
  EXPECT_EQ(model.delta_max, plain.delta_max);
  EXPECT_EQ(model.r_mean, plain.r_mean);
  std::vector<std::string> names;
  for (const auto& member : model.members)
    names.push_back(member.condition);
  EXPECT_EQ(names,
            (std::vector<std::string>{"complete", "noise 3 %", "visible 30 % (1 of 4)",
                                      "visible 30 % (2 of 4)", "visible 30 % (3 of 4)",
                                      "visible 30 % (4 of 4)", "view, noise 0.3 % (1 of 3)",
                                      "view, noise 0.3 % (2 of 3)", "view, noise 0.3 % (3 of 3)"}));
  for (const auto& member : model.members) {
    EXPECT_GT(member.misfit, 0) << member.condition;
    EXPECT_GT(member.misfit_limit, 1) << member.condition;
  }
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(model.members[k].area, model.surface_area, 0.001 * model.surface_area);
  for (std::size_t k = 2; k < 6; ++k)
    EXPECT_NEAR(model.members[k].area, 0.3 * model.surface_area, 0.01 * model.surface_area);
  for (std::size_t k = 6; k < 9; ++k) // a cup hides most of its inside
    EXPECT_NEAR(model.members[k].area, 0.4 * model.surface_area, 0.15 * model.surface_area);
}

TEST(ModelBankTrainer, ABankWithoutConditionsIsThePlainTrainer)
{
  const auto cloud = sampleShape(*shapeByName("cup"), 1000, 1);
  const auto plain = quickTrainer().train("cup", cloud);
  const auto none = ModelBankTrainer(quickTrainer(), ModelBank::none()).train("cup", cloud);
  ASSERT_EQ(none.members.size(), 1u);
  EXPECT_EQ(none.members[0].histogram, plain.members[0].histogram);
  EXPECT_EQ(none.members[0].misfit, 0);
}

TEST(ModelBankTrainer, SameSeedSameModelForAnyNumberOfThreads)
{
  auto trainer = quickTrainer();
  const auto bank = ModelBank::parse("noise 2\nview members 2");
  const auto cloud = sampleShape(*shapeByName("cup"), 3000, 1);
  trainer.setNumberOfThreads(1);
  const auto one = ModelBankTrainer(trainer, bank).train("cup", cloud);
  trainer.setNumberOfThreads(3);
  const auto three = ModelBankTrainer(trainer, bank).train("cup", cloud);
  ASSERT_EQ(one.members.size(), three.members.size());
  for (std::size_t k = 0; k < one.members.size(); ++k) {
    EXPECT_EQ(one.members[k].histogram, three.members[k].histogram);
    EXPECT_EQ(one.members[k].misfit, three.members[k].misfit);
  }
  trainer.setSeed(2);
  EXPECT_NE(one.members[1].histogram,
            ModelBankTrainer(trainer, bank).train("cup", cloud).members[1].histogram);
}

TEST(ModelBankTrainer, TheAnsweringMemberTellsTheCondition)
{
  const HistogramClassifier classifier(shapes());
  const auto clean = classifier.classify(sampleIsoMesh(meshOf("cup"), kSurflets, 77));
  EXPECT_EQ(clean.best()->label, "cup");
  EXPECT_EQ(clean.best()->condition, "complete");
  const auto rough = classifier.classify(noisy("cup", 0.03, 77));
  EXPECT_EQ(rough.best()->label, "cup");
  EXPECT_EQ(rough.best()->condition, "noise 3 %");
  for (std::uint64_t seed = 70; seed < 75; ++seed) {
    const auto part = classifier.classify(
        cutByRandomPlane(sampleIsoMesh(meshOf("bottle"), kSurflets, seed), 0.3, seed));
    EXPECT_EQ(part.best()->label, "bottle");
    EXPECT_EQ(part.best()->condition.rfind("visible 30 %", 0), 0u) << part.best()->condition;
  }
}

TEST(ModelBankTrainer, StrangersAreToldFromNoise)
{
  HistogramClassifier classifier(shapes());
  const auto limit = classifier.calibratedMisfitLimit();
  ASSERT_TRUE(limit);
  EXPECT_GT(*limit, 1);
  EXPECT_LT(*limit, 3);
  classifier.setMisfitLimit(limit);
  for (const auto* name : {"cup", "bottle", "torus", "cone"}) {
    EXPECT_FALSE(classifier.classify(sampleIsoMesh(meshOf(name), kSurflets, 5)).unknown) << name;
    EXPECT_FALSE(classifier.classify(noisy(name, 0.03, 5)).unknown) << name;
  }
  for (const auto* name : {"box", "tetrahedron", "ellipsoid", "cylinder"}) {
    const auto answer = classifier.classify(sampleIsoMesh(meshOf(name), kSurflets, 5));
    EXPECT_TRUE(answer.unknown) << name << " " << answer.strangeness;
    ASSERT_GT(answer.ranking.size(), 1u);
    const auto &best = answer.ranking[0], &next = answer.ranking[1];
    EXPECT_NEAR(answer.strangeness,
                best.relative_misfit * std::sqrt(std::min(1.0, best.misfit / next.misfit)), 1e-12);
  }
  ModelDatabase alone; // without runner-up the relative misfit decides
  alone.add(shapes()[0]);
  HistogramClassifier one(alone);
  const auto answer = one.classify(sampleIsoMesh(meshOf("box"), kSurflets, 5));
  EXPECT_EQ(answer.strangeness, answer.ranking[0].relative_misfit);
  double sum = 0;
  for (const auto& member : alone[0].members)
    sum += member.misfit_limit / static_cast<double>(alone[0].members.size());
  EXPECT_NEAR(one.calibratedMisfitLimit().value(), sum, 1e-12);
  ModelDatabase plain;
  plain.add(quickTrainer().train("cup", meshOf("cup")));
  EXPECT_FALSE(HistogramClassifier(plain).calibratedMisfitLimit());
}

TEST(ModelBankTrainer, BanksSurviveTheFile)
{
  const std::string path = testing::TempDir() + "/bank_database.pcd";
  saveDatabase(shapes(), path);
  const auto read = loadDatabase(path);
  std::remove(path.c_str());
  ASSERT_EQ(read.size(), shapes().size());
  for (std::size_t k = 0; k < read[0].members.size(); ++k) {
    EXPECT_EQ(read[0].members[k].condition, shapes()[0].members[k].condition);
    EXPECT_EQ(read[0].members[k].misfit, shapes()[0].members[k].misfit);
    EXPECT_EQ(read[0].members[k].misfit_limit, shapes()[0].members[k].misfit_limit);
  }
}

TEST(ModelBankTrainer, MisuseAndUselessDataAreTold)
{
  ModelBankTrainer trainer(quickTrainer(), ModelBank::standard());
  EXPECT_THROW(trainer.setSamplesPerMember(0), std::invalid_argument);
  try {
    trainer.train("crumb", sampleShape(Shape::sphere(1), 20, 1));
    FAIL() << "twenty points have no neighbours to speak of";
  }
  catch (const TrainingError& e) {
    EXPECT_NE(std::string(e.what()).find("'crumb': 20 points are too few"), std::string::npos);
  }
  // One point of forty is left.
  const auto hopeless = ModelBank::parse("normals 1.5\nvisible 1 noise 50");
  try {
    ModelBankTrainer(quickTrainer(), hopeless).train("crumb", sampleShape(Shape::sphere(1), 40, 1));
    FAIL() << "one point has no pairs";
  }
  catch (const TrainingError& e) {
    EXPECT_NE(std::string(e.what()).find("noise 50 %, visible 1 %"), std::string::npos) << e.what();
  }
}
