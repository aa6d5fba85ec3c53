/** \file
 * Scenes of three shapes of ours, with models of them, for tests of explanation. */
#pragma once

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/recognition/scene_interpretation.h"
#include "pcl_surflet/recognition/scene_training.h"

#include <map>
#include <utility>
#include <vector>

namespace pcl_surflet {
namespace test {

inline constexpr double kLeaf = 0.006;

inline const std::vector<SceneItem>&
things()
{
  static const std::vector<SceneItem> all = {
      sceneItem("bottle", *shapeByName("bottle")), sceneItem("glass", *shapeByName("wine_glass")),
      sceneItem("torus", *shapeByName("torus")), sceneItem("die", *shapeByName("cube"))};
  return all;
}

/** \brief Trains bottle, glass and torus, or only the first \p count of them; the die is unknown.
 */
inline ModelDatabase
trainModels(std::size_t count = 3, bool background = false)
{
  HistogramModelTrainer trainer;
  trainer.setResolution({7, 7, 7, 7});
  trainer.setNumberOfPairs(2000000);
  ModelDatabase database;
  for (std::size_t i = 0; i < count; ++i)
    database.add(trainForScenes(trainer, things()[i].label, things()[i].sample(20000, 99), kLeaf));
  trainer.setRole(ModelRole::Background);
  if (background)
    database.add(trainer.train("floor", sampleShape(Shape::plane(0.2, 0.2), 5000, 5)));
  return database;
}

/** \brief trainModels(), once: a sanitizer needs half a minute for it. */
inline const ModelDatabase&
models(std::size_t count = 3, bool background = false)
{
  static std::map<std::pair<std::size_t, bool>, ModelDatabase> trained;
  const auto [place, is_new] = trained.try_emplace({count, background});
  if (is_new)
    place->second = trainModels(count, background);
  return place->second;
}

inline SceneOptions
options(Background background = Background::None)
{
  SceneOptions o;
  o.background = background;
  o.size = 0.9;
  o.density = 200000;
  o.seed = 3;
  return o;
}

inline SurfletSet
reduced(const SurfletSet& set)
{
  return reduceToTwoSidedCells(set, kLeaf).cells;
}

inline ExplanationParameters
quick()
{
  ExplanationParameters p;
  p.leaf = kLeaf;
  return p;
}

} // namespace test
} // namespace pcl_surflet
