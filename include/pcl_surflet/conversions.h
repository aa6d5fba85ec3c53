/** \file
 * From PCL's clouds and meshes to surflets. */
#pragma once

#include "pcl_surflet/compat.h"
#include "pcl_surflet/core/surflet_set.h"
#include "pcl_surflet/core/triangle_mesh.h"

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <pcl/types.h>

#include <stdexcept>

namespace pcl_surflet {

/** \brief Surflets of a cloud and where they came from. */
struct ConvertedSurflets {
  SurfletSet surflets;      ///< in the order of the indices, normals of unit length
  pcl::Indices indices;     ///< index in the cloud of each surflet
  std::size_t rejected = 0; ///< points left out: not finite, or a normal without direction
};

/** \brief Converts the points \p indices of \p cloud with the normals of the same places.
 *
 * PointT has x, y, z; PointNT has normal_x, normal_y, normal_z (they may be one type). Normals are
 * scaled to unit length; points that are not finite or have no usable normal are left out and
 * counted. \p normals must be as large as \p cloud and every index in range
 * (std::invalid_argument). */
template <typename PointT, typename PointNT>
ConvertedSurflets
toSurflets(const pcl::PointCloud<PointT>& cloud, const pcl::PointCloud<PointNT>& normals,
           const pcl::Indices& indices)
{
  if (cloud.size() != normals.size())
    throw std::invalid_argument("pcl_surflet: as many normals as points are needed");
  ConvertedSurflets out;
  out.surflets.reserve(indices.size());
  out.indices.reserve(indices.size());
  for (const auto i : indices) {
    if (i < 0 || static_cast<std::size_t>(i) >= cloud.size())
      throw std::invalid_argument("pcl_surflet: an index is outside the cloud");
    const auto& p = cloud[static_cast<std::size_t>(i)];
    const auto& n = normals[static_cast<std::size_t>(i)];
    if (out.surflets.appendChecked({p.x, p.y, p.z, n.normal_x, n.normal_y, n.normal_z}))
      out.indices.push_back(i);
    else
      ++out.rejected;
  }
  return out;
}

/** \brief Converts a whole cloud that carries its normals, e.g. of pcl::PointNormal. */
template <typename PointNT>
ConvertedSurflets
toSurflets(const pcl::PointCloud<PointNT>& cloud)
{
  pcl::Indices all(cloud.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = static_cast<pcl::index_t>(i);
  return toSurflets(cloud, cloud, all);
}

/** \brief Converts a mesh; polygons are split into fans. Faces with fewer than three corners are
 * skipped. \throws std::invalid_argument if the mesh has no x, y, z of FLOAT32 or an index is out
 * of range. */
PCL_SURFLET_API TriangleMesh toTriangleMesh(const pcl::PolygonMesh& mesh);

} // namespace pcl_surflet
