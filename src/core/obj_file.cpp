#include "file_content.h"
#include "mesh_readers.h"
#include "pcl_surflet/core/mesh_file.h"

namespace pcl_surflet {
namespace detail {
namespace {

/** \brief Vertex of "7", "7/1", "7//3" or "-1" (the last vertex so far), counted from 0. */
std::uint32_t
cornerIndex(const TextLines& lines, std::string_view token, std::size_t vertices)
{
  const std::int64_t given = lines.integer(token.substr(0, token.find('/')));
  const auto known = static_cast<std::int64_t>(vertices);
  if (given == 0 || given > known || given < -known)
    lines.fail("a face refers to vertex " + std::to_string(given) + ", but there are " +
                   std::to_string(known) + " before it (counted from 1)",
               "correct it or export the mesh again");
  return static_cast<std::uint32_t>(given > 0 ? given - 1 : known + given);
}

void
appendFace(const TextLines& lines, const std::vector<std::string_view>& tokens, TriangleMesh& mesh)
{
  std::uint32_t first = 0, previous = 0;
  for (std::size_t k = 1; k < tokens.size(); ++k) {
    const std::uint32_t v = cornerIndex(lines, tokens[k], mesh.vertices.size());
    if (k == 1)
      first = v;
    if (k >= 3)
      mesh.triangles.push_back({first, previous, v});
    previous = v;
  }
}

} // namespace

TriangleMesh
loadObj(const std::string& path)
{
  const std::string text = fileContent(path);
  TextLines lines(path, text);
  TriangleMesh mesh;
  std::vector<std::string_view> tokens;
  while (lines.next(tokens)) {
    if (tokens[0] == "v") {
      if (tokens.size() < 4)
        lines.fail("a vertex has fewer than three coordinates", "export the mesh again");
      TriangleMesh::Point p{};
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = static_cast<float>(lines.number(tokens[k + 1]));
      mesh.vertices.push_back(p);
    }
    else if (tokens[0] == "f")
      appendFace(lines, tokens, mesh);
  }
  if (mesh.vertices.empty())
    throw MeshFileError(path + ": not an OBJ file: it has no vertices (lines beginning with v); "
                               "give a Wavefront OBJ in text form");
  if (mesh.triangles.empty())
    throw MeshFileError(path + ": the file has no faces; give a surface mesh, or save the points "
                               "with normals as PLY or PCD");
  return mesh;
}

} // namespace detail
} // namespace pcl_surflet
