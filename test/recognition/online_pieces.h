/** \file
 * Two things that are scanned one after the other, and their models. */
#pragma once

#include "scene_pieces.h"

#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/recognition/online_interpretation.h"
#include "pcl_surflet/recognition/scene_training.h"

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace test {

constexpr double kLeaf = 0.006;
constexpr float kFar = 2; ///< objects so far apart do not share a region

inline const std::vector<SceneItem>&
things()
{
  static const std::vector<SceneItem> all = {sceneItem("bottle", *shapeByName("bottle")),
                                             sceneItem("torus", *shapeByName("torus"))};
  return all;
}

inline const ModelDatabase&
models()
{
  static const ModelDatabase database = [] {
    HistogramModelTrainer trainer;
    trainer.setResolution({7, 7, 7, 7});
    trainer.setNumberOfPairs(1000000);
    ModelDatabase d;
    for (const auto& thing : things())
      d.add(trainForScenes(trainer, thing.label, thing.sample(20000, 99), kLeaf));
    return d;
  }();
  return database;
}

inline SurfletSet
thingAt(std::size_t thing, float x, std::uint64_t seed = 5)
{
  return shifted(things()[thing].sample(20000, seed), x);
}

constexpr std::array<double, 3> kSensor{0, -2, 0};

/** \brief Ends of rays on a wall at y = 1, from kSensor past (\p x, 0). They have no normals, so
 * that no cells come from them. */
inline SurfletSet
wallSeenThrough(float x)
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  SurfletSet wall;
  for (int i = -60; i <= 60; ++i)
    for (int k = -120; k <= 120; ++k)
      wall.push_back({1.5F * x + 0.005F * static_cast<float>(i), 1, 0.005F * static_cast<float>(k),
                      nan, nan, nan});
  return wall;
}

inline OnlineParameters
quick(unsigned threads = 1)
{
  OnlineParameters p;
  p.leaf = kLeaf;
  p.explanation.steps.threads = threads;
  return p;
}

inline const OnlineDetection*
find(const OnlineInterpretation& online, const std::string& label)
{
  for (const auto& d : online.detections())
    if (d.label == label && d.state != OnlineState::Vanished)
      return &d;
  return nullptr;
}

} // namespace test
} // namespace pcl_surflet
