/** \file
 * Cells that models were trained for, and those that a program looks at. */
#pragma once

#include "pcl_surflet/recognition/model_database.h"

#include <string>

namespace pcl_surflet {
namespace apps {

/** \brief What to say if cells of edge \p leaf (0: the default) are others than the models of \p
 * path were trained for, by more than a tenth: in those an object looks otherwise. Empty if they
 * are not, or nobody knows. */
std::string otherCells(const std::string& path, const ModelDatabase& database, double leaf);

} // namespace apps
} // namespace pcl_surflet
