/** \file
 * Files that programs read surfaces from, and clouds made of them. */
#pragma once

#include "app_common.h"

#include "pcl_surflet/surface_file.h"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <string>

namespace pcl_surflet {
namespace apps {

/** \brief loadSurface() with the values of the options of missing normals and of -threads (0: all).
 * \throws SurfaceFileError */
SurfaceFile readSurface(const std::string& path, const MissingNormals& normals,
                        std::uint64_t threads, bool keep_points = false);

/** \brief How many points of \p path could not be used; empty if all could. */
std::string losses(const std::string& path, const SurfaceFile& file);

/** \brief The same points and normals in the same order. */
pcl::PointCloud<pcl::PointNormal>::Ptr cloudOf(const SurfletSet& set);

} // namespace apps
} // namespace pcl_surflet
