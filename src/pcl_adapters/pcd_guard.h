/** \file
 * A look at a PCD file before PCL reads it; internal, not installed. */
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace pcl_surflet {
namespace detail {

/** \brief What the header of a PCD file says, as it is written. */
struct PcdClaim {
  std::size_t fields = 0;
  std::uint64_t points = 0;
  std::uint64_t step = 0; ///< bytes of a point
  std::uint64_t end = 0;  ///< offset of the first byte behind the header
};

/** \brief Empty if the header of \p path is consistent with itself and with the size of the file,
 * else what is wrong (without the file's name).
 *
 * pcl::PCDReader allocates what the header claims and reads past the end of truncated files; a
 * damaged or hostile file must not get that far.
 * \param claim what PCL's reading has to agree with, if there is no problem */
std::string pcdProblem(const std::string& path, PcdClaim& claim);

} // namespace detail
} // namespace pcl_surflet
