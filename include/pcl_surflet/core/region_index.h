/** \file
 * What every space representation can do: region, nearest-neighbour and box search over points. */
#pragma once

#include "pcl_surflet/export.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_surflet {

/** \brief A place in space: x, y, z in the unit of the data. */
using Position = std::array<float, 3>;

/** \brief Number by which the user knows a point; the type of pcl::index_t in PCL's default build.
 */
using PointIndex = std::int32_t;

/** \brief Radius and squared radius as every search here uses them.
 *
 * A point p lies in F(r, q) where (dx * dx + dy * dy) + dz * dz <= float(r * r), computed in single
 * precision without contraction: the border is inclusive [Wahl 2007, Eq. 4.13] and the same for
 * every backend, instruction set and compiler. Squares beyond the float range are clamped to the
 * largest float, so points more than 1.8e19 away are never found. */
PCL_SURFLET_API float squaredRadius(double radius);

/** \brief Squared distance of the definition above. */
PCL_SURFLET_API float squaredDistance(const Position& p, const Position& q);

/** \brief A set of points prepared for searching.
 *
 * Const calls may run in several threads at once. Queries with a non-finite centre, a negative or
 * NaN radius, or an empty set yield an empty result. Result vectors are replaced; their capacity
 * is reused, so keep them between queries. */
class PCL_SURFLET_API RegionIndex {
public:
  virtual ~RegionIndex();

  /** \brief Number of points. */
  virtual std::size_t size() const = 0;

  /** \brief Bytes held, the capacity of vectors included. */
  virtual std::size_t memoryUsage() const = 0;

  /** \brief Region search: all points in F(r, q) [Wahl 2007, Eq. 4.13], in no particular but a
   * reproducible order.
   * \param[in] q centre
   * \param[in] radius radius r >= 0, inclusive; +inf is allowed
   * \param[out] indices the points found
   * \param[out] sqr_distances their squared distances, parallel to indices; nullptr if not wanted,
   * which is two to five times as fast in the linear octree */
  virtual void regionSearch(const Position& q, double radius, std::vector<PointIndex>& indices,
                            std::vector<float>* sqr_distances) const = 0;

  /** \brief The \p k points nearest to \p q (all if there are fewer), by ascending distance; ties
   * by ascending index. */
  virtual void nearestSearch(const Position& q, std::size_t k, std::vector<PointIndex>& indices,
                             std::vector<float>& sqr_distances) const = 0;

  /** \brief All points p with low <= p <= high in each coordinate; bounds may be infinite. */
  virtual void boxSearch(const Position& low, const Position& high,
                         std::vector<PointIndex>& indices) const = 0;
};

} // namespace pcl_surflet
