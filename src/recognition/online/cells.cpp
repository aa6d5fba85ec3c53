#include "cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

namespace pcl_surflet {
namespace online {
namespace {

/** \brief Beyond this many cells from the origin floats no longer tell neighbours apart. */
constexpr double kFarthest = 1e9;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Surflet
meanOf(const detail::CellSums& sums)
{
  // The first surflet of a side keeps the length from 0.
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
  set.x[i] = s.x;
  set.y[i] = s.y;
  set.z[i] = s.z;
  set.nx[i] = s.nx;
  set.ny[i] = s.ny;
  set.nz[i] = s.nz;
}

/** \brief Also where an array is longer than the others, as after a push_back() that threw. */
void
shorten(SurfletSet& set, std::size_t n)
{
  for (auto* values : {&set.x, &set.y, &set.z, &set.nx, &set.ny, &set.nz})
    values->resize(std::min(n, values->size()));
}

bool
hasChanged(const Surflet& now, const Surflet& then, double distance, double cosine)
{
  return std::hypot(now.x - then.x, now.y - then.y, now.z - then.z) > distance ||
         now.nx * then.nx + now.ny * then.ny + now.nz * then.nz < cosine;
}

std::int64_t
floorDivided(std::int64_t a, std::int64_t b)
{
  return a / b - (a % b < 0 ? 1 : 0);
}

/** \brief Squared least distance of two blocks that are so many steps apart along an axis. */
std::int64_t
gap(std::int64_t steps)
{
  const std::int64_t between = std::max<std::int64_t>(std::abs(steps) - 1, 0);
  return between * between;
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

OnlineCells::OnlineCells(double leaf, double block)
    : leaf_(leaf), cells_per_block_(std::max<std::int64_t>(std::llround(block / leaf), 1))
{
}

CellKey
OnlineCells::blockOf(const CellKey& cell) const
{
  return {floorDivided(cell[0], cells_per_block_), floorDivided(cell[1], cells_per_block_),
          floorDivided(cell[2], cells_per_block_)};
}

Place
OnlineCells::middleOf(const CellKey& block) const
{
  Place middle;
  for (std::size_t a = 0; a < 3; ++a)
    middle[a] =
        (static_cast<double>(block[a]) + 0.5) * leaf_ * static_cast<double>(cells_per_block_);
  return middle;
}

void
OnlineCells::begin() noexcept
{
  for (const auto c : removed_) {
    auto& cells = blocks_.find(blockOf(cells_[c].key))->second;
    cells.erase(std::remove(cells.begin(), cells.end(), c), cells.end());
  }
  removed_.clear();
  touched_.clear();
  saved_cells_.clear();
  saved_sides_.clear();
  cells_before_ = cells_.size();
  ++begun_;
}

void
OnlineCells::rollBack() noexcept
{
  for (std::size_t c = cells_before_; c < cells_.size(); ++c)
    if (const auto block = blocks_.find(blockOf(cells_[c].key)); block != blocks_.end())
      while (!block->second.empty() && block->second.back() >= cells_before_)
        block->second.pop_back();
  cells_.resize(std::min(cells_before_, cells_.size()));
  shorten(means_, cells_before_);
  for (const auto& s : saved_cells_) {
    cells_[s.cell] = s.before;
    assign(means_, s.cell, s.mean);
  }
  for (auto s = saved_sides_.rbegin(); s != saved_sides_.rend(); ++s)
    if (!s->was_there)
      sides_.erase(s->key);
    else
      sides_.find(s->key)->second = s->before;
  removed_.clear(); // still in their blocks
  begin();
}

void
OnlineCells::save(std::uint32_t cell)
{
  if (cells_[cell].saved_for == begun_)
    return;
  if (cell < cells_before_)
    saved_cells_.push_back({cell, cells_[cell], means_[cell]});
  cells_[cell].saved_for = begun_;
}

/** \brief The sides of a cell, ready to be changed; a cell without any takes the surflet's normal
 * for its first. */
OnlineCells::Sides&
OnlineCells::sidesFor(const CellKey& key, const SurfletSet& set, std::size_t i)
{
  const auto known = sides_.find(key);
  const bool is_new = known == sides_.end();
  if (!is_new && (known->second.cell[0] != kNone || known->second.cell[1] != kNone))
    return known->second;
  saved_sides_.push_back({key, !is_new, is_new ? Sides() : known->second});
  Sides& sides = is_new ? sides_[key] : known->second;
  sides.first = {set.nx[i], set.ny[i], set.nz[i]};
  return sides;
}

std::uint32_t
OnlineCells::appended(const CellKey& key)
{
  const auto cell = static_cast<std::uint32_t>(cells_.size());
  cells_.emplace_back().key = key; // first: rollBack() goes by the cells there are
  blocks_[blockOf(key)].push_back(cell);
  means_.push_back({kNan, kNan, kNan, kNan, kNan, kNan});
  return cell;
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
  Sides& sides = sidesFor(key, set, i);
  const auto& f = sides.first;
  auto& cell = sides.cell[set.nx[i] * f[0] + set.ny[i] * f[1] + set.nz[i] * f[2] < 0 ? 1 : 0];
  if (cell == kNone) {
    saved_sides_.push_back({key, true, sides});
    cell = appended(key);
  }
  if (cells_[cell].saved_for != begun_) {
    touched_.push_back(cell);
    save(cell);
  }
  cells_[cell].sums.add(set, i);
  return true;
}

void
OnlineCells::remove(std::uint32_t cell)
{
  removed_.push_back(cell);
  save(cell);
  Sides& sides = sides_.find(cells_[cell].key)->second;
  saved_sides_.push_back({cells_[cell].key, true, sides});
  sides.cell[sides.cell[0] == cell ? 0 : 1] = kNone;
  cells_[cell].is_there = false;
  assign(means_, cell, {kNan, kNan, kNan, kNan, kNan, kNan});
}

void
OnlineCells::setBackground(std::uint32_t cell, bool is_background)
{
  cells_[cell].is_background = is_background;
}

Indices
OnlineCells::takeChanged(double moved, double turned)
{
  std::sort(touched_.begin(), touched_.end());
  Indices changed;
  for (const auto c : touched_) {
    Cell& cell = cells_[c];
    const Surflet mean = meanOf(cell.sums);
    assign(means_, c, mean);
    if (cell.is_taken && !hasChanged(mean, cell.taken, moved * leaf_, std::cos(turned)))
      continue;
    cell.taken = mean;
    cell.is_taken = true;
    changed.push_back(c);
  }
  return changed;
}

void
OnlineCells::append(const CellKey& key, Indices& cells) const
{
  const auto sides = sides_.find(key);
  if (sides == sides_.end())
    return;
  for (const auto c : sides->second.cell)
    if (c != kNone && takesPart(c))
      cells.push_back(c);
}

Indices
OnlineCells::near(const std::vector<Place>& places, double reach) const
{
  const double edge = leaf_ * static_cast<double>(cells_per_block_);
  const double in_blocks = reach / edge;
  const auto n = static_cast<std::int64_t>(std::ceil(in_blocks));
  std::unordered_set<CellKey, CellKeyHash> origins, blocks;
  for (const auto& p : places) {
    CellKey key;
    for (std::size_t a = 0; a < 3; ++a)
      key[a] = static_cast<std::int64_t>(std::floor(p[a] / edge));
    origins.insert(key);
  }
  for (const auto& o : origins)
    for (std::int64_t x = -n; x <= n; ++x)
      for (std::int64_t y = -n; y <= n; ++y)
        for (std::int64_t z = -n; z <= n; ++z)
          if (static_cast<double>(gap(x) + gap(y) + gap(z)) <= in_blocks * in_blocks)
            blocks.insert({o[0] + x, o[1] + y, o[2] + z});
  Indices found;
  for (const auto& b : blocks)
    if (const auto cells = blocks_.find(b); cells != blocks_.end())
      for (const auto c : cells->second)
        if (takesPart(c))
          found.push_back(c);
  std::sort(found.begin(), found.end());
  return found;
}

} // namespace online
} // namespace pcl_surflet
