#include "attention.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace pcl_surflet {
namespace online {
namespace {

/** \brief A mean normal shorter than this says nothing about where the sensor was. */
constexpr double kEveryWay = 0.1;

using Keys = std::unordered_set<CellKey, CellKeyHash>;

CellKey
neighbour(const CellKey& key, int step)
{
  return {key[0] + step % 3 - 1, key[1] + step / 3 % 3 - 1, key[2] + step / 9 - 1};
}

/** \brief Fills groups from cells one by one, and gives up those that become too wide. */
class Filling {
public:
  Filling(const OnlineCells& cells, std::int64_t widest, const IsOpen& is_open)
      : cells_(cells), widest_(widest), is_open_(is_open)
  {
  }

  /** \brief The group of a cell; empty if it is known already, not open or too wide. */
  Group
  from(const CellKey& key)
  {
    Group group;
    group.low = group.high = key;
    std::vector<CellKey> next, filled;
    const auto take = [&](const CellKey& k) {
      const auto before = group.cells.size();
      if (filled_.count(k) == 0)
        appendOpen(k, group.cells);
      if (group.cells.size() == before)
        return wide_.count(k) == 0;
      filled_.insert(k);
      filled.push_back(k);
      next.push_back(k);
      return widen(group, k);
    };
    bool is_narrow = take(key);
    while (!next.empty() && is_narrow) {
      const CellKey at = next.back();
      next.pop_back();
      for (int step = 0; step < 27 && is_narrow; ++step)
        is_narrow = take(neighbour(at, step));
    }
    if (!is_narrow) {
      wide_.insert(filled.begin(), filled.end());
      return {};
    }
    std::sort(group.cells.begin(), group.cells.end());
    return group;
  }

private:
  void
  appendOpen(const CellKey& key, Indices& out) const
  {
    const auto begin = static_cast<std::ptrdiff_t>(out.size());
    cells_.append(key, out);
    out.erase(std::remove_if(out.begin() + begin, out.end(),
                             [&](std::uint32_t c) { return !is_open_(c); }),
              out.end());
  }
  bool
  widen(Group& group, const CellKey& key) const
  {
    bool is_narrow = true;
    for (std::size_t a = 0; a < 3; ++a) {
      group.low[a] = std::min(group.low[a], key[a]);
      group.high[a] = std::max(group.high[a], key[a]);
      is_narrow = is_narrow && group.high[a] - group.low[a] <= widest_;
    }
    return is_narrow;
  }

  const OnlineCells& cells_;
  std::int64_t widest_;
  const IsOpen& is_open_;
  Keys filled_, wide_; ///< wide_: known to be part of something too wide
};

bool
touches(const Group& group, const CellKey& key)
{
  for (std::size_t a = 0; a < 3; ++a)
    if (key[a] < group.low[a] - 1 || key[a] > group.high[a] + 1)
      return false;
  return true;
}

} // namespace

Patch
patchOf(const SurfletSet& cells, const Indices& indices)
{
  Patch patch;
  const SurfletSet part = cells.subset(indices);
  const Extent extent = computeExtent(part);
  const auto n = static_cast<double>(std::max<std::size_t>(part.size(), 1));
  for (std::size_t a = 0; a < 3; ++a)
    patch.centre[a] = extent.centroid[a];
  patch.radius = extent.r_max;
  for (std::size_t i = 0; i < part.size(); ++i) {
    patch.normal[0] += part.nx[i] / n;
    patch.normal[1] += part.ny[i] / n;
    patch.normal[2] += part.nz[i] / n;
  }
  return patch;
}

Attractor
attractorAt(const Patch& patch, std::uint64_t id)
{
  Attractor a{patch.centre, patch.radius, {}, id};
  const auto& n = patch.normal;
  const double length = std::hypot(n[0], n[1], n[2]);
  if (length >= kEveryWay)
    for (std::size_t k = 0; k < 3; ++k)
      a.view_from[k] = -n[k] / length;
  return a;
}

Groups
regrouped(const OnlineCells& cells, const Groups& before, const std::vector<CellKey>& changed,
          double leaf, double widest, const IsOpen& is_open)
{
  Groups groups;
  std::vector<CellKey> seeds;
  for (const auto& group : before) {
    const bool stays = std::none_of(changed.begin(), changed.end(),
                                    [&](const CellKey& key) { return touches(*group, key); });
    if (stays)
      groups.push_back(group);
    else
      for (const auto c : group->cells)
        seeds.push_back(cells.keyOf(c));
  }
  // What was part of something wide may have been cut off: it lies beside what changed.
  for (const auto& key : changed)
    for (int step = 0; step < 27; ++step)
      seeds.push_back(neighbour(key, step));
  Filling filling(cells, static_cast<std::int64_t>(std::ceil(widest / leaf)), is_open);
  for (const auto& key : seeds) {
    auto group = std::make_shared<Group>(filling.from(key));
    if (group->cells.empty())
      continue;
    group->patch = patchOf(cells.means(), group->cells);
    groups.push_back(std::move(group));
  }
  std::sort(groups.begin(), groups.end(),
            [](const auto& a, const auto& b) { return a->cells.front() < b->cells.front(); });
  return groups;
}

} // namespace online
} // namespace pcl_surflet
