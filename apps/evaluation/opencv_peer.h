/** \file
 * OpenCV's surface_matching, where it is installed. */
#pragma once

#include "evaluation/pose_peers.h"

namespace pcl_surflet {
namespace apps {

/** \param repaired OpenCV 4.6 averages quaternions without normalising, so its rotations shrink:
 * scaled back to rotations. Otherwise poses remain as they are, and its own ICP refines them. */
std::unique_ptr<PoseFinder> opencvFinder(const SurfletSet& model,
                                         const PosePeerParameters& parameters, bool repaired);

} // namespace apps
} // namespace pcl_surflet
