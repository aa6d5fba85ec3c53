/** \file
 * What differs between PCL 1.12 and 1.15, and what a user's file must have in common with the
 * library. Every header that shows PCL includes this one. */
#pragma once

#include "pcl_surflet/config.h"

#include <pcl/pcl_config.h>

#include <Eigen/Core>

#include <utility>

#define PCL_SURFLET_TEXT_OF(x) #x                  ///< for PCL_SURFLET_TEXT()
#define PCL_SURFLET_TEXT(x) PCL_SURFLET_TEXT_OF(x) ///< what the macro x stands for, as a text

// clang-format breaks the texts into single words.
// clang-format off
static_assert(PCL_MAJOR_VERSION == PCL_SURFLET_PCL_MAJOR &&
              PCL_MINOR_VERSION == PCL_SURFLET_PCL_MINOR,
    "pcl_surflet was built with PCL "
    PCL_SURFLET_TEXT(PCL_SURFLET_PCL_MAJOR) "." PCL_SURFLET_TEXT(PCL_SURFLET_PCL_MINOR)
    ", this file includes PCL "
    PCL_SURFLET_TEXT(PCL_MAJOR_VERSION) "." PCL_SURFLET_TEXT(PCL_MINOR_VERSION)
    ", whose classes differ: build pcl_surflet with that PCL, or include the one it was built "
    "with.");

// With -mavx or -march=native Eigen aligns to 32 or 64 bytes and no longer frees what malloc()
// gave: a cloud filled by a library built without would crash where it is destroyed.
static_assert(EIGEN_MAX_ALIGN_BYTES == PCL_SURFLET_EIGEN_MAX_ALIGN_BYTES &&
              EIGEN_MALLOC_ALREADY_ALIGNED == PCL_SURFLET_EIGEN_MALLOC_ALREADY_ALIGNED,
    "Eigen aligns memory otherwise in this file than in the libraries of PCL and pcl_surflet, and "
    "clouds would crash: -mavx, -march=native and -fsanitize=address do that. Compile with "
    "-DEIGEN_MAX_ALIGN_BYTES=" PCL_SURFLET_TEXT(PCL_SURFLET_EIGEN_MAX_ALIGN_BYTES)
    " -DEIGEN_MALLOC_ALREADY_ALIGNED=" PCL_SURFLET_TEXT(PCL_SURFLET_EIGEN_MALLOC_ALREADY_ALIGNED)
    ", as find_package(pcl_surflet) and pkg-config pcl_surflet do, in all files of the program.");
// clang-format on

namespace pcl_surflet {
namespace compat {

/** \brief What setInputCloud() of a pcl::search::Search returns: nothing up to PCL 1.13, bool from
 * 1.14 on. */
template <typename Search>
using SetInputCloudResult = decltype(std::declval<Search&>().setInputCloud(
    std::declval<const typename Search::PointCloudConstPtr&>(),
    std::declval<const typename Search::IndicesConstPtr&>()));

} // namespace compat
} // namespace pcl_surflet
