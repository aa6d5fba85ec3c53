#include "up_axis.h"

#include <algorithm>

namespace pcl_surflet {
namespace apps {

const UpAxis*
upAxis(const std::string& name)
{
  static const std::array<UpAxis, 6> axes = {{{"z", {0, 1, 2}, {1, 1, 1}},
                                              {"-z", {0, 1, 2}, {1, -1, -1}},
                                              {"y", {0, 2, 1}, {1, -1, 1}},
                                              {"-y", {0, 2, 1}, {1, 1, -1}},
                                              {"x", {2, 1, 0}, {-1, 1, 1}},
                                              {"-x", {2, 1, 0}, {1, 1, -1}}}};
  const auto at =
      std::find_if(axes.begin(), axes.end(), [&](const UpAxis& axis) { return axis.name == name; });
  return at == axes.end() ? nullptr : &*at;
}

} // namespace apps
} // namespace pcl_surflet
