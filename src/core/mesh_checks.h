/** \file
 * Checks of meshes shared by the core; internal, not installed. */
#pragma once

#include "pcl_surflet/core/triangle_mesh.h"

#include <string>

namespace pcl_surflet {
namespace detail {

/** \brief Empty if every index names a vertex, else which does not and how to mend it. */
std::string indexProblem(const TriangleMesh& mesh);

/** \brief Empty if every coordinate is finite, else which is not and how to mend it. */
std::string coordinateProblem(const TriangleMesh& mesh);

/** \throws std::invalid_argument naming \p caller and indexProblem(), where there is one. */
void checkIndices(const TriangleMesh& mesh, const char* caller);

} // namespace detail
} // namespace pcl_surflet
