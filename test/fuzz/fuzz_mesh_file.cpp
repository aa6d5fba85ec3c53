// A mesh reader, chosen by PCL_SURFLET_FUZZ_READER and PCL_SURFLET_FUZZ_ENDING: what it takes must
// be a mesh that can be sampled, what it refuses must be a MeshFileError with a remedy.
#include "input_file.h"

#include "core/mesh_readers.h"
#include "pcl_surflet/core/mesh_file.h"

#include <cstdlib>
#include <cstring>

using namespace pcl_surflet;

namespace {

[[maybe_unused]] TriangleMesh
meshOf(TriangleMesh mesh)
{
  return mesh;
}

[[maybe_unused]] TriangleMesh
meshOf(detail::PlyContent content)
{
  if (!content.normals.empty() && content.normals.size() != content.mesh.vertices.size())
    std::abort();
  return std::move(content.mesh);
}

} // namespace

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  static const fuzz::InputFile file(PCL_SURFLET_FUZZ_ENDING);
  try {
    const TriangleMesh mesh = meshOf(PCL_SURFLET_FUZZ_READER(file.hold(data, size)));
    if (mesh.problem().empty() && !mesh.triangles.empty())
      sampleSurface(mesh, 64, 1);
  }
  catch (const MeshFileError& error) {
    if (std::strchr(error.what(), ';') == nullptr)
      std::abort(); // no remedy
  }
  return 0;
}
