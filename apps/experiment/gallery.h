/** \file
 * A picture of objects and their histograms, drawn by gnuplot. */
#pragma once

#include "experiment/objects.h"
#include "pcl_surflet/recognition/model_database.h"

#include <string>

namespace pcl_surflet {
namespace apps {

/** \brief Draws every object (shaded points) above its histogram (bins as a bar chart).
 *
 * Writes \p directory/objects.png and beside it the data and the script gallery.gp that made it.
 * \return an empty string, or why there is no picture (gnuplot missing or failing): the
 * experiment's numbers do not depend on it. \throws DataError if the files cannot be written */
std::string drawGallery(const std::vector<ExperimentObject>& objects, const ModelDatabase& database,
                        const std::string& directory);

} // namespace apps
} // namespace pcl_surflet
