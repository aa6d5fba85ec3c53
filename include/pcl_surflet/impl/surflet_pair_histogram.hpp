#pragma once

#include "pcl_surflet/impl/oriented_input.h"
#include "pcl_surflet/impl/whole_cloud_feature.hpp"
#include "pcl_surflet/surflet_pair_histogram.h"

#include <algorithm>

template <typename PointInT, typename PointNT, typename PointOutT>
void
pcl_surflet::SurfletPairHistogramEstimation<PointInT, PointNT, PointOutT>::computeFeature(
    PointCloudOut& output)
{
  if (const auto problem = detail::requestProblem(request_, PointOutT::descriptorSize());
      !problem.empty()) {
    PCL_ERROR("[pcl_surflet::%s::compute] %s\n", this->feature_name_.c_str(), problem.c_str());
    return;
  }
  ConvertedSurflets converted;
  if (!detail::convertInput<PointInT, PointNT>(this->feature_name_, this->input_, this->surface_,
                                               this->normals_, *this->indices_, converted))
    return;
  const auto histogram = detail::computePairHistogram(converted.surflets, request_);
  if (histogram.empty()) {
    PCL_ERROR(
        "[pcl_surflet::%s::compute] None of the %zu usable points make a pair with a feature.\n",
        this->feature_name_.c_str(), converted.surflets.size());
    return;
  }
  output.resize(1);
  std::copy(histogram.begin(), histogram.end(), output[0].histogram);
}

#define PCL_SURFLET_INSTANTIATE_SurfletPairHistogramEstimation(T, NT)                              \
  template class PCL_SURFLET_API                                                                   \
      pcl_surflet::detail::WholeCloudFeature<T, NT, pcl_surflet::SurfletPairHistogram625>;         \
  template class PCL_SURFLET_API pcl_surflet::SurfletPairHistogramEstimation<T, NT>
