#include "evaluation/opencv_peer.h"

#include "pcl_surflet/core/geometry.h"

#include <Eigen/SVD>
#include <opencv2/core.hpp>
#include <opencv2/surface_matching.hpp>
#include <opencv2/surface_matching/icp.hpp>

#include <algorithm>

namespace pcl_surflet {
namespace apps {
namespace {

cv::Mat
matOf(const SurfletSet& set)
{
  cv::Mat rows(static_cast<int>(set.size()), 6, CV_32F);
  for (std::size_t i = 0; i < set.size(); ++i) {
    auto* to = rows.ptr<float>(static_cast<int>(i));
    const Surflet s = set[i];
    for (const float v : {s.x, s.y, s.z, s.nx, s.ny, s.nz})
      *to++ = v;
  }
  return rows;
}

RigidMotion
motionOf(const cv::Matx44d& pose)
{
  RigidMotion m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      m.rotation[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = pose(i, j);
    m.translation[static_cast<std::size_t>(i)] = pose(i, 3);
  }
  return m;
}

/** \brief The rotation nearest to the matrix, which a normalised quaternion would have given. */
RigidMotion
repairedRotation(RigidMotion m)
{
  Eigen::Matrix3d r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r(i, j) = m.rotation[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
  r = svd.matrixU() * svd.matrixV().transpose();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      m.rotation[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = r(i, j);
  return m;
}

class OpenCvFinder : public PoseFinder {
public:
  OpenCvFinder(const SurfletSet& model, const PosePeerParameters& p, bool repaired)
      : parameters_(p), repaired_(repaired), model_(matOf(model)),
        step_(p.sampling * farthestDistance(model)), detector_(p.sampling, p.sampling)
  {
    cv::setNumThreads(1);
    detector_.trainModel(model_);
  }

  std::vector<RigidMotion>
  find(const SurfletSet& scene) const override
  {
    cv::setNumThreads(1);
    const cv::Mat rows = matOf(scene);
    std::vector<cv::ppf_match_3d::Pose3DPtr> poses;
    // The scene is sampled as densely as the model: its step is a share of the scene's size.
    detector_.match(rows, poses, parameters_.scene_step,
                    std::min(parameters_.sampling, step_ / farthestDistance(scene)));
    poses.resize(std::min(poses.size(), parameters_.proposals));
    if (!repaired_ && !poses.empty()) {
      cv::ppf_match_3d::ICP icp(100, 0.005f, 2.5f, 8);
      icp.registerModelToScene(model_, rows, poses);
    }
    std::vector<RigidMotion> motions;
    motions.reserve(poses.size());
    for (const auto& pose : poses)
      motions.push_back(repaired_ ? repairedRotation(motionOf(pose->pose)) : motionOf(pose->pose));
    return motions;
  }

private:
  PosePeerParameters parameters_;
  bool repaired_;
  cv::Mat model_;
  double step_;
  mutable cv::ppf_match_3d::PPF3DDetector detector_; // match() is not const
};

} // namespace

std::unique_ptr<PoseFinder>
opencvFinder(const SurfletSet& model, const PosePeerParameters& parameters, bool repaired)
{
  return std::make_unique<OpenCvFinder>(model, parameters, repaired);
}

} // namespace apps
} // namespace pcl_surflet
