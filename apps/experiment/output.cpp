#include "experiment/output.h"

#include "app_common.h"

#include <cstdlib>
#include <filesystem>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief \p text as one word of a POSIX shell. */
std::string
shellQuoted(const std::string& text)
{
  std::string quoted = "'";
  for (const char c : text)
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

} // namespace

void
makeDirectory(const std::string& path)
{
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error)
    throw DataError("cannot make the directory '" + path + "': " + error.message() +
                    "; give another one by -out");
}

std::string
drawByGnuplot(const std::string& directory, const std::string& script)
{
  // Absolute, lest a leading dash make an option of it.
  const std::string place = std::filesystem::absolute(directory).string();
  const std::string command = "cd " + shellQuoted(place) + " && gnuplot " + shellQuoted(script);
  if (std::system(command.c_str()) != 0)
    return "gnuplot is missing or failed; install gnuplot-nox and run it on " + script;
  return {};
}

} // namespace apps
} // namespace pcl_surflet
