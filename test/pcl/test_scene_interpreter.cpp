#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/recognition/scene_training.h"
#include "pcl_surflet/scene_interpreter.h"

#include <pcl/console/print.h>
#include <pcl/search/kdtree.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

using namespace pcl_surflet;

namespace {

using Interpreter = SceneInterpreter<pcl::PointNormal>;

const Scene&
scene()
{
  static const Scene made = [] {
    SceneOptions o;
    o.background = Background::None;
    o.density = 100000;
    o.seed = 3;
    return generateScene(
        {sceneItem("bottle", *shapeByName("bottle")), sceneItem("torus", *shapeByName("torus"))},
        {}, o);
  }();
  return made;
}

const ModelDatabase&
database()
{
  static const ModelDatabase models = [] {
    HistogramModelTrainer trainer;
    trainer.setResolution({7, 7, 7, 7});
    trainer.setNumberOfPairs(1000000);
    ModelDatabase d;
    for (const char* name : {"bottle", "torus"})
      d.add(trainer.train(name, sampleShape(*shapeByName(name), 20000, 9)));
    return d;
  }();
  return models;
}

using Cloud = pcl::PointCloud<pcl::PointNormal>;

Cloud::Ptr
cloudOf(const SurfletSet& s, float scale = 1)
{
  Cloud::Ptr out(new Cloud);
  for (std::size_t i = 0; i < s.size(); ++i) {
    pcl::PointNormal p;
    p.x = scale * s.x[i];
    p.y = scale * s.y[i];
    p.z = scale * s.z[i];
    p.normal_x = s.nx[i];
    p.normal_y = s.ny[i];
    p.normal_z = s.nz[i];
    out->push_back(p);
  }
  return out;
}

/** \brief The scene's points, then one that is not finite. */
Cloud::Ptr
cloud()
{
  const Cloud::Ptr out = cloudOf(scene().surflets);
  out->push_back(out->back());
  out->back().x = std::numeric_limits<float>::quiet_NaN();
  return out;
}

Interpreter
ready(bool extract_removed = false)
{
  Interpreter interpreter(extract_removed);
  interpreter.setInputCloud(cloud());
  interpreter.setDatabase(database());
  interpreter.setLeafSize(0.008);
  auto p = interpreter.getParameters();
  p.steps.pairs = 50000;
  interpreter.setParameters(p);
  return interpreter;
}

/** \brief The same objects on a background; \p objects false: the background alone. */
struct Backed {
  SceneOptions options;
  Scene scene;

  explicit Backed(Background background)
  {
    options.background = background;
    options.size = 0.6;
    options.density = 100000;
    options.seed = 5;
    scene = generateScene(
        {sceneItem("bottle", *shapeByName("bottle")), sceneItem("torus", *shapeByName("torus"))},
        {}, options);
  }
};

/** \brief Bottle and torus were found, and nothing else; most points are theirs. */
void
expectBoth(const std::vector<SceneDetection>& found, const Scene& truth)
{
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NE(found[0].model, found[1].model);
  for (const auto& d : found) {
    std::size_t right = 0;
    for (const auto i : d.indices)
      right += truth.labels[static_cast<std::size_t>(i)] == d.model + 1 ? 1 : 0;
    EXPECT_GT(double(right), 0.95 * double(d.indices.size())) << d.label;
    EXPECT_GT(double(right), 0.8 * double(truth.items[d.model].surflets)) << d.label;
  }
}

/** \brief Silences what the tests provoke. */
struct Quiet {
  pcl::console::VERBOSITY_LEVEL before = pcl::console::getVerbosityLevel();
  Quiet() { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }
  ~Quiet() { pcl::console::setVerbosityLevel(before); }
};

} // namespace

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

TEST(SceneInterpreter, ABackgroundThatIsIgnoredIsNoObject)
{
  auto interpreter = ready();
  SceneOptions table;
  table.density = 50000;
  interpreter.setInputCloud(cloudOf(emptyBackground(table)));
  EXPECT_TRUE(interpreter.interpret().empty());
  EXPECT_NE(interpreter.getDiagnostics().reason.find("no model explains"), std::string::npos)
      << interpreter.getDiagnostics().reason;
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

TEST(SceneInterpreter, CellsConfidenceAndCoverageOfADetection)
{
  auto models = database();
  HistogramModel torus = models[1];
  torus.surface_area = areaOfShape(*shapeByName("torus"));
  models.replace(torus);
  auto interpreter = ready();
  interpreter.setDatabase(models);
  const auto found = interpreter.interpret();
  ASSERT_EQ(found.size(), 2u);
  for (const auto& d : found) {
    if (d.label == "bottle")
      EXPECT_TRUE(std::isnan(d.coverage)) << "its area is unknown";
    else
      EXPECT_NEAR(d.coverage, 1, 0.1);
    EXPECT_GT(d.confidence, 0);
    EXPECT_LE(d.confidence, 1);
    double x = 0;
    for (const auto c : d.cells)
      x += interpreter.getCells().x[c];
    EXPECT_NEAR(x / double(d.cells.size()), d.centroid[0], 1e-5);
  }
  EXPECT_EQ(interpreter.getCells().size(), interpreter.getDiagnostics().cells);
}

TEST(SceneInterpreter, CoverageIsOfTheAreaThatTrainingForScenesFinds)
{
  HistogramModelTrainer trainer;
  trainer.setResolution({7, 7, 7, 7});
  ModelDatabase models;
  for (const char* name : {"bottle", "torus"})
    models.add(trainForScenes(trainer, name, sampleShape(*shapeByName(name), 20000, 9), 0.008));
  auto interpreter = ready();
  interpreter.setDatabase(models);
  const auto found = interpreter.interpret();
  ASSERT_EQ(found.size(), 2u);
  for (const auto& d : found)
    EXPECT_NEAR(d.coverage, 1, 0.1) << d.label;
}

TEST(SceneInterpreter, ConfidenceGrowsWithFitAndMargin)
{
  Detection d;
  d.margin = 0.1;
  d.fit = 0.83;
  d.cells.resize(300);
  const double usual = detail::confidenceOf(d, 30);
  EXPECT_NEAR(usual, 1 / (1 + std::exp(18.4 - 19.7 * 0.83 - 12.5 * 0.1)), 1e-12);
  Detection better = d, nearer = d, best = d, alone = d;
  better.margin = 0.2;
  nearer.fit = 0.9;
  for (const auto& e : {better, nearer})
    EXPECT_GT(detail::confidenceOf(e, 30), usual);
  best.fit = 0.95;
  best.margin = 0.3;
  EXPECT_GT(detail::confidenceOf(best, 30), 0.8);
  alone.margin = 0;
  alone.fit = 0.95;
  EXPECT_GT(detail::confidenceOf(alone, 30), 0.9) << "a database of one model has no rivals";
  alone.fit = 0.7;
  EXPECT_LT(detail::confidenceOf(alone, 30), 0.1);
  EXPECT_EQ(detail::confidenceOf(Detection(), 30), 0);
}

TEST(SceneInterpreter, ConfidenceWithoutFitGrowsWithScoreAndCells)
{
  Detection d;
  d.score = 0.1;
  d.cells.resize(300);
  const double usual = detail::confidenceOf(d, 30);
  EXPECT_NEAR(usual, 1 / (1 + std::exp(-1.0)) / 1.1, 1e-12);
  Detection better = d, larger = d;
  better.score = 0.2;
  larger.cells.resize(3000);
  for (const auto& e : {better, larger})
    EXPECT_GT(detail::confidenceOf(e, 30), usual);
  d.score = -1e9;
  EXPECT_EQ(detail::confidenceOf(d, 30), 0);
  d.score = 1e9;
  EXPECT_LE(detail::confidenceOf(d, 30), 1);
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

TEST(SceneInterpreter, ExcludesAnEmptyScene)
{
  const Backed backed(Background::Bowl);
  auto interpreter = ready();
  interpreter.setInputCloud(cloudOf(backed.scene.surflets));
  interpreter.setBackgroundCloud(cloudOf(emptyBackground(backed.options)));
  expectBoth(interpreter.interpret(), backed.scene);
  EXPECT_GT(interpreter.getDiagnostics().background_points, 30000u);
  // A search of PCL's serves as well, and is used.
  pcl::search::KdTree<pcl::PointNormal>::Ptr tree(new pcl::search::KdTree<pcl::PointNormal>);
  const auto excluded = interpreter.getDiagnostics().background_points;
  interpreter.setSearchMethod(tree);
  expectBoth(interpreter.interpret(), backed.scene);
  EXPECT_TRUE(tree->getInputCloud() != nullptr);
  EXPECT_NEAR(double(interpreter.getDiagnostics().background_points), double(excluded),
              0.001 * double(excluded));
  // The background itself holds no object.
  interpreter.setInputCloud(cloudOf(emptyBackground(backed.options)));
  EXPECT_TRUE(interpreter.interpret().empty());
  EXPECT_EQ(interpreter.getDiagnostics().reason, "all points are background");
}

TEST(SceneInterpreter, ExcludesPlanes)
{
  const Backed backed(Background::Corner);
  auto interpreter = ready();
  interpreter.setInputCloud(cloudOf(backed.scene.surflets));
  BackgroundPlane table, any;
  table.normal = {0, 0, 2};
  interpreter.setBackgroundPlanes({table, any});
  expectBoth(interpreter.interpret(), backed.scene);
  EXPECT_EQ(interpreter.getDiagnostics().planes, 2u);
  BackgroundPlane slope; // there is none that faces this way
  slope.normal = {1, 0, 1};
  interpreter.setBackgroundPlanes({slope});
  interpreter.interpret();
  EXPECT_EQ(interpreter.getDiagnostics().planes, 0u);
  EXPECT_EQ(interpreter.getDiagnostics().background_points, 0u);
}

TEST(SceneInterpreter, WhatStandsOnTheBackgroundKeepsItsUnderside)
{
  const Backed backed(Background::Plane);
  auto interpreter = ready();
  interpreter.setInputCloud(cloudOf(backed.scene.surflets));
  interpreter.setBackgroundPlanes({{}});
  const std::size_t table = std::size_t(
      std::count(backed.scene.labels.begin(), backed.scene.labels.end(), std::uint32_t{0}));
  interpreter.interpret();
  const std::size_t excluded = interpreter.getDiagnostics().background_points;
  EXPECT_GE(excluded, table);
  EXPECT_LT(excluded, table + table / 50) << "what turns up inside the bottle may go";
  ExclusionOptions whatever_it_faces;
  whatever_it_faces.max_angle = M_PI;
  interpreter.setExclusionOptions(whatever_it_faces);
  interpreter.interpret();
  EXPECT_GT(interpreter.getDiagnostics().background_points, excluded + table / 50);
}

TEST(SceneInterpreter, TheBackgroundNeedsNormals)
{
  SceneInterpreter<pcl::PointXYZ, pcl::Normal> interpreter;
  pcl::PointCloud<pcl::PointXYZ>::Ptr points(new pcl::PointCloud<pcl::PointXYZ>(3, 1));
  interpreter.setInputCloud(points);
  interpreter.setInputNormals(
      pcl::PointCloud<pcl::Normal>::Ptr(new pcl::PointCloud<pcl::Normal>(3, 1)));
  interpreter.setDatabase(database());
  interpreter.setBackgroundCloud(points);
  const Quiet quiet;
  EXPECT_TRUE(interpreter.interpret().empty());
  EXPECT_EQ(interpreter.getDiagnostics().status, SceneStatus::NoNormals);
  EXPECT_NE(interpreter.getDiagnostics().reason.find("background"), std::string::npos);
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
