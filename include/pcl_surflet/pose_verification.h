/** \file
 * Poses as a second opinion on the names of detections. */
#pragma once

#include "pcl_surflet/recognition/pose.h"
#include "pcl_surflet/scene_interpreter.h"

#include <cstddef>
#include <vector>

namespace pcl_surflet {

/** \brief What a pose says about the name of a detection. */
enum class Verdict {
  Confirmed, ///< the detection lies on the model
  Refuted,   ///< no pose puts enough of it there
  Open       ///< no model, or a cluster that leaves the pose open
};

/** \brief Constants of keepVerified(), chosen on scenes with seeds 100 to 139. */
struct VerificationParameters {
  /** \brief What ExplanationParameters::min_fit should be before a verification, in [0, 1]: poses
   * refute what is wrong, so names may be guessed more boldly. */
  static constexpr double kProposalFit = 0.55;

  double min_inliers = 0.7; ///< least PoseEstimate::inlier_share that confirms, in [0, 1]
  double min_fit = ExplanationParameters().min_fit; ///< least fit where the verdict is open
};

/** \brief Confirmed from \p min_inliers on. */
PCL_SURFLET_API Verdict verdictOf(const PoseEstimate& pose, double min_inliers);

/** \brief Does a detection of this pose and fit (Detection::fit) stay? */
PCL_SURFLET_API bool isVerified(const PoseEstimate& pose, double fit,
                                const VerificationParameters& parameters = {});

/** \brief Removes detections whose poses refute them, and the poses with them.
 *
 * A histogram has forgotten where the surflets of its pairs are, so an unknown cow looks much like
 * a known camel; a pose has not. It refutes nearly all wrong names and hardly a right one, and as
 * names may then be guessed more boldly, more is found where objects hide each other: numbers in
 * doc/pose.md.
 *
 * \code
 * auto parameters = interpreter.getParameters ();
 * parameters.min_fit = pcl_surflet::VerificationParameters::kProposalFit;
 * interpreter.setParameters (parameters);
 * auto detections = interpreter.interpret ();
 * auto poses = estimator.estimate (detections);
 * pcl_surflet::keepVerified (detections, poses);
 * \endcode
 *
 * \param detections in any order
 * \param poses one a detection, from PoseEstimator::estimate()
 * \param parameters see there
 * \return how many were removed
 * \throws std::invalid_argument if there are not as many poses as detections, or a parameter is
 * outside [0, 1] */
PCL_SURFLET_API std::size_t keepVerified(std::vector<SceneDetection>& detections,
                                         std::vector<PoseEstimate>& poses,
                                         const VerificationParameters& parameters = {});

} // namespace pcl_surflet
