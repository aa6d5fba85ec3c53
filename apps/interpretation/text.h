/** \file
 * What pcl_surflet_interpret says about a scene. */
#pragma once

#include "pcl_surflet/pose_estimator.h"
#include "pcl_surflet/scene_interpreter.h"

#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief First line of the table that -csv prints. */
std::string csvHeader(bool with_poses);

/** \brief The objects of the file \p path, as lines of text or of a table. \p poses may be fewer
 * than the detections. */
std::string foundText(const std::string& path, const std::vector<SceneDetection>& detections,
                      const std::vector<PoseEstimate>& poses, const SceneDiagnostics& diagnostics,
                      bool csv);

/** \brief What each step did for each model. */
std::string stepsText(Method method, const SceneDiagnostics& diagnostics);

} // namespace apps
} // namespace pcl_surflet
