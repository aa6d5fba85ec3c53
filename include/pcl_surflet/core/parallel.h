/** \file
 * The one way work is spread over threads. */
#pragma once

#include "pcl_surflet/export.h"

#include <cstddef>
#include <functional>

namespace pcl_surflet {

/** \brief Number of threads meant by a setNumberOfThreads() argument: 0 is all of the machine's. */
PCL_SURFLET_API unsigned resolveThreads(unsigned threads);

/** \brief Calls \p work(item, worker) for every item in [0, items), worker in [0, threads).
 *
 * Which worker gets an item is not determined; results must depend on the item alone or be sums of
 * integers. With one thread or one item everything runs in the calling thread. The first exception
 * thrown by \p work is rethrown here once all workers have stopped. */
PCL_SURFLET_API void
parallelFor(std::size_t items, unsigned threads,
            const std::function<void(std::size_t item, unsigned worker)>& work);

} // namespace pcl_surflet
