#include "pcl_surflet/core/geometry.h"

#include "pcl_surflet/core/counter_random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace pcl_surflet {
namespace {

using Point = std::array<double, 3>;

double
squaredDistance(const Point& a, const Point& b)
{
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

std::vector<Point>
pointsOf(const SurfletSet& set)
{
  std::vector<Point> points(set.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {set.x[i], set.y[i], set.z[i]};
  return points;
}

/** \brief A k-d tree of bounding balls for the search of the farthest pair.
 *
 * Pairs of nodes are split as long as their balls may hold a longer pair than the best one known.
 * Balls instead of boxes: those of small patches far apart are tight whatever their orientation, so
 * also on a sphere about its centroid each patch is left with few partners. */
class FarthestPair {
public:
  explicit FarthestPair(std::vector<Point> points) : points_(std::move(points))
  {
    build(0, points_.size());
    best_ = sweep();
    search(0, 0);
  }

  double
  distance() const
  {
    return best_;
  }

private:
  static constexpr std::size_t kLeaf = 8;

  struct Node {
    Point centre;
    double radius;
    std::size_t begin, end;
    std::size_t right = 0; ///< 0: a leaf; the left child is the next node
  };

  /** \brief Ball about the middle of the bounding box, and the box's longest axis. */
  std::pair<Node, std::size_t>
  bound(std::size_t begin, std::size_t end) const
  {
    Point low = points_[begin], high = points_[begin];
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], points_[i][k]);
        high[k] = std::max(high[k], points_[i][k]);
      }
    Node node{{}, 0, begin, end, 0};
    std::size_t axis = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      node.centre[k] = (low[k] + high[k]) / 2;
      if (high[k] - low[k] > high[axis] - low[axis])
        axis = k;
    }
    for (std::size_t i = begin; i < end; ++i)
      node.radius = std::max(node.radius, squaredDistance(points_[i], node.centre));
    node.radius = std::sqrt(node.radius);
    return {node, axis};
  }

  std::size_t
  build(std::size_t begin, std::size_t end)
  {
    const std::size_t self = nodes_.size();
    const auto [node, axis] = bound(begin, end);
    nodes_.push_back(node);
    if (end - begin <= kLeaf)
      return self;
    const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
    const std::size_t middle = (begin + end) / 2;
    const std::size_t along = axis;
    std::nth_element(at(begin), at(middle), at(end),
                     [along](const Point& a, const Point& b) { return a[along] < b[along]; });
    build(begin, middle);
    const std::size_t right = build(middle, end);
    nodes_[self].right = right;
    return self;
  }

  /** \brief A long pair to begin with: from any point to the farthest, and on from there. */
  double
  sweep() const
  {
    std::size_t from = 0;
    double longest = 0;
    for (int round = 0; round < 4; ++round) {
      std::size_t far = from;
      double far_squared = 0;
      for (std::size_t i = 0; i < points_.size(); ++i)
        if (const double d = squaredDistance(points_[from], points_[i]); d > far_squared) {
          far_squared = d;
          far = i;
        }
      longest = std::max(longest, std::sqrt(far_squared));
      from = far;
    }
    return longest;
  }

  /** \brief No pair of a point of \p a and one of \p b is longer than this. */
  double
  reach(std::size_t a, std::size_t b) const
  {
    return std::sqrt(squaredDistance(nodes_[a].centre, nodes_[b].centre)) + nodes_[a].radius +
           nodes_[b].radius;
  }

  void
  searchLeaves(const Node& a, const Node& b)
  {
    double longest = best_ * best_;
    for (std::size_t i = a.begin; i < a.end; ++i)
      for (std::size_t j = b.begin; j < b.end; ++j)
        longest = std::max(longest, squaredDistance(points_[i], points_[j]));
    best_ = std::max(best_, std::sqrt(longest));
  }

  /** \brief Splits the larger node, the more promising half first. */
  void
  search(std::size_t a, std::size_t b)
  {
    if (nodes_[a].right == 0 && nodes_[b].right == 0)
      return searchLeaves(nodes_[a], nodes_[b]);
    if (nodes_[a].right == 0 || (nodes_[b].right != 0 && nodes_[b].radius > nodes_[a].radius))
      std::swap(a, b);
    std::size_t first = a + 1, second = nodes_[a].right;
    if (reach(second, b) > reach(first, b))
      std::swap(first, second);
    if (reach(first, b) > best_)
      search(first, b);
    if (reach(second, b) > best_)
      search(second, b);
  }

  std::vector<Point> points_;
  std::vector<Node> nodes_;
  double best_ = 0;
};

/** \brief Squared distance from surflet \p i to its eighth neighbour, by looking at all. */
double
eighthNeighbour(const std::vector<Point>& points, std::size_t i)
{
  std::array<double, 8> nearest;
  nearest.fill(std::numeric_limits<double>::infinity());
  for (std::size_t j = 0; j < points.size(); ++j) {
    const double d = squaredDistance(points[i], points[j]);
    if (d >= nearest.back() || j == i)
      continue;
    std::size_t k = nearest.size() - 1;
    for (; k > 0 && nearest[k - 1] > d; --k)
      nearest[k] = nearest[k - 1];
    nearest[k] = d;
  }
  return nearest.back();
}

} // namespace

double
farthestDistance(const SurfletSet& set)
{
  if (set.size() < 2)
    return 0;
  // In unit scale, so that squares of absurd coordinates stay finite.
  const UnitSurflets unit = toUnitScale(set);
  return FarthestPair(pointsOf(unit.set)).distance() / unit.scale;
}

SurfaceDensity
surfaceDensity(const SurfletSet& set, std::uint64_t seed)
{
  constexpr std::size_t kSmallest = 32, kSamples = 256;
  SurfaceDensity density;
  if (set.size() < kSmallest)
    return density;
  const UnitSurflets unit = toUnitScale(set);
  const auto points = pointsOf(unit.set);
  CounterRandom random(seed);
  std::vector<double> squared;
  for (std::size_t k = 0; k < std::min(kSamples, points.size()); ++k)
    squared.push_back(
        eighthNeighbour(points, random.below(static_cast<std::uint32_t>(points.size()))));
  // Every sample stands for an area in proportion to its squared spacing: weighted by that,
  // quantiles are shares of the surface, so that a sparse half with few surflets still counts as a
  // half.
  std::sort(squared.begin(), squared.end());
  const double total = std::accumulate(squared.begin(), squared.end(), 0.0);
  const auto quantile = [&](double share) {
    double sum = 0;
    for (const double s : squared)
      if ((sum += s) >= share * total)
        return s;
    return squared.back();
  };
  density.spacing = std::sqrt(quantile(0.5)) / unit.scale;
  density.widest = std::sqrt(quantile(0.95)) / unit.scale;
  // Duplicates have neighbours at distance 0.
  density.contrast = std::max(1.0, quantile(0.9) / std::max(quantile(0.1), 1e-14));
  return density;
}

} // namespace pcl_surflet
