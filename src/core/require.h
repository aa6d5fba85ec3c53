#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

namespace pcl_surflet {

/** \brief A condition on a caller's values.
 * \param[in] what what should hold, in a sentence that names the value
 * \param[in] who the start of the message
 * \throws std::invalid_argument if it does not hold */
inline void
require(bool holds, const char* what, const char* who = "pcl_surflet: ")
{
  if (!holds)
    throw std::invalid_argument(std::string(who) + what);
}

/** \brief A size: positive and finite, or zero where \p or_zero says so. NaN is neither. */
inline void
requirePositive(double value, const char* name, const char* who, bool or_zero = false)
{
  if (!std::isfinite(value) || value < 0 || (value == 0 && !or_zero))
    throw std::invalid_argument(std::string(who) + name +
                                (or_zero ? " must be finite and not negative, not "
                                         : " must be positive and finite, not ") +
                                std::to_string(value));
}

} // namespace pcl_surflet
