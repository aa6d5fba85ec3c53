/** \file
 * Databases of the things that scenes are made of. */
#pragma once

#include "evaluation/scenes.h"

#include "pcl_surflet/recognition/model_database.h"

#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief How models are made. */
struct TrainingOptions {
  SceneOptions scene; ///< density, and what the empty background looks like
  Sensing sensing;    ///< how objects alone and the background are seen
  int bins = 5;       ///< in each of the four dimensions
  double leaf = 0.0058;
  bool for_scenes = false;      ///< by trainForScenes(); else on 100,000 surflets of the surface
  bool with_background = false; ///< adds models of pieces of the empty background
  unsigned threads = 0;
};

ModelDatabase trainedDatabase(const std::vector<SceneItem>& objects,
                              const TrainingOptions& options);

} // namespace apps
} // namespace pcl_surflet
