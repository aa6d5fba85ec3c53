/** \file
 * PCD files to and from memory, as files that others wrote and as files to be replaced whole; not
 * installed, shared with the apps. */
#pragma once

#include "pcl_surflet/surface_file.h"

#include <string>

namespace pcl_surflet {
namespace detail {

/** \brief Reads \p path after a look by pcdProblem(); throws nothing that PCL throws.
 *
 * \p content then holds at least size() points of data.
 * \return what is wrong (without the file's name), empty if nothing */
PCL_SURFLET_API std::string readPcd(const std::string& path, SourcePoints& content);

/** \brief \p content as a binary PCD file. In memory, so that a file can be replaced as a whole:
 * pcl::PCDWriter truncates it first. Rows must not be padded.
 * \throws std::invalid_argument if the fields take more room than a point has */
PCL_SURFLET_API std::string binaryPcd(const SourcePoints& content);

} // namespace detail
} // namespace pcl_surflet
