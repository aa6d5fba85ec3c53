#include "experiment/space.h"

#include "pcl_surflet/core/cell_tree.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/linear_octree.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <forward_list>
#include <memory>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr int kDepth = 8;                 // d_max of the experiment
constexpr double kListBytesPerPoint = 32; // a node of PointList on the heap

/** \brief The naive approach of ch. 4.6: a linked list, every point tested. */
class PointList {
public:
  void
  add(PointIndex id, const Position& p)
  {
    points_.push_front({p, id});
  }
  void
  regionSearch(const Position& q, double radius, std::vector<PointIndex>& indices,
               std::vector<float>& squares) const
  {
    indices.clear();
    squares.clear();
    const float limit = squaredRadius(radius);
    for (const auto& entry : points_) {
      const float dx = entry.p[0] - q[0], dy = entry.p[1] - q[1], dz = entry.p[2] - q[2];
      const float square = dx * dx + dy * dy + dz * dz;
      if (square <= limit) {
        indices.push_back(entry.id);
        squares.push_back(square);
      }
    }
  }

private:
  struct Entry {
    Position p;
    PointIndex id;
  };
  std::forward_list<Entry> points_;
};

/** \brief All four representations of one cloud. */
class Subject {
public:
  Subject(std::size_t n, CounterRandom& random)
  {
    const CubeFrame frame{{0, 0, 0}, 1, kDepth};
    octree_ = makeCellTree(TreeKind::Octree, frame);
    avl_ = makeCellTree(TreeKind::AVL, frame);
    for (std::size_t i = 0; i < n; ++i) {
      const Position p = {static_cast<float>(random.uniform()),
                          static_cast<float>(random.uniform()),
                          static_cast<float>(random.uniform())};
      const auto id = static_cast<PointIndex>(i);
      points_.push_back(p);
      list_.add(id, p);
      octree_->add(id, {p[0], p[1], p[2], 0, 0, 1});
      avl_->add(id, {p[0], p[1], p[2], 0, 0, 1});
    }
    linear_.build({points_[0].data(), points_[0].data() + 1, points_[0].data() + 2, 3, n});
  }

  std::size_t
  search(std::size_t method, const Position& q, double radius)
  {
    if (method == List)
      list_.regionSearch(q, radius, indices_, squares_);
    else
      index(method).regionSearch(q, radius, indices_, &squares_);
    return indices_.size();
  }

  double
  bytesPerPoint(std::size_t method) const
  {
    const double n = static_cast<double>(points_.size());
    return method == List ? kListBytesPerPoint
                          : static_cast<double>(index(method).memoryUsage()) / n;
  }

  const Position&
  point(CounterRandom& random) const
  {
    return points_[random.below(static_cast<std::uint32_t>(points_.size()))];
  }

private:
  const RegionIndex&
  index(std::size_t method) const
  {
    if (method == Linear)
      return linear_;
    return method == Octree ? *octree_ : *avl_;
  }

  std::vector<Position> points_;
  PointList list_;
  std::unique_ptr<CellTree> octree_, avl_;
  LinearOctree linear_;
  std::vector<PointIndex> indices_;
  std::vector<float> squares_;
};

/** \brief Step \p i of \p n equal ones from \p low to \p high. */
double
step(std::uint64_t i, std::uint64_t n, double low, double high)
{
  const double part = n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0;
  return low + part * (high - low);
}

/** \brief Times every method on the same \p queries, in turns, so that a busy machine slows all;
 * medians, so that being interrupted counts for nothing. */
SpaceRow
measure(Subject& subject, double saturation, double radius, std::uint64_t queries,
        CounterRandom& random)
{
  SpaceRow row{saturation, radius, 0, {}, {}};
  std::array<std::vector<double>, kSpaceMethods> seconds;
  for (std::uint64_t i = 0; i < queries; ++i) {
    const Position q = subject.point(random);
    for (std::size_t m = 0; m < kSpaceMethods; ++m) {
      const auto start = std::chrono::steady_clock::now();
      const std::size_t hits = subject.search(m, q, radius);
      seconds[m].push_back(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      row.hits += m == Linear ? static_cast<double>(hits) / static_cast<double>(queries) : 0;
    }
  }
  for (std::size_t m = 0; m < kSpaceMethods; ++m) {
    auto& t = seconds[m];
    const auto middle = t.begin() + static_cast<std::ptrdiff_t>(t.size() / 2);
    std::nth_element(t.begin(), middle, t.end());
    row.seconds[m] = *middle;
    row.per_point[m] = subject.bytesPerPoint(m);
  }
  return row;
}

} // namespace

const char* const*
spaceMethodNames()
{
  static const char* const names[kSpaceMethods] = {"list", "octree", "avl", "linear"};
  return names;
}

double
relativeTime(const SpaceRow& row, std::size_t method)
{
  const double fastest = std::min({row.seconds[List], row.seconds[Octree], row.seconds[AVL]});
  return 100 * (row.seconds[method] / fastest - 1);
}

double
saturationOf(const SpaceOptions& options, std::uint64_t i)
{
  return step(i, options.saturations, 0.001, 0.1);
}

std::vector<SpaceRow>
runSpace(const SpaceOptions& options, const ProgressFunction& progress)
{
  std::vector<SpaceRow> rows;
  for (std::uint64_t s = 0; s < options.saturations; ++s) {
    const double saturation = saturationOf(options, s);
    CounterRandom random(options.seed, s);
    Subject subject(static_cast<std::size_t>(std::lround(saturation * std::ldexp(1, 3 * kDepth))),
                    random);
    for (std::uint64_t r = 0; r < options.radii; ++r) {
      progress(rows.size(), "saturation " + std::to_string(s + 1));
      const double radius = step(r, options.radii, 0.01, 0.5);
      rows.push_back(measure(subject, saturation, radius, options.queries, random));
    }
  }
  return rows;
}

} // namespace apps
} // namespace pcl_surflet
