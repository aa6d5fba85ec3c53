#include "evaluation/training.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/recognition/scene_training.h"
#include "pcl_surflet/view_training.h"

#include <cmath>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr std::size_t kTrainingSurflets = 100000; // as in [Wahl 2007, Sec. 5.5.2]
constexpr std::size_t kBackgroundPatches = 8;
constexpr double kEvening = 0.5; ///< edge of cells that even out the density, in those of scenes

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

HistogramModel
trained(const SceneItem& item, const TrainingOptions& o, const HistogramModelTrainer& trainer)
{
  if (o.sensing && o.for_scenes)
    return trainForSensors(trainer, item, aroundAlone(*o.sensing, o.scene.posture), o.leaf,
                           kTrainingSeed, o.threads);
  if (o.sensing) { // what many sensors see is dense: even it out
    const SurfletSet seen =
        senseAlone(item, aroundAlone(*o.sensing, o.scene.posture), kTrainingSeed);
    return trainer.train(item.label, reduceToCells(seen, kEvening * o.leaf).cells);
  }
  if (!o.for_scenes)
    return trainer.train(item.label, item.sample(kTrainingSurflets, kTrainingSeed));
  const auto surflets = static_cast<std::size_t>(item.area * o.scene.density) + 1;
  return trainForScenes(trainer, item.label, item.sample(surflets, kTrainingSeed), o.leaf,
                        kTrainingSeed, o.threads);
}

/** \brief Models of pieces of the empty background, of the size of the largest object. */
void
addBackground(ModelDatabase& database, const TrainingOptions& o, HistogramModelTrainer trainer)
{
  const SurfletSet empty = reduceToCells(seenBackground(o.scene, o.sensing), o.leaf).cells;
  const double radius = database.largestDelta() / 2;
  CounterRandom random(kTrainingSeed);
  trainer.setRole(ModelRole::Background);
  const std::size_t patches = o.scene.background == Background::Plane ? 1 : kBackgroundPatches;
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
    database.add(trained(item, o, trainer));
  if (o.with_background)
    addBackground(database, o, trainer);
  return database;
}

} // namespace apps
} // namespace pcl_surflet
