#include "pcl_surflet/core/space_search.h"

#include "pcl_surflet/core/morton_key.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace pcl_surflet {

namespace {

/** \brief Distance and index as one number that sorts by distance, then index: the bits of floats
 * >= 0 ascend with their value. */
std::uint64_t
pack(float square, PointIndex index)
{
  std::uint32_t bits;
  std::memcpy(&bits, &square, sizeof bits);
  return std::uint64_t{bits} << 32 | static_cast<std::uint32_t>(index);
}

void
unpack(std::uint64_t packed, float& square, PointIndex& index)
{
  const auto bits = static_cast<std::uint32_t>(packed >> 32);
  std::memcpy(&square, &bits, sizeof bits);
  index = static_cast<PointIndex>(packed & 0xffffffffu);
}

/** \brief Keeps the nearest \p max_count (0: all) results, sorted if asked for. */
void
selectNearest(bool sorted, std::size_t max_count, std::vector<PointIndex>& indices,
              std::vector<float>& squares)
{
  std::vector<std::uint64_t> packed(indices.size());
  for (std::size_t i = 0; i < packed.size(); ++i)
    packed[i] = pack(squares[i], indices[i]);
  if (max_count > 0 && max_count < packed.size()) {
    std::nth_element(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(max_count),
                     packed.end());
    packed.resize(max_count);
  }
  if (sorted)
    std::sort(packed.begin(), packed.end());
  indices.resize(packed.size());
  squares.resize(packed.size());
  for (std::size_t i = 0; i < packed.size(); ++i)
    unpack(packed[i], squares[i], indices[i]);
}

/** \brief Adds points along the Morton curve: consecutive ones share their cell or its neighbours,
 * which costs half the time of random order, the sorting included. */
void
addInOrder(UnrestrictedSpace& space, PointIndex first, const PointArray& points,
           const PointArray& normals, const std::vector<PointIndex>* subset)
{
  LinearOctree order;
  order.build(points, subset);
  if (points.size > 0)
    space.reserve(first + static_cast<PointIndex>(points.size));
  constexpr std::uint32_t kPiece = 256;
  PointIndex ids[kPiece];
  Surflet surflets[kPiece];
  const auto size = static_cast<std::uint32_t>(order.size());
  for (std::uint32_t begin = 0; begin < size; begin += kPiece) {
    const std::uint32_t n = std::min(kPiece, size - begin);
    for (std::uint32_t k = 0; k < n; ++k) {
      const PointIndex i = order.indexAt(begin + k);
      const Position p = order.positionAt(begin + k); // points itself is in random order
      ids[k] = first + i;
      surflets[k] = {p[0], p[1], p[2], 0, 0, 0};
      if (normals.x) {
        const std::size_t at = static_cast<std::size_t>(i) * normals.stride;
        surflets[k].nx = normals.x[at];
        surflets[k].ny = normals.y[at];
        surflets[k].nz = normals.z[at];
      }
    }
    space.addBatch(ids, surflets, n);
  }
}

} // namespace

SpaceSearch::SpaceSearch() : linear_(std::make_unique<LinearOctree>()) {}

SpaceSearch::SpaceSearch(const Options& options) { build(options, {}, {}, nullptr); }

SpaceSearch::~SpaceSearch() = default;
SpaceSearch::SpaceSearch(SpaceSearch&&) noexcept = default;
SpaceSearch& SpaceSearch::operator=(SpaceSearch&&) noexcept = default;

void
SpaceSearch::build(const Options& options, const PointArray& points, const PointArray& normals,
                   const std::vector<PointIndex>* subset)
{
  std::unique_ptr<LinearOctree> linear;
  std::unique_ptr<UnrestrictedSpace> space;
  if (options.backend == SpaceBackend::Linear) {
    linear = std::make_unique<LinearOctree>();
    linear->setOptions(options.linear);
    linear->build(points, subset);
  }
  else {
    UnrestrictedSpace::Options space_options;
    space_options.tree = options.backend == SpaceBackend::Octree ? TreeKind::Octree : TreeKind::AVL;
    space_options.cell = options.cell != 0 ? options.cell : suggestCellSize(points);
    space_options.depth = options.depth;
    space_options.threads = options.threads;
    space = std::make_unique<UnrestrictedSpace>(space_options);
    addInOrder(*space, 0, points, normals, subset);
  }
  options_ = options;
  linear_ = std::move(linear);
  space_ = std::move(space);
}

void
SpaceSearch::addPoints(PointIndex first, const PointArray& points, const PointArray& normals)
{
  if (space_)
    addInOrder(*space_, first, points, normals, nullptr);
}

std::size_t
SpaceSearch::radiusSearch(const Position& q, double radius, bool sorted, std::size_t max_count,
                          std::vector<PointIndex>& indices, std::vector<float>& sqr_distances) const
{
  index().regionSearch(q, radius, indices, &sqr_distances);
  if (sorted || (max_count > 0 && max_count < indices.size()))
    selectNearest(sorted, max_count, indices, sqr_distances);
  return indices.size();
}

const RegionIndex&
SpaceSearch::index() const
{
  return linear_ ? static_cast<const RegionIndex&>(*linear_) : *space_;
}

const LinearOctree*
SpaceSearch::linear() const
{
  return linear_.get();
}

const UnrestrictedSpace*
SpaceSearch::space() const
{
  return space_.get();
}

UnrestrictedSpace*
SpaceSearch::space()
{
  return space_.get();
}

const SpaceSearch::Options&
SpaceSearch::options() const
{
  return options_;
}

void
SpaceSearch::setNumberOfThreads(unsigned threads)
{
  options_.threads = threads;
  if (space_)
    space_->setNumberOfThreads(threads);
}

double
suggestCellSize(const PointArray& points, double per_cell)
{
  constexpr int kDepth = 16;
  constexpr std::size_t kSample = 100000;
  double low[3], high[3], extent = 0;
  std::fill(low, low + 3, std::numeric_limits<double>::infinity());
  std::fill(high, high + 3, -std::numeric_limits<double>::infinity());
  std::vector<std::array<double, 3>> sample;
  const std::size_t step = points.size / kSample + 1;
  for (std::size_t i = 0; i < points.size; i += step) {
    const std::size_t at = i * points.stride;
    const std::array<double, 3> p = {points.x[at], points.y[at], points.z[at]};
    if (!std::isfinite(p[0] + p[1] + p[2]))
      continue;
    sample.push_back(p);
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a]);
      extent = std::max(extent, high[a] - low[a]);
    }
  }
  if (!(extent > 0))
    return 0.01;
  const CubeFrame frame{{low[0], low[1], low[2]}, extent, kDepth};
  std::vector<MortonKey> keys;
  keys.reserve(sample.size());
  for (const auto& p : sample)
    keys.push_back(MortonKey::fromCoordinates(frame.coordinates(p), kDepth));
  std::sort(keys.begin(), keys.end());
  // From coarse to fine: stop before the cells hold fewer points than asked for. Every step-th
  // point was looked at, so a cell holds step times as many as the sample shows.
  for (int depth = 1; depth <= kDepth; ++depth) {
    std::size_t cells = 1;
    for (std::size_t i = 1; i < keys.size(); ++i)
      cells += keys[i].prefix(depth) != keys[i - 1].prefix(depth);
    if (static_cast<double>(sample.size() * step) < per_cell * static_cast<double>(cells))
      return frame.edgeAt(depth - 1);
  }
  return frame.edgeAt(kDepth);
}

} // namespace pcl_surflet
