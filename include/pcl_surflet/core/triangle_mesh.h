/** \file
 * Triangle meshes and what training needs of them. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief A triangle mesh with counter-clockwise (outward) faces; units are the user's. */
struct PCL_SURFLET_API TriangleMesh {
  using Point = std::array<float, 3>;            ///< x, y, z
  using Triangle = std::array<std::uint32_t, 3>; ///< indices of its corners

  std::vector<Point> vertices;     ///< corners, shared by their triangles
  std::vector<Triangle> triangles; ///< counter-clockwise, seen from outside

  /** \brief Empty if the mesh can be sampled, else what is wrong and how to mend it: no triangles,
   * an index beyond the vertices, a coordinate that is not finite, or no area. */
  std::string problem() const;
};

/** \brief Total area of the triangles, in squared units.
 * \throws std::invalid_argument if an index is out of range. */
PCL_SURFLET_API double surfaceArea(const TriangleMesh& mesh);

/** \brief Area-weighted mean of the normals of the triangles around each vertex ("umbrella"),
 * normalised [Wahl 2007, Eq. 2.25].
 * Zero vectors where a vertex has no triangle with area or its normals cancel.
 * \throws std::invalid_argument if an index is out of range. */
PCL_SURFLET_API std::vector<TriangleMesh::Point> umbrellaNormals(const TriangleMesh& mesh);

/** \brief Splits edges at their middle until none is longer than \p longest_edge.
 *
 * Shared edges are split alike, so a closed mesh stays closed. CAD meshes need it before
 * umbrellaNormals(): on a cube of 12 triangles the umbrella normals of the corners would round the
 * whole faces. Stops (documented, not an error) when \p max_triangles is reached, the longest edges
 * first; edges so far from the origin that floats are too coarse for their middle are left alone.
 * \throws std::invalid_argument if \p longest_edge is not positive or an index is out of range. */
PCL_SURFLET_API TriangleMesh refineEdges(const TriangleMesh& mesh, double longest_edge,
                                         std::size_t max_triangles = 2000000);

/** \brief Draws \p n points uniformly by area, with umbrella normals interpolated over the
 * triangle.
 *
 * Where the interpolated normal vanishes the triangle's own is taken. The same seed gives the same
 * points. \throws std::invalid_argument with mesh.problem(). */
PCL_SURFLET_API SurfletSet sampleSurface(const TriangleMesh& mesh, std::size_t n,
                                         std::uint64_t seed);

/** \brief Draws a blue-noise (Poisson-disk) sample of about \p target points: no two closer than a
 * common radius, so the surface density is homogeneous ("iso-mesh", [Wahl 2007, Sec. 2.3.1]).
 *
 * Thins an area-uniform sample of sampleSurface(), eight times as large; the count lies within 20 %
 * of \p target whenever the surface allows it. Edges longer than sqrt(area / target), the sample
 * spacing, are refined first (refineEdges): faces keep their own normal except within about one
 * spacing of an edge, and a coarse mesh of a round body is taken for the polyhedron it is.
 * Deterministic in \p seed. Distances are straight lines, also through thin walls.
 * \throws std::invalid_argument with mesh.problem(), or if \p target exceeds 2^28. */
PCL_SURFLET_API SurfletSet sampleIsoMesh(const TriangleMesh& mesh, std::size_t target,
                                         std::uint64_t seed);

} // namespace pcl_surflet
