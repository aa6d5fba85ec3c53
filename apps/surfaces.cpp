#include "surfaces.h"

namespace pcl_surflet {
namespace apps {

SurfaceFile
readSurface(const std::string& path, const MissingNormals& normals, std::uint64_t threads,
            bool keep_points)
{
  SurfaceFileOptions options;
  options.estimate_normals = static_cast<int>(normals.neighbours);
  options.sensor = normals.sensor;
  options.threads = static_cast<unsigned>(threads);
  options.keep_points = keep_points;
  return loadSurface(path, options);
}

std::string
losses(const std::string& path, const SurfaceFile& file)
{
  return file.rejected == 0 ? ""
                            : path + ": " + std::to_string(file.rejected) +
                                  " points left out (not finite or without usable normal)";
}

pcl::PointCloud<pcl::PointNormal>::Ptr
cloudOf(const SurfletSet& set)
{
  pcl::PointCloud<pcl::PointNormal>::Ptr cloud(new pcl::PointCloud<pcl::PointNormal>);
  cloud->reserve(set.size());
  for (std::size_t i = 0; i < set.size(); ++i)
    cloud->push_back(
        pcl::PointNormal(set.x[i], set.y[i], set.z[i], set.nx[i], set.ny[i], set.nz[i]));
  return cloud;
}

} // namespace apps
} // namespace pcl_surflet
