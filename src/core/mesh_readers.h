/** \file
 * Readers of PLY, OBJ and STL; internal, not installed.
 *
 * Our own because hostile files must give an error: PCL 1.13's OBJ reader crashes on a file with
 * many more normals than vertices, and its PLY reader, by its source, allocates what the header
 * claims.
 * Memory here grows with what a file holds, not with what it claims to hold. */
#pragma once

#include "pcl_surflet/core/triangle_mesh.h"

#include <string>

namespace pcl_surflet {
namespace detail {

/** \brief Vertices, normals (as many, or none) and faces of a PLY file. */
struct PlyContent {
  TriangleMesh mesh;
  std::vector<TriangleMesh::Point> normals;
};

/** \brief Reads PLY, ASCII or binary of either byte order; polygons are split into fans.
 * \throws MeshFileError if the file is missing, damaged, truncated or without vertices */
PlyContent loadPly(const std::string& path);

/** \brief Reads the vertices and faces of a Wavefront OBJ. \throws MeshFileError as loadPly() */
TriangleMesh loadObj(const std::string& path);

/** \brief Reads STL, ASCII or binary; equal corners become one vertex, so that umbrella normals
 * are smooth. \throws MeshFileError as loadPly() */
TriangleMesh loadStl(const std::string& path);

} // namespace detail
} // namespace pcl_surflet
