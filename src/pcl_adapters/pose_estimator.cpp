#include "pcl_surflet/impl/pose_estimator.hpp"
#include "pcl_surflet/surface_file.h"

#include <pcl/point_types.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace pcl_surflet {
namespace {

constexpr std::size_t kModelSurflets = 20000;

bool
isSurfaceFile(const std::filesystem::path& path)
{
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto known = {".pcd", ".ply", ".obj", ".stl", ".off"};
  return std::find(known.begin(), known.end(), ending) != known.end();
}

} // namespace

PoseModel
loadPoseModel(const std::string& path)
{
  return PoseModel::train(std::filesystem::path(path).stem().string(),
                          surfletsOf(loadSurface(path), kModelSurflets, 1));
}

std::vector<PoseModel>
loadPoseModels(const std::string& directory)
{
  std::error_code failure;
  std::vector<std::string> paths;
  for (std::filesystem::directory_iterator at(directory, failure), end; !failure && at != end;
       at.increment(failure))
    if (isSurfaceFile(at->path()))
      paths.push_back(at->path().string());
  if (failure)
    throw SurfaceFileError("cannot read '" + directory + "': " + failure.message() +
                           "; give a directory of meshes");
  if (paths.empty())
    throw SurfaceFileError("'" + directory +
                           "' holds no PCD, PLY, OBJ, STL or OFF file; put a mesh there for every "
                           "object, named like it");
  std::sort(paths.begin(), paths.end());
  std::vector<PoseModel> models;
  models.reserve(paths.size());
  for (const auto& path : paths) {
    models.push_back(loadPoseModel(path));
    for (std::size_t k = 0; k + 1 < models.size(); ++k)
      if (models[k].label() == models.back().label())
        throw SurfaceFileError("'" + paths[k] + "' and '" + path +
                               "' would both be the surface of '" + models[k].label() +
                               "'; leave one of them there");
  }
  return models;
}

Eigen::Isometry3f
toIsometry(const RigidMotion& motion)
{
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    for (int j = 0; j < 3; ++j)
      out.linear()(i, j) = motion.rotation[row][static_cast<std::size_t>(j)];
    out.translation()(i) = motion.translation[row];
  }
  return out.cast<float>();
}

SurfletSet
detail::pointsBeside(const SurfletSet& scene, const std::vector<char>& taken,
                     const SurfletSet& cluster, double radius)
{
  const Extent extent = computeExtent(cluster);
  const auto& c = extent.centroid;
  SurfletSet out;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const double x = scene.x[i] - c[0], y = scene.y[i] - c[1], z = scene.z[i] - c[2];
    if (taken[i] == 0 && x * x + y * y + z * z <= radius * radius)
      out.push_back(scene[i]);
  }
  return out;
}

} // namespace pcl_surflet

PCL_SURFLET_INSTANTIATE_PoseEstimator(pcl::PointXYZ, pcl::Normal);
PCL_SURFLET_INSTANTIATE_PoseEstimator(pcl::PointXYZRGB, pcl::Normal);
PCL_SURFLET_INSTANTIATE_PoseEstimator(pcl::PointNormal, pcl::PointNormal);
PCL_SURFLET_INSTANTIATE_PoseEstimator(pcl::PointXYZRGBNormal, pcl::PointXYZRGBNormal);
