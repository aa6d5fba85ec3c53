/** \file
 * Prints and writes what was found in a scene. */
#pragma once

#include "interpretation/options.h"
#include "interpretation/scene_worker.h"

namespace pcl_surflet {
namespace apps {

/** \brief Prints \p scene and writes the files that the options want of it.
 * \throws DataError with the scene's error, or if a file cannot be written */
void deliver(const InterpretedScene& scene, const InterpretOptions& o);

} // namespace apps
} // namespace pcl_surflet
