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

/** \brief The same for a sensor whose way the program knows. */
void addPassingSensor(CommandLine& line, SceneSensing& target);

/** \brief For programs that take complete surfaces without a sensor. \throws UsageError if an
 * option of the sensor is given without -views */
void requireViews(const CommandLine& line);

/** \brief For programs with -noise, which moves the points of complete surfaces: sensors have
 * -sensor_noise. \throws UsageError if -noise and -views are given together */
void refuseNoiseOfViews(const CommandLine& line);

} // namespace apps
} // namespace pcl_surflet
