/** \file
 * Long tables that a sensor passes, and what is found there scan by scan. */
#pragma once

#include "evaluation/scoring.h"

#include "pcl_surflet/online_scene_interpreter.h"
#include "pcl_surflet/recognition/model_database.h"
#include "pcl_surflet/sensed_scene.h"

#include <vector>

namespace pcl_surflet {
namespace apps {

struct LongTable {
  SceneSensing sensing; ///< its views, but for their distance and elevation, are those of a pass
  double leaf = 0.006;  ///< edge of the cells of models and scenes
  double width = 0.8, items_per_length = 5;
  double stride = 0.15; ///< of the sensor between scans
};

/** \brief A table as the sensor passes it. */
struct SensedTable {
  std::uint64_t seed = 0;
  std::vector<SensedBody> bodies;
  SceneSensing sensing;
  Scene scene; ///< the points of all scans
  std::vector<OrientedScan> scans;
  SurfletSet empty; ///< cells of the table without anything on it, sensed another time
};

std::size_t itemsOn(const LongTable& table, double length);

/** \brief Models of what the sensor sees of the items alone. */
ModelDatabase tableDatabase(const std::vector<SceneItem>& items, const LongTable& table, int bins);

/** \brief Items stand in turn on the table, as many as itemsOn(). */
SensedTable sensedTable(const std::vector<SceneItem>& items, const LongTable& table, double length,
                        std::uint64_t seed);

/** \brief A scan as a sensor's cloud, with its pose. */
pcl::PointCloud<pcl::PointNormal> cloudOf(const OrientedScan& scan);

void append(SurfletSet& to, const SurfletSet& from);

/** \brief Every cell comes from what the nearest point of the scene comes from. Cells that are not
 * finite come from the background. */
CellScene withNearestTruth(const SurfletSet& cells, const Scene& scene);

/** \brief Without those that vanished. */
std::vector<Detection> thereOf(const OnlineInterpretation& online);

/** \brief What became of detections when things were taken away. */
struct Taking {
  std::size_t taken = 0, ended = 0, others = 0, stayed = 0;
};

/** \brief Takes up to \p most things away that were found and lets the sensor pass again. */
void takeAway(const SensedTable& table, std::size_t most, const CellScene& cells,
              OnlineSceneInterpreter& online, Taking& taking);

} // namespace apps
} // namespace pcl_surflet
