#include "launcher.h"

#include <cstdlib>
#include <string>

namespace pcl_surflet {
namespace apps {

Launch
launchOf()
{
  Launch launch;
  if (const char* wish = std::getenv("PCL_SURFLET_MPI");
      wish != nullptr && std::string(wish) == "off")
    return launch;
  for (const char* size : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* text = std::getenv(size)) {
      launch.by_launcher = true;
      launch.processes = std::atoi(text);
    }
  // srun --mpi=pmix and Open MPI 5 tell the rank only.
  launch.by_launcher = launch.by_launcher || std::getenv("PMIX_RANK") != nullptr;
  return launch;
}

} // namespace apps
} // namespace pcl_surflet
