#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/scene_interpreter.h"

#include <pcl/console/print.h>

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

/** \brief The scene's points, then one that is not finite. */
pcl::PointCloud<pcl::PointNormal>::Ptr
cloud()
{
  pcl::PointCloud<pcl::PointNormal>::Ptr out(new pcl::PointCloud<pcl::PointNormal>);
  const auto& s = scene().surflets;
  for (std::size_t i = 0; i < s.size(); ++i) {
    pcl::PointNormal p;
    p.x = s.x[i];
    p.y = s.y[i];
    p.z = s.z[i];
    p.normal_x = s.nx[i];
    p.normal_y = s.ny[i];
    p.normal_z = s.nz[i];
    out->push_back(p);
  }
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
  EXPECT_GT(interpreter.getDiagnostics().drawn, 0u);
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
  EXPECT_TRUE(interpreter.interpret().empty()) << "no normals";
  interpreter.setInputNormals(normals);
  EXPECT_EQ(interpreter.interpret().size(), 2u);
}

TEST(SceneInterpreter, MisuseGivesNothing)
{
  const Quiet quiet;
  Interpreter none;
  EXPECT_TRUE(none.interpret().empty()) << "no cloud";
  none.setInputCloud(cloud());
  EXPECT_TRUE(none.interpret().empty()) << "no database";
  pcl::Indices indices = {1, 2, 3};
  none.filter(indices);
  EXPECT_TRUE(indices.empty());
  auto interpreter = ready();
  interpreter.setBackgroundTreatment(BackgroundTreatment::Model);
  EXPECT_TRUE(interpreter.interpret().empty()) << "no background model";
  pcl::PointCloud<pcl::PointNormal>::Ptr empty(new pcl::PointCloud<pcl::PointNormal>);
  interpreter = ready();
  interpreter.setInputCloud(empty);
  EXPECT_TRUE(interpreter.interpret().empty());
}
