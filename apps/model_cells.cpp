#include "model_cells.h"

#include "app_common.h"

#include "pcl_surflet/scene_interpreter.h"

#include <cmath>

namespace pcl_surflet {
namespace apps {

std::string
otherCells(const std::string& path, const ModelDatabase& database, double leaf)
{
  constexpr double kAlike = 0.1;
  const double trained = detail::trainedLeafOf(database);
  if (!(leaf > 0) || !(trained > 0) || std::abs(leaf / trained - 1) <= kAlike)
    return {};
  return path + ": the models were trained for cells of " + number(trained) + ", not of " +
         number(leaf) + "; see -leaf";
}

} // namespace apps
} // namespace pcl_surflet
