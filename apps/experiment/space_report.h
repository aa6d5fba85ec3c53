/** \file
 * The region search experiment as the program runs it. */
#pragma once

#include "experiment/space.h"

namespace pcl_surflet {
namespace apps {

/** \brief Prints the times per radius and writes experiment_46.csv (times, relative times, memory),
 * .gnuplot and, by gnuplot, .svg (cuts through Fig. 4.8). \return the exit code
 * \throws DataError if the files cannot be written */
int reportSpace(const SpaceOptions& options);

} // namespace apps
} // namespace pcl_surflet
