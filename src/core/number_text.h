/** \file
 * Numbers in messages. */
#pragma once

#include <charconv>
#include <string>

namespace pcl_surflet {
namespace detail {

/** \brief \p value with six significant digits, as text that every locale reads alike;
 * std::to_string() shows 1e-9 as 0.000000. */
inline std::string
numberText(double value)
{
  char digits[32];
  const auto end =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 6).ptr;
  return {digits, end};
}

} // namespace detail
} // namespace pcl_surflet
