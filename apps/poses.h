/** \file
 * Poses of detections: options, text and pictures of pcl_surflet_interpret. */
#pragma once

#include "app_common.h"

#include "pcl_surflet/pose_estimator.h"
#include "pcl_surflet/pose_verification.h"

#include <array>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Estimates poses where the command line asks for them. */
struct PoseJob {
  std::string directory; ///< of the models; empty: no poses
  std::vector<std::array<double, 3>> viewpoints;
  std::vector<PoseModel> models;
  bool verify = false; ///< whether poses refute detections

  void addOptions(CommandLine& line);
  /** \brief Trains the models. \throws DataError */
  void load();
  /** \brief The least fit to interpret with. */
  double
  minFit() const
  {
    return verify ? VerificationParameters::kProposalFit : ExplanationParameters().min_fit;
  }
  /** \brief One pose per detection, or nothing where none are wanted. */
  std::vector<PoseEstimate> estimate(const pcl::PointCloud<pcl::PointNormal>::ConstPtr& cloud,
                                     const std::vector<SceneDetection>& detections,
                                     std::uint64_t seed) const;
  /** \brief Surface of the models in their poses, for pictures. */
  SurfletSet surfaces(const std::vector<SceneDetection>& detections,
                      const std::vector<PoseEstimate>& poses) const;
};

/** \brief Columns that poseCsv() fills, with a comma in front. */
std::string poseCsvHeader();
/** \brief Empty columns where there is no pose. */
std::string poseCsv(const PoseEstimate& pose);
/** \brief Translation, quaternion and how sure; or why there is none. One line. */
std::string poseText(const PoseEstimate& pose);

} // namespace apps
} // namespace pcl_surflet
