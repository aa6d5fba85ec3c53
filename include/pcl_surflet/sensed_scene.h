/** \file
 * Scenes as a virtual sensor measures them, with normals from its depth pictures. */
#pragma once

#include "pcl_surflet/core/scene_generator.h"

#include <cstdint>
#include <vector>

namespace pcl_surflet {

/** \brief How a set of views is taken. */
struct SceneSensing {
  DepthSensor sensor;           ///< of every view
  ViewOptions views;            ///< from where
  double normal_radius = 0.007; ///< neighbourhood of a normal in the unit of the scene, > 0
  unsigned threads = 0;         ///< 0: all; does not change the result
};

/** \brief A scan with normals that point to its sensor, in the sensor's frame. */
struct OrientedScan {
  DepthScan scan; ///< positions
  ///@{
  /** \brief Normal of each pixel; NaN where there is no point or no normal. */
  std::vector<float> nx, ny, nz;
  ///@}
};

/** \brief Normals of a scan by pcl::NormalEstimation over the points within \p radius, turned to
 * the sensor. Pixels with fewer than three neighbours get none, nor do those of surfaces seen at
 * more than 85 degrees off their normal, of which it is uncertain which side is seen.
 * \throws std::invalid_argument if the radius is not positive and finite */
PCL_SURFLET_API OrientedScan withNormals(DepthScan scan, double radius);

/** \brief Scans of \p bodies from all places of a set of views.
 * \throws std::invalid_argument as sense(), sensorPoses() and withNormals() */
PCL_SURFLET_API std::vector<OrientedScan>
senseViews(const std::vector<SensedBody>& bodies, const SceneSensing& sensing, std::uint64_t seed);

/** \brief The scene as these scans of it show it: all points that have a normal, in the frame of
 * the scene, background first, then the items in their order. PlacedItem::surflets become those
 * that are seen; pose and centroid remain those of the complete items.
 * \throws std::invalid_argument if a scan has an instance that \p scene lacks */
PCL_SURFLET_API Scene sensedScene(const Scene& scene, const std::vector<OrientedScan>& scans);

/** \brief The same where there is nothing but one object, or background: points of all scans. */
PCL_SURFLET_API SurfletSet sensedSurflets(const std::vector<OrientedScan>& scans);

/** \brief The scans of senseAlone(). */
PCL_SURFLET_API std::vector<OrientedScan>
scansAlone(const SceneItem& item, const SceneSensing& sensing, std::uint64_t seed);

/** \brief An object alone, as it stands, on something that the sensor does not see: what models are
 * trained from [Wahl 2007, Sec. 5.5.3]. The sensors look at the middle of its bounding box; those
 * of a ring do not see its bottom. \throws std::invalid_argument as senseViews() */
PCL_SURFLET_API SurfletSet senseAlone(const SceneItem& item, const SceneSensing& sensing,
                                      std::uint64_t seed);

} // namespace pcl_surflet
