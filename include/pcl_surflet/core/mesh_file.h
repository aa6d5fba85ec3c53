/** \file
 * Reads and writes meshes as OFF, the format of many shape collections that PCL and VTK lack. */
#pragma once

#include "pcl_surflet/core/triangle_mesh.h"

#include <stdexcept>
#include <string>

namespace pcl_surflet {

/** \brief A mesh file that cannot be read or written; what() names file, line, cause and remedy. */
class PCL_SURFLET_API MeshFileError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/** \brief Reads an ASCII OFF mesh (OFF, and COFF, NOFF, STOFF and their combinations).
 *
 * Comments (#), empty lines, Windows line ends, a byte order mark and counts on the header's line
 * ("OFF 8 12 0", also "OFF8 12 0" as in ModelNet) are understood. Vertices and faces must start on
 * lines of their own; what follows the coordinates or indices on their line (colours, normals,
 * texture coordinates) is ignored. Polygons are split into fans from their first vertex, which is
 * right for convex ones; faces of fewer than three vertices are skipped. Numbers are read the same
 * way in every locale and rounded to single precision; text after the last face is ignored.
 *
 * Memory grows with what the file holds, not with what it claims to hold. A file of points alone
 * is a mesh without triangles: see TriangleMesh::problem().
 * \throws MeshFileError if the file is missing, a directory, unreadable, empty, not an OFF file,
 * binary or not three-dimensional, ends early, claims more than 2^32 - 1 vertices or faces, or has
 * a token that is not a number, a coordinate that is not finite in single precision, or an index
 * without vertex. */
PCL_SURFLET_API TriangleMesh loadOff(const std::string& path);

/** \brief Writes \p mesh as ASCII OFF; loadOff() gives back the same mesh bit by bit.
 *
 * Atomic: written beside \p path and then renamed, so that readers see the old file or the whole
 * new one. Existing permissions and symbolic links are kept. Devices and pipes are written to
 * directly.
 * \throws MeshFileError if the file cannot be written (also when the disk is full; an existing file
 * is left as it was), an index is out of range or a coordinate not finite. */
PCL_SURFLET_API void saveOff(const TriangleMesh& mesh, const std::string& path);

} // namespace pcl_surflet
