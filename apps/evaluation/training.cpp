#include "evaluation/training.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/recognition/scene_training.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr std::size_t kTrainingSurflets = 100000; // as in [Wahl 2007, Sec. 5.5.2]
constexpr std::size_t kBackgroundPatches = 8;
/** \brief What lies this flat and this low, in cells, is a foot, if it is this share of a view. */
constexpr float kFlat = 0.7f;
constexpr double kFootHeight = 2, kLeastFoot = 0.05;
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

/** \brief Without the flat foot of what stands upright: it is taken for what carries it. */
SurfletSet
withoutFoot(const SurfletSet& seen, double leaf)
{
  const float bottom = *std::min_element(seen.z.begin(), seen.z.end());
  SurfletSet out;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen.nz[i] < kFlat || seen.z[i] > bottom + kFootHeight * leaf)
      out.push_back(seen[i]);
  return out;
}

/** \brief Adds a member for \p seen, and for the same without foot if there is one. */
void
addViewAndFootless(HistogramModel& model, const std::string& name, const SurfletSet& seen,
                   const TrainingOptions& o)
{
  addView(model, name, seen, o.leaf, kTrainingSeed, o.threads);
  const SurfletSet above = withoutFoot(seen, o.leaf);
  if (static_cast<double>(above.size()) < (1 - kLeastFoot) * static_cast<double>(seen.size()))
    addView(model, name + ", no foot", above, o.leaf, kTrainingSeed, o.threads);
}

/** \brief Adds members for what single sensors and pairs of opposite ones see: every second place
 * of the ring, where there are two sensors at each. */
void
addViews(HistogramModel& model, const std::vector<OrientedScan>& scans, const TrainingOptions& o)
{
  for (std::size_t place = 0; place < scans.size() / 2; place += 2)
    for (std::size_t sensor : {0, 1}) {
      const OrientedScan& scan = scans[2 * place + sensor];
      const std::string name = "seen from " + std::to_string(2 * place + sensor);
      addViewAndFootless(model, name, sensedSurflets({scan}), o);
      if (place < scans.size() / 4)
        addViewAndFootless(
            model, name + " and opposite",
            sensedSurflets({scan, scans[2 * place + sensor + scans.size() / 2]}), o);
    }
}

HistogramModel
trained(const SceneItem& item, const TrainingOptions& o, const HistogramModelTrainer& trainer)
{
  const auto train = [&](const SurfletSet& surflets) {
    return o.for_scenes ? trainForScenes(trainer, item.label, surflets, o.leaf, kTrainingSeed,
                                         o.threads)
                        : trainer.train(item.label, surflets);
  };
  if (!o.sensing)
    return train(item.sample(o.for_scenes
                                 ? static_cast<std::size_t>(item.area * o.scene.density) + 1
                                 : kTrainingSurflets,
                             kTrainingSeed));
  const auto scans = scansAlone(item, *o.sensing, o.scene.posture);
  const SurfletSet seen = sensedSurflets(scans);
  // What many sensors see is dense: even out what is not reduced to cells later on.
  if (!o.for_scenes)
    return train(reduceToCells(seen, kEvening * o.leaf).cells);
  HistogramModel model = train(seen);
  addViews(model, scans, o);
  return model;
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
