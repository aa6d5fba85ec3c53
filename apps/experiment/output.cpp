#include "experiment/output.h"

#include "app_common.h"

#include <cstdio>
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

/** \brief What the command of a shell prints, empty if it fails. */
std::string
outputOf(const std::string& command)
{
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr)
    return {};
  std::string out;
  char block[4096];
  while (const std::size_t read = std::fread(block, 1, sizeof block, pipe))
    out.append(block, read);
  return ::pclose(pipe) == 0 ? out : std::string();
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
outputStatements(const std::string& picture)
{
  return "if (!exists('picture')) picture = '" + picture + "'\nset output picture\n";
}

std::string
drawByGnuplot(const std::string& directory, const std::string& script, const std::string& picture)
{
  // By itself gnuplot leaves half a picture on a full disk, and says that all went well. The path
  // is absolute, lest a leading dash make an option of it.
  const std::string place = std::filesystem::absolute(directory).string();
  const std::string drawn =
      outputOf("cd " + shellQuoted(place) + " && gnuplot -e \"picture='/dev/stdout'\" " +
               shellQuoted(script));
  if (drawn.empty())
    return "gnuplot is missing or failed; install gnuplot-nox and run it on " + script;
  writeFile(directory + "/" + picture, drawn);
  return {};
}

} // namespace apps
} // namespace pcl_surflet
