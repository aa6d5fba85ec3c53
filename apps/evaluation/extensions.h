/** \file
 * Measurements of the extensions [Wahl 2007, Ch. 6], a CSV each. */
#pragma once

#include "evaluation/recognisers.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Scenes and the methods that interpret them. */
struct ExtensionStudy {
  std::vector<std::string> names; ///< of the methods
  std::vector<std::shared_ptr<const Recogniser>> methods;
  std::vector<std::string> labels; ///< of what they know
  std::function<Scene(std::uint64_t k)> scene;
  std::uint64_t scenes = 1, seed = 1; ///< scene k is interpreted with seed + k
  double leaf = 0.0058;
  AccumulationParameters accumulation; ///< runs: of studyRuns()
};

/** \brief Paths of the seeds that start on an instance of their model, relative to its centroid, as
 * in Fig. 6.2. The methods must keep them. */
std::string studyPaths(const ExtensionStudy& study);

/** \brief Which share of their objects detections hold, in the middle (within the mean distance of
 * the object's cells from their centroid) and at the border (beyond) [Sec. 6.1.3]. */
std::string studyBorder(const ExtensionStudy& study);

/** \brief What accumulates over 1, 2, ... runs, and the time it takes [Sec. 6.2]. */
std::string studyRuns(const ExtensionStudy& study);

} // namespace apps
} // namespace pcl_surflet
