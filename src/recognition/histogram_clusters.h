/** \file
 * Groups of similar histograms. */
#pragma once

#include "pcl_surflet/core/pair_histogram.h"

#include <vector>

namespace pcl_surflet {

/** \brief Adds up \p histograms in at most \p groups groups of similar ones, the fullest group
 * first.
 *
 * k-means over the square roots of the shares, whose Euclidean distance is Hellinger's: rare bins
 * count as they do for the likelihood. Starts from the histogram in the middle and goes on with the
 * one farthest from all centres, so the result depends on the histograms alone. There are fewer
 * groups if there are fewer different histograms. Histograms must have one resolution; those
 * without features are left out. */
std::vector<PairHistogram> groupHistograms(const std::vector<PairHistogram>& histograms,
                                           std::size_t groups);

} // namespace pcl_surflet
