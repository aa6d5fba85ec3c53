/** \file
 * The parts of the scene generator; internal, not installed. */
#pragma once

#include "pcl_surflet/core/scene_generator.h"

#include "vector3.h"

namespace pcl_surflet {
namespace detail {

/** \brief Rotation and translation; rows of the rotation. */
struct Pose {
  std::array<Vector3, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vector3 shift{0, 0, 0};

  Vector3 turned(const Vector3& v) const;
  /** \brief This pose after \p first. */
  Pose after(const Pose& first) const;
  std::array<double, 16> matrix() const;
};

Pose turnAboutZ(double angle);
Pose tiltAboutX(double angle);
SurfletSet moved(const SurfletSet& set, const Pose& pose);

/** \brief A thing to be placed, and where it stands in the end. */
struct PlacementItem {
  SurfletSet surflets;  ///< in the posture it will have, moved as it is placed
  Pose pose;            ///< from the item as it was to surflets
  double radius = 0;    ///< largest distance to the centroid
  double r_mean = 0;    ///< mean distance to the centroid
  double radius_xy = 0; ///< the same, horizontally
  Vector3 centroid{0, 0, 0};
};

PlacementItem placementItem(const SurfletSet& upright, const Pose& posture);
void translate(PlacementItem& item, const Vector3& by);

/** \brief Height of what carries the items at (\p x, \p y). */
double floorHeight(const SceneOptions& options, double x, double y);
double backgroundArea(const SceneOptions& options);
TriangleMesh backgroundMesh(const SceneOptions& options);
SurfletSet sampleBackground(const SceneOptions& options, std::size_t n, std::uint64_t seed);

/** \brief Puts all items in their places. \throws std::invalid_argument if they do not fit */
void placeItems(std::vector<PlacementItem>& items, const SceneOptions& options);

} // namespace detail
} // namespace pcl_surflet
