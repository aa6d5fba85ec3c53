/** \file
 * Compares poses with the truth. */
#pragma once

#include "pcl_surflet/core/linear_octree.h"
#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/recognition/pose.h"

#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Rotation and translation of PlacedItem::pose. */
RigidMotion motionOf(const PlacedItem& item);

/** \brief Measures how far a pose is from the truth, by points of the model's surface. */
class PoseError {
public:
  explicit PoseError(const SurfletSet& surface);

  /** \brief Mean distance between the places that both motions give a point (ADD). */
  double distance(const RigidMotion& found, const RigidMotion& truth) const;
  /** \brief Mean distance of the points from the nearest one of the other pose (ADD-S). */
  double nearest(const RigidMotion& found, const RigidMotion& truth) const;

private:
  SurfletSet dense_, points_;
  LinearOctree octree_;
};

/** \brief Results of one object or of all. */
struct PoseCounts {
  std::size_t present = 0, segmented = 0, posed = 0, right = 0;
  std::vector<double> errors;  ///< ADD or ADD-S over the diameter, of those that are right
  std::vector<double> seconds; ///< of each estimation

  PoseCounts& operator+=(const PoseCounts& other);
};

} // namespace apps
} // namespace pcl_surflet
