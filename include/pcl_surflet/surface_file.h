/** \file
 * Loads what models are trained from and queries are made of: PCD, PLY, OBJ, STL, OFF. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"
#include "pcl_surflet/core/triangle_mesh.h"

#include <pcl/PCLPointCloud2.h>
#include <pcl/types.h>

#include <Eigen/Geometry>

#include <memory>
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

/** \brief All points of a file, fields, rows and columns as they were. */
struct SourcePoints {
  pcl::PCLPointCloud2 cloud;                        ///< with at least size() points of data
  Eigen::Vector4f origin = Eigen::Vector4f::Zero(); ///< of the sensor: the VIEWPOINT of a PCD
  Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity(); ///< of the sensor, likewise

  /** \brief How many points. */
  std::size_t
  size() const
  {
    return std::size_t{cloud.width} * cloud.height;
  }
};

/** \brief Content of a file: a mesh, or oriented points. */
struct SurfaceFile {
  std::optional<TriangleMesh> mesh; ///< set if the file has faces
  SurfletSet surflets;              ///< set otherwise
  pcl::Indices indices;             ///< which point of the file each surflet is
  std::size_t rejected = 0;         ///< points left out: not finite or without usable normal
  std::shared_ptr<const SourcePoints> points; ///< set by SurfaceFileOptions::keep_points
};

/** \brief How loadSurface() reads. */
struct SurfaceFileOptions {
  /** \brief Neighbours for estimating missing normals (pcl::NormalEstimationOMP); also where no
   * point has a usable one. 0: organised clouds (3 by 3 and more) get theirs by
   * surfletsFromDepth(), others without normals are an error. */
  int estimate_normals = 0;
  /** \brief Where the sensor was, for such normals, in the coordinates of the points. Without it:
   * the VIEWPOINT of a PCD, the origin otherwise. Some programs, ours that generate scans among
   * them, write points relative to the sensor and its pose in a world as VIEWPOINT: then it is
   * {0, 0, 0}. */
  std::optional<std::array<double, 3>> sensor;
  unsigned threads = 0; ///< for normal estimation; 0: all
  /** \brief Keeps all points of a cloud, so that results can be written beside what the file says
   * of them: of a PCD every field, of a PLY x, y and z. Takes as much memory again. */
  bool keep_points = false;
};

/** \brief Loads \p path by its ending (pcd, ply, obj, stl, off, any case).
 *
 * Files with faces give a mesh; PCD and PLY without faces give oriented points, with their
 * normal_x, normal_y, normal_z or with what \p options say. Estimated normals are turned to the
 * sensor, see SurfaceFileOptions::sensor.
 * \throws SurfaceFileError if the file is missing, of an unknown kind, empty, damaged, or has
 * neither faces nor usable normals */
PCL_SURFLET_API SurfaceFile loadSurface(const std::string& path,
                                        const SurfaceFileOptions& options = {});

/** \brief The surflets of a file: those of the points, or about \p mesh_surflets drawn evenly from
 * the mesh (sampleIsoMesh() with \p seed, whose errors come through). */
PCL_SURFLET_API SurfletSet surfletsOf(const SurfaceFile& file, std::size_t mesh_surflets,
                                      std::uint64_t seed);

} // namespace pcl_surflet
