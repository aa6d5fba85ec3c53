/** \file
 * What the programs have in common that compare files with the models of a database. */
#pragma once

#include "app_common.h"

#include "pcl_surflet/core/surflet_set.h"

#include <cstdint>
#include <string>

namespace pcl_surflet {
namespace apps {

/** \brief Surflets drawn from a mesh to make a query of it. */
constexpr std::size_t kQuerySurflets = 4500;

struct QueryOptions {
  std::string database;
  std::uint64_t features = 0, top = 3, seed = 1, threads = 0;
  MissingNormals normals;
  bool csv = false;
};

/** \brief -database, -features, -top, -seed, -threads, -k, -csv. \p target holds the defaults.
 * \param columns of the table that -csv prints */
void addQueryOptions(CommandLine& line, const std::string& columns, QueryOptions& target);

/** \brief The oriented points of a file, or points drawn from its mesh.
 * \param threads for estimating normals, 0: all \throws SurfaceFileError */
SurfletSet queryFrom(const std::string& path, const QueryOptions& o, std::uint64_t threads);

/** \brief For a query that nothing can be said about. \throws DataError */
[[noreturn]] void refuseQueryWithoutPairs();

} // namespace apps
} // namespace pcl_surflet
