#pragma once

#include "pcl_surflet/impl/oriented_input.h"
#include "pcl_surflet/scene_interpreter.h"

#include <pcl/filters/impl/filter_indices.hpp>

#include <exception>

template <typename PointT, typename PointNT>
bool
pcl_surflet::SceneInterpreter<PointT, PointNT>::interpretInput(
    ConvertedSurflets& points, std::vector<SceneDetection>& detections)
{
  diagnostics_ = {};
  if (!detail::convertInput<PointT, PointNT>(this->filter_name_, this->input_, this->input_,
                                             normals_, *this->indices_, points))
    return false;
  try {
    detections = detail::interpretPoints(points, database_, request_, diagnostics_);
  }
  catch (const std::exception& error) {
    PCL_ERROR("[pcl_surflet::%s::interpret] %s\n", this->filter_name_.c_str(), error.what());
    return false;
  }
  return true;
}

template <typename PointT, typename PointNT>
std::vector<pcl_surflet::SceneDetection>
pcl_surflet::SceneInterpreter<PointT, PointNT>::interpret()
{
  std::vector<SceneDetection> detections;
  if (!this->initCompute()) {
    PCL_ERROR("[pcl_surflet::%s::interpret] No input cloud.\n", this->filter_name_.c_str());
    return detections;
  }
  ConvertedSurflets points;
  interpretInput(points, detections);
  this->deinitCompute();
  return detections;
}

template <typename PointT, typename PointNT>
void
pcl_surflet::SceneInterpreter<PointT, PointNT>::getLabeledCloud(
    pcl::PointCloud<pcl::PointXYZL>& output)
{
  const auto detections = interpret();
  output.clear();
  if (!this->input_)
    return;
  output.header = this->input_->header;
  output.is_dense = this->input_->is_dense;
  for (const auto& p : *this->input_) {
    pcl::PointXYZL q;
    q.x = p.x;
    q.y = p.y;
    q.z = p.z;
    q.label = 0;
    output.push_back(q);
  }
  output.width = this->input_->width;
  output.height = this->input_->height;
  for (const auto& d : detections)
    for (const auto i : d.indices)
      output[static_cast<std::size_t>(i)].label = static_cast<std::uint32_t>(d.model + 1);
}

template <typename PointT, typename PointNT>
void
pcl_surflet::SceneInterpreter<PointT, PointNT>::applyFilter(pcl::Indices& indices)
{
  enum : char { Unusable, Rest, Object };
  indices.clear();
  this->removed_indices_->clear();
  ConvertedSurflets points;
  std::vector<SceneDetection> detections;
  if (!interpretInput(points, detections))
    return;
  std::vector<char> kind(this->input_->size(), Unusable);
  for (const auto i : points.indices)
    kind[static_cast<std::size_t>(i)] = Rest;
  for (const auto& d : detections)
    for (const auto i : d.indices)
      kind[static_cast<std::size_t>(i)] = Object;
  for (const auto i : *this->indices_) {
    if (kind[static_cast<std::size_t>(i)] == (this->negative_ ? Rest : Object))
      indices.push_back(i);
    else if (this->extract_removed_indices_)
      this->removed_indices_->push_back(i);
  }
}

#define PCL_INSTANTIATE_SceneInterpreter(T, NT)                                                    \
  template class PCL_SURFLET_API pcl_surflet::SceneInterpreter<T, NT>;
