#include "queries.h"

#include "surfaces.h"

namespace pcl_surflet {
namespace apps {

void
addQueryOptions(CommandLine& line, const std::string& columns, QueryOptions& o)
{
  line.text("-database", "DB.pcd", "the database (required)", o.database);
  line.count("-features", "N", "pairs drawn per query, default 2000 or twice the number of bins",
             o.features, 1, 1000000000);
  line.count("-top", "N", "models listed per file, default " + std::to_string(o.top), o.top, 1,
             1000000);
  addSeed(line, o.seed);
  addThreads(line, o.threads);
  addMissingNormals(line, o.normals);
  line.flag("-csv", "print a table with the columns " + columns, o.csv);
}

SurfletSet
queryFrom(const std::string& path, const QueryOptions& o, std::uint64_t threads)
{
  return surfletsOf(readSurface(path, o.normals, threads), kQuerySurflets, o.seed);
}

void
refuseQueryWithoutPairs()
{
  throw DataError("no pair of its points has a feature; give a cloud of at least two different "
                  "points");
}

} // namespace apps
} // namespace pcl_surflet
