/** \file
 * Coordinates and normals of clouds whose fields only a file knows; not installed, shared with the
 * apps. */
#pragma once

#include "pcl_surflet/export.h"

#include <pcl/PCLPointCloud2.h>

#include <array>
#include <cstddef>

namespace pcl_surflet {
namespace detail {

/** \brief Three fields of a cloud, all or none. */
using Columns = std::array<const pcl::PCLPointField*, 3>;

/** \brief The fields \p names if all are single floating-point numbers within a point, else null
 * pointers. */
PCL_SURFLET_API Columns columns(const pcl::PCLPointCloud2& cloud,
                                const std::array<const char*, 3>& names);

/** \brief Rounded to single precision. \p field is one of columns(). */
PCL_SURFLET_API float valueAt(const pcl::PCLPointCloud2& cloud, std::size_t point,
                              const pcl::PCLPointField& field);

} // namespace detail
} // namespace pcl_surflet
