#include "evaluation/pose_peers.h"

#include "surfaces.h"

#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/linear_octree.h"

#include <pcl/common/transforms.h>
#include <pcl/features/ppf.h>
#include <pcl/features/shot.h>
#include <pcl/filters/uniform_sampling.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/recognition/cg/geometric_consistency.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/ppf_registration.h>

#ifdef PCL_SURFLET_OPENCV
#include "evaluation/opencv_peer.h"
#endif

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pcl_surflet {
namespace apps {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Signatures = pcl::PointCloud<pcl::SHOT352>;

constexpr int kIcpIterations = 40;
constexpr double kIcpReach = 3;    // in cells
constexpr int kFewestAgreeing = 4; // correspondences of a geometrically consistent group

/** \brief Every k-th point, so that about \p most remain. */
SurfletSet
thinned(const SurfletSet& set, std::size_t most)
{
  SurfletSet out;
  const std::size_t step = std::max<std::size_t>(1, (set.size() + most - 1) / most);
  for (std::size_t i = 0; i < set.size(); i += step)
    out.push_back(set[i]);
  return out;
}

class PpfRegistrationFinder : public PoseFinder {
public:
  PpfRegistrationFinder(const SurfletSet& model, const PosePeerParameters& p)
      : parameters_(p), model_(cloudOf(thinned(model, p.model_points))),
        step_(0.05 * farthestDistance(model)),
        table_(new pcl::PPFHashMapSearch(12.0f / 180 * static_cast<float>(M_PI),
                                         static_cast<float>(step_)))
  {
    pcl::PointCloud<pcl::PPFSignature>::Ptr features(new pcl::PointCloud<pcl::PPFSignature>);
    pcl::PPFEstimation<pcl::PointNormal, pcl::PointNormal, pcl::PPFSignature> estimation;
    estimation.setInputCloud(model_);
    estimation.setInputNormals(model_);
    estimation.compute(*features);
    table_->setInputFeatureCloud(features);
  }

  std::vector<RigidMotion>
  find(const SurfletSet& scene) const override
  {
    pcl::PPFRegistration<pcl::PointNormal, pcl::PointNormal> registration;
    registration.setSceneReferencePointSamplingRate(parameters_.reference_rate);
    registration.setPositionClusteringThreshold(static_cast<float>(2 * step_));
    registration.setRotationClusteringThreshold(30.0f / 180 * static_cast<float>(M_PI));
    registration.setSearchMethod(table_);
    registration.setInputSource(model_);
    registration.setInputTarget(cloudOf(scene));
    Cloud aligned;
    registration.align(aligned);
    return {motionOf(registration.getFinalTransformation())};
  }

private:
  PosePeerParameters parameters_;
  Cloud::Ptr model_;
  double step_;
  pcl::PPFHashMapSearch::Ptr table_;
};

/** \brief A cloud, its keypoints and what describes them. */
struct Described {
  Cloud::Ptr keypoints{new Cloud};
  Signatures::Ptr signatures{new Signatures};
  pcl::PointCloud<pcl::ReferenceFrame>::Ptr frames;
};

Described
described(const Cloud::Ptr& cloud, const PosePeerParameters& p)
{
  Described d;
  pcl::UniformSampling<pcl::PointNormal> sampling;
  sampling.setInputCloud(cloud);
  sampling.setRadiusSearch(p.keypoint_spacing * p.leaf);
  sampling.filter(*d.keypoints);
  pcl::SHOTEstimation<pcl::PointNormal, pcl::PointNormal, pcl::SHOT352> shot;
  shot.setInputCloud(d.keypoints);
  shot.setSearchSurface(cloud);
  shot.setInputNormals(cloud);
  shot.setRadiusSearch(p.shot_radius * p.leaf);
  shot.compute(*d.signatures);
  return d;
}

class ShotFinder : public PoseFinder {
public:
  ShotFinder(const SurfletSet& model, const PosePeerParameters& p)
      : parameters_(p), model_(described(cloudOf(model), p))
  {
    tree_.setInputCloud(model_.signatures);
  }

  std::vector<RigidMotion>
  find(const SurfletSet& scene) const override
  {
    const Described seen = described(cloudOf(scene), parameters_);
    const auto pairs = correspondences(*seen.signatures);
    std::vector<RigidMotion> motions;
    if (pairs->empty())
      return motions;
    pcl::GeometricConsistencyGrouping<pcl::PointNormal, pcl::PointNormal> grouping;
    grouping.setGCSize(parameters_.consistency * parameters_.leaf);
    grouping.setGCThreshold(kFewestAgreeing);
    grouping.setInputCloud(model_.keypoints);
    grouping.setSceneCloud(seen.keypoints);
    grouping.setModelSceneCorrespondences(pairs);
    std::vector<Eigen::Matrix4f, Eigen::aligned_allocator<Eigen::Matrix4f>> transforms;
    std::vector<pcl::Correspondences> groups;
    grouping.recognize(transforms, groups);
    return largestFirst(transforms, groups);
  }

private:
  pcl::CorrespondencesPtr
  correspondences(const Signatures& seen) const
  {
    pcl::CorrespondencesPtr pairs(new pcl::Correspondences);
    pcl::Indices index(1);
    std::vector<float> squared(1);
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (std::isfinite(seen[i].descriptor[0]) &&
          tree_.nearestKSearch(seen[i], 1, index, squared) == 1 &&
          squared[0] < parameters_.correspondence)
        pairs->push_back(pcl::Correspondence(index[0], static_cast<int>(i), squared[0]));
    return pairs;
  }

  template <class Transforms>
  std::vector<RigidMotion>
  largestFirst(const Transforms& transforms, const std::vector<pcl::Correspondences>& groups) const
  {
    std::vector<std::size_t> order(std::min(transforms.size(), groups.size()));
    for (std::size_t k = 0; k < order.size(); ++k)
      order[k] = k;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return groups[a].size() > groups[b].size();
    });
    order.resize(std::min(order.size(), parameters_.proposals));
    std::vector<RigidMotion> motions;
    motions.reserve(order.size());
    for (const auto k : order)
      motions.push_back(motionOf(transforms[k]));
    return motions;
  }

  PosePeerParameters parameters_;
  Described model_;
  pcl::KdTreeFLANN<pcl::SHOT352> tree_;
};

/** \brief A finder whose poses ICP refines. */
class RefinedFinder : public PoseFinder {
public:
  RefinedFinder(std::unique_ptr<PoseFinder> finder, SurfletSet model, double leaf)
      : finder_(std::move(finder)), model_(std::move(model)), leaf_(leaf)
  {
  }

  std::vector<RigidMotion>
  find(const SurfletSet& scene) const override
  {
    auto motions = finder_->find(scene);
    for (auto& m : motions)
      m = refined(model_, m, scene, kIcpReach * leaf_);
    return motions;
  }

private:
  std::unique_ptr<PoseFinder> finder_;
  SurfletSet model_;
  double leaf_;
};

/** \brief Indices of the surflets of \p from that have one of \p to within \p radius. */
std::vector<std::uint32_t>
near(const SurfletSet& from, const SurfletSet& to, double radius)
{
  std::vector<std::uint32_t> out;
  if (to.size() == 0)
    return out;
  LinearOctree octree;
  octree.build({to.x.data(), to.y.data(), to.z.data(), 1, to.size()});
  std::vector<PointIndex> index;
  std::vector<float> squared;
  for (std::size_t i = 0; i < from.size(); ++i) {
    octree.nearestSearch({from.x[i], from.y[i], from.z[i]}, 1, index, squared);
    if (!squared.empty() && squared[0] <= radius * radius)
      out.push_back(static_cast<std::uint32_t>(i));
  }
  return out;
}

} // namespace

Eigen::Matrix4f
matrixOf(const RigidMotion& motion)
{
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    for (int j = 0; j < 3; ++j)
      m(i, j) = static_cast<float>(motion.rotation[row][static_cast<std::size_t>(j)]);
    m(i, 3) = static_cast<float>(motion.translation[row]);
  }
  return m;
}

RigidMotion
motionOf(const Eigen::Matrix4f& matrix)
{
  RigidMotion m;
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    for (int j = 0; j < 3; ++j)
      m.rotation[row][static_cast<std::size_t>(j)] = static_cast<double>(matrix(i, j));
    m.translation[row] = static_cast<double>(matrix(i, 3));
  }
  return m;
}

RigidMotion
refined(const SurfletSet& model, const RigidMotion& motion, const SurfletSet& scene, double reach)
{
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  icp.setInputSource(cloudOf(model));
  icp.setInputTarget(cloudOf(scene));
  icp.setMaxCorrespondenceDistance(reach);
  icp.setMaximumIterations(kIcpIterations);
  Cloud aligned;
  icp.align(aligned, matrixOf(motion));
  const Eigen::Matrix4f found = icp.getFinalTransformation();
  return icp.hasConverged() && found.allFinite() ? motionOf(found) : motion;
}

Support
supportOf(const SurfletSet& model, const RigidMotion& motion, const SurfletSet& scene, double leaf)
{
  Support s;
  for (const auto& row : motion.rotation)
    for (const double v : row)
      if (!std::isfinite(v))
        return s;
  const SurfletSet placed = moved(model, motion);
  s.share = static_cast<double>(near(placed, scene, leaf).size()) /
            static_cast<double>(std::max<std::size_t>(1, placed.size()));
  s.cells = near(scene, placed, leaf);
  return s;
}

std::unique_ptr<PoseFinder>
ppfRegistrationFinder(const SurfletSet& model, const PosePeerParameters& parameters)
{
  return std::make_unique<PpfRegistrationFinder>(model, parameters);
}

std::unique_ptr<PoseFinder>
shotFinder(const SurfletSet& model, const PosePeerParameters& parameters)
{
  return std::make_unique<ShotFinder>(model, parameters);
}

const std::vector<std::string>&
poseFinderNames()
{
  static const std::vector<std::string> names = {
#ifdef PCL_SURFLET_OPENCV
      "opencv", "opencv_repaired",
#endif
      "shot", "ppf_registration"};
  return names;
}

std::unique_ptr<PoseFinder>
poseFinder(const std::string& name, const SurfletSet& model, const PosePeerParameters& parameters)
{
  std::unique_ptr<PoseFinder> finder;
  if (name == "shot")
    finder = shotFinder(model, parameters);
  else if (name == "ppf_registration")
    finder = ppfRegistrationFinder(model, parameters);
#ifdef PCL_SURFLET_OPENCV
  else if (name == "opencv")
    return opencvFinder(model, parameters, false);
  else if (name == "opencv_repaired")
    finder = opencvFinder(model, parameters, true);
#endif
  else
    throw std::invalid_argument("there is no pose finder '" + name + "'");
  return std::make_unique<RefinedFinder>(std::move(finder), model, parameters.leaf);
}

} // namespace apps
} // namespace pcl_surflet
