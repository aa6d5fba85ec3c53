// Writes the surflet-pair histogram of a cloud as a PCD that pcl_viewer plots.

#include "app_common.h"
#include "queries.h"
#include "surfaces.h"

#include "pcl_adapters/pcd_content.h"
#include "pcl_surflet/surflet_pair_histogram.h"

#include <pcl/conversions.h>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_feature";

struct Options {
  double delta_max = 0;
  std::uint64_t pairs = 1000000, seed = 1;
  MissingNormals normals;
};

pcl::PointCloud<SurfletPairHistogram625>
describe(const std::string& path, const Options& o)
{
  const auto cloud = cloudOf(surfletsOf(readSurface(path, o.normals, 0), kQuerySurflets, o.seed));
  SurfletPairHistogramEstimation<pcl::PointNormal, pcl::PointNormal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(cloud);
  estimation.setDeltaMax(o.delta_max);
  estimation.setNumberOfPairs(o.pairs);
  estimation.setSeed(o.seed);
  pcl::PointCloud<SurfletPairHistogram625> descriptor;
  estimation.compute(descriptor);
  if (descriptor.empty())
    throw DataError("cannot describe '" + path + "': none of its " + std::to_string(cloud->size()) +
                    " oriented points makes a pair; give a cloud of at least two different points");
  return descriptor;
}

std::string
asPcd(const pcl::PointCloud<SurfletPairHistogram625>& descriptor)
{
  SourcePoints content;
  pcl::toPCLPointCloud2(descriptor, content.cloud);
  return detail::binaryPcd(content);
}

int
feature(int argc, char** argv)
{
  Options o;
  CommandLine line(kProgram, "IN.pcd OUT.pcd",
                   "Writes the surflet-pair histogram (625 bins) of a cloud or mesh (PCD, PLY, "
                   "OBJ, STL, OFF)\nas a PCD with one field, which pcl_viewer plots.");
  line.real("-delta_max", "D", "upper end of the distance, default: measured", o.delta_max, 1e-30,
            1e30);
  line.count("-pairs", "N", "pairs drawn, default 1000000; all if there are no more", o.pairs, 1,
             1000000000000ULL);
  addSeed(line, o.seed);
  addMissingNormals(line, o.normals);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(2, 2);
  requirePcdName(line.files()[1]);
  writeFile(line.files()[1], asPcd(describe(line.files()[0], o)));
  note("wrote '" + line.files()[1] + "'");
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return feature(argc, argv); });
}
