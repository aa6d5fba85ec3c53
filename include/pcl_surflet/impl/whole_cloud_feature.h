/** \file
 * What features of a whole cloud have in common. */
#pragma once

#include "pcl_surflet/compat.h"

#include <pcl/features/feature.h>

namespace pcl_surflet {
namespace detail {

/** \brief A pcl::FeatureFromNormals whose output belongs to the cloud, not point by point to its
 * input. */
template <typename PointInT, typename PointNT, typename PointOutT>
class WholeCloudFeature : public pcl::FeatureFromNormals<PointInT, PointNT, PointOutT> {
public:
  /** \brief As PCL's classes have it. */
  using PointCloudOut = typename pcl::Feature<PointInT, PointOutT>::PointCloudOut;

  /** \brief Computes the feature; hides pcl::Feature::compute(), which would make one output per
   * point. \param output replaced; empty after an error, which PCL_ERROR tells */
  void compute(PointCloudOut& output);

private:
  /** \brief What compute() calls, with input and indices set. \param output empty */
  void computeFeature(PointCloudOut& output) override = 0;
};

} // namespace detail
} // namespace pcl_surflet
