#include "scene_parts.h"

#include "pcl_surflet/core/counter_random.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <unordered_map>

namespace pcl_surflet {
namespace detail {
namespace {

constexpr int kTriesPerItem = 500, kRestarts = 100;
constexpr std::uint64_t kPlacementStream = 0x706c616365ULL;

std::string
number(double v)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", v);
  return text;
}

void
settle(PlacementItem& item, const SceneOptions& o)
{
  double lift = -std::numeric_limits<double>::infinity();
  const auto& s = item.surflets;
  for (std::size_t i = 0; i < s.size(); ++i)
    lift = std::max(lift, floorHeight(o, s.x[i], s.y[i]) - s.z[i]);
  translate(item, {0, 0, lift});
}

/** \brief Does the item's bounding cylinder lie within the background? */
bool
inside(const PlacementItem& item, const SceneOptions& o)
{
  const double x = std::abs(item.centroid[0]), y = std::abs(item.centroid[1]), r = item.radius_xy;
  if (o.background == Background::Bowl)
    return std::hypot(x, y) + r <= o.size / 2;
  const auto half = halfEdges(o);
  return x + r <= half[0] && y + r <= half[1];
}

double
horizontalDistance(const PlacementItem& a, const PlacementItem& b)
{
  return std::hypot(a.centroid[0] - b.centroid[0], a.centroid[1] - b.centroid[1]);
}

/** \brief Eq. 5.22 with its factor, and no overlap of the vertical bounding cylinders. */
bool
farEnough(const PlacementItem& a, const PlacementItem& b, double factor)
{
  return horizontalDistance(a, b) >=
         std::max(factor * std::min(a.radius, b.radius), a.radius_xy + b.radius_xy);
}

/** \brief Tries random places for item \p i. \return false if none was free */
bool
placeApart(std::vector<PlacementItem>& items, std::size_t i, const SceneOptions& o,
           CounterRandom& random)
{
  auto& item = items[i];
  const auto half = halfEdges(o);
  const double reach_x = half[0] - item.radius_xy, reach_y = half[1] - item.radius_xy;
  if (reach_x < 0 || reach_y < 0)
    return false;
  for (int k = 0; k < kTriesPerItem; ++k) {
    const double x = random.uniform(-reach_x, reach_x), y = random.uniform(-reach_y, reach_y);
    translate(item, {x - item.centroid[0], y - item.centroid[1], 0});
    const bool free = std::all_of(
        items.begin(), items.begin() + static_cast<std::ptrdiff_t>(i),
        [&](const PlacementItem& other) { return farEnough(item, other, o.distance_factor); });
    if (free && inside(item, o))
      return true;
  }
  return false;
}

/** \brief Places that a sliding item sweeps: cells across the direction it moves in. */
class SweptCells {
public:
  SweptCells(double angle, double cell)
      : along_{std::cos(angle), std::sin(angle), 0}, across_{-std::sin(angle), std::cos(angle), 0},
        cell_(cell)
  {
  }

  /** \brief Remembers how far each cell is filled against the direction of motion. */
  void
  addObstacle(const SurfletSet& s)
  {
    for (std::size_t i = 0; i < s.size(); ++i) {
      const auto found = front_.emplace(key(s, i), depth(s, i));
      found.first->second = std::min(found.first->second, depth(s, i));
    }
  }

  /** \brief How far \p s can move before it meets an obstacle; infinite if it never does. */
  double
  freeWay(const SurfletSet& s) const
  {
    double way = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < s.size(); ++i) {
      const auto found = front_.find(key(s, i));
      if (found != front_.end())
        way = std::min(way, found->second - depth(s, i));
    }
    return way;
  }

  const Vector3&
  along() const
  {
    return along_;
  }

private:
  double
  depth(const SurfletSet& s, std::size_t i) const
  {
    return along_[0] * s.x[i] + along_[1] * s.y[i];
  }
  std::int64_t
  key(const SurfletSet& s, std::size_t i) const
  {
    const double u = across_[0] * s.x[i] + across_[1] * s.y[i];
    return static_cast<std::int64_t>(std::floor(u / cell_)) * (std::int64_t{1} << 32) +
           static_cast<std::int64_t>(std::floor(s.z[i] / cell_));
  }

  Vector3 along_, across_;
  double cell_;
  std::unordered_map<std::int64_t, double> front_;
};

/** \brief Slides item \p i towards one of those before it until it is the gap from meeting one. */
void
slideIn(std::vector<PlacementItem>& items, std::size_t i, const SceneOptions& o,
        CounterRandom& random)
{
  auto& item = items[i];
  const auto& target = items[random.below(static_cast<std::uint32_t>(i))];
  const double angle = random.uniform(0, 2 * M_PI);
  // Two surflets and more of each item fall into a cell, on average.
  SweptCells cells(angle, 1.5 / std::sqrt(o.density));
  double start = item.radius_xy;
  for (std::size_t k = 0; k < i; ++k) {
    cells.addObstacle(items[k].surflets);
    start += 2 * items[k].radius_xy + o.gap;
  }
  const Vector3 from = subtract(target.centroid, scaled(cells.along(), start));
  translate(item, {from[0] - item.centroid[0], from[1] - item.centroid[1], 0});
  double way = cells.freeWay(item.surflets) - o.gap;
  if (!std::isfinite(way)) // slides above or below: only the footprints can meet
    way = start - target.radius_xy - item.radius_xy - o.gap;
  translate(item, scaled(cells.along(), way));
}

void
placePile(std::vector<PlacementItem>& items, const SceneOptions& o, CounterRandom& random)
{
  Vector3 low{0, 0, 0}, high{0, 0, 0};
  for (std::size_t i = 0; i < items.size(); ++i) {
    auto& item = items[i];
    translate(item, {-item.centroid[0], -item.centroid[1], 0});
    if (i > 0)
      slideIn(items, i, o, random);
    for (std::size_t a = 0; a < 2; ++a) {
      low[a] = i == 0 ? item.centroid[a] - item.radius_xy
                      : std::min(low[a], item.centroid[a] - item.radius_xy);
      high[a] = i == 0 ? item.centroid[a] + item.radius_xy
                       : std::max(high[a], item.centroid[a] + item.radius_xy);
    }
  }
  for (auto& item : items)
    translate(item, {-(low[0] + high[0]) / 2, -(low[1] + high[1]) / 2, 0});
}

/** \brief Puts the first item somewhere and the others at their distance from it.
 * \return false if one lies outside */
bool
placePairs(std::vector<PlacementItem>& items, const SceneOptions& o, CounterRandom& random)
{
  const auto half = halfEdges(o);
  for (auto& item : items) {
    double x = random.uniform(-half[0], half[0]), y = random.uniform(-half[1], half[1]);
    if (&item != &items.front()) {
      const double way = o.distance_factor * std::min(item.radius, items.front().radius);
      const double angle = random.uniform(0, 2 * M_PI);
      x = items.front().centroid[0] + way * std::cos(angle);
      y = items.front().centroid[1] + way * std::sin(angle);
    }
    translate(item, {x - item.centroid[0], y - item.centroid[1], 0});
    if (!inside(item, o))
      return false;
  }
  return true;
}

bool
attempt(std::vector<PlacementItem>& items, const SceneOptions& o, CounterRandom& random)
{
  if (o.spacing == Spacing::Pile) {
    placePile(items, o, random);
    return std::all_of(items.begin(), items.end(), [&](const auto& i) { return inside(i, o); });
  }
  if (o.spacing == Spacing::Pair)
    return placePairs(items, o, random);
  for (std::size_t i = 0; i < items.size(); ++i)
    if (!placeApart(items, i, o, random))
      return false;
  return true;
}

} // namespace

void
placeItems(std::vector<PlacementItem>& items, const SceneOptions& o)
{
  CounterRandom random(o.seed, kPlacementStream);
  SceneOptions level = o; // items slide on a level floor and settle on the true one afterwards
  level.background = Background::None;
  for (auto& item : items)
    settle(item, level);
  for (int k = 0; k < kRestarts; ++k)
    if (attempt(items, o, random)) {
      for (auto& item : items)
        settle(item, o);
      return;
    }
  throw std::invalid_argument("generateScene: " + std::to_string(items.size()) +
                              " items do not fit on a background of size " + number(o.size) +
                              "; make it larger, use fewer items or a smaller distance_factor");
}

} // namespace detail
} // namespace pcl_surflet
