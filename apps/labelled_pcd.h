/** \file
 * Labelled oriented points as PCD files: what scenes are kept in. */
#pragma once

#include "pcl_surflet/sensed_scene.h"
#include "pcl_surflet/surface_file.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief What belongs to every point of a scene. */
struct PointLabels {
  std::vector<std::uint32_t> labels;    ///< 0 none, else the object's number from 1
  std::vector<std::uint32_t> instances; ///< 0 none, else which thing of the scene, from 1
};

/** \brief Binary PCD with x y z normal_x normal_y normal_z and, unless null, label and instance.
 * \p labels are as many as \p set. */
std::string asPcd(const SurfletSet& set, const PointLabels* labels);

/** \brief Binary PCD of all points of a file that has been read with keep_points: their fields,
 * rows, columns and VIEWPOINT, and normal_x normal_y normal_z (NaN where there is none), label and
 * instance in place of any fields of these names.
 * \param[in] labels as many as the file's surflets; other points have label and instance 0 */
std::string asPcd(const SurfaceFile& file, const PointLabels& labels);

/** \brief Organised binary PCD with the fields above, in the sensor's frame; VIEWPOINT is the
 * sensor's pose in the scene. NaN where nothing returned. */
std::string asPcd(const OrientedScan& scan);

} // namespace apps
} // namespace pcl_surflet
