/** \file
 * PCD files to and from memory, as files that others wrote and as files to be replaced whole; not
 * installed, shared with the apps. */
#pragma once

#include "pcl_surflet/export.h"

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <string>

namespace pcl_surflet {
namespace detail {

/** \brief What a PCD file says. */
struct PcdContent {
  pcl::PCLPointCloud2 cloud;
  Eigen::Vector4f origin = Eigen::Vector4f::Zero(); ///< of the sensor
  Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();

  std::size_t
  size() const
  {
    return std::size_t{cloud.width} * cloud.height;
  }
};

/** \brief Reads \p path after a look by pcdProblem(); throws nothing that PCL throws.
 *
 * \p content then holds at least size() points of data.
 * \return what is wrong (without the file's name), empty if nothing */
PCL_SURFLET_API std::string readPcd(const std::string& path, PcdContent& content);

/** \brief \p content as a binary PCD file. In memory, so that a file can be replaced as a whole:
 * pcl::PCDWriter truncates it first. Rows must not be padded.
 * \throws std::invalid_argument if the fields take more room than a point has */
PCL_SURFLET_API std::string binaryPcd(const PcdContent& content);

} // namespace detail
} // namespace pcl_surflet
