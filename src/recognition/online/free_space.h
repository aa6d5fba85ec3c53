/** \file
 * What a sensor has seen through; internal, not installed. */
#pragma once

#include "cells.h"

#include "pcl_surflet/core/linear_octree.h"

namespace pcl_surflet {
namespace online {

/** \brief The rays of a scan, from the sensor to each point. */
class FreeSpace {
public:
  /** \param ends of the rays; those that are not finite, or where the sensor is, are left out
   * \param radius rays that pass a place within it tell about the place
   * \param behind length by which they must go on behind a place that they have seen through
   * \param rays fewest that tell */
  FreeSpace(const SurfletSet& ends, const Place& sensor, double radius, double behind,
            std::size_t rays);

  /** \brief Does any ray pass within \p radius of \p place, before it ends or after? */
  bool looksAt(const Place& place, double radius) const;

  /** \brief Do enough rays pass \p place, and do all that pass end behind it? One that ends before
   * tells that the place is hidden, one that ends there that something is left of it. */
  bool isSeenThrough(const Place& place) const;

  /** \brief Those of \p cells that are seen through. */
  Indices seenThrough(const OnlineCells& cells, const Indices& candidates, unsigned threads) const;

private:
  double passing(const Place& place, double radius, std::vector<PlaceRange>& ranges) const;

  Place sensor_;
  double radius_, behind_;
  std::size_t rays_;
  LinearOctree directions_;     ///< of the rays, on the unit sphere
  std::vector<double> lengths_; ///< in the order of the octree's numbers
};

} // namespace online
} // namespace pcl_surflet
