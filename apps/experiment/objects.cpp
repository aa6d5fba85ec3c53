#include "experiment/objects.h"

#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/mesh_file.h"

#include <cmath>
#include <sstream>

namespace pcl_surflet {
namespace apps {

const std::vector<std::string>&
experimentLabels()
{
  static const std::vector<std::string> labels = {"armadillo", "cow",         "bull",
                                                  "bunny00",   "anchor",      "pig",
                                                  "cube",      "cylinder",    "ChineseDragon-10kv",
                                                  "man",       "mushroom",    "camel",
                                                  "dino",      "femur",       "elephant",
                                                  "sphere",    "tetrahedron", "triceratops",
                                                  "rotor",     "turbine"};
  return labels;
}

std::vector<std::string>
namesIn(const std::string& list)
{
  std::vector<std::string> names;
  std::istringstream in(list);
  for (std::string name; std::getline(in, name, ',');)
    names.push_back(name);
  return names;
}

std::vector<ExperimentObject>
loadObjects(const std::string& directory, const std::vector<std::string>& labels)
{
  std::vector<ExperimentObject> objects;
  for (const auto& label : labels) {
    ExperimentObject object;
    object.label = label;
    object.mesh = scaledToDiameter(loadOff(directory + "/" + label + ".off"), 1.0);
    if (const auto problem = object.mesh.problem(); !problem.empty())
      throw std::invalid_argument(label + ".off: " + problem);
    object.spacing = std::sqrt(surfaceArea(object.mesh) / static_cast<double>(kMeshSurflets));
    object.axes = principalAxes(sampleIsoMesh(object.mesh, kMeshSurflets, 0));
    objects.push_back(std::move(object));
  }
  return objects;
}

} // namespace apps
} // namespace pcl_surflet
