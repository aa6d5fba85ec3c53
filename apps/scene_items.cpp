#include "scene_items.h"

#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/mesh_file.h"
#include "pcl_surflet/surface_file.h"

#include <cmath>
#include <filesystem>
#include <optional>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief The mesh turned so that \p axis becomes z. */
TriangleMesh
turnedUp(TriangleMesh mesh, const std::string& axis)
{
  for (auto& p : mesh.vertices)
    if (axis == "y") // (x, y, z) -> (x, -z, y)
      p = {p[0], -p[2], p[1]};
    else if (axis == "x") // -> (-z, y, x)
      p = {-p[2], p[1], p[0]};
  return mesh;
}

/** \brief An ITEM of the command line: a ready-made shape, or a mesh. */
struct ItemSource {
  std::string label;
  std::optional<Shape> shape;
  TriangleMesh mesh; ///< scaled and upright; empty for shapes
};

/** \brief SHAPE or FILE[:DIAMETER[:UP]]. */
ItemSource
sourceOf(const std::string& text)
{
  const auto spec = parts(text, ':');
  if (auto shape = shapeByName(spec[0])) {
    if (spec.size() > 1)
      throw UsageError("'" + spec[0] +
                       "' is a ready-made shape and has its size and posture; give "
                       "its name alone, or a mesh file");
    return {spec[0], std::move(shape), {}};
  }
  if (spec.size() > 3 || (spec.size() == 3 && spec[2] != "x" && spec[2] != "y" && spec[2] != "z"))
    throw UsageError("'" + text + "' is not FILE:DIAMETER:UP, where UP is x, y or z");
  const double diameter =
      spec.size() > 1 ? parseReal("DIAMETER of " + spec[0], spec[1], 1e-6, 1e6) : 0;
  const SurfaceFile file = loadSurface(spec[0]);
  if (!file.mesh)
    throw DataError(spec[0] + ": holds points; give a file with faces, or the name of a shape");
  const TriangleMesh upright = spec.size() == 3 ? turnedUp(*file.mesh, spec[2]) : *file.mesh;
  return {stemOf(spec[0]), {}, diameter > 0 ? scaledToDiameter(upright, diameter) : upright};
}

} // namespace

TriangleMesh
meshOf(const Shape& shape, double vertices)
{
  // n vertices carry 2n triangles, of sqrt(3)/4 e^2 each if they are equilateral.
  return meshOfShape(shape, std::sqrt(areaOfShape(shape) * 2 / (std::sqrt(3.0) * vertices)));
}

std::vector<std::string>
parts(const std::string& text, char separator)
{
  std::vector<std::string> out(1);
  for (const char c : text)
    if (c == separator)
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

std::vector<SceneItem>
itemsOf(const std::vector<std::string>& texts)
{
  std::vector<SceneItem> items;
  for (const auto& text : texts) {
    const ItemSource source = sourceOf(text);
    items.push_back(source.shape ? sceneItem(source.label, *source.shape)
                                 : sceneItem(source.label, source.mesh));
  }
  return items;
}

void
saveMeshes(const std::vector<std::string>& texts, const std::string& directory)
{
  constexpr double kVertices = 20000; // of a shape: fine enough for handles and rims
  std::error_code failure;            // saveOff() will say it better
  std::filesystem::create_directories(directory, failure);
  for (const auto& text : texts) {
    const ItemSource source = sourceOf(text);
    const auto path = std::filesystem::path(directory) / (source.label + ".off");
    saveOff(source.shape ? meshOf(*source.shape, kVertices) : source.mesh, path.string());
  }
}

void
addArrangement(CommandLine& line, SceneOptions& o)
{
  addChoice<Background>(line, "-background", "what carries the objects, default plane",
                        o.background,
                        {{"none", Background::None},
                         {"plane", Background::Plane},
                         {"corner", Background::Corner},
                         {"box", Background::Box},
                         {"bowl", Background::Bowl}});
  line.real("-size", "S", "edge of the background, or opening of the bowl, default 1", o.size, 1e-6,
            1e6);
  line.real("-wall", "H", "height of walls, default 0.3", o.wall_height, 1e-6, 1e6);
  addChoice<Posture>(line, "-posture", "how objects stand, default upright", o.posture,
                     {{"upright", Posture::Upright},
                      {"lying", Posture::Lying},
                      {"leaning", Posture::Leaning},
                      {"mixed", Posture::Mixed}});
  addChoice<Spacing>(line, "-spacing",
                     "apart (default), pushed together, or the others around the first", o.spacing,
                     {{"apart", Spacing::Apart}, {"pile", Spacing::Pile}, {"pair", Spacing::Pair}});
  line.real("-factor", "F",
            "apart, pair: centroids F times the smaller bounding radius apart, or more; default 1",
            o.distance_factor, 0, 1e6);
  line.real("-gap", "G", "pile: gap along the direction of pushing, default 0", o.gap, 0, 1e6);
}

} // namespace apps
} // namespace pcl_surflet
