#pragma once

#include "pcl_surflet/impl/oriented_input.h"
#include "pcl_surflet/impl/whole_cloud_feature.hpp"
#include "pcl_surflet/surflet_pair_feature.h"

template <typename PointInT, typename PointNT, typename PointOutT>
void
pcl_surflet::SurfletPairFeature<PointInT, PointNT, PointOutT>::computeFeature(PointCloudOut& output)
{
  if (!(request_.maximum_distance >= 0)) {
    PCL_ERROR("[pcl_surflet::%s::compute] The maximum distance must not be negative.\n",
              this->feature_name_.c_str());
    return;
  }
  ConvertedSurflets converted;
  if (!detail::convertInput<PointInT, PointNT>(this->feature_name_, this->input_, this->surface_,
                                               this->normals_, *this->indices_, converted))
    return;
  if (request_.pairs == 0 && detail::countablePairs(converted.surflets.size()) == 0 &&
      converted.surflets.size() > 1) {
    PCL_ERROR("[pcl_surflet::%s::compute] All pairs of %zu points are too many: draw some with "
              "setNumberOfPairs(), or reduce the cloud.\n",
              this->feature_name_.c_str(), converted.surflets.size());
    return;
  }
  const auto pairs = detail::computePairSignatures(converted.surflets, request_, rejected_);
  output.resize(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    auto& out = output[i];
    out.alpha = pairs[i].alpha;
    out.beta = pairs[i].beta;
    out.gamma = pairs[i].gamma;
    out.delta = pairs[i].delta;
    out.index_1 = static_cast<std::uint32_t>(converted.indices[pairs[i].index_1]);
    out.index_2 = static_cast<std::uint32_t>(converted.indices[pairs[i].index_2]);
  }
}

#define PCL_SURFLET_INSTANTIATE_SurfletPairFeature(T, NT)                                          \
  template class PCL_SURFLET_API                                                                   \
      pcl_surflet::detail::WholeCloudFeature<T, NT, pcl_surflet::SurfletPairSignature>;            \
  template class PCL_SURFLET_API pcl_surflet::SurfletPairFeature<T, NT>
