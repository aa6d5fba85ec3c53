/** \file
 * PCL's descriptors as recognisers. */
#pragma once

#include "experiment/recogniser.h"
#include "experiment/trials.h"

namespace pcl_surflet {
namespace apps {

/** \brief The descriptors named in \p names (peerDescriptors()), each trained with kTrainingRounds
 * samples an object and compared by the metric that recognises most of two further *training*
 * samples per object and setting of \p settings: no metric is chosen on test data.
 * \throws UsageError as requirePeers(), DataError if a descriptor fails on every training sample */
Recognisers peers(const Training& training, const std::vector<std::string>& names,
                  const std::vector<Setting>& settings);

/** \brief Before a long run. \throws UsageError if one of \p names is unknown */
void requirePeers(const std::vector<std::string>& names);

/** \brief Names of all peers, separated by commas. */
std::string peerNames();

} // namespace apps
} // namespace pcl_surflet
