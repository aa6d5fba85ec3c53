#pragma once

#include "pcl_surflet/impl/oriented_input.h"
#include "pcl_surflet/pose_estimator.h"

#include <pcl/console/print.h>

template <typename PointT, typename PointNT>
const pcl_surflet::PoseModel*
pcl_surflet::PoseEstimator<PointT, PointNT>::modelOf(const std::string& label) const
{
  for (const auto& model : models_)
    if (model.label() == label)
      return &model;
  return nullptr;
}

template <typename PointT, typename PointNT>
bool
pcl_surflet::PoseEstimator<PointT, PointNT>::markPoints(
    const std::vector<SceneDetection>& detections, std::vector<char>& taken) const
{
  taken.assign(this->input_->size(), 0);
  for (const auto& d : detections)
    for (const auto i : d.indices) {
      if (i < 0 || static_cast<std::size_t>(i) >= taken.size()) {
        PCL_ERROR("[pcl_surflet::PoseEstimator::estimate] '%s' has a point outside the cloud: "
                  "detections must be of this cloud.\n",
                  d.label.c_str());
        return false;
      }
      taken[static_cast<std::size_t>(i)] = 1;
    }
  return true;
}

template <typename PointT, typename PointNT>
std::vector<pcl_surflet::PoseEstimate>
pcl_surflet::PoseEstimator<PointT, PointNT>::estimate(const std::vector<SceneDetection>& detections)
{
  std::vector<PoseEstimate> poses;
  ConvertedSurflets all;
  if (!this->initCompute() ||
      !detail::convertInput<PointT, PointNT>("PoseEstimator", this->input_, this->input_, normals_,
                                             *this->indices_, all))
    return poses;
  std::vector<char> taken_points;
  if (!markPoints(detections, taken_points))
    return poses;
  std::vector<char> taken(all.surflets.size(), 0);
  for (std::size_t k = 0; k < taken.size(); ++k)
    taken[k] = taken_points[static_cast<std::size_t>(all.indices[k])];
  const auto normals = detail::normalsOrInput<PointT, PointNT>(this->input_, normals_);
  for (const auto& d : detections) {
    const PoseModel* model = modelOf(d.label);
    if (model == nullptr) {
      poses.emplace_back();
      poses.back().status = PoseStatus::NoModel;
      poses.back().reason = "there is no pose model named '" + d.label + "': see setModels()";
      continue;
    }
    const SurfletSet cluster = toSurflets(*this->input_, *normals, d.indices).surflets;
    poses.push_back(
        estimatePose(cluster, *model, parameters_,
                     detail::pointsBeside(all.surflets, taken, cluster, model->diameter())));
  }
  this->deinitCompute();
  return poses;
}

#define PCL_SURFLET_INSTANTIATE_PoseEstimator(T, NT)                                               \
  template class PCL_SURFLET_API pcl_surflet::PoseEstimator<T, NT>
