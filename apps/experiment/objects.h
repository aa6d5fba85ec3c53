/** \file
 * The objects of the experiments. */
#pragma once

#include "pcl_surflet/core/triangle_mesh.h"

#include <array>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief A mesh of diameter 1. */
struct ExperimentObject {
  std::string label;
  TriangleMesh mesh;
  double spacing = 0; ///< distance between neighbours of an even sample of kMeshSurflets surflets
  std::array<std::array<double, 3>, 3> axes{}; ///< principal axes of the surface, longest first
};

/** \brief Surflets per sampling, for training and queries alike [Wahl 2007, Sec. 3.6.1]. */
constexpr std::size_t kMeshSurflets = 4500;

/** \brief The twenty objects that the experiments of chapter 3 use, all in the Debian package
 * libcgal-demo. */
const std::vector<std::string>& experimentLabels();

/** \brief The names in \p list, separated by commas. */
std::vector<std::string> namesIn(const std::string& list);

/** \brief Loads \p label.off of \p directory, scaled to diameter 1, for each of the \p labels.
 * \throws MeshFileError, std::invalid_argument */
std::vector<ExperimentObject> loadObjects(const std::string& directory,
                                          const std::vector<std::string>& labels);

} // namespace apps
} // namespace pcl_surflet
