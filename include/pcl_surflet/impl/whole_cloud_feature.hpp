#pragma once

#include "pcl_surflet/impl/whole_cloud_feature.h"

#include <pcl/console/print.h>

template <typename PointInT, typename PointNT, typename PointOutT>
void
pcl_surflet::detail::WholeCloudFeature<PointInT, PointNT, PointOutT>::compute(PointCloudOut& output)
{
  output.clear();
  output.is_dense = true;
  if (!pcl::PCLBase<PointInT>::initCompute()) {
    PCL_ERROR("[pcl_surflet::%s::compute] No input cloud.\n", this->feature_name_.c_str());
    return;
  }
  output.header = this->input_->header;
  this->computeFeature(output);
  pcl::PCLBase<PointInT>::deinitCompute();
}
