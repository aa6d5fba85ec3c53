/** \file
 * Peers that search a scene for one model and give its pose: PCL's PPFRegistration, SHOT with
 * geometric consistency, OpenCV's ppf_match_3d. */
#pragma once

#include "pcl_surflet/recognition/pose.h"

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Constants of the peers, lengths in cell edges or shares of the model's diameter. */
struct PosePeerParameters {
  double leaf = 0.0058;           ///< edge of the scene's cells, in its unit, > 0
  std::size_t model_points = 400; ///< PPFRegistration: its tables grow with the square
  unsigned reference_rate = 10;   ///< PPFRegistration: every so many scene points votes
  double keypoint_spacing = 2;    ///< SHOT: in cells
  double shot_radius = 7;         ///< SHOT: in cells
  double correspondence = 0.25;   ///< SHOT: largest squared distance of descriptors
  double consistency = 2;         ///< SHOT: in cells
  /** \brief OpenCV: distance step, share of the diameter. Training an ellipsoid takes 0.3 s with
   * 0.1, 9 s with 0.07 and more than 30 s with 0.05. */
  double sampling = 0.1;
  double scene_step = 0.1;   ///< OpenCV: share of the scene's points that vote
  std::size_t proposals = 5; ///< of each model, refined and compared
};

/** \brief Looks for one model. Results are motions from its coordinates to the scene's, the most
 * trusted first; the rotation need not be one: it is what the peer gave. One thread. */
class PoseFinder {
public:
  virtual ~PoseFinder() = default;
  virtual std::vector<RigidMotion> find(const SurfletSet& scene) const = 0;
};

std::unique_ptr<PoseFinder> ppfRegistrationFinder(const SurfletSet& model,
                                                  const PosePeerParameters& parameters);
std::unique_ptr<PoseFinder> shotFinder(const SurfletSet& model,
                                       const PosePeerParameters& parameters);

/** \brief Names that poseFinder() understands: ppf_registration, shot and, where OpenCV's
 * surface_matching is there, opencv and opencv_repaired. */
const std::vector<std::string>& poseFinderNames();

/** \brief A peer by name for a \p model reduced to cells. All but opencv, which has its own, refine
 * by pcl::IterativeClosestPointWithNormals. \throws std::invalid_argument for an unknown name */
std::unique_ptr<PoseFinder> poseFinder(const std::string& name, const SurfletSet& model,
                                       const PosePeerParameters& parameters);

/** \brief What a placed model explains. */
struct Support {
  double share = 0;                 ///< of the model's cells with one of the scene within a leaf
  std::vector<std::uint32_t> cells; ///< of the scene with one of the model within a leaf, ascending
};

Support supportOf(const SurfletSet& model, const RigidMotion& motion, const SurfletSet& scene,
                  double leaf);

/** \brief Refines \p motion by point-to-plane ICP; itself if this does not converge. */
RigidMotion refined(const SurfletSet& model, const RigidMotion& motion, const SurfletSet& scene,
                    double reach);

Eigen::Matrix4f matrixOf(const RigidMotion& motion);
RigidMotion motionOf(const Eigen::Matrix4f& matrix);

} // namespace apps
} // namespace pcl_surflet
