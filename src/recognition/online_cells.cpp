#include "online_cells.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace online {
namespace {

/** \brief Beyond this many cells from the origin floats no longer tell neighbours apart. */
constexpr double kFarthest = 1e9;

Surflet
meanOf(const detail::CellSums& sums)
{
  const double n = sums.count, length = sums.normalLength();
  const auto* p = sums.position;
  const auto* d = sums.normal;
  return {static_cast<float>(p[0] / n),      static_cast<float>(p[1] / n),
          static_cast<float>(p[2] / n),      static_cast<float>(d[0] / length),
          static_cast<float>(d[1] / length), static_cast<float>(d[2] / length)};
}

void
assign(SurfletSet& set, std::size_t i, const Surflet& s)
{
  if (i == set.size())
    return set.push_back(s);
  set.x[i] = s.x;
  set.y[i] = s.y;
  set.z[i] = s.z;
  set.nx[i] = s.nx;
  set.ny[i] = s.ny;
  set.nz[i] = s.nz;
}

bool
hasChanged(const Surflet& now, const Surflet& then, double distance, double cosine)
{
  return std::hypot(now.x - then.x, now.y - then.y, now.z - then.z) > distance ||
         now.nx * then.nx + now.ny * then.ny + now.nz * then.nz < cosine;
}

} // namespace

std::size_t
CellKeyHash::operator()(const CellKey& key) const
{
  std::uint64_t h = 0;
  for (const auto k : key) {
    h = (h ^ static_cast<std::uint64_t>(k)) * 0x9E3779B97F4A7C15u;
    h ^= h >> 29;
  }
  return h;
}

OnlineCells::OnlineCells(double leaf) : leaf_(leaf) {}

std::uint32_t&
OnlineCells::cellOf(const SurfletSet& set, std::size_t i, const CellKey& key)
{
  const auto [place, is_new] = sides_.try_emplace(key);
  Sides& sides = place->second;
  if (is_new)
    sides.first = {set.nx[i], set.ny[i], set.nz[i]};
  const auto& f = sides.first;
  return sides.cell[set.nx[i] * f[0] + set.ny[i] * f[1] + set.nz[i] * f[2] < 0 ? 1 : 0];
}

bool
OnlineCells::add(const SurfletSet& set, std::size_t i)
{
  const std::array<double, 3> p{set.x[i] / leaf_, set.y[i] / leaf_, set.z[i] / leaf_};
  CellKey key;
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(std::abs(p[a]) < kFarthest))
      return false;
    key[a] = static_cast<std::int64_t>(std::floor(p[a]));
  }
  std::uint32_t& cell = cellOf(set, i, key);
  if (cell == kNone) {
    cell = static_cast<std::uint32_t>(sums_.size());
    sums_.emplace_back();
    keys_.push_back(key);
    is_touched_.push_back(false);
  }
  sums_[cell].add(set, i);
  if (!is_touched_[cell])
    touched_.push_back(cell);
  is_touched_[cell] = true;
  return true;
}

std::vector<std::uint32_t>
OnlineCells::takeChanged(double moved, double turned)
{
  std::sort(touched_.begin(), touched_.end()); // what is new comes last, in order
  std::vector<std::uint32_t> changed;
  for (const auto c : touched_) {
    const Surflet mean = meanOf(sums_[c]);
    assign(means_, c, mean);
    is_touched_[c] = false;
    if (c < taken_.size() && !hasChanged(mean, taken_[c], moved * leaf_, std::cos(turned)))
      continue;
    assign(taken_, c, mean);
    changed.push_back(c);
  }
  touched_.clear();
  return changed;
}

} // namespace online
} // namespace pcl_surflet
