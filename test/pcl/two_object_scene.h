/** \file
 * A scene of two objects, its models and an interpreter that is ready to find them. */
#pragma once

#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/scene_interpreter.h"

#include <pcl/console/print.h>

#include <gtest/gtest.h>

#include <limits>

namespace pcl_surflet {
namespace test {

using Interpreter = SceneInterpreter<pcl::PointNormal>;

inline const Scene&
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

inline const ModelDatabase&
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

inline Cloud::Ptr
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
inline Cloud::Ptr
cloud()
{
  const Cloud::Ptr out = cloudOf(scene().surflets);
  out->push_back(out->back());
  out->back().x = std::numeric_limits<float>::quiet_NaN();
  return out;
}

inline Interpreter
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

/** \brief Bottle and torus were found, and nothing else; most points are theirs. */
inline void
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

} // namespace test
} // namespace pcl_surflet
