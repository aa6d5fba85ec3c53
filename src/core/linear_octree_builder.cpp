#include "linear_octree_data.h"

#include "pcl_surflet/core/morton_key.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace pcl_surflet {
namespace detail {

Box::Box()
{
  for (int a = 0; a < 3; ++a) {
    low[a] = std::numeric_limits<float>::infinity();
    high[a] = -low[a];
  }
}

void
Box::add(const Box& other)
{
  for (int a = 0; a < 3; ++a) {
    low[a] = std::min(low[a], other.low[a]);
    high[a] = std::max(high[a], other.high[a]);
  }
}

namespace {

/** \brief Smallest and largest of \p n values; eight independent chains, so that the compiler may
 * use vectors without reordering anything that could matter. */
void
minMax(const float* v, std::size_t n, float& low, float& high)
{
  constexpr std::size_t kChains = 8;
  float lows[kChains], highs[kChains];
  for (std::size_t c = 0; c < kChains; ++c) {
    lows[c] = low;
    highs[c] = high;
  }
  std::size_t i = 0;
  for (; i + kChains <= n; i += kChains)
    for (std::size_t c = 0; c < kChains; ++c) {
      lows[c] = v[i + c] < lows[c] ? v[i + c] : lows[c];
      highs[c] = v[i + c] > highs[c] ? v[i + c] : highs[c];
    }
  for (; i < n; ++i) {
    lows[0] = std::min(lows[0], v[i]);
    highs[0] = std::max(highs[0], v[i]);
  }
  low = *std::min_element(lows, lows + kChains);
  high = *std::max_element(highs, highs + kChains);
}

/** \brief Cuts one axis of a box into 2^10 slices. Halved coordinates cannot overflow; the
 * numbering only has to be monotone, since the nodes' boxes come from the points themselves. */
struct Slices {
  float origin, scale;

  Slices(float low, float extent)
      : origin(0.5f * low),
        scale(std::min(1023.99f / (0.5f * extent), std::numeric_limits<float>::max()))
  {
  }
  std::uint32_t
  operator()(float v) const
  {
    return std::min(static_cast<std::uint32_t>((0.5f * v - origin) * scale), 1023u);
  }
};

/** \brief Moves bit i of the low 10 bits to bit 3 i. */
std::uint32_t
spread10(std::uint32_t v)
{
  v = (v | v << 16) & 0x030000ff;
  v = (v | v << 8) & 0x0300f00f;
  v = (v | v << 4) & 0x030c30c3;
  return (v | v << 2) & 0x09249249;
}

} // namespace

LinearOctreeBuilder::LinearOctreeBuilder(const PointArray& points, std::uint32_t leaf_size)
    : points_(points), leaf_size_(std::max(leaf_size, 1u))
{
  if (points.size > static_cast<std::size_t>(std::numeric_limits<PointIndex>::max()))
    throw std::length_error("LinearOctree: more than 2^31 - 1 points");
}

void
LinearOctreeBuilder::sortPoints(const std::vector<PointIndex>* subset)
{
  const std::size_t n = subset ? subset->size() : points_.size;
  items_.resize(n);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = subset ? static_cast<std::size_t>((*subset)[k]) : k;
    if (i >= points_.size)
      throw std::out_of_range("LinearOctree: index " + std::to_string((*subset)[k]) + " of " +
                              std::to_string(points_.size) + " points");
    const std::size_t at = i * points_.stride;
    items_[kept].index = static_cast<std::uint32_t>(i);
    // 0 times a number is 0 unless the number is infinite or NaN.
    kept += points_.x[at] * 0 + points_.y[at] * 0 + points_.z[at] * 0 == 0;
  }
  items_.resize(kept);
  for (auto* v : {&x, &y, &z})
    v->resize(kept + kernels::kRegionSlack);
  index.resize(kept + kernels::kRegionSlack);
  if (kept == 0)
    return;
  gather(0, kept);
  sortRange(0, kept, boxOf(0, kept));
  makeNodes();
  items_ = {};
  scratch_ = {};
}

Box
LinearOctreeBuilder::boxOf(std::size_t begin, std::size_t end) const
{
  Box box;
  const float* const v[3] = {x.data() + begin, y.data() + begin, z.data() + begin};
  for (int a = 0; a < 3; ++a)
    minMax(v[a], end - begin, box.low[a], box.high[a]);
  return box;
}

/** \brief Keys of the points in [begin, end), whose arrays are filled, and everything sorted by
 * them. One scale for all axes: cells are cubes. */
void
LinearOctreeBuilder::sortRange(std::size_t begin, std::size_t end, const Box& box)
{
  float half = 0;
  for (int a = 0; a < 3; ++a)
    half = std::max(half, 0.5f * box.high[a] - 0.5f * box.low[a]);
  const Slices sx(box.low[0], half), sy(box.low[1], half), sz(box.low[2], half);
  std::vector<Item> part(end - begin);
  for (std::size_t i = begin; i < end; ++i)
    part[i - begin] = {spread10(sx(x[i])) | spread10(sy(y[i])) << 1 | spread10(sz(z[i])) << 2,
                       items_[i].index};
  radixSort(part, scratch_, 3 * kDepth);
  std::copy(part.begin(), part.end(), items_.begin() + static_cast<std::ptrdiff_t>(begin));
  gather(begin, end);
}

/** \brief Copies the points in the order of items_. */
void
LinearOctreeBuilder::gather(std::size_t begin, std::size_t end)
{
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t at = items_[i].index * points_.stride;
    x[i] = points_.x[at];
    y[i] = points_.y[at];
    z[i] = points_.z[at];
    index[i] = static_cast<PointIndex>(items_[i].index);
  }
}

void
LinearOctreeBuilder::makeNodes()
{
  Box box;
  const auto n = static_cast<std::uint32_t>(items_.size());
  nodes.reserve(n / (2 * leaf_size_) + 1);
  if (makeChild(0, n, 0, box) == kernels::kLeafChild)
    setChild(addEmptyNode(), 0, kernels::kLeafChild, 0, n, box);
  nodes.shrink_to_fit();
}

/** \brief The node over [begin, end), or kLeafChild; fills \p box. The range's points share all
 * digits above \p level. */
std::uint32_t
LinearOctreeBuilder::makeChild(std::uint32_t begin, std::uint32_t end, int level, Box& box)
{
  if (end - begin <= leaf_size_) {
    box = boxOf(begin, end);
    return kernels::kLeafChild;
  }
  level = firstDifferentLevel(begin, end, level);
  if (level == kDepth) { // crowded: a key relative to the box of these points tells them apart
    box = boxOf(begin, end);
    sortRange(begin, end, box);
    level = firstDifferentLevel(begin, end, 0);
    if (level == kDepth)
      return kernels::kLeafChild; // duplicates: their box is a point, never on a border
  }
  return makeNode(begin, end, level, box);
}

/** \brief The first level from \p level on whose digits differ in the sorted range, or kDepth. */
int
LinearOctreeBuilder::firstDifferentLevel(std::uint32_t begin, std::uint32_t end, int level) const
{
  const std::uint32_t different = items_[begin].key ^ items_[end - 1].key;
  while (level < kDepth && different >> (3 * (kDepth - 1 - level)) == 0)
    ++level;
  return level;
}

std::uint32_t
LinearOctreeBuilder::addEmptyNode()
{
  kernels::RegionNode node;
  const Box empty;
  for (int c = 0; c < 8; ++c) {
    for (int a = 0; a < 3; ++a) {
      node.low[a][c] = empty.low[a];
      node.high[a][c] = empty.high[a];
    }
    node.begin[c] = node.count[c] = 0;
    node.child[c] = kernels::kLeafChild;
  }
  nodes.push_back(node);
  return static_cast<std::uint32_t>(nodes.size() - 1);
}

void
LinearOctreeBuilder::setChild(std::uint32_t node, int slot, std::uint32_t child,
                              std::uint32_t begin, std::uint32_t end, const Box& box)
{
  kernels::RegionNode& n = nodes[node];
  for (int a = 0; a < 3; ++a) {
    n.low[a][slot] = box.low[a];
    n.high[a][slot] = box.high[a];
  }
  n.begin[slot] = begin;
  n.count[slot] = end - begin;
  n.child[slot] = child;
}

/** \brief Splits [begin, end) by the digit of \p level; parents come before their children. */
std::uint32_t
LinearOctreeBuilder::makeNode(std::uint32_t begin, std::uint32_t end, int level, Box& box)
{
  const std::uint32_t node = addEmptyNode();
  const int shift = 3 * (kDepth - 1 - level);
  box = Box();
  int slot = 0;
  while (begin < end) {
    const std::uint32_t digits = items_[begin].key >> shift;
    const auto next = std::partition_point(items_.begin() + begin, items_.begin() + end,
                                           [&](const Item& i) { return i.key >> shift == digits; });
    const auto part_end = static_cast<std::uint32_t>(next - items_.begin());
    Box part;
    const std::uint32_t child = makeChild(begin, part_end, level + 1, part);
    setChild(node, slot++, child, begin, part_end, part);
    box.add(part);
    begin = part_end;
  }
  return node;
}

} // namespace detail
} // namespace pcl_surflet
