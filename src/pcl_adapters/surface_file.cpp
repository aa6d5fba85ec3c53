#include "pcl_surflet/surface_file.h"

#include "core/file_content.h"
#include "core/mesh_readers.h"
#include "pcl_adapters/cloud_columns.h"
#include "pcl_adapters/pcd_content.h"
#include "pcl_surflet/core/mesh_file.h"
#include "pcl_surflet/sensed_surface.h"

#include <pcl/conversions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <filesystem>

namespace pcl_surflet {
namespace {

using detail::Columns, detail::columns, detail::valueAt;

[[noreturn]] void
refuse(const std::string& path, const std::string& cause, const std::string& remedy)
{
  throw SurfaceFileError("cannot use '" + path + "': " + cause + "; " + remedy);
}

[[noreturn]] void
refuseWithoutNormals(const std::string& path)
{
  refuse(path, "its points have no normals (normal_x, normal_y, normal_z)",
         "add them, or have them estimated from k neighbours (option -k of the apps)");
}

/** \brief What is left of a cloud must be something. */
SurfaceFile
ofPoints(const std::string& path, ConvertedSurflets converted)
{
  if (converted.surflets.empty())
    refuse(path,
           "none of its " + std::to_string(converted.rejected) +
               " points is finite and has a usable normal",
           "check the coordinates and normals, or have normals estimated from k neighbours (option "
           "-k of "
           "the apps)");
  SurfaceFile file;
  file.surflets = std::move(converted.surflets);
  file.indices = std::move(converted.indices);
  file.rejected = converted.rejected;
  return file;
}

/** \brief Adds the point \p s of index \p i, if it can be used. */
void
append(const Surflet& s, std::size_t i, ConvertedSurflets& converted)
{
  if (converted.surflets.appendChecked(s))
    converted.indices.push_back(static_cast<pcl::index_t>(i));
  else
    ++converted.rejected;
}

SurfaceFile
ofMesh(const std::string& path, TriangleMesh mesh)
{
  if (const auto problem = mesh.problem(); !problem.empty())
    refuse(path, problem, "mend the mesh or export it again");
  SurfaceFile file;
  file.mesh = std::move(mesh);
  return file;
}

SourcePoints
readCloud(const std::string& path)
{
  constexpr const char* kRemedy = "export it again as PCD";
  detail::checkedFileSize(path);
  SourcePoints raw;
  if (const auto problem = detail::readPcd(path, raw); !problem.empty())
    refuse(path, problem, kRemedy);
  if (raw.size() == 0)
    refuse(path, "it has no points", kRemedy);
  return raw;
}

pcl::PointCloud<pcl::PointXYZ>
coordinates(const SourcePoints& raw, const Columns& xyz)
{
  pcl::PointCloud<pcl::PointXYZ> out(raw.cloud.width, raw.cloud.height);
  out.is_dense = false; // PCL then looks for itself, whatever the file says
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {valueAt(raw.cloud, i, *xyz[0]), valueAt(raw.cloud, i, *xyz[1]),
              valueAt(raw.cloud, i, *xyz[2])};
  return out;
}

/** \brief A depth image has its normals from its neighbourhood; points need to be told of how many.
 */
SurfaceFile
withEstimatedNormals(const std::string& path, const pcl::PointCloud<pcl::PointXYZ>& points,
                     const Eigen::Vector3f& viewpoint, const SurfaceFileOptions& options)
{
  const Eigen::Vector3f sensor =
      options.sensor ? Eigen::Map<const Eigen::Vector3d>(options.sensor->data()).cast<float>()
                     : viewpoint;
  if (options.estimate_normals > 0)
    return ofPoints(path,
                    surfletsFromPoints(points, sensor, options.estimate_normals, options.threads));
  if (points.width >= 3 && points.height >= 3)
    return ofPoints(path, surfletsFromDepth(points, sensor));
  refuseWithoutNormals(path);
}

SurfaceFile
surfaceOf(const std::string& path, const SourcePoints& raw, const SurfaceFileOptions& options)
{
  const Columns xyz = columns(raw.cloud, {"x", "y", "z"});
  if (xyz[0] == nullptr)
    refuse(path, "it has no fields x, y, z of type F", "give a cloud of points");
  const Columns n = columns(raw.cloud, {"normal_x", "normal_y", "normal_z"});
  if (n[0] == nullptr)
    return withEstimatedNormals(path, coordinates(raw, xyz), raw.origin.head<3>(), options);
  ConvertedSurflets converted;
  for (std::size_t i = 0; i < raw.size(); ++i)
    append({valueAt(raw.cloud, i, *xyz[0]), valueAt(raw.cloud, i, *xyz[1]),
            valueAt(raw.cloud, i, *xyz[2]), valueAt(raw.cloud, i, *n[0]),
            valueAt(raw.cloud, i, *n[1]), valueAt(raw.cloud, i, *n[2])},
           i, converted);
  if (converted.surflets.empty() && options.estimate_normals > 0) // fields that nobody filled
    return withEstimatedNormals(path, coordinates(raw, xyz), raw.origin.head<3>(), options);
  return ofPoints(path, std::move(converted));
}

SurfaceFile
loadPcdSurface(const std::string& path, const SurfaceFileOptions& options)
{
  const auto raw = std::make_shared<const SourcePoints>(readCloud(path));
  SurfaceFile file = surfaceOf(path, *raw, options);
  if (options.keep_points)
    file.points = raw;
  return file;
}

/** \brief The vertices as a cloud. Other properties of a PLY are not read. */
std::shared_ptr<const SourcePoints>
verticesOf(const detail::PlyContent& content)
{
  pcl::PointCloud<pcl::PointXYZ> points;
  for (const auto& p : content.mesh.vertices)
    points.push_back({p[0], p[1], p[2]});
  const auto out = std::make_shared<SourcePoints>();
  pcl::toPCLPointCloud2(points, out->cloud);
  return out;
}

SurfaceFile
surfaceOf(const std::string& path, const detail::PlyContent& content,
          const SurfaceFileOptions& options)
{
  const auto& vertices = content.mesh.vertices;
  ConvertedSurflets converted;
  for (std::size_t i = 0; i < content.normals.size(); ++i) {
    const auto& p = vertices[i];
    const auto& n = content.normals[i];
    append({p[0], p[1], p[2], n[0], n[1], n[2]}, i, converted);
  }
  const bool none_usable = converted.surflets.empty() && options.estimate_normals > 0;
  if (content.normals.empty() || none_usable) {
    pcl::PointCloud<pcl::PointXYZ> points;
    for (const auto& p : vertices)
      points.push_back({p[0], p[1], p[2]});
    points.is_dense = false;
    return withEstimatedNormals(path, points, Eigen::Vector3f::Zero(), options);
  }
  return ofPoints(path, std::move(converted));
}

SurfaceFile
loadPlySurface(const std::string& path, const SurfaceFileOptions& options)
{
  detail::PlyContent content = detail::loadPly(path);
  if (!content.mesh.triangles.empty())
    return ofMesh(path, std::move(content.mesh));
  SurfaceFile file = surfaceOf(path, content, options);
  if (options.keep_points)
    file.points = verticesOf(content);
  return file;
}

std::string
lowerEnding(const std::string& path)
{
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return ending;
}

} // namespace

SurfaceFileError::~SurfaceFileError() = default;

SurfaceFile
loadSurface(const std::string& path, const SurfaceFileOptions& options)
{
  const std::string ending = lowerEnding(path);
  try {
    if (ending == ".pcd")
      return loadPcdSurface(path, options);
    if (ending == ".ply")
      return loadPlySurface(path, options);
    if (ending == ".obj")
      return ofMesh(path, detail::loadObj(path));
    if (ending == ".stl")
      return ofMesh(path, detail::loadStl(path));
    if (ending == ".off")
      return ofMesh(path, loadOff(path));
  }
  catch (const MeshFileError& error) {
    throw SurfaceFileError(std::string("cannot use ") + error.what());
  }
  catch (const std::invalid_argument& error) { // e.g. options.estimate_normals below 3
    throw SurfaceFileError("cannot use '" + path + "': " + error.what());
  }
  catch (const std::bad_alloc&) {
    refuse(path, "it does not fit into memory", "reduce it first");
  }
  refuse(path, "the kind of file is not known from its ending",
         "give a file that ends in .pcd, .ply, .obj, .stl or .off");
}

SurfletSet
surfletsOf(const SurfaceFile& file, std::size_t mesh_surflets, std::uint64_t seed)
{
  return file.mesh ? sampleIsoMesh(*file.mesh, mesh_surflets, seed) : file.surflets;
}

} // namespace pcl_surflet
