#include "file_content.h"
#include "mesh_readers.h"
#include "pcl_surflet/core/mesh_file.h"

#include <cstring>
#include <unordered_map>

namespace pcl_surflet {
namespace detail {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kFacetBytes = 50;

/** \brief Collects corners, three to a triangle, and merges equal ones. */
class CornerMerger {
public:
  void
  append(const TriangleMesh::Point& p)
  {
    const auto [at, is_new] = index_.try_emplace(p, mesh_.vertices.size());
    if (is_new)
      mesh_.vertices.push_back(p);
    triangle_[corner_] = static_cast<std::uint32_t>(at->second);
    corner_ = (corner_ + 1) % 3;
    if (corner_ == 0)
      mesh_.triangles.push_back(triangle_);
  }
  bool
  complete() const
  {
    return corner_ == 0;
  }
  TriangleMesh
  take()
  {
    return std::move(mesh_);
  }

private:
  struct Hash {
    std::size_t
    operator()(const TriangleMesh::Point& p) const
    {
      std::size_t h = 0;
      for (const float c : p)
        h = h * 0x9e3779b97f4a7c15ULL + std::hash<float>{}(c);
      return h ^ (h >> 29);
    }
  };

  TriangleMesh mesh_;
  TriangleMesh::Triangle triangle_{};
  unsigned corner_ = 0;
  std::unordered_map<TriangleMesh::Point, std::size_t, Hash> index_;
};

std::uint32_t
littleEndian32(const char* bytes)
{
  std::uint32_t v = 0;
  for (int k = 3; k >= 0; --k)
    v = v << 8 | static_cast<unsigned char>(bytes[k]);
  return v;
}

TriangleMesh
readBinary(const std::string& data, std::size_t triangles)
{
  CornerMerger merger;
  for (std::size_t i = 0; i < triangles; ++i) {
    const char* corner = data.data() + kHeaderBytes + i * kFacetBytes + 12; // behind the normal
    for (int c = 0; c < 3; ++c) {
      TriangleMesh::Point p{};
      for (float& coordinate : p) {
        const std::uint32_t bits = littleEndian32(corner);
        std::memcpy(&coordinate, &bits, sizeof bits);
        corner += sizeof bits;
      }
      merger.append(p);
    }
  }
  return merger.take();
}

TriangleMesh
readText(const std::string& path, const std::string& data)
{
  TextLines lines(path, data);
  CornerMerger merger;
  std::vector<std::string_view> tokens;
  bool ended = false;
  for (bool first = true; lines.next(tokens); first = false) {
    if (tokens[0] == "endsolid")
      ended = true;
    else if (tokens[0] == "vertex" && tokens.size() == 4) {
      TriangleMesh::Point p{};
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = static_cast<float>(lines.number(tokens[k + 1]));
      merger.append(p);
    }
    else if (!first && tokens[0] != "solid" && tokens[0] != "facet" && tokens[0] != "outer" &&
             tokens[0] != "endloop" && tokens[0] != "endfacet")
      lines.fail("this is neither a facet nor a vertex of three coordinates",
                 "the file is damaged; export the mesh again");
  }
  if (!ended || !merger.complete())
    lines.fail("the file ends before 'endsolid'", "it is truncated; export the mesh again");
  return merger.take();
}

} // namespace

TriangleMesh
loadStl(const std::string& path)
{
  const std::string data = fileContent(path);
  TriangleMesh mesh;
  // Binary files may begin with "solid" too: the size decides.
  const std::size_t claimed =
      data.size() >= kHeaderBytes ? littleEndian32(data.data() + kHeaderBytes - 4) : 0;
  if (data.size() >= kHeaderBytes && data.size() == kHeaderBytes + claimed * kFacetBytes)
    mesh = readBinary(data, claimed);
  else if (data.compare(0, 5, "solid") == 0 && data.find('\0') == std::string::npos)
    mesh = readText(path, data);
  else
    throw MeshFileError(path + ": not an STL file, or damaged: its header claims " +
                        std::to_string(claimed) + " triangles, which does not fit its " +
                        std::to_string(data.size()) + " bytes; export the mesh again");
  if (mesh.triangles.empty())
    throw MeshFileError(path + ": the file has no triangles; export the mesh again");
  return mesh;
}

} // namespace detail
} // namespace pcl_surflet
