/** \file
 * Options of the programs that look at scenes with a virtual sensor. */
#pragma once

#include "app_common.h"

#include "pcl_surflet/sensed_scene.h"

namespace pcl_surflet {
namespace apps {

/** \brief Sensor, its places and its normals. \p target holds the defaults; -views says whether
 * there is a sensor at all. */
void addSensor(CommandLine& line, SceneSensing& target);

} // namespace apps
} // namespace pcl_surflet
