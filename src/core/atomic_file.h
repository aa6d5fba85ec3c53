/** \file
 * Replaces a file as a whole; internal, not installed. */
#pragma once

#include <string>

namespace pcl_surflet {
namespace detail {

/** \brief Makes \p content the content of the file \p path, or leaves it as it was.
 *
 * Writes a temporary file in the same directory, flushes it to the disk and renames it. An existing
 * file keeps its permissions, a symbolic link its target's name. What is neither a file nor absent
 * (a device, a pipe) is written to directly: renaming would replace it.
 * \return what went wrong, empty if nothing. */
std::string replaceFile(const std::string& path, const std::string& content);

} // namespace detail
} // namespace pcl_surflet
