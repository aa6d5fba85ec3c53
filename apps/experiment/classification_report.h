/** \file
 * The classification experiment as the program runs it. */
#pragma once

#include <cstdint>
#include <string>

namespace pcl_surflet {
namespace apps {

struct ClassificationOptions {
  std::string meshes; ///< directory of the objects' meshes
  std::string out;    ///< directory of the results, made if missing
  std::uint64_t tests = 100, seed = 1, threads = 0;
};

/** \brief Table 3.1 and points of Fig. 3.5 and 3.6 by the likelihood criterion: prints the rates,
 * writes the database, the confusions and a picture. \return the exit code
 * \throws DataError, MeshFileError, std::invalid_argument, DatabaseFileError */
int reportClassification(const ClassificationOptions& options);

} // namespace apps
} // namespace pcl_surflet
