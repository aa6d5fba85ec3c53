/** \file
 * The clouds that region searches are timed on. */
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstddef>
#include <string>

namespace pcl_surflet {
namespace region_search {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

/** \brief \p n uniform points in the unit cube. */
Cloud::Ptr cubeCloud(std::size_t n);

/** \brief A table of 1 m with seven round bodies on it. */
Cloud::Ptr tableCloud(std::size_t n);

/** \brief The cloud \p name: cube84k, cube1700k, scan200k, or else a reduced table scene.
 * PCL_SURFLET_SCAN and PCL_SURFLET_SCENE may name PCD files in place of the generated ones. */
Cloud::Ptr namedCloud(const std::string& name);

} // namespace region_search
} // namespace pcl_surflet
