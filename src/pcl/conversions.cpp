#include "pcl_surflet/conversions.h"

#include <pcl/conversions.h>
#include <pcl/point_types.h>

namespace pcl_surflet {
namespace {

bool
hasCoordinates(const pcl::PCLPointCloud2& cloud)
{
  int found = 0;
  for (const auto& field : cloud.fields)
    if (field.name == "x" || field.name == "y" || field.name == "z")
      found += field.datatype == pcl::PCLPointField::FLOAT32 &&
               field.offset + sizeof(float) <= cloud.point_step;
  return found == 3 &&
         cloud.data.size() >= std::size_t{cloud.point_step} * cloud.width * cloud.height;
}

} // namespace

TriangleMesh
toTriangleMesh(const pcl::PolygonMesh& mesh)
{
  if (!hasCoordinates(mesh.cloud))
    throw std::invalid_argument("pcl_surflet: the mesh's vertices have no x, y, z of FLOAT32");
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2(mesh.cloud, vertices);
  TriangleMesh out;
  out.vertices.reserve(vertices.size());
  for (const auto& p : vertices)
    out.vertices.push_back({p.x, p.y, p.z});
  for (const auto& polygon : mesh.polygons) {
    for (const auto v : polygon.vertices)
      if (static_cast<std::size_t>(v) >= vertices.size())
        throw std::invalid_argument("pcl_surflet: a face of the mesh has a vertex index beyond its " +
                                    std::to_string(vertices.size()) + " vertices");
    for (std::size_t k = 2; k < polygon.vertices.size(); ++k)
      out.triangles.push_back({static_cast<std::uint32_t>(polygon.vertices[0]),
                               static_cast<std::uint32_t>(polygon.vertices[k - 1]),
                               static_cast<std::uint32_t>(polygon.vertices[k])});
  }
  return out;
}

} // namespace pcl_surflet
