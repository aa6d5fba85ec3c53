/** \file
 * Measures of a whole surflet set that training needs. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"

#include <cstddef>
#include <cstdint>

namespace pcl_surflet {

/** \brief Largest distance between two surflets, exact, in their unit; 0 for fewer than two
 * (delta_max, [Wahl 2007, Sec. 2.3]). Positions must be finite.
 *
 * Splits pairs of tree nodes as long as they may hold a longer pair than the best one known: far
 * below O(n^2), also for a sphere, where every surflet has partners almost as far as the farthest.
 */
PCL_SURFLET_API double farthestDistance(const SurfletSet& set);

/** \brief How evenly the surflets cover their surface. */
struct SurfaceDensity {
  double spacing = 0;  ///< distance to the eighth neighbour, median over the surface
  double widest = 0;   ///< on 95 % of the surface the eighth neighbour is within this
  double contrast = 1; ///< ratio of surface densities, densest to sparsest tenth of the
                       ///< surface, >= 1
};

/** \brief Surflets per area vary by chance: independent uniform draws reach a contrast of
 * about 2.5, evenly spread ones less. From this contrast on a set counts as uneven. */
constexpr double kUnevenContrast = 5.0;

/** \brief Estimates the density from at most 256 surflets (deterministic in \p seed) and their
 * eighth neighbours; trivial (contrast 1) for fewer than 32 surflets. */
PCL_SURFLET_API SurfaceDensity surfaceDensity(const SurfletSet& set, std::uint64_t seed = 1);

} // namespace pcl_surflet
