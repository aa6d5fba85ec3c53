#include "pcl_surflet/core/geometry.h"

#include "pcl_surflet/core/counter_random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
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

/** \brief A k-d tree of boxes for farthest-point queries. */
class FarthestTree {
public:
  explicit FarthestTree(std::vector<Point> points) : points_(std::move(points))
  {
    build(0, points_.size());
  }

  /** \brief Squared distance of the point farthest from \p q if above \p best, else \p best. */
  double
  farther(const Point& q, double best) const
  {
    return search(0, q, best);
  }

private:
  static constexpr std::size_t kLeaf = 16;

  struct Node {
    Point low, high;
    std::size_t begin, end;
    std::size_t right = 0; ///< 0: a leaf; the left child is the next node
  };

  std::size_t
  build(std::size_t begin, std::size_t end)
  {
    const std::size_t self = nodes_.size();
    Node node{points_[begin], points_[begin], begin, end, 0};
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        node.low[k] = std::min(node.low[k], points_[i][k]);
        node.high[k] = std::max(node.high[k], points_[i][k]);
      }
    nodes_.push_back(node);
    if (end - begin <= kLeaf)
      return self;
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (node.high[k] - node.low[k] > node.high[axis] - node.low[axis])
        axis = k;
    const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
    const std::size_t middle = (begin + end) / 2;
    std::nth_element(at(begin), at(middle), at(end),
                     [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; });
    build(begin, middle);
    const std::size_t right = build(middle, end);
    nodes_[self].right = right;
    return self;
  }

  static double
  reach(const Node& node, const Point& q)
  {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = std::max(std::abs(q[k] - node.low[k]), std::abs(node.high[k] - q[k]));
      sum += d * d;
    }
    return sum;
  }

  double
  search(std::size_t index, const Point& q, double best) const
  {
    const Node& node = nodes_[index];
    if (node.right == 0) {
      for (std::size_t i = node.begin; i < node.end; ++i)
        best = std::max(best, squaredDistance(points_[i], q));
      return best;
    }
    std::size_t near = index + 1, far = node.right;
    double near_reach = reach(nodes_[near], q), far_reach = reach(nodes_[far], q);
    if (near_reach > far_reach) {
      std::swap(near, far);
      std::swap(near_reach, far_reach);
    }
    if (far_reach > best)
      best = search(far, q, best);
    if (near_reach > best)
      best = search(near, q, best);
    return best;
  }

  std::vector<Point> points_;
  std::vector<Node> nodes_;
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
  const auto points = pointsOf(unit.set);
  // An end of the longest pair (length L) lies at least L - r_max from the centroid.
  std::vector<double> radius(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    radius[i] = std::sqrt(squaredDistance(points[i], {0, 0, 0}));
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return radius[a] > radius[b]; });
  const FarthestTree tree(points);
  const double r_max = radius[order.front()];
  double best = 0;
  for (const auto i : order) {
    if (radius[i] + r_max < std::sqrt(best))
      break;
    best = tree.farther(points[i], best);
  }
  return std::sqrt(best) / unit.scale;
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
