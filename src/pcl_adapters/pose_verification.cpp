#include "pcl_surflet/pose_verification.h"

#include <stdexcept>
#include <utility>

namespace pcl_surflet {

Verdict
verdictOf(const PoseEstimate& pose, double min_inliers)
{
  switch (pose.status) {
  case PoseStatus::Found:
    return pose.inlier_share >= min_inliers ? Verdict::Confirmed : Verdict::Refuted;
  case PoseStatus::NoAgreement:
    return Verdict::Refuted;
  default:
    return Verdict::Open;
  }
}

bool
isVerified(const PoseEstimate& pose, double fit, const VerificationParameters& p)
{
  const Verdict verdict = verdictOf(pose, p.min_inliers);
  return verdict == Verdict::Confirmed || (verdict == Verdict::Open && fit >= p.min_fit);
}

std::size_t
keepVerified(std::vector<SceneDetection>& detections, std::vector<PoseEstimate>& poses,
             const VerificationParameters& p)
{
  if (detections.size() != poses.size())
    throw std::invalid_argument("keepVerified: " + std::to_string(poses.size()) + " poses for " +
                                std::to_string(detections.size()) +
                                " detections; give those that PoseEstimator::estimate() made of "
                                "them");
  for (const double share : {p.min_inliers, p.min_fit})
    if (!(share >= 0 && share <= 1))
      throw std::invalid_argument("keepVerified: min_inliers and min_fit must be in [0, 1]");
  std::size_t kept = 0;
  for (std::size_t k = 0; k < detections.size(); ++k) {
    if (!isVerified(poses[k], detections[k].fit, p))
      continue;
    if (kept != k) {
      detections[kept] = std::move(detections[k]);
      poses[kept] = std::move(poses[k]);
    }
    ++kept;
  }
  const std::size_t removed = detections.size() - kept;
  detections.resize(kept);
  poses.resize(kept);
  return removed;
}

} // namespace pcl_surflet
