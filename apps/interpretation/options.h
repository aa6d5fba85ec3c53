/** \file
 * The command line of pcl_surflet_interpret. */
#pragma once

#include "poses.h"

#include "pcl_surflet/scene_interpreter.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

struct InterpretOptions {
  std::string database, empty, out, objects_dir, picture;
  Method method = Method::Explanation;
  BackgroundTreatment background = BackgroundTreatment::Ignore;
  double leaf = 0, distance = 0;
  double min_confidence = 0.1; ///< of what is below, few are right: detail::confidenceOf()
  std::uint64_t planes = 0, threads = 0, detections = 0, seed = 1;
  MissingNormals normals;
  bool csv = false, verbose = false;
  PoseJob pose;
  std::vector<std::string> files;
};

/** \brief Reads and checks the command line.
 * \return false if help was asked for \throws UsageError */
bool readInterpretOptions(const std::string& program, int argc, char** argv, InterpretOptions& o);

} // namespace apps
} // namespace pcl_surflet
