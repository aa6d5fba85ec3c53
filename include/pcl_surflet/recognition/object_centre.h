/** \file
 * Where the middle of an object is of which only a part is seen. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_surflet {

/** \brief Weights, without unit, of the vectors by which ObjectCentre guesses. All 0: the middle of
 * what is seen. */
using CentreWeights = std::array<double, 7>;

/** \brief Guesses the centroid of a whole object from the cells that are seen of it.
 *
 * The middle of what a sensor shows is not that of the object: it lies nearer to the sensor, and
 * higher than that of a thing with a foot that is not seen. Where it should be, relative to the
 * cells' middle x, is written as a sum of vectors that turn and move with the cells, so nothing
 * need be known of the sensor or of the object's posture. With d = (cell - x) / r_mean, n its
 * normal and E[.] the mean over the cells:
 *
 * E[n], E[n |d|], E[d |d|^2], E[n (n d)], E[d (n d)], E[d (n d)^2], E[d (n E[n])],
 *
 * times r_mean. Their weights are learned for each object from its views, by least squares: see
 * trainForSensors(). */
class PCL_SURFLET_API ObjectCentre {
public:
  /** \param r_mean of the model, > 0 */
  explicit ObjectCentre(double r_mean) : r_mean_(r_mean) {}

  /** \brief Another example. \param seen cells, not empty \param centre the whole object's */
  void learn(const SurfletSet& seen, const std::array<double, 3>& centre);

  /** \brief Weights that suit all examples best; all 0 if there were none. */
  CentreWeights weights() const;

  /** \brief The expected centroid of the object, at most 2 r_mean from the middle of its cells.
   * \param cells a scene
   * \param of indices of the object's cells; if empty, the guess is the origin
   * \param r_mean of the model, > 0
   * \param weights of the model */
  static std::array<double, 3> guess(const SurfletSet& cells, const std::vector<std::uint32_t>& of,
                                     double r_mean, const CentreWeights& weights);

private:
  double r_mean_;
  /** \brief Sums of the normal equations. */
  std::array<CentreWeights, std::tuple_size<CentreWeights>::value> matrix_{};
  CentreWeights right_{};
};

} // namespace pcl_surflet
