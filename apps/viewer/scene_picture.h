/** \file
 * What a labelled scene looks like: grey, its objects coloured and named. */
#pragma once

#include "labelled_scene.h"

#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief How the scene is looked at. */
struct PictureOptions {
  int width = 1000, height = 640; ///< pixels
  double azimuth = -60;           ///< of the eye about the vertical (z), degrees from +x
  double elevation = 35;          ///< of the eye above the horizon, degrees
  double zoom = 1;                ///< larger: nearer
  double point = 2;               ///< size of a point, pixels
  pcl::PointCloud<pcl::PointXYZLNormal> overlay; ///< drawn dark over the scene
};

/** \brief Name of label i + 1; labels without one are called by their number. */
using Names = std::vector<std::string>;

/** \brief The scene as a PNG file. Needs a display: see VirtualDisplay. */
std::string drawnScene(const LabelledScene& scene, const Names& names,
                       const PictureOptions& options);

/** \brief Shows the scene in a window until the user closes it. */
void showScene(const LabelledScene& scene, const Names& names, const PictureOptions& options);

} // namespace apps
} // namespace pcl_surflet
