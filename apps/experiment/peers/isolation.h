/** \file
 * Runs what may crash in a process of its own. */
#pragma once

#include "experiment/peers/descriptors.h"

#include <functional>
#include <optional>

namespace pcl_surflet {
namespace apps {

struct IsolatedResult {
  Signatures signatures;
  double seconds = 0; ///< CPU time of the work, without the fork
};

/** \brief What \p work returns, computed in a forked child without messages.
 * \param seconds CPU time after which the child is ended
 * \return none if the child crashed, threw, took too long or could not be made */
std::optional<IsolatedResult> runIsolated(const std::function<Signatures()>& work,
                                          unsigned seconds = 20);

} // namespace apps
} // namespace pcl_surflet
