/** \file
 * Loads what models are trained from and queries are made of: PCD, PLY, OBJ, STL, OFF. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"
#include "pcl_surflet/core/triangle_mesh.h"

#include <optional>
#include <stdexcept>
#include <string>

namespace pcl_surflet {

/** \brief A file that cannot be used; what() names file, cause and remedy. */
class PCL_SURFLET_API SurfaceFileError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
  ~SurfaceFileError() override;
};

/** \brief Content of a file: a mesh, or oriented points. */
struct SurfaceFile {
  std::optional<TriangleMesh> mesh; ///< set if the file has faces
  SurfletSet surflets;              ///< set otherwise
  std::size_t rejected = 0;         ///< points left out: not finite or without usable normal
};

/** \brief How loadSurface() reads. */
struct SurfaceFileOptions {
  /** \brief Neighbours for estimating missing normals (pcl::NormalEstimationOMP, oriented to the
   * file's viewpoint); 0: a cloud without normals is an error. */
  int estimate_normals = 0;
  unsigned threads = 0; ///< for normal estimation; 0: all
};

/** \brief Loads \p path by its ending (pcd, ply, obj, stl, off, any case).
 *
 * Files with faces give a mesh; PCD and PLY without faces give oriented points and need
 * normal_x, normal_y, normal_z unless options say to estimate them.
 * \throws SurfaceFileError if the file is missing, of an unknown kind, empty, damaged, or has
 * neither faces nor usable normals */
PCL_SURFLET_API SurfaceFile loadSurface(const std::string& path,
                                        const SurfaceFileOptions& options = {});

/** \brief The surflets of a file: those of the points, or about \p mesh_surflets drawn evenly from
 * the mesh (sampleIsoMesh() with \p seed, whose errors come through). */
PCL_SURFLET_API SurfletSet surfletsOf(const SurfaceFile& file, std::size_t mesh_surflets,
                                      std::uint64_t seed);

} // namespace pcl_surflet
