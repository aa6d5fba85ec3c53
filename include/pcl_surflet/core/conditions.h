/** \file
 * What happens to surfaces on their way through a sensor: motion, scale, noise, missing parts.
 * And what tells two instances of a class apart: distortion. For experiments and for training under
 * conditions. Surflets must be finite; of an empty set nothing is left but an empty set. One seed
 * gives one result. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"
#include "pcl_surflet/core/triangle_mesh.h"

#include <array>
#include <cstdint>

namespace pcl_surflet {

/** \brief The set turned by a random rotation (uniform over all orientations) about the origin. */
PCL_SURFLET_API SurfletSet randomlyRotated(const SurfletSet& set, std::uint64_t seed);

/** \brief The set with every position moved along its normal by a random distance, uniform in
 * [-amplitude, amplitude] [Wahl 2007, Sec. 3.6.5]. Normals stay: a sensor would have to estimate
 * them anew. \param set of surflets \param amplitude in their unit, finite and >= 0 \param seed of
 * the distances */
PCL_SURFLET_API SurfletSet displacedAlongNormals(const SurfletSet& set, double amplitude,
                                                 std::uint64_t seed);

/** \brief The share \p visible (in (0, 1]) of the surflets that lies on one side of a random plane
 * [Wahl 2007, Sec. 3.6.6]: of a set of even density, that share of the area. At least one surflet
 * remains of a set that is not empty. \throws std::invalid_argument if \p visible is out of range
 */
PCL_SURFLET_API SurfletSet cutByRandomPlane(const SurfletSet& set, double visible,
                                            std::uint64_t seed);

/** \brief What a distant sensor in a random direction sees of the set: surflets that face it and
 * that no other one hides, each moved along the line of sight by a random distance, uniform in
 * [-\p noise, \p noise]. Normals stay.
 *
 * Hidden is what lies behind the foremost surflet of its cell of 1.5 \p spacing, by more than the
 * surface's own slope explains; surflets seen at less than 6 degrees are left out.
 * \param set of even density
 * \param spacing distance between neighbouring surflets, > 0, else std::invalid_argument
 * \param noise largest displacement in the unit of the set, >= 0
 * \param seed of the direction and the noise */
PCL_SURFLET_API SurfletSet singleView(const SurfletSet& set, double spacing, double noise,
                                      std::uint64_t seed);

/** \brief The mesh scaled so that its farthest vertices are \p diameter (> 0) apart.
 * \throws std::invalid_argument if the vertices have no extent */
PCL_SURFLET_API TriangleMesh scaledToDiameter(const TriangleMesh& mesh, double diameter);

/** \brief Orthonormal directions of the largest, the second and the smallest spread of the
 * positions: the eigenvectors of their covariance [Wahl 2007, Sec. 3.6.8]. Where spreads are equal,
 * as on a sphere, any of the possible directions. Unit vectors also for an empty set. */
PCL_SURFLET_API std::array<std::array<double, 3>, 3> principalAxes(const SurfletSet& set);

/** \brief The mesh stretched along three orthonormal \p axes by \p factors (1 leaves an axis as it
 * is) about the origin [Wahl 2007, Eq. 3.24-3.26].
 * \throws std::invalid_argument if a factor is not positive and finite */
PCL_SURFLET_API TriangleMesh stretched(const TriangleMesh& mesh,
                                       const std::array<std::array<double, 3>, 3>& axes,
                                       const std::array<double, 3>& factors);

/** \brief Signed measure of a distortion by these factors [Wahl 2007, Eq. 3.27, 3.28]: the
 * Euclidean distance of the factors from (1, 1, 1), negative if they shrink more than they stretch.
 * The sign's condition is lost in the dissertation's text; here it is the sign of the sum of
 * (factor - 1). */
PCL_SURFLET_API double distortionMeasure(const std::array<double, 3>& factors);

} // namespace pcl_surflet
