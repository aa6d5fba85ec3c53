// The interpreter as a filter: what it finds, labels and refuses.
#include "two_object_scene.h"

#include <algorithm>
#include <limits>
#include <numeric>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

TEST(SceneInterpreter, NamesObjectsAndTheirPoints)
{
  auto interpreter = ready();
  const auto found = interpreter.interpret();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_GT(interpreter.getDiagnostics().models[0].places, 0u);
  for (const auto& d : found) {
    EXPECT_EQ(d.label, database()[d.model].label);
    EXPECT_TRUE(std::is_sorted(d.indices.begin(), d.indices.end()));
    std::size_t right = 0;
    for (const auto i : d.indices)
      right += scene().labels[static_cast<std::size_t>(i)] == d.model + 1 ? 1 : 0;
    EXPECT_GT(double(right), 0.98 * double(d.indices.size()));
    EXPECT_GT(double(right), 0.85 * double(scene().items[d.model].surflets));
  }
}

TEST(SceneInterpreter, ThinWallsGoWithTheirNeighbours)
{
  // Cells as wide as a wall is thick hold both its sides, and their normals cancel.
  auto interpreter = ready();
  interpreter.setLeafSize(0.012);
  const auto found = interpreter.interpret();
  std::size_t points = 0;
  for (const auto& d : found)
    points += d.label == "bottle" ? d.indices.size() : 0;
  EXPECT_GT(double(points), 0.9 * double(scene().items[0].surflets));
}

TEST(SceneInterpreter, FiltersObjectPointsAndTheRest)
{
  auto interpreter = ready(true);
  const std::size_t n = scene().surflets.size() + 1;
  pcl::Indices objects, rest;
  interpreter.filter(objects);
  EXPECT_GT(objects.size(), 9 * n / 10);
  EXPECT_EQ(interpreter.getRemovedIndices()->size() + objects.size(), n);
  EXPECT_EQ(interpreter.getRemovedIndices()->back(), static_cast<int>(n - 1)) << "not finite";
  interpreter.setNegative(true);
  interpreter.filter(rest);
  EXPECT_EQ(objects.size() + rest.size(), n - 1) << "the point that is not finite is in neither";
  pcl::PointCloud<pcl::PointNormal> output;
  interpreter.setNegative(false);
  interpreter.filter(output);
  EXPECT_EQ(output.size(), objects.size());
}

TEST(SceneInterpreter, IndicesSelectThePointsToLookAt)
{
  auto interpreter = ready();
  pcl::IndicesPtr bottle(new pcl::Indices(scene().items[0].surflets));
  std::iota(bottle->begin(), bottle->end(), 0);
  interpreter.setIndices(bottle);
  const auto found = interpreter.interpret();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].label, "bottle");
  EXPECT_LT(found[0].indices.back(), static_cast<int>(bottle->size()));
}

TEST(SceneInterpreter, LabelsEveryPoint)
{
  auto interpreter = ready();
  pcl::PointCloud<pcl::PointXYZL> labelled;
  interpreter.getLabeledCloud(labelled);
  ASSERT_EQ(labelled.size(), scene().surflets.size() + 1);
  EXPECT_EQ(labelled.back().label, 0u);
  std::size_t right = 0;
  for (std::size_t i = 0; i + 1 < labelled.size(); ++i)
    right += labelled[i].label == scene().labels[i] ? 1 : 0;
  EXPECT_GT(double(right), 0.9 * double(labelled.size()));
}

TEST(SceneInterpreter, KeepsTheLargestDetections)
{
  auto interpreter = ready();
  const auto all = interpreter.interpret();
  ASSERT_EQ(all.size(), 2u);
  interpreter.setMaximumDetections(1);
  const auto found = interpreter.interpret();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].cells.size(), std::max(all[0].cells.size(), all[1].cells.size()));
}

TEST(SceneInterpreter, TheDissertationsMethodIsAChoice)
{
  auto interpreter = ready();
  interpreter.setMethod(Method::Dissertation);
  const auto found = interpreter.interpret();
  ASSERT_FALSE(found.empty());
  for (const auto& d : found) {
    EXPECT_GT(d.seeds, 1u);
    EXPECT_FALSE(d.indices.empty());
  }
}

TEST(SceneInterpreter, SeparateNormals)
{
  const auto both = cloud();
  pcl::PointCloud<pcl::PointXYZ>::Ptr points(new pcl::PointCloud<pcl::PointXYZ>);
  pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
  for (const auto& p : *both) {
    points->push_back({p.x, p.y, p.z});
    normals->push_back({p.normal_x, p.normal_y, p.normal_z});
  }
  SceneInterpreter<pcl::PointXYZ, pcl::Normal> interpreter;
  interpreter.setInputCloud(points);
  interpreter.setDatabase(database());
  interpreter.setLeafSize(0.008);
  interpreter.setParameters(ready().getParameters());
  const Quiet quiet;
  EXPECT_TRUE(interpreter.interpret().empty());
  EXPECT_EQ(interpreter.getDiagnostics().status, SceneStatus::NoNormals);
  EXPECT_NE(interpreter.getDiagnostics().reason.find("setInputNormals"), std::string::npos);
  interpreter.setInputNormals(pcl::PointCloud<pcl::Normal>::Ptr(new pcl::PointCloud<pcl::Normal>));
  EXPECT_TRUE(interpreter.interpret().empty());
  EXPECT_EQ(interpreter.getDiagnostics().status, SceneStatus::WrongInput);
  interpreter.setInputNormals(normals);
  EXPECT_EQ(interpreter.interpret().size(), 2u);
}

TEST(SceneInterpreter, MisuseGivesNothing)
{
  const Quiet quiet;
  const auto statusOf = [](Interpreter& interpreter) {
    EXPECT_TRUE(interpreter.interpret().empty());
    EXPECT_NE(interpreter.getDiagnostics().reason, "");
    return interpreter.getDiagnostics().status;
  };
  Interpreter none;
  EXPECT_EQ(none.getDiagnostics().status, SceneStatus::NotYet);
  EXPECT_EQ(statusOf(none), SceneStatus::NoInput);
  none.setInputCloud(cloud());
  EXPECT_EQ(statusOf(none), SceneStatus::WrongDatabase);
  pcl::Indices indices = {1, 2, 3};
  none.filter(indices);
  EXPECT_TRUE(indices.empty());
  auto interpreter = ready();
  interpreter.setBackgroundTreatment(BackgroundTreatment::Model);
  EXPECT_EQ(statusOf(interpreter), SceneStatus::WrongDatabase) << "no background model";
  interpreter = ready();
  interpreter.setLeafSize(-1);
  EXPECT_EQ(statusOf(interpreter), SceneStatus::WrongParameter);
  interpreter = ready();
  interpreter.setIndices(pcl::IndicesPtr(new pcl::Indices{-1}));
  EXPECT_EQ(statusOf(interpreter), SceneStatus::WrongInput);
  interpreter = ready();
  BackgroundPlane flat;
  flat.max_tilt = 0;
  interpreter.setBackgroundPlanes({flat});
  EXPECT_EQ(statusOf(interpreter), SceneStatus::WrongParameter);
}

TEST(SceneInterpreter, NothingThereIsNothingFound)
{
  auto interpreter = ready();
  interpreter.setInputCloud(Cloud::Ptr(new Cloud));
  EXPECT_TRUE(interpreter.interpret().empty());
  EXPECT_EQ(interpreter.getDiagnostics().status, SceneStatus::NothingFound);
  const Cloud::Ptr invalid = cloud();
  for (auto& p : *invalid)
    p.normal_z = std::numeric_limits<float>::quiet_NaN();
  interpreter.setInputCloud(invalid);
  EXPECT_TRUE(interpreter.interpret().empty());
  EXPECT_EQ(interpreter.getDiagnostics().status, SceneStatus::NothingFound);
  EXPECT_EQ(interpreter.getDiagnostics().rejected, invalid->size());
  EXPECT_NE(interpreter.getDiagnostics().reason.find("finite"), std::string::npos);
}

TEST(SceneInterpreter, OtherUnitsFindNothingAndSaySo)
{
  for (const Method method : {Method::Explanation, Method::Dissertation})
    for (const float scale : {0.001f, 1000.f}) {
      auto interpreter = ready();
      interpreter.setMethod(method);
      interpreter.setInputCloud(cloudOf(scene().surflets, scale));
      EXPECT_TRUE(interpreter.interpret().empty()) << scale;
      const auto& d = interpreter.getDiagnostics();
      EXPECT_EQ(d.status, SceneStatus::NothingFound) << scale;
      EXPECT_NE(d.reason.find("same unit"), std::string::npos) << d.reason;
      // Fast: the draws are limited, however many of them are in vain.
      const auto& steps = interpreter.getParameters().steps;
      EXPECT_LE(double(d.drawn), 1.1 * double(steps.pairs * steps.draws_per_pair));
    }
}

TEST(SceneInterpreter, AMiniatureIsNotNamed)
{
  // Cells as fine as the scene is small: the dissertation's steps alone would find objects.
  auto interpreter = ready();
  interpreter.setMethod(Method::Dissertation);
  interpreter.setInputCloud(cloudOf(scene().surflets, 0.01f));
  interpreter.setLeafSize(0.00008);
  EXPECT_TRUE(interpreter.interpret().empty());
  EXPECT_GT(interpreter.getDiagnostics().cells, 1000u);
  EXPECT_EQ(interpreter.getDiagnostics().drawn, 0u) << "nor are the steps bothered with it";
  EXPECT_NE(interpreter.getDiagnostics().reason.find("same unit"), std::string::npos);
}

TEST(SceneInterpreter, ThreadsDoNotChangeTheResult)
{
  auto interpreter = ready();
  interpreter.setNumberOfThreads(1);
  const auto one = interpreter.interpret();
  interpreter.setNumberOfThreads(2);
  const auto two = interpreter.interpret();
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].indices, two[k].indices);
    EXPECT_EQ(one[k].score, two[k].score);
    EXPECT_EQ(one[k].confidence, two[k].confidence);
  }
}

TEST(SceneInterpreter, LabelsCarryNormals)
{
  auto interpreter = ready();
  const auto found = interpreter.interpret();
  pcl::PointCloud<pcl::PointXYZLNormal> labelled;
  interpreter.labelCloud(found, labelled);
  const auto input = cloud();
  ASSERT_EQ(labelled.size(), input->size());
  std::size_t counted = 0;
  for (std::size_t i = 0; i < labelled.size(); ++i) {
    EXPECT_EQ(labelled[i].normal_z, (*input)[i].normal_z);
    counted += labelled[i].label > 0 ? 1 : 0;
  }
  EXPECT_EQ(counted, found[0].indices.size() + found[1].indices.size());
  pcl::PointCloud<pcl::PointXYZLNormal> again;
  interpreter.getLabeledCloud(again);
  for (std::size_t i = 0; i < labelled.size(); ++i)
    EXPECT_EQ(again[i].label, labelled[i].label);
}

TEST(SceneInterpreter, LabelsOfAnotherCloudAreRefused)
{
  const auto interpreter = ready();
  pcl::PointCloud<pcl::PointXYZL> labelled;
  for (const pcl::index_t wrong : {-1, static_cast<pcl::index_t>(cloud()->size())}) {
    SceneDetection d;
    d.indices = {0, wrong};
    EXPECT_THROW(interpreter.labelCloud({d}, labelled), std::invalid_argument) << wrong;
  }
}

TEST(SceneInterpreter, ProgressGrowsAndCancels)
{
  auto interpreter = ready();
  interpreter.setMethod(Method::Dissertation);
  std::vector<double> shares;
  interpreter.setProgressCallback([&](double share) {
    shares.push_back(share);
    return true;
  });
  EXPECT_FALSE(interpreter.interpret().empty());
  ASSERT_GT(shares.size(), 3u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_GE(shares.front(), 0);
  EXPECT_EQ(shares.back(), 1);
  for (std::size_t stop = 0; stop < shares.size(); ++stop) {
    std::size_t calls = 0;
    interpreter.setNumberOfThreads(1);
    interpreter.setProgressCallback([&](double) { return calls++ < stop; });
    EXPECT_TRUE(interpreter.interpret().empty()) << stop;
    EXPECT_TRUE(interpreter.getDiagnostics().cancelled);
    EXPECT_EQ(interpreter.getDiagnostics().status, SceneStatus::Cancelled);
    EXPECT_EQ(calls, stop + 1) << "asked again after it said no";
    for (const auto& m : interpreter.getDiagnostics().models) {
      if (stop < 2) {
        EXPECT_EQ(m.seeds, 0u) << "went on after it said no";
      }
    }
  }
}

TEST(SceneInterpreter, AccumulatesRunsWithinItsBudgets)
{
  auto interpreter = ready();
  const auto once = interpreter.interpret();
  EXPECT_EQ(interpreter.getDiagnostics().runs, 1u);
  AccumulationParameters p;
  p.runs = 3;
  std::vector<double> shares;
  interpreter.setProgressCallback([&](double share) {
    shares.push_back(share);
    return true;
  });
  interpreter.setAccumulation(p);
  const auto often = interpreter.interpret();
  EXPECT_EQ(interpreter.getDiagnostics().runs, 3u);
  expectBoth(often, scene());
  for (const auto& d : often) {
    const auto first = std::find_if(once.begin(), once.end(),
                                    [&](const auto& other) { return other.label == d.label; });
    ASSERT_NE(first, once.end());
    EXPECT_TRUE(std::includes(d.indices.begin(), d.indices.end(), first->indices.begin(),
                              first->indices.end()))
        << "no point is lost";
    EXPECT_EQ(d.votes, 1);
  }
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1);

  interpreter.setAccumulation(p, 1e-9); // the first run always goes
  EXPECT_EQ(interpreter.interpret().size(), once.size());
  EXPECT_EQ(interpreter.getDiagnostics().runs, 1u);
  interpreter.setAccumulation(p, 3600);
  interpreter.interpret();
  EXPECT_EQ(interpreter.getDiagnostics().runs, 3u);

  const Quiet quiet;
  interpreter.setAccumulation(p, -1);
  EXPECT_TRUE(interpreter.interpret().empty());
  EXPECT_EQ(interpreter.getDiagnostics().status, SceneStatus::WrongParameter);
}
