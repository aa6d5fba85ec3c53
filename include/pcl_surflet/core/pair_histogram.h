/** \file
 * Resolution of a surflet-pair histogram, the mapping of features to bins, and integer counts. */
#pragma once

#include "pcl_surflet/core/surflet_pair.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief Number of uniform intervals per feature dimension [Wahl 2007, Eq. 2.22].
 *
 * Intervals cover alpha in [-pi, pi), beta and gamma in [-1, 1], delta in (0, delta_max].
 * Odd numbers keep the pairs of a plane (alpha = beta = gamma = 0) in the middle of a bin. */
struct PCL_SURFLET_API Resolution {
  static constexpr int kMaxPerDimension = 64; ///< most intervals of one dimension
  static constexpr int kMaxBins = 1 << 20;    ///< most bins of a histogram

  int alpha = 5; ///< intervals of alpha, in [1, 64]
  int beta = 5;  ///< intervals of beta, in [1, 64]
  int gamma = 5; ///< intervals of gamma, in [1, 64]
  int delta = 5; ///< intervals of delta, in [1, 64]

  /** \brief Number of bins, d = d_alpha * d_beta * d_gamma * d_delta. */
  int
  bins() const
  {
    return alpha * beta * gamma * delta;
  }
  /** \brief Number of bins of the three angular dimensions, the stride of delta. */
  int
  angularBins() const
  {
    return alpha * beta * gamma;
  }
  /** \brief Empty if every dimension is in [1, 64] and bins() <= 2^20, else what is wrong. */
  std::string problem() const;
  /** \brief As the programs write it: "5,5,5,5". */
  std::string toString() const;

  /** \brief Equal in every dimension. */
  bool
  operator==(const Resolution& o) const
  {
    return alpha == o.alpha && beta == o.beta && gamma == o.gamma && delta == o.delta;
  }
  /** \brief Different in some dimension: such histograms cannot be compared. */
  bool
  operator!=(const Resolution& o) const
  {
    return !(*this == o);
  }
};

/** \brief Linear bin index h(f), alpha fastest, then beta, gamma, delta [Wahl 2007, Fig. 2.2].
 *
 * Closed upper ends go to the last interval; delta above \p delta_max is clamped to the last delta
 * interval [Wahl 2007, Sec. 3.3]. \p delta_max must be positive. */
PCL_SURFLET_API int binIndex(const PairFeature& f, const Resolution& resolution, double delta_max);

/** \brief Counts of features per bin.
 *
 * Integers, so that the sum over blocks of work does not depend on their order. */
struct PCL_SURFLET_API PairHistogram {
  Resolution resolution;             ///< what the bins mean
  std::vector<std::uint64_t> counts; ///< resolution.bins() entries
  std::uint64_t features = 0;        ///< sum of counts
  std::uint64_t rejected = 0;        ///< pairs without feature

  /** \brief No feature yet. \param r must have no Resolution::problem() */
  explicit PairHistogram(const Resolution& r = {})
      : resolution(r), counts(static_cast<std::size_t>(r.bins()), 0)
  {
  }

  /** \brief Adds another histogram bin by bin [Wahl 2007, Sec. 2.3.1].
   * \throws std::invalid_argument if the resolutions differ. */
  void merge(const PairHistogram& other);

  /** \brief H(b) = count / number of features [Wahl 2007, Eq. 2.23]; all zero without features. */
  std::vector<double> normalized() const;
};

} // namespace pcl_surflet
