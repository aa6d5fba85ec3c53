/** \file
 * Which axis of a file points upwards. Here it is z. */
#pragma once

#include <array>
#include <string>

namespace pcl_surflet {
namespace apps {

/** \brief A rotation by right angles. */
struct UpAxis {
  std::string name; ///< as options call it
  std::array<std::size_t, 3> from;
  std::array<float, 3> sign;

  std::array<float, 3>
  turned(const std::array<float, 3>& v) const
  {
    return {sign[0] * v[from[0]], sign[1] * v[from[1]], sign[2] * v[from[2]]};
  }
};

/** \brief Turns the axis \p name upwards: x, y, z, -x, -y or -z; null if it is none of these. */
const UpAxis* upAxis(const std::string& name);

} // namespace apps
} // namespace pcl_surflet
