// The templates for the point types most people use, so that users' files compile fast. Other
// types: define PCL_NO_PRECOMPILE before including our headers.

#include "pcl_surflet/impl/surflet_pair_feature.hpp"
#include "pcl_surflet/impl/surflet_pair_histogram.hpp"

#include <pcl/point_types.h>

#define PCL_SURFLET_INSTANTIATE(T, NT)                                                             \
  PCL_SURFLET_INSTANTIATE_SurfletPairFeature(T, NT);                                               \
  PCL_SURFLET_INSTANTIATE_SurfletPairHistogramEstimation(T, NT)

PCL_SURFLET_INSTANTIATE(pcl::PointXYZ, pcl::Normal);
PCL_SURFLET_INSTANTIATE(pcl::PointXYZ, pcl::PointNormal);
PCL_SURFLET_INSTANTIATE(pcl::PointXYZI, pcl::Normal);
PCL_SURFLET_INSTANTIATE(pcl::PointXYZRGB, pcl::Normal);
PCL_SURFLET_INSTANTIATE(pcl::PointXYZRGBA, pcl::Normal);
PCL_SURFLET_INSTANTIATE(pcl::PointXYZL, pcl::Normal);
PCL_SURFLET_INSTANTIATE(pcl::PointNormal, pcl::Normal);
PCL_SURFLET_INSTANTIATE(pcl::PointNormal, pcl::PointNormal);
PCL_SURFLET_INSTANTIATE(pcl::PointXYZRGBNormal, pcl::PointXYZRGBNormal);
PCL_SURFLET_INSTANTIATE(pcl::PointXYZINormal, pcl::PointXYZINormal);
