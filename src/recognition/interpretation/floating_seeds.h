/** \file
 * Floating cluster seeds: a seed's centre moves to where most surflets lie between the model's
 * r_min and r_max of it [Wahl 2007, Sec. 6.1.1]; internal, not installed. */
#pragma once

#include "steps.h"

#include <array>
#include <functional>
#include <vector>

namespace pcl_surflet {
namespace interpretation {

using Place = std::array<double, 3>;

/** \brief The energy of a centre q among surflets p, E(q) [Wahl 2007, Eq. 6.2-6.7].
 *
 * **Readings.** Printed, Eq. 6.4 grows with the distance; a surflet shall count while
 * r_min < |p - q| < r_max, so E_max falls with it. Printed, Eq. 6.7 normalises by a surflet at
 * (r_max - r_min) / 2 from q, which may lie within r_min; the greatest potential, which is to be 1,
 * is that at (r_min + r_max) / 2. */
class SeedEnergy {
public:
  /** \param s steepness of the sigmoids, in 1 / length, > 0; 0 <= r_min < r_max */
  SeedEnergy(double r_min, double r_max, double s);

  /** \brief E_pot of a surflet at the distance \p delta, at most 1 [Eq. 6.5]. */
  double potential(double delta) const;
  /** \brief E(q) [Eq. 6.2]. */
  double of(const std::vector<Place>& surflets, const Place& q) const;
  /** \brief Its derivative by q [Eq. 6.8-6.12]; a surflet exactly at q adds nothing. */
  Place gradient(const std::vector<Place>& surflets, const Place& q) const;
  /** \brief Farther than this from q, a surflet adds less than a thousandth of the greatest
   * potential. */
  double reach() const;
  double
  rMin() const
  {
    return r_min_;
  }

private:
  double r_min_, r_max_, s_, norm_;
};

/** \brief The surflets that can matter to a centre. */
using SurfletsAbout = std::function<const std::vector<Place>&(const Place& q)>;

/** \brief The places of a centre that climbs the energy: \p start and one more after each step,
 * which is r_min / (k + 1) long [Wahl 2007, Eq. 6.13]. Ends where the energy is flat. */
std::vector<Place> floatSeed(const SeedEnergy& energy, const SurfletsAbout& surflets, Place start,
                             unsigned steps);

} // namespace interpretation
} // namespace pcl_surflet
