#pragma once

#include "pcl_surflet/impl/oriented_input.h"
#include "pcl_surflet/octree_region_search.h"
#include "pcl_surflet/scene_interpreter.h"

#include <pcl/filters/impl/filter_indices.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>

template <typename PointT, typename PointNT>
bool
pcl_surflet::SceneInterpreter<PointT, PointNT>::fail(SceneStatus status, const std::string& reason)
{
  diagnostics_.status = status;
  diagnostics_.reason = reason;
  PCL_ERROR("[pcl_surflet::%s::interpret] %s\n", this->filter_name_.c_str(), reason.c_str());
  return false;
}

template <typename PointT, typename PointNT>
bool
pcl_surflet::SceneInterpreter<PointT, PointNT>::convertPoints(ConvertedSurflets& points)
{
  using detail::InputProblem;
  const auto normals = detail::normalsOrInput<PointT, PointNT>(this->input_, normals_);
  const auto problem = detail::findInputProblem<PointT, PointNT>(this->input_, this->input_,
                                                                 normals, *this->indices_);
  if (problem != InputProblem::None)
    return fail(problem == InputProblem::NoNormals ? SceneStatus::NoNormals
                                                   : SceneStatus::WrongInput,
                detail::textOf(problem));
  if (background_) {
    const auto theirs = detail::normalsOrInput<PointT, PointNT>(background_, background_normals_);
    if (!theirs || theirs->size() != background_->size())
      return fail(SceneStatus::NoNormals,
                  "The background cloud needs one normal per point: see setBackgroundCloud().");
  }
  points = toSurflets(*this->input_, *normals, *this->indices_);
  diagnostics_.points = points.surflets.size();
  diagnostics_.rejected = points.rejected;
  return true;
}

template <typename PointT, typename PointNT>
void
pcl_surflet::SceneInterpreter<PointT, PointNT>::removeBackgroundCloud(
    const ExclusionOptions& options, ConvertedSurflets& points)
{
  const auto normals = detail::normalsOrInput<PointT, PointNT>(background_, background_normals_);
  pcl::Indices all(background_->size());
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = static_cast<pcl::index_t>(i);
  const SurfletSet cells =
      detail::backgroundCells(toSurflets(*background_, *normals, all).surflets, options);
  if (cells.empty())
    return;
  typename pcl::PointCloud<PointT>::Ptr positions(new pcl::PointCloud<PointT>(cells.size(), 1));
  const auto place = [](PointT& p, const Surflet& s) {
    p.x = s.x;
    p.y = s.y;
    p.z = s.z;
  };
  for (std::size_t i = 0; i < cells.size(); ++i)
    place((*positions)[i], cells[i]);
  if (!search_)
    search_.reset(new OctreeRegionSearch<PointT>);
  search_->setInputCloud(positions);
  const double least = std::cos(options.max_angle);
  pcl::Indices near;
  std::vector<float> squared;
  detail::removePoints(
      [&](const Surflet& s) {
        PointT p;
        place(p, s);
        search_->radiusSearch(p, options.distance, near, squared);
        return std::any_of(near.begin(), near.end(), [&](pcl::index_t i) {
          const Surflet b = cells[static_cast<std::size_t>(i)];
          return s.nx * b.nx + s.ny * b.ny + s.nz * b.nz >= least;
        });
      },
      points);
}

template <typename PointT, typename PointNT>
pcl_surflet::ConvertedSurflets
pcl_surflet::SceneInterpreter<PointT, PointNT>::withoutBackground(ConvertedSurflets points)
{
  ExclusionOptions options = request_.exclusion;
  if (options.distance == 0)
    options.distance = detail::leafOf(request_.leaf, database_);
  if (background_)
    removeBackgroundCloud(options, points);
  diagnostics_.planes = detail::removePlanes(request_.planes, options, points);
  diagnostics_.background_points = diagnostics_.points - points.surflets.size();
  return points;
}

template <typename PointT, typename PointNT>
bool
pcl_surflet::SceneInterpreter<PointT, PointNT>::interpretInput(
    ConvertedSurflets& points, std::vector<SceneDetection>& detections)
{
  if (!convertPoints(points))
    return false;
  try {
    const bool excludes = request_.parameters.steps.background == BackgroundTreatment::Exclude;
    detections = detail::interpretPoints(excludes ? withoutBackground(points) : points, database_,
                                         request_, diagnostics_, cells_);
  }
  catch (const DatabaseError& error) {
    return fail(SceneStatus::WrongDatabase, error.what());
  }
  catch (const std::invalid_argument& error) {
    return fail(SceneStatus::WrongParameter, error.what());
  }
  return true;
}

template <typename PointT, typename PointNT>
std::vector<pcl_surflet::SceneDetection>
pcl_surflet::SceneInterpreter<PointT, PointNT>::interpret()
{
  std::vector<SceneDetection> detections;
  diagnostics_ = {};
  cells_.clear();
  if (!this->initCompute()) {
    fail(SceneStatus::NoInput, "No input cloud.");
    return detections;
  }
  ConvertedSurflets points;
  interpretInput(points, detections);
  this->deinitCompute();
  return detections;
}

template <typename PointT, typename PointNT>
template <typename PointOutT>
void
pcl_surflet::SceneInterpreter<PointT, PointNT>::labelCloud(
    const std::vector<SceneDetection>& detections, pcl::PointCloud<PointOutT>& output) const
{
  output.clear();
  if (!this->input_)
    return;
  const auto& input = *this->input_;
  for (const auto& d : detections)
    detail::checkWithin(d.indices, input.size());
  output.resize(input.size());
  output.header = input.header;
  output.is_dense = input.is_dense;
  output.width = input.width;
  output.height = input.height;
  output.sensor_origin_ = input.sensor_origin_;
  output.sensor_orientation_ = input.sensor_orientation_;
  const auto normals = detail::normalsOrInput<PointT, PointNT>(this->input_, normals_);
  const bool have_normals = normals && normals->size() == input.size();
  for (std::size_t i = 0; i < input.size(); ++i) {
    auto& q = output[i];
    q.x = input[i].x;
    q.y = input[i].y;
    q.z = input[i].z;
    q.label = 0;
    if constexpr (std::is_same<PointOutT, pcl::PointXYZLNormal>::value) {
      const float none = std::numeric_limits<float>::quiet_NaN();
      q.normal_x = have_normals ? (*normals)[i].normal_x : none;
      q.normal_y = have_normals ? (*normals)[i].normal_y : none;
      q.normal_z = have_normals ? (*normals)[i].normal_z : none;
    }
  }
  for (const auto& d : detections)
    for (const auto i : d.indices)
      output[static_cast<std::size_t>(i)].label = static_cast<std::uint32_t>(d.model + 1);
}

template <typename PointT, typename PointNT>
void
pcl_surflet::SceneInterpreter<PointT, PointNT>::getLabeledCloud(
    pcl::PointCloud<pcl::PointXYZL>& output)
{
  labelCloud(interpret(), output);
}

template <typename PointT, typename PointNT>
void
pcl_surflet::SceneInterpreter<PointT, PointNT>::getLabeledCloud(
    pcl::PointCloud<pcl::PointXYZLNormal>& output)
{
  labelCloud(interpret(), output);
}

template <typename PointT, typename PointNT>
void
pcl_surflet::SceneInterpreter<PointT, PointNT>::applyFilter(pcl::Indices& indices)
{
  enum : char { Unusable, Rest, Object };
  indices.clear();
  this->removed_indices_->clear();
  diagnostics_ = {};
  cells_.clear();
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

#define PCL_SURFLET_INSTANTIATE_SceneInterpreter(T, NT)                                            \
  template class PCL_SURFLET_API pcl_surflet::SceneInterpreter<T, NT>;                             \
  template PCL_SURFLET_API void pcl_surflet::SceneInterpreter<T, NT>::labelCloud(                  \
      const std::vector<pcl_surflet::SceneDetection>&, pcl::PointCloud<pcl::PointXYZL>&) const;    \
  template PCL_SURFLET_API void pcl_surflet::SceneInterpreter<T, NT>::labelCloud(                  \
      const std::vector<pcl_surflet::SceneDetection>&, pcl::PointCloud<pcl::PointXYZLNormal>&)     \
      const
