/** \file
 * A labelled scene as it is looked at. */
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Points that are finite, with what they belong to. */
struct LabelledScene {
  pcl::PointCloud<pcl::PointXYZLNormal> points; ///< label 0: background; normals zero if unknown
  std::vector<std::uint32_t> things; ///< of every point: 0 none, else which thing, from 1
  std::size_t width = 0;             ///< columns of the file; 0 if it has no rows
  std::vector<std::uint32_t> places; ///< of every point in the file: column + width * row
};

/** \brief Reads a PCD with x y z, if it has them normals, label and instance. Without labels all is
 * background; without instances every label is one thing. \throws DataError */
LabelledScene readLabelledScene(const std::string& path);

} // namespace apps
} // namespace pcl_surflet
