#pragma once

#include "pcl_surflet/impl/oriented_input.h"
#include "pcl_surflet/surflet_pair_histogram.h"

#include <algorithm>

template <typename PointInT, typename PointNT, typename PointOutT>
void
pcl_surflet::SurfletPairHistogramEstimation<PointInT, PointNT, PointOutT>::compute(
    PointCloudOut& output)
{
  output.clear();
  output.is_dense = true;
  if (!pcl::PCLBase<PointInT>::initCompute()) {
    PCL_ERROR("[pcl_surflet::%s::compute] No input cloud.\n", this->feature_name_.c_str());
    return;
  }
  output.header = this->input_->header;
  computeFeature(output);
  pcl::PCLBase<PointInT>::deinitCompute();
}

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

#define PCL_INSTANTIATE_SurfletPairHistogramEstimation(T, NT)                                      \
  template class PCL_SURFLET_API pcl_surflet::SurfletPairHistogramEstimation<T, NT>;
