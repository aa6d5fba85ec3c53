#include "pcl_surflet/core/triangle_mesh.h"

#include "mesh_checks.h"
#include "vector3.h"

#include <cmath>
#include <stdexcept>

namespace pcl_surflet {

using detail::Vector3;

namespace {

/** \brief Umbrella normals shorter than this share of the summed areas have cancelled: what is left
 * is rounding, not a direction. */
constexpr double kCancelledNormal = 1e-9;

Vector3
doubledAreaNormalOf(const TriangleMesh& mesh, const TriangleMesh::Triangle& t)
{
  return detail::doubledAreaNormal(detail::toVector3(mesh.vertices[t[0]]),
                                   detail::toVector3(mesh.vertices[t[1]]),
                                   detail::toVector3(mesh.vertices[t[2]]));
}

} // namespace

std::string
detail::indexProblem(const TriangleMesh& mesh)
{
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const auto v : mesh.triangles[i])
      if (v >= mesh.vertices.size())
        return "triangle " + std::to_string(i) + " refers to vertex " + std::to_string(v) +
               ", but there are only " + std::to_string(mesh.vertices.size()) +
               " vertices (counted from 0); export the mesh again or remove the triangle";
  return {};
}

std::string
detail::coordinateProblem(const TriangleMesh& mesh)
{
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    for (const float c : mesh.vertices[i])
      if (!std::isfinite(c))
        return "vertex " + std::to_string(i) +
               " has a coordinate that is not finite; remove it and its triangles";
  return {};
}

void
detail::checkIndices(const TriangleMesh& mesh, const char* caller)
{
  const std::string problem = indexProblem(mesh);
  if (!problem.empty())
    throw std::invalid_argument(std::string(caller) + ": " + problem);
}

std::string
TriangleMesh::problem() const
{
  if (triangles.empty())
    return "the mesh has no triangles; give a surface mesh, not a bare point cloud";
  std::string what = detail::indexProblem(*this);
  if (what.empty())
    what = detail::coordinateProblem(*this);
  if (what.empty() && !(surfaceArea(*this) > 0))
    what = "all " + std::to_string(triangles.size()) +
           " triangles have zero area; check the unit and the vertices of the mesh";
  return what;
}

double
surfaceArea(const TriangleMesh& mesh)
{
  detail::checkIndices(mesh, "surfaceArea");
  double doubled = 0;
  for (const auto& t : mesh.triangles)
    doubled += detail::norm(doubledAreaNormalOf(mesh, t));
  return doubled / 2;
}

std::vector<TriangleMesh::Point>
umbrellaNormals(const TriangleMesh& mesh)
{
  detail::checkIndices(mesh, "umbrellaNormals");
  // A_i n_i of Eq. 2.25 is half the cross product of two edges; the factor does not matter.
  std::vector<Vector3> sums(mesh.vertices.size(), Vector3{0, 0, 0});
  std::vector<double> areas(mesh.vertices.size(), 0.0);
  for (const auto& t : mesh.triangles) {
    const Vector3 n = doubledAreaNormalOf(mesh, t);
    const double area = detail::norm(n);
    for (const auto v : t) {
      sums[v] = detail::add(sums[v], n);
      areas[v] += area;
    }
  }
  std::vector<TriangleMesh::Point> normals(mesh.vertices.size(), TriangleMesh::Point{0, 0, 0});
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double length = detail::norm(sums[i]);
    if (length > kCancelledNormal * areas[i])
      normals[i] = detail::toFloat3(detail::scaled(sums[i], 1 / length));
  }
  return normals;
}

} // namespace pcl_surflet
