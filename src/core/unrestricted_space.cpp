#include "pcl_surflet/core/unrestricted_space.h"

#include "cell_tree_detail.h"
#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace pcl_surflet {

namespace {

/** \brief Points in the cubes reached from which on threads are worth starting. */
constexpr std::size_t kParallelPoints = 50000;

/** \brief std::floor() without a library call, which machines without SSE4.1 need. */
double
floorOf(double v)
{
  if (!(v > -0x1p52 && v < 0x1p52))
    return v; // whole already
  const auto whole = static_cast<double>(static_cast<std::int64_t>(v));
  return whole > v ? whole - 1 : whole;
}

} // namespace

UnrestrictedSpace::UnrestrictedSpace(const Options& options)
    : options_(options), edge_(std::ldexp(options.cell, options.depth))
{
  if (!(options.cell > 0) || !std::isfinite(options.cell))
    throw std::invalid_argument("UnrestrictedSpace: the cell must be positive and finite, it is " +
                                std::to_string(options.cell));
  makeCellTree(options.tree, CubeFrame{{0, 0, 0}, edge_, options.depth}); // checks the rest
}

UnrestrictedSpace::~UnrestrictedSpace() = default;

SuperKey
UnrestrictedSpace::superKeyOf(const std::array<double, 3>& p) const
{
  return {floorOf(p[0] / edge_), floorOf(p[1] / edge_), floorOf(p[2] / edge_)};
}

SuperKey
UnrestrictedSpace::superKey(const Position& p) const
{
  return superKeyOf({p[0], p[1], p[2]});
}

CellTree&
UnrestrictedSpace::cubeAt(const SuperKey& key)
{
  if (last_cube_ && key == last_key_)
    return *last_cube_;
  auto& cube = cubes_[key];
  if (!cube) {
    const CubeFrame frame{{key[0] * edge_, key[1] * edge_, key[2] * edge_}, edge_, options_.depth};
    cube = makeCellTree(options_.tree, frame);
  }
  last_key_ = key;
  last_cube_ = cube.get();
  return *cube;
}

bool
UnrestrictedSpace::add(PointIndex id, const Surflet& s)
{
  if (id < 0 || contains(id) || !detail::isFinite({s.x, s.y, s.z}))
    return false;
  const auto i = static_cast<std::size_t>(id);
  if (i >= points_.size())
    reserve(id + 1);
  cubeAt(superKey({s.x, s.y, s.z})).add(id, s);
  points_[i] = s;
  ++size_;
  return true;
}

void
UnrestrictedSpace::reserve(PointIndex end)
{
  Surflet unused;
  unused.x = std::numeric_limits<float>::quiet_NaN();
  if (end > 0 && static_cast<std::size_t>(end) > points_.size())
    points_.resize(static_cast<std::size_t>(end), unused);
}

std::size_t
UnrestrictedSpace::addBatch(const PointIndex* ids, const Surflet* surflets, std::size_t n)
{
#if defined(__GNUC__) || defined(__clang__)
  // Numbers in random order would miss the cache one after the other; so they do all at once.
  for (std::size_t i = 0; i < n; ++i)
    if (ids[i] >= 0 && static_cast<std::size_t>(ids[i]) < points_.size())
      __builtin_prefetch(&points_[static_cast<std::size_t>(ids[i])], 1);
#endif
  std::size_t added = 0;
  for (std::size_t i = 0; i < n; ++i)
    added += add(ids[i], surflets[i]);
  return added;
}

std::size_t
UnrestrictedSpace::addBatch(PointIndex first, const SurfletSet& set)
{
  std::size_t added = 0;
  for (std::size_t i = 0; i < set.size(); ++i)
    added += add(static_cast<PointIndex>(first + static_cast<PointIndex>(i)), set[i]);
  return added;
}

bool
UnrestrictedSpace::remove(PointIndex id)
{
  if (!contains(id))
    return false;
  Surflet& s = points_[static_cast<std::size_t>(id)];
  const SuperKey key = superKey({s.x, s.y, s.z});
  CellTree& cube = cubeAt(key);
  cube.remove(id, s);
  if (cube.size() == 0) {
    cubes_.erase(key);
    last_cube_ = nullptr;
  }
  s.x = std::numeric_limits<float>::quiet_NaN();
  --size_;
  return true;
}

bool
UnrestrictedSpace::contains(PointIndex id) const
{
  return id >= 0 && static_cast<std::size_t>(id) < points_.size() &&
         !std::isnan(points_[static_cast<std::size_t>(id)].x);
}

const UnrestrictedSpace::Options&
UnrestrictedSpace::options() const
{
  return options_;
}

void
UnrestrictedSpace::setNumberOfThreads(unsigned threads)
{
  options_.threads = threads;
}

std::size_t
UnrestrictedSpace::cubeCount() const
{
  return cubes_.size();
}

std::size_t
UnrestrictedSpace::cellCount() const
{
  std::size_t cells = 0;
  for (const auto& cube : cubes_)
    cells += cube.second->cellCount();
  return cells;
}

void
UnrestrictedSpace::forEachCell(const std::function<void(const Cell&)>& visit) const
{
  for (const auto& cube : cubes_)
    cube.second->forEachCell(visit);
}

std::size_t
UnrestrictedSpace::size() const
{
  return size_;
}

std::size_t
UnrestrictedSpace::memoryUsage() const
{
  std::size_t bytes = sizeof(*this) + points_.capacity() * sizeof(Surflet);
  for (const auto& cube : cubes_)
    bytes += cube.second->memoryUsage() + sizeof(Cubes::value_type) + 4 * sizeof(void*);
  return bytes;
}

/** \brief The cubes whose super-keys lie between two corners, in the order of the keys. */
std::vector<const CellTree*>
UnrestrictedSpace::cubesBetween(const SuperKey& low, const SuperKey& high) const
{
  std::vector<const CellTree*> found;
  auto cube = cubes_.lower_bound(low);
  while (cube != cubes_.end() && cube->first[0] <= high[0]) {
    // Within a slab or bar the keys of interest are consecutive: jump over what lies between.
    SuperKey next = cube->first;
    if (next[1] < low[1])
      next = {next[0], low[1], low[2]};
    else if (next[1] > high[1])
      next = {next[0] + 1, low[1], low[2]};
    else if (next[2] < low[2])
      next = {next[0], next[1], low[2]};
    else if (next[2] > high[2])
      next = {next[0], next[1] + 1, low[2]};
    else {
      found.push_back(cube->second.get());
      ++cube;
      continue;
    }
    // Beyond 2^53 adding 1 changes nothing: step instead.
    cube = cube->first < next ? cubes_.lower_bound(next) : std::next(cube);
  }
  return found;
}

/** \brief Extension 1 of ch. 4.5.3: the cubes that may hold a part of F(r, q). */
std::vector<const CellTree*>
UnrestrictedSpace::cubesReached(const Position& q, double radius) const
{
  if (size_ == 0 || !(radius >= 0) || !detail::isFinite(q))
    return {};
  const double reach = detail::reachOf(radius);
  return cubesBetween(superKeyOf({q[0] - reach, q[1] - reach, q[2] - reach}),
                      superKeyOf({q[0] + reach, q[1] + reach, q[2] + reach}));
}

void
UnrestrictedSpace::regionSearch(const Position& q, double radius, std::vector<PointIndex>& indices,
                                std::vector<float>* sqr_distances) const
{
  const auto cubes = cubesReached(q, radius); // 1: which cubes
  if (cubes.size() == 1)
    return cubes[0]->regionSearch(q, radius, indices, sqr_distances);
  indices.clear();
  if (sqr_distances)
    sqr_distances->clear();
  std::size_t points = 0;
  for (const CellTree* cube : cubes)
    points += cube->size();
  struct Part {
    std::vector<PointIndex> indices;
    std::vector<float> squares;
  };
  std::vector<Part> parts(cubes.size());
  const unsigned threads = points < kParallelPoints ? 1 : options_.threads;
  parallelFor(cubes.size(), threads, [&](std::size_t i, unsigned) { // 2: search each
    cubes[i]->regionSearch(q, radius, parts[i].indices,
                           sqr_distances ? &parts[i].squares : nullptr);
  });
  for (const Part& part : parts) { // 3: merge
    indices.insert(indices.end(), part.indices.begin(), part.indices.end());
    if (sqr_distances)
      sqr_distances->insert(sqr_distances->end(), part.squares.begin(), part.squares.end());
  }
}

void
UnrestrictedSpace::regionCells(const Position& q, double radius, std::vector<Cell>& cells) const
{
  cells.clear();
  std::vector<Cell> part;
  for (const CellTree* cube : cubesReached(q, radius)) {
    cube->regionCells(q, radius, part);
    cells.insert(cells.end(), part.begin(), part.end());
  }
}

void
UnrestrictedSpace::nearestSearch(const Position& q, std::size_t k, std::vector<PointIndex>& indices,
                                 std::vector<float>& sqr_distances) const
{
  detail::nearestByRegions(*this, q, k, options_.cell, indices, sqr_distances);
}

void
UnrestrictedSpace::boxSearch(const Position& low, const Position& high,
                             std::vector<PointIndex>& indices) const
{
  indices.clear();
  std::vector<PointIndex> part;
  for (const CellTree* cube : cubesBetween(superKey(low), superKey(high))) {
    cube->boxSearch(low, high, part);
    indices.insert(indices.end(), part.begin(), part.end());
  }
}

} // namespace pcl_surflet
