/** \file
 * PoseEstimator: where detected objects are, in all six degrees of freedom. */
#pragma once

#include "pcl_surflet/compat.h"
#include "pcl_surflet/recognition/pose.h"
#include "pcl_surflet/scene_interpreter.h"

#include <pcl/pcl_base.h>

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief A pose model from a mesh or complete cloud in a file that loadSurface() reads, its name
 * without ending as the label. \throws SurfaceFileError, PoseModelError */
PCL_SURFLET_API PoseModel loadPoseModel(const std::string& path);

/** \brief One model for every PCD, PLY, OBJ, STL or OFF file of a directory, by name.
 * \throws SurfaceFileError if it cannot be read or has no such file; as loadPoseModel() */
PCL_SURFLET_API std::vector<PoseModel> loadPoseModels(const std::string& directory);

/** \brief The rotation and translation as PCL's users know them. */
PCL_SURFLET_API Eigen::Isometry3f toIsometry(const RigidMotion& motion);

namespace detail {

/** \brief The points of \p scene within \p radius of the middle of \p cluster, but those whose
 * \p taken is not 0 (as many as \p scene). */
PCL_SURFLET_API SurfletSet pointsBeside(const SurfletSet& scene, const std::vector<char>& taken,
                                        const SurfletSet& cluster, double radius);

} // namespace detail

/** \brief Estimates the poses of what SceneInterpreter found [Wahl 2007, Sec. 6.4].
 *
 * \code
 * pcl_surflet::PoseEstimator<pcl::PointNormal> estimator;
 * estimator.setInputCloud (cloud);                                    // that of the interpreter
 * estimator.setModels (pcl_surflet::loadPoseModels ("meshes/"));      // cup.off, bottle.ply ...
 * estimator.setViewpoints ({cloud->sensor_origin_.head<3> ()});       // if known
 * for (const auto& pose : estimator.estimate (detections))
 *   if (pose.status == pcl_surflet::PoseStatus::Found)
 *     std::cout << pcl_surflet::toIsometry (pose.motion).matrix () << "\n";
 * \endcode
 *
 * Points near a detection that are in no other one may confirm a pose, see estimatePose(). Points
 * that are not finite or have no usable normal are left out. One seed gives one result. */
template <typename PointT, typename PointNT = PointT>
class PoseEstimator : public pcl::PCLBase<PointT> {
public:
  using Normals = pcl::PointCloud<PointNT>; ///< of the input points

  /** \brief One normal per input point, pointing outwards; not needed if the points carry them. */
  void
  setInputNormals(const typename Normals::ConstPtr& normals)
  {
    normals_ = normals;
  }
  /** \brief Models, which detections name by their labels. */
  void
  setModels(std::vector<PoseModel> models)
  {
    models_ = std::move(models);
  }
  /** \brief Places of the sensors in the cloud's coordinates; empty: unknown. */
  void
  setViewpoints(const std::vector<Eigen::Vector3f>& viewpoints)
  {
    parameters_.viewpoints.clear();
    for (const auto& v : viewpoints)
      parameters_.viewpoints.push_back({v.x(), v.y(), v.z()});
  }
  /** \brief All other constants; replaces the viewpoints, too. */
  void
  setParameters(const PoseParameters& parameters)
  {
    parameters_ = parameters;
  }
  /** \brief The constants in use, viewpoints included. */
  const PoseParameters&
  getParameters() const
  {
    return parameters_;
  }

  /** \brief A pose for every detection, in their order; PoseStatus::NoModel where no model has its
   * label.
   * \param detections of the input cloud, as SceneInterpreter found them
   * \return nothing after misuse (no input, no normals, detections of another cloud), which
   * PCL_ERROR tells \throws std::invalid_argument if a parameter is out of range */
  std::vector<PoseEstimate> estimate(const std::vector<SceneDetection>& detections);

private:
  const PoseModel* modelOf(const std::string& label) const;
  /** \brief Which points are in a detection. \return false after an error */
  bool markPoints(const std::vector<SceneDetection>& detections, std::vector<char>& taken) const;

  typename Normals::ConstPtr normals_;
  std::vector<PoseModel> models_;
  PoseParameters parameters_;
};

} // namespace pcl_surflet

#ifdef PCL_NO_PRECOMPILE
#include "pcl_surflet/impl/pose_estimator.hpp"
#endif
