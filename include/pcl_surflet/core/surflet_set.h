/** \file
 * Surflets (oriented surface points) as a structure of arrays. */
#pragma once

#include "pcl_surflet/export.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_surflet {

/** \brief An oriented surface point: position p and outward unit normal n [Wahl 2007, Def. 2.1]. */
struct Surflet {
  ///@{
  /** \brief Position in the user's unit, normal of unit length. */
  float x = 0, y = 0, z = 0;
  float nx = 0, ny = 0, nz = 0;
  ///@}
};

/** \brief A set of surflets as a structure of arrays (Phi, [Wahl 2007, Eq. 2.16]).
 *
 * The six arrays always have the same length. Positions are in the user's unit (normally metres);
 * normals are expected to be finite and of unit length: appendChecked() guarantees it, push_back()
 * trusts its caller. */
class PCL_SURFLET_API SurfletSet {
public:
  ///@{
  /** \brief Positions and normals, all of one length. */
  std::vector<float> x, y, z, nx, ny, nz;
  ///@}

  /** \brief Number of surflets. */
  std::size_t
  size() const
  {
    return x.size();
  }
  /** \brief Whether there is none. */
  bool
  empty() const
  {
    return x.empty();
  }
  void reserve(std::size_t n); ///< makes room for \p n in all
  void clear();                ///< removes all
  /** \brief Appends \p s as it is; its normal must have unit length. */
  void push_back(const Surflet& s);

  /** \brief Appends \p s with its normal scaled to unit length.
   * \return false, appending nothing, if a coordinate is not finite or the normal has no direction
   * (zero or not finite). */
  bool appendChecked(const Surflet& s);

  /** \brief Surflet \p i < size(). */
  Surflet
  operator[](std::size_t i) const
  {
    return {x[i], y[i], z[i], nx[i], ny[i], nz[i]};
  }

  /** \brief The surflets at \p indices, in that order (each must be < size()). */
  SurfletSet subset(const std::vector<std::uint32_t>& indices) const;
};

/** \brief Centroid and distances of the surflets to it.
 *
 * Computed in double precision; all zero for an empty set. */
struct Extent {
  double centroid[3] = {0, 0, 0}; ///< mean position
  double r_mean = 0;              ///< mean distance to the centroid [Wahl 2007, Eq. 2.24]
  double r_max = 0;               ///< largest distance to the centroid
  double r_min = 0;               ///< smallest distance to the centroid [Wahl 2007, Sec. 6.1.1]
};

/** \brief The extent of \p set, whose positions must be finite. */
PCL_SURFLET_API Extent computeExtent(const SurfletSet& set);

/** \brief The set moved to its centroid and scaled by a power of two so that no coordinate exceeds
 * 1 in magnitude.
 *
 * The pair kernels compute in single precision; centring keeps that precision for clouds far from
 * the origin and the power of two (exact) keeps squares of absurdly large or small coordinates
 * finite. A length in the result is \p scale times the original length. */
struct UnitSurflets {
  SurfletSet set;   ///< in [-1, 1] along every axis
  double scale = 1; ///< a power of two
};

/** \brief \p set, whose positions must be finite, centred and scaled; without extent the scale is
 * 1. */
PCL_SURFLET_API UnitSurflets toUnitScale(const SurfletSet& set);

} // namespace pcl_surflet
