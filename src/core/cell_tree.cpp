#include "pcl_surflet/core/cell_tree.h"

#include "cell_tree_detail.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace pcl_surflet {

double
CubeFrame::edgeAt(int d) const
{
  return std::ldexp(edge, -d);
}

CubeFrame::Coordinates
CubeFrame::coordinates(const std::array<double, 3>& p) const
{
  // Below 2^63 in any case: depth is at most 63.
  const double scale = std::ldexp(1 / edge, depth);
  const std::uint64_t last = (std::uint64_t{1} << depth) - 1;
  Coordinates c;
  for (int a = 0; a < 3; ++a) {
    const double v = (p[a] - corner[a]) * scale;
    c[a] = !(v > 0) ? 0 : v >= static_cast<double>(last) ? last : static_cast<std::uint64_t>(v);
  }
  return c;
}

std::unique_ptr<CellTree>
makeCellTree(TreeKind kind, const CubeFrame& frame)
{
  if (!(frame.edge > 0) || !std::isfinite(frame.edge))
    throw std::invalid_argument(
        "CellTree: the edge of the cube must be positive and finite, it is " +
        std::to_string(frame.edge));
  if (frame.depth < 0 || frame.depth > 63)
    throw std::invalid_argument("CellTree: the depth must be in [0, 63], it is " +
                                std::to_string(frame.depth));
  return kind == TreeKind::Octree ? detail::makeOctree(frame) : detail::makeAvlTree(frame);
}

StartCells
findStartCells(const CubeFrame& frame, const Position& q, double radius)
{
  const double reach = detail::reachOf(radius);
  StartCells starts;
  while (starts.depth < frame.depth && 2 * reach <= frame.edgeAt(starts.depth + 1)) // (4.15)
    ++starts.depth;
  const int up = frame.depth - starts.depth;
  const auto low = frame.coordinates({q[0] - reach, q[1] - reach, q[2] - reach});
  const auto centre = frame.coordinates({q[0], q[1], q[2]});
  const auto high = frame.coordinates({q[0] + reach, q[1] + reach, q[2] + reach});
  const CubeFrame::Coordinates first = {centre[0] >> up, centre[1] >> up,
                                        centre[2] >> up}; // (4.16)
  const detail::RegionBounds bounds(frame, q, radius);
  const double edge = frame.edgeAt(starts.depth);
  starts.cells.push_back(first);
  for (auto z = low[2] >> up; z <= high[2] >> up; ++z)
    for (auto y = low[1] >> up; y <= high[1] >> up; ++y)
      for (auto x = low[0] >> up; x <= high[0] >> up; ++x) {
        const double corner[3] = {frame.corner[0] + static_cast<double>(x) * edge,
                                  frame.corner[1] + static_cast<double>(y) * edge,
                                  frame.corner[2] + static_cast<double>(z) * edge};
        const CubeFrame::Coordinates cell = {x, y, z};
        if (cell != first && bounds.reaches(corner, edge)) // the outliers (4.17-4.19)
          starts.cells.push_back(cell);
      }
  return starts;
}

namespace detail {

namespace {

constexpr double kUnit = 1 << 30; ///< fixed-point one of the bucket sums

std::int64_t
toFixed(double v, double limit)
{
  v = std::min(std::max(v, -limit), limit) * kUnit;
  return static_cast<std::int64_t>(v + (v < 0 ? -0.5 : 0.5)); // llround() is a slow library call
}

} // namespace

void
addToSums(Bucket& bucket, const CubeFrame& frame, const CubeFrame::Coordinates& cell,
          const Surflet& s, int sign)
{
  const double inverse_edge = std::ldexp(1 / frame.edge, frame.depth);
  const float p[3] = {s.x, s.y, s.z}, n[3] = {s.nx, s.ny, s.nz};
  const bool has_normal = std::isfinite(n[0]) && std::isfinite(n[1]) && std::isfinite(n[2]);
  for (int a = 0; a < 3; ++a) {
    const double offset = (p[a] - frame.corner[a]) * inverse_edge - static_cast<double>(cell[a]);
    bucket.position[a] += sign * toFixed(offset, 1.0);
    bucket.normal[a] += has_normal ? sign * toFixed(n[a], 1024.0) : 0;
  }
}

Cell
toCell(const Bucket& bucket, const CubeFrame& frame, const CubeFrame::Coordinates& cell)
{
  Cell result;
  const double edge = frame.edgeAt(frame.depth);
  const double count = static_cast<double>(bucket.points.size());
  double p[3], n[3], square = 0;
  for (int a = 0; a < 3; ++a) {
    const double offset = static_cast<double>(bucket.position[a]) / (kUnit * count);
    p[a] = frame.corner[a] + (static_cast<double>(cell[a]) + offset) * edge;
    n[a] = static_cast<double>(bucket.normal[a]) / kUnit;
    square += n[a] * n[a];
  }
  const double length = std::sqrt(square), scale = length > 0 ? 1 / length : 0;
  result.mean = {static_cast<float>(p[0]),         static_cast<float>(p[1]),
                 static_cast<float>(p[2]),         static_cast<float>(n[0] * scale),
                 static_cast<float>(n[1] * scale), static_cast<float>(n[2] * scale)};
  result.normal_agreement = static_cast<float>(length / count);
  result.count = static_cast<std::uint32_t>(bucket.points.size());
  return result;
}

std::uint32_t
BucketStore::take()
{
  if (free_.empty()) {
    buckets_.emplace_back();
    return static_cast<std::uint32_t>(buckets_.size() - 1);
  }
  const std::uint32_t bucket = free_.back();
  free_.pop_back();
  return bucket;
}

void
BucketStore::release(std::uint32_t bucket)
{
  buckets_[bucket] = Bucket();
  free_.push_back(bucket);
}

std::size_t
BucketStore::count() const
{
  return buckets_.size() - free_.size();
}

std::size_t
BucketStore::memoryUsage() const
{
  std::size_t bytes = buckets_.capacity() * sizeof(Bucket) + free_.capacity() * sizeof(free_[0]);
  for (const Bucket& bucket : buckets_)
    bytes += bucket.points.capacity() * sizeof(CellPoint);
  return bytes;
}

double
reachOf(double radius)
{
  // A float square rounds by 2^-22 at most; differences below 3e-23 square to zero.
  return radius * (1 + 1e-6) + 1e-22;
}

RegionBounds::RegionBounds(const CubeFrame& frame, const Position& centre, double radius)
    : square(squaredRadius(radius))
{
  double size = frame.edge;
  for (int a = 0; a < 3; ++a) {
    q[a] = centre[a];
    size = std::max({size, std::abs(frame.corner[a]), std::abs(q[a])});
  }
  slack = 1e-14 * size;
  skip_beyond = static_cast<double>(square) * (1 + 2e-6) + 1e-37;
  whole_within = static_cast<double>(square) * (1 - 2e-6) - 1e-37;
}

bool
RegionBounds::reaches(const double* low, double edge) const
{
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = std::max({low[a] - q[a], q[a] - (low[a] + edge), slack}) - slack;
    sum += d * d;
  }
  return sum <= skip_beyond;
}

bool
RegionBounds::contains(const double* low, double edge) const
{
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = std::max(q[a] - low[a], low[a] + edge - q[a]) + slack;
    sum += d * d;
  }
  return sum <= whole_within;
}

RegionResult::RegionResult(const Position& centre, float square_radius,
                           std::vector<PointIndex>& index_results,
                           std::vector<float>* square_results)
    : indices(index_results), squares(square_results), q(centre), square(square_radius)
{
}

void
RegionResult::flush()
{
  indices.insert(indices.end(), index_buffer, index_buffer + size);
  if (squares)
    squares->insert(squares->end(), square_buffer, square_buffer + size);
  size = 0;
}

void
RegionResult::append(const Bucket& bucket, float limit)
{
  const CellPoint* p = bucket.points.data();
  for (std::size_t left = bucket.points.size(); left > 0;) {
    if (size == kCapacity)
      flush();
    const std::size_t n = std::min<std::size_t>(left, kCapacity - size);
    std::size_t at = size; // no branch: on the border it would be mispredicted
    for (const CellPoint* const end = p + n; p != end; ++p) {
      const float dx = p->x - q[0], dy = p->y - q[1], dz = p->z - q[2];
      const float d = dx * dx + dy * dy + dz * dz;
      index_buffer[at] = p->id;
      square_buffer[at] = d;
      at += d <= limit;
    }
    size = at;
    left -= n;
  }
}

void
RegionResult::test(const Bucket& bucket)
{
  append(bucket, square);
}

void
RegionResult::take(const Bucket& bucket)
{
  append(bucket, std::numeric_limits<float>::infinity());
}

bool
isFinite(const Position& q)
{
  return std::isfinite(q[0]) && std::isfinite(q[1]) && std::isfinite(q[2]);
}

void
CellTreeBase::regionSearch(const Position& q, double radius, std::vector<PointIndex>& indices,
                           std::vector<float>* sqr_distances) const
{
  indices.clear();
  if (sqr_distances)
    sqr_distances->clear();
  if (size_ == 0 || !(radius >= 0) || !isFinite(q))
    return;
  const RegionBounds bounds(frame_, q, radius);
  const StartCells starts = findStartCells(frame_, q, radius); // step 1
  RegionResult result(q, bounds.square, indices, sqr_distances);
  collectPoints(starts, bounds, result); // steps 2 and 3
  result.flush();
}

void
CellTreeBase::regionCells(const Position& q, double radius, std::vector<Cell>& cells) const
{
  cells.clear();
  if (size_ == 0 || !(radius >= 0) || !isFinite(q))
    return;
  const RegionBounds bounds(frame_, q, radius);
  collectCells(findStartCells(frame_, q, radius), bounds, cells);
  const auto outside = [&](const Cell& c) {
    return !(squaredDistance({c.mean.x, c.mean.y, c.mean.z}, q) <= bounds.square);
  };
  cells.erase(std::remove_if(cells.begin(), cells.end(), outside), cells.end());
}

void
CellTreeBase::nearestSearch(const Position& q, std::size_t k, std::vector<PointIndex>& indices,
                            std::vector<float>& sqr_distances) const
{
  nearestByRegions(*this, q, k, frame_.edgeAt(frame_.depth), indices, sqr_distances);
}

void
CellTreeBase::addToBucket(std::uint32_t bucket, const CubeFrame::Coordinates& cell, PointIndex id,
                          const Surflet& s)
{
  addToSums(buckets_[bucket], frame_, cell, s, 1);
  buckets_[bucket].points.push_back({s.x, s.y, s.z, id});
  ++size_;
}

bool
CellTreeBase::removeFromBucket(std::uint32_t bucket, const CubeFrame::Coordinates& cell,
                               PointIndex id, const Surflet& s)
{
  auto& points = buckets_[bucket].points;
  const auto at =
      std::find_if(points.begin(), points.end(), [id](const CellPoint& p) { return p.id == id; });
  if (at == points.end())
    return false;
  points.erase(at);
  addToSums(buckets_[bucket], frame_, cell, s, -1);
  --size_;
  return true;
}

void
nearestByRegions(const RegionIndex& index, const Position& q, std::size_t k, double first_radius,
                 std::vector<PointIndex>& indices, std::vector<float>& sqr_distances)
{
  indices.clear();
  sqr_distances.clear();
  k = std::min(k, index.size());
  if (k == 0 || !isFinite(q))
    return;
  double radius = first_radius;
  for (;; radius *= 2) {
    index.regionSearch(q, radius, indices, &sqr_distances);
    if (indices.size() >= k || squaredRadius(radius) == std::numeric_limits<float>::max())
      break;
  }
  std::vector<std::pair<float, PointIndex>> found(indices.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    found[i] = {sqr_distances[i], indices[i]};
  k = std::min(k, found.size());
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(k), found.end());
  indices.resize(k);
  sqr_distances.resize(k);
  for (std::size_t i = 0; i < k; ++i) {
    sqr_distances[i] = found[i].first;
    indices[i] = found[i].second;
  }
}

void
appendInBox(const Bucket& bucket, const Position& low, const Position& high,
            std::vector<PointIndex>& indices)
{
  for (const CellPoint& p : bucket.points)
    if (low[0] <= p.x && p.x <= high[0] && low[1] <= p.y && p.y <= high[1] && low[2] <= p.z &&
        p.z <= high[2])
      indices.push_back(p.id);
}

} // namespace detail
} // namespace pcl_surflet
