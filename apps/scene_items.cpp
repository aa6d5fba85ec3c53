#include "scene_items.h"

#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/mesh_file.h"
#include "pcl_surflet/surface_file.h"
#include "up_axis.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief SHAPE or FILE[:DIAMETER[:UP]]: scaled and upright. */
SceneItem
itemOf(const std::string& text)
{
  const auto spec = parts(text, ':');
  if (auto shape = shapeByName(spec[0])) {
    if (spec.size() > 1)
      throw UsageError("'" + spec[0] +
                       "' is a ready-made shape and has its size and posture; give "
                       "its name alone, or a mesh file");
    return sceneItem(spec[0], *shape);
  }
  const UpAxis* up = upAxis(spec.size() < 3 ? "z" : spec[2]);
  if (spec.size() > 3 || up == nullptr)
    throw UsageError("'" + text + "' is not FILE:DIAMETER:UP, where UP is x, y, z, -x, -y or -z");
  const double diameter =
      spec.size() > 1 ? parseReal("DIAMETER of " + spec[0], spec[1], 1e-6, 1e6) : 0;
  const SurfaceFile file = loadSurface(spec[0]);
  if (!file.mesh)
    throw DataError(spec[0] + ": holds points; give a file with faces, or the name of a shape");
  TriangleMesh upright = *file.mesh;
  for (auto& p : upright.vertices)
    p = up->turned(p);
  return sceneItem(stemOf(spec[0]), diameter > 0 ? scaledToDiameter(upright, diameter) : upright);
}

} // namespace

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
  items.reserve(texts.size());
  for (const auto& text : texts)
    items.push_back(itemOf(text));
  return items;
}

void
addClutter(CommandLine& line, SceneContents& o)
{
  line.text("-clutter", "ITEM,...", "things unknown to the database", o.clutter);
  line.count("-unknown", "N", "things present of the clutter, default all", o.unknown, 0, 1000000);
}

void
addContents(CommandLine& line, SceneContents& o)
{
  line.count("-present", "N", "items present, chosen at random, default all", o.present, 1,
             1000000);
  addClutter(line, o);
}

std::vector<SceneItem>
clutterOf(const CommandLine& line, const SceneContents& contents)
{
  return line.given("-clutter") ? itemsOf(parts(contents.clutter, ',')) : std::vector<SceneItem>();
}

void
settleContents(const CommandLine& line, const SceneContents& contents, std::size_t objects,
               std::size_t clutter, SceneOptions& o)
{
  o.present = line.given("-present") ? contents.present : objects;
  o.clutter = line.given("-unknown") ? contents.unknown : clutter;
  if (o.present > objects || o.clutter > clutter)
    throw UsageError(std::string("option ") + (o.present > objects ? "-present" : "-unknown") +
                     ": so many things were not given");
}

void
saveMeshes(const std::vector<std::string>& texts, const std::string& directory)
{
  std::error_code failure; // saveOff() will say it better
  std::filesystem::create_directories(directory, failure);
  for (const auto& text : texts) {
    const SceneItem item = itemOf(text);
    const auto path = std::filesystem::path(directory) / (item.label + ".off");
    saveOff(item.mesh(), path.string());
  }
}

std::vector<std::string>
labelsOf(const std::vector<SceneItem>& items)
{
  std::vector<std::string> labels;
  labels.reserve(items.size());
  for (const auto& item : items)
    labels.push_back(item.label);
  return labels;
}

void
addNames(CommandLine& line, const std::string& option, const std::string& help,
         const std::vector<std::string>& known, std::vector<std::string>& target)
{
  std::string names;
  for (const auto& name : known)
    names += (names.empty() ? "" : ", ") + name;
  line.option(option, "NAME,...", help + ": " + names, [=, &target](const std::string& text) {
    target = parts(text, ',');
    for (const auto& name : target)
      if (std::find(known.begin(), known.end(), name) == known.end())
        throw UsageError("option " + option + ": there is no '" + name + "'; the names are " +
                         names);
  });
}

void
addNumbers(CommandLine& line, const std::string& option, const std::string& value,
           const std::string& help, double low, double high, std::vector<double>& target)
{
  line.option(option, value, help, [=, &target](const std::string& text) {
    target.clear();
    for (const auto& part : parts(text, ','))
      target.push_back(parseReal(option, part, low, high));
  });
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
  line.real("-width", "W", "edge of the background along y, default as -size", o.width, 1e-6, 1e6);
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
  line.real("-density", "D", "points per squared unit, default 470000", o.density, 1e-9, 1e12);
  line.real("-noise", "S",
            "complete surfaces: moves points along their normals by up to S, default 0", o.noise, 0,
            1e6);
}

} // namespace apps
} // namespace pcl_surflet
