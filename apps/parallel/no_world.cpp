// Where there is no MPI at build time.
#include "app_common.h"
#include "parallel/launcher.h"
#include "parallel/world.h"

namespace pcl_surflet {
namespace apps {

std::unique_ptr<World>
joinWorld()
{
  if (launchOf().processes > 1)
    throw DataError("built without MPI, but started several times by a launcher of MPI programs; "
                    "build it with libboost-mpi-dev installed, start it once, or set "
                    "PCL_SURFLET_MPI=off to let every process do all the work");
  return nullptr;
}

} // namespace apps
} // namespace pcl_surflet
