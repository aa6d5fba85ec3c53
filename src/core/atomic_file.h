/** \file
 * Replaces a file as a whole; not installed, shared with the apps. */
#pragma once

#include "pcl_surflet/export.h"

#include <string>

namespace pcl_surflet {
namespace detail {

/** \brief Makes \p content the content of the file \p path, or leaves it as it was.
 *
 * Writes a temporary file in the same directory, flushes it to the disk and renames it. An existing
 * file keeps its permissions, which must let one write, a symbolic link its target's name. What is
 * neither a file nor absent (a device, a pipe) is written to directly: renaming would replace it.
 * \return what went wrong and what to look at, empty if nothing. */
PCL_SURFLET_API std::string replaceFile(const std::string& path, const std::string& content);

} // namespace detail
} // namespace pcl_surflet
