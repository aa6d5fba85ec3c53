#include "mesh_checks.h"
#include "vector3.h"

#include "pcl_surflet/core/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace pcl_surflet {

using detail::Vector3;

namespace {

using Index = std::uint32_t;
constexpr Index kNotSplit = std::numeric_limits<Index>::max();

/** \brief Name of the edge (a, b), the same from both of its triangles. */
std::uint64_t
edgeKey(Index a, Index b)
{
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
}

double
squaredLength(const TriangleMesh& mesh, Index a, Index b)
{
  const Vector3 d =
      detail::subtract(detail::toVector3(mesh.vertices[a]), detail::toVector3(mesh.vertices[b]));
  return detail::dot(d, d);
}

TriangleMesh::Point
middle(const TriangleMesh& mesh, Index a, Index b)
{
  return detail::toFloat3(detail::scaled(
      detail::add(detail::toVector3(mesh.vertices[a]), detail::toVector3(mesh.vertices[b])), 0.5));
}

/** \brief Whether the edge (a, b) is longer than a squared length and can be split: where no float
 * lies between its ends (far from the origin), splitting would never end. */
bool
mustSplit(const TriangleMesh& mesh, Index a, Index b, double longer_than)
{
  if (squaredLength(mesh, a, b) <= longer_than)
    return false;
  const auto m = middle(mesh, a, b);
  return m != mesh.vertices[a] && m != mesh.vertices[b];
}

/** \brief One round of splitting: all edges longer than a threshold at once.
 *
 * The threshold looks at the geometry of the edge alone, so both triangles of an edge agree, even
 * where they do not share vertices but only positions (triangle soups). */
class SplitRound {
public:
  SplitRound(const TriangleMesh& mesh, double longest_edge, std::size_t max_triangles) : mesh_(mesh)
  {
    measure(longest_edge * longest_edge);
    collect(threshold(longest_edge * longest_edge, max_triangles));
  }

  bool
  anythingToSplit() const
  {
    return !keys_.empty();
  }

  TriangleMesh
  split() const
  {
    TriangleMesh out;
    out.vertices = mesh_.vertices;
    out.vertices.reserve(mesh_.vertices.size() + keys_.size());
    for (const auto key : keys_)
      out.vertices.push_back(middle(mesh_, static_cast<Index>(key >> 32), static_cast<Index>(key)));
    out.triangles.reserve(mesh_.triangles.size() + 2 * keys_.size());
    for (const auto& t : mesh_.triangles)
      splitTriangle(t, out);
    return out;
  }

private:
  /** \brief Collects the lengths (of both sides of each edge) above the squared length \p wanted.
   */
  void
  measure(double wanted)
  {
    for (const auto& t : mesh_.triangles)
      for (int e = 0; e < 3; ++e)
        if (mustSplit(mesh_, t[e], t[(e + 1) % 3], wanted))
          lengths_.push_back(squaredLength(mesh_, t[e], t[(e + 1) % 3]));
  }

  /** \brief The smallest squared length from \p wanted upwards that keeps max_triangles: each
   * marked side of an edge adds one triangle. */
  double
  threshold(double wanted, std::size_t max_triangles)
  {
    const std::size_t have = mesh_.triangles.size();
    if (have + lengths_.size() <= max_triangles)
      return wanted;
    const std::size_t room = max_triangles > have ? max_triangles - have : 0;
    const auto nth = lengths_.begin() + static_cast<std::ptrdiff_t>(room);
    std::nth_element(lengths_.begin(), nth, lengths_.end(), std::greater<double>());
    return *nth;
  }

  void
  collect(double longer_than)
  {
    if (lengths_.empty())
      return;
    for (const auto& t : mesh_.triangles)
      for (int e = 0; e < 3; ++e)
        if (mustSplit(mesh_, t[e], t[(e + 1) % 3], longer_than))
          keys_.push_back(edgeKey(t[e], t[(e + 1) % 3]));
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    if (keys_.size() >= kNotSplit - mesh_.vertices.size()) // indices are 32 bits wide
      keys_.clear();
  }

  /** \brief Index of the new vertex in the middle of (a, b), or kNotSplit. */
  Index
  middleVertex(Index a, Index b) const
  {
    const auto key = edgeKey(a, b);
    const auto it = std::lower_bound(keys_.begin(), keys_.end(), key);
    if (it == keys_.end() || *it != key)
      return kNotSplit;
    return static_cast<Index>(mesh_.vertices.size() + static_cast<std::size_t>(it - keys_.begin()));
  }

  void
  splitTriangle(const TriangleMesh::Triangle& t, TriangleMesh& out) const
  {
    const std::array<Index, 3> m = {middleVertex(t[0], t[1]), middleVertex(t[1], t[2]),
                                    middleVertex(t[2], t[0])};
    const auto count = std::count_if(m.begin(), m.end(), [](Index v) { return v != kNotSplit; });
    auto& triangles = out.triangles;
    if (count == 0)
      triangles.push_back(t);
    else if (count == 3)
      triangles.insert(
          triangles.end(),
          {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}, {m[0], m[1], m[2]}});
    else if (count == 1) {
      const auto e = static_cast<std::size_t>(
          std::find_if(m.begin(), m.end(), [](Index v) { return v != kNotSplit; }) - m.begin());
      const Index a = t[e], b = t[(e + 1) % 3], c = t[(e + 2) % 3];
      triangles.insert(triangles.end(), {{a, m[e], c}, {m[e], b, c}});
    }
    else {
      const auto whole =
          static_cast<std::size_t>(std::find(m.begin(), m.end(), kNotSplit) - m.begin());
      const std::size_t ab = (whole + 1) % 3, bc = (whole + 2) % 3;
      splitTwoEdges(t[ab], t[bc], t[whole], m[ab], m[bc], out);
    }
  }

  /** \brief Splits (a, b, c) with middles \p ab and \p bc; of the two diagonals of the quadrangle
   * left over takes the shorter, without which the longest edge would hardly shrink. */
  static void
  splitTwoEdges(Index a, Index b, Index c, Index ab, Index bc, TriangleMesh& out)
  {
    out.triangles.push_back({ab, b, bc});
    if (squaredLength(out, a, bc) <= squaredLength(out, ab, c))
      out.triangles.insert(out.triangles.end(), {{a, ab, bc}, {a, bc, c}});
    else
      out.triangles.insert(out.triangles.end(), {{a, ab, c}, {ab, bc, c}});
  }

  const TriangleMesh& mesh_;
  std::vector<double> lengths_;
  std::vector<std::uint64_t> keys_;
};

} // namespace

TriangleMesh
refineEdges(const TriangleMesh& mesh, double longest_edge, std::size_t max_triangles)
{
  if (!(longest_edge > 0))
    throw std::invalid_argument("refineEdges: longest_edge must be positive, not " +
                                std::to_string(longest_edge));
  detail::checkIndices(mesh, "refineEdges");
  TriangleMesh out = mesh;
  while (true) {
    const SplitRound round(out, longest_edge, max_triangles);
    if (!round.anythingToSplit())
      return out;
    out = round.split();
  }
}

} // namespace pcl_surflet
