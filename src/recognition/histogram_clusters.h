/** \file
 * Groups of similar histograms. */
#pragma once

#include "pcl_surflet/core/pair_histogram.h"

#include <vector>

namespace pcl_surflet {

/** \brief Similar histograms and their sum. */
struct HistogramGroup {
  PairHistogram sum;
  std::vector<std::size_t> parts; ///< indices of the histograms, ascending
};

/** \brief Adds up \p histograms in at most \p groups groups of similar ones, the fullest group
 * first.
 *
 * k-means over the square roots of the shares, whose Euclidean distance is Hellinger's: rare bins
 * count as they do for the likelihood. Starts from the histogram in the middle and goes on with the
 * one farthest from all centres, so the result depends on the histograms alone. There are fewer
 * groups if there are fewer different histograms. Histograms must have one resolution; those
 * without features are left out. */
std::vector<HistogramGroup> groupHistograms(const std::vector<PairHistogram>& histograms,
                                            std::size_t groups);

/** \brief Kullback-Leibler divergence of the counted \p sample from \p h, whose bins are floored at
 * \p floor, in nats; positive infinity for a sample without features. */
double misfit(const PairHistogram& sample, const std::vector<double>& h, double floor);

/** \brief How badly \p samples fit the groups they were left out of: for each, its misfit to the
 * nearest group without histogram number i of the sample number i. Samples that no group is left
 * for are skipped. */
std::vector<double> leftOutMisfits(const std::vector<PairHistogram>& samples,
                                   const std::vector<PairHistogram>& histograms,
                                   const std::vector<HistogramGroup>& groups, double floor);

} // namespace pcl_surflet
