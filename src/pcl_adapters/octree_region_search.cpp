#include "pcl_surflet/impl/octree_region_search.hpp"

PCL_SURFLET_INSTANTIATE_OctreeRegionSearch(pcl::PointXYZ);
PCL_SURFLET_INSTANTIATE_OctreeRegionSearch(pcl::PointXYZI);
PCL_SURFLET_INSTANTIATE_OctreeRegionSearch(pcl::PointXYZL);
PCL_SURFLET_INSTANTIATE_OctreeRegionSearch(pcl::PointXYZRGB);
PCL_SURFLET_INSTANTIATE_OctreeRegionSearch(pcl::PointXYZRGBA);
PCL_SURFLET_INSTANTIATE_OctreeRegionSearch(pcl::PointNormal);
PCL_SURFLET_INSTANTIATE_OctreeRegionSearch(pcl::PointXYZINormal);
PCL_SURFLET_INSTANTIATE_OctreeRegionSearch(pcl::PointXYZRGBNormal);
