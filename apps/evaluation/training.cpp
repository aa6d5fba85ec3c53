#include "evaluation/training.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"

#include <cmath>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr std::size_t kTrainingSurflets = 100000; // as in [Wahl 2007, Sec. 5.5.2]
constexpr std::uint64_t kOrientations = 4;
constexpr std::size_t kBackgroundPatches = 8;

/** \brief A model of what the item looks like after reduction to cells: thin walls cancel and cells
 * on edges average there as in a scene. One member for each of a few orientations. */
HistogramModel
trainedOnCells(const HistogramModelTrainer& trainer, const SceneItem& item,
               const TrainingOptions& o)
{
  const auto surflets =
      item.sample(static_cast<std::size_t>(item.area * o.scene.density) + 1, kTrainingSeed);
  HistogramModel model;
  for (std::uint64_t k = 0; k < kOrientations; ++k) {
    const auto cells = reduceToCells(randomlyRotated(surflets, kTrainingSeed + k), o.leaf).cells;
    HistogramModel turned = trainer.train(item.label, cells);
    turned.members.front().condition = "cells, orientation " + std::to_string(k);
    if (k == 0)
      model = std::move(turned);
    else
      model.members.push_back(turned.members.front());
  }
  return model;
}

/** \brief Surflets of \p set within \p radius of one of them, drawn at random. */
SurfletSet
patchOf(const SurfletSet& set, double radius, CounterRandom& random)
{
  const Surflet c = set[random.below(static_cast<std::uint32_t>(set.size()))];
  SurfletSet patch;
  for (std::size_t i = 0; i < set.size(); ++i)
    if (std::hypot(set.x[i] - c.x, set.y[i] - c.y, set.z[i] - c.z) <= radius)
      patch.push_back(set[i]);
  return patch;
}

/** \brief Models of pieces of the empty background, of the size of the largest object. */
void
addBackground(ModelDatabase& database, const TrainingOptions& o, HistogramModelTrainer trainer)
{
  SceneOptions scene = o.scene;
  scene.seed = kTrainingSeed;
  const SurfletSet empty = reduceToCells(emptyBackground(scene), o.leaf).cells;
  const double radius = database.largestDelta() / 2;
  CounterRandom random(kTrainingSeed);
  trainer.setRole(ModelRole::Background);
  const std::size_t patches = scene.background == Background::Plane ? 1 : kBackgroundPatches;
  for (std::size_t k = 0; k < patches; ++k)
    database.add(trainer.train("background " + std::to_string(k), patchOf(empty, radius, random)));
}

} // namespace

ModelDatabase
trainedDatabase(const std::vector<SceneItem>& objects, const TrainingOptions& o)
{
  HistogramModelTrainer trainer;
  trainer.setResolution({o.bins, o.bins, o.bins, o.bins});
  trainer.setNumberOfThreads(o.threads);
  ModelDatabase database;
  for (const auto& item : objects)
    database.add(o.on_cells
                     ? trainedOnCells(trainer, item, o)
                     : trainer.train(item.label, item.sample(kTrainingSurflets, kTrainingSeed)));
  if (o.with_background)
    addBackground(database, o, trainer);
  return database;
}

} // namespace apps
} // namespace pcl_surflet
