#include "picture.h"

#include "app_common.h"

#include <filesystem>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

namespace pcl_surflet {
namespace apps {

void
drawPicture(const std::string& labelled, const std::string& database, const std::string& picture,
            const std::string& overlay)
{
  std::error_code failure;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", failure);
  const std::string viewer = (self.parent_path() / "pcl_surflet_view").string();
  const pid_t child = ::fork();
  if (child == 0) {
    std::vector<const char*> arguments = {viewer.c_str(), "-database", database.c_str(), "-picture",
                                          picture.c_str()};
    if (!overlay.empty())
      arguments.insert(arguments.end(), {"-overlay", overlay.c_str()});
    arguments.insert(arguments.end(), {"--", labelled.c_str(), nullptr});
    ::execv(viewer.c_str(), const_cast<char**>(arguments.data()));
    ::_exit(127);
  }
  int status = 0;
  if (child > 0)
    ::waitpid(child, &status, 0);
  const bool ended = child > 0 && WIFEXITED(status);
  if (!ended || WEXITSTATUS(status) == 127)
    throw DataError("cannot draw '" + picture + "': '" + viewer +
                    (ended ? "' cannot be run; build or install it" : "' crashed"));
  if (WEXITSTATUS(status) != kOk)
    throw DataError("cannot draw '" + picture + "': see above");
}

} // namespace apps
} // namespace pcl_surflet
