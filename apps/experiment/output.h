/** \file
 * What the experiments share: where results go, how progress shows. */
#pragma once

#include "app_common.h"

#include <cstddef>
#include <cstdio>
#include <functional>
#include <string>

namespace pcl_surflet {
namespace apps {

/** \brief Makes the directory \p path and those above it. \throws DataError */
void makeDirectory(const std::string& path);

/** \brief The statements of a script by which it draws \p picture, run by hand, and what
 * drawByGnuplot() asks for, run by it. */
std::string outputStatements(const std::string& picture);

/** \brief Runs gnuplot on \p script in \p directory, and writes what it draws to \p picture
 * there.
 * \return an empty string, or why there is no picture (gnuplot missing or failing): an
 * experiment's numbers do not depend on it
 * \throws DataError if the picture cannot be written */
std::string drawByGnuplot(const std::string& directory, const std::string& script,
                          const std::string& picture);

/** \brief snprintf into a string of at most 800 bytes, for tables; no program here sets a locale.
 */
template <class... Values>
std::string
formatted(const char* format, const Values&... values)
{
  char text[800];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

using ProgressFunction = std::function<void(std::size_t done, const std::string& what)>;

/** \brief Runs \p work with a function that shows its progress over \p steps. */
template <class Result, class Work>
Result
withProgress(std::size_t steps, const Work& work)
{
  Progress progress(steps);
  return work([&](std::size_t done, const std::string& what) { progress.show(done, what); });
}

} // namespace apps
} // namespace pcl_surflet
