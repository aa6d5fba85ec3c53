/** \file
 * What a distant sensor sees of a mesh, by drawing it. */
#pragma once

#include "pcl_surflet/core/depth_buffer.h"
#include "pcl_surflet/core/surflet_set.h"
#include "pcl_surflet/core/triangle_mesh.h"

#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief A mesh as a sensor far up the z axis sees it: the foremost height in every pixel of 512 x
 * 512 that just hold it. */
class DepthPicture {
public:
  /** \param vertices positions of the mesh's vertices, not empty, with an extent in x or y
   * \param triangles indices of \p vertices; those seen from the edge are left out */
  DepthPicture(const SurfletSet& vertices, const std::vector<TriangleMesh::Triangle>& triangles);

  /** \brief Whether \p s, a surflet of the surface, is seen: nothing lies before it, and it is not
   * seen at less than 3 degrees. */
  bool shows(const Surflet& s) const;

private:
  static constexpr long kPixels = 512;

  DepthBuffer::Corner inPixels(const Surflet& s) const;

  double left_ = 0, low_ = 0, size_ = 1; ///< of the left and lower edge, of a pixel
  DepthBuffer heights_;
};

} // namespace apps
} // namespace pcl_surflet
