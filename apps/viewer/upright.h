/** \file
 * Pictures have z upwards; clouds need not. */
#pragma once

#include "labelled_scene.h"

#include <string>

namespace pcl_surflet {
namespace apps {

/** \brief Is this a capture in the frame of its camera: x to the right, y down, z forward? That is
 * so if rows and columns are where such a camera sees points of these coordinates. False for clouds
 * without rows. */
bool isCapture(const LabelledScene& scene);

/** \brief Turns points and normals so that the axis \p up ("z", "-y", ...) points along z.
 * \throws UsageError if there is no such axis */
void turnUpright(const std::string& up, pcl::PointCloud<pcl::PointXYZLNormal>& points);

} // namespace apps
} // namespace pcl_surflet
