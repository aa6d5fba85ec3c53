// Writes the surflet-pair histogram of a cloud as a PCD that pcl_viewer plots.

#include "app_common.h"

#include "pcl_adapters/pcd_content.h"
#include "pcl_surflet/surface_file.h"
#include "pcl_surflet/surflet_pair_histogram.h"

#include <pcl/conversions.h>
#include <pcl/point_types.h>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_feature";

/** Surflets drawn from a mesh. */
constexpr std::size_t kMeshSurflets = 4500;

struct Options {
  double delta_max = 0;
  std::uint64_t pairs = 1000000, seed = 1, neighbours = 0;
};

pcl::PointCloud<pcl::PointNormal>::Ptr
toCloud(const SurfletSet& surflets)
{
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  cloud->reserve(surflets.size());
  for (std::size_t i = 0; i < surflets.size(); ++i) {
    const Surflet s = surflets[i];
    cloud->push_back(pcl::PointNormal(s.x, s.y, s.z, s.nx, s.ny, s.nz));
  }
  return cloud;
}

pcl::PointCloud<SurfletPairHistogram625>
describe(const std::string& path, const Options& o)
{
  SurfaceFileOptions loading;
  loading.estimate_normals = static_cast<int>(o.neighbours);
  const auto cloud = toCloud(surfletsOf(loadSurface(path, loading), kMeshSurflets, o.seed));
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
  detail::PcdContent content;
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
  addNeighbours(line, o.neighbours);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(2, 2);
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
