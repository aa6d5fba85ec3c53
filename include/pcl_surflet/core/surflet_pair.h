/** \file
 * The four-dimensional feature of one surflet pair: the double-precision reference. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"

#include <optional>

namespace pcl_surflet {

/** \brief The surflet-pair feature f = (alpha, beta, gamma, delta) [Wahl 2007, Eq. 2.10]. */
struct PairFeature {
  double alpha = 0; ///< azimuth of n2 about u, radian, in [-pi, pi) [Wahl 2007, Eq. 2.6, 2.12]
  double beta = 0;  ///< v . n2, in [-1, 1] [Wahl 2007, Eq. 2.7]
  double gamma = 0; ///< u . d / |d|, in [-1, 1] [Wahl 2007, Eq. 2.8]
  double delta = 0; ///< |d|, in the unit of the points, > 0 [Wahl 2007, Eq. 2.9]
};

/** \brief Ends whose (n.d)^2 differ by no more than this share of the smaller one tie for the
 * origin.
 *
 * Eq. 2.2 leaves the tie open. Parallel normals always tie, but after a rotation in floating point
 * only up to rounding; without a tolerance the sign of gamma would then be chance. */
constexpr double kOriginTieTolerance = 1e-5;

/** \brief A pair with |d x u|^2 at or below this share of |d|^2 has no feature: v is undefined. */
constexpr double kCollinearityTolerance = 1e-6;

/** \brief Computes the feature of the pair (\p s1, \p s2) in double precision
 * [Wahl 2007, Eq. 2.2-2.9].
 *
 * The origin is the end whose normal is more orthogonal to the connecting line (Eq. 2.2); at a tie
 * the end with the larger gamma. The result does not depend on the order of the two surflets, nor
 * on rigid motions; it changes under mirroring.
 *
 * Normals must have unit length.
 * \return nothing for a pair without feature: coincident points, both normals collinear with the
 * connecting line, or a coordinate or normal that is not finite. */
PCL_SURFLET_API std::optional<PairFeature> computePairFeature(const Surflet& s1, const Surflet& s2);

/** \brief The same; \p origin_is_second tells whether Eq. 2.2 made \p s2 the origin: what a pose is
 * made from needs the frame, not only the feature. Unchanged for a pair without feature. */
PCL_SURFLET_API std::optional<PairFeature> computePairFeature(const Surflet& s1, const Surflet& s2,
                                                              bool& origin_is_second);

} // namespace pcl_surflet
