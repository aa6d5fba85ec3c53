/** \file
 * What the environment tells of a launcher of MPI programs. */
#pragma once

namespace pcl_surflet {
namespace apps {

/** \brief How the process was started. */
struct Launch {
  bool by_launcher = false; ///< MPI is to be initialised
  int processes = 0;        ///< started together; 0: the launcher does not tell
};

/** \brief Looks for the variables of Open MPI, PMIx, MPICH and their relatives; PCL_SURFLET_MPI=off
 * makes every process work for itself. */
Launch launchOf();

} // namespace apps
} // namespace pcl_surflet
