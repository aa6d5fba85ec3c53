/** \file
 * What a run costs, and what PCL's own first steps cost on the same data. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"

#include <functional>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Wall-clock seconds that \p work takes. */
double secondsOf(const std::function<void()>& work);

/** \brief Bytes by which the resident memory of the process exceeds, at its peak during \p work,
 * what it was before; negative if the system cannot tell. */
double bytesOf(const std::function<void()>& work);

/** \brief Seconds of pcl::NormalEstimationOMP (20 neighbours) on \p cells. */
double normalEstimationSeconds(const SurfletSet& cells, unsigned threads);

/** \brief Seconds of pcl::VoxelGrid with cells of edge \p leaf on \p scene as points with normals.
 */
double voxelGridSeconds(const SurfletSet& scene, double leaf);

} // namespace apps
} // namespace pcl_surflet
