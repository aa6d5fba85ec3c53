/** \file
 * A look at a PCD file before PCL reads it; internal, not installed. */
#pragma once

#include <string>

namespace pcl_surflet {
namespace detail {

/** \brief Empty if the header of \p path is consistent with itself and with the size of the file,
 * else what is wrong (without the file's name).
 *
 * pcl::PCDReader allocates what the header claims and reads past the end of truncated files; a
 * damaged or hostile file must not get that far. */
std::string pcdProblem(const std::string& path);

} // namespace detail
} // namespace pcl_surflet
