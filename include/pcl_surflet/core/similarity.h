/** \file
 * The similarity criteria between a model's histogram H and a query's Q, and the penalty term. */
#pragma once

#include "pcl_surflet/export.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief The criteria of [Wahl 2007, Sec. 3.3, 3.4]. */
enum class Criterion {
  SquaredEuclidean,    ///< sum (H-Q)^2, Eq. 3.5; smaller is better
  Intersection,        ///< sum min(H,Q), Eq. 3.7; larger is better
  ChiSquared1,         ///< sum (H-Q)^2 / H, Eq. 3.9; smaller is better
  ChiSquared2,         ///< sum (H-Q)^2 / (H+Q), Eq. 3.10; smaller is better
  KullbackLeibler,     ///< sum (Q-H) ln (Q/H), Eq. 3.14; smaller is better
  Likelihood,          ///< mean ln H of the features, Eq. 3.16, 3.17; larger is better
  NormalizedLikelihood ///< sum of ln H of the features / sum of ln H of the bins, Eq. 3.18; smaller
};

/** \brief Whether less of this criterion is more alike. */
PCL_SURFLET_API bool smallerIsBetter(Criterion criterion);

/** \brief Name used by the apps: euclidean, intersection, chi1, chi2, kullback, likelihood,
 * normalized. */
PCL_SURFLET_API const char* criterionName(Criterion criterion);
/** \brief The criterion of that name (criterionName()), or nothing. */
PCL_SURFLET_API std::optional<Criterion> criterionByName(const std::string& name);
/** \brief All criteria, in the order of the enumeration. */
PCL_SURFLET_API const std::vector<Criterion>& allCriteria();

/** \brief Shares of the bins, as many as Resolution::bins(): >= 0, sum 1. */
using Histogram = std::vector<double>;

/** \name Criteria between two normalised histograms of equal size
 * H must be free of zeros (penalize()) for ChiSquared1, KullbackLeibler and the likelihoods. */
///@{
/** \brief Eq. 3.5, in [0, 2]. */
PCL_SURFLET_API double squaredEuclidean(const Histogram& h, const Histogram& q);
/** \brief Eq. 3.7, in [0, 1]; 1 for equal histograms. */
PCL_SURFLET_API double intersection(const Histogram& h, const Histogram& q);
/** \brief Eq. 3.9, >= 0. */
PCL_SURFLET_API double chiSquared1(const Histogram& h, const Histogram& q);
/** \brief Eq. 3.10, in [0, 2]; bins empty in both contribute nothing. */
PCL_SURFLET_API double chiSquared2(const Histogram& h, const Histogram& q);
/** \brief Eq. 3.14, >= 0. Where Q is zero its limit is taken (Q ln Q = 0) and ln Q is floored at ln
 * \p h_min: such a bin contributes H ln (H / h_min). */
PCL_SURFLET_API double kullbackLeibler(const Histogram& h, const Histogram& q, double h_min);
/** \brief Mean of ln H over the features of Q, Eq. 3.16 and 3.17, <= 0. \p log_h holds
 * ln H. */
PCL_SURFLET_API double meanLogLikelihood(const Histogram& log_h, const Histogram& q);
///@}

/** \brief Smallest positive value, or 0 if there is none. */
PCL_SURFLET_API double smallestPositive(const Histogram& h);

/** \brief Penalty term [Wahl 2007, Eq. 3.20-3.22]: zero bins become \p h_min and the others are
 * multiplied by (1 - eta h_min), eta = number of zero bins, so that the sum stays 1.
 *
 * With an absolute floor (\p h_min above the smallest bin) bins below it are raised to it as well,
 * otherwise a rare feature would count for less than an impossible one, and the bins above share
 * what is left. \p h_min must be positive and below 1 / number of bins, else
 * std::invalid_argument. */
PCL_SURFLET_API Histogram penalize(const Histogram& h, double h_min);

} // namespace pcl_surflet
