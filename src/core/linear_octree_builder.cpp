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

  Slices(float low, float half_extent)
      : origin(0.5f * low),
        scale(std::min(1023.99f / half_extent, std::numeric_limits<float>::max()))
  {
  }
  std::uint32_t
  operator()(float v) const
  {
    return std::min(static_cast<std::uint32_t>((0.5f * v - origin) * scale), 1023u);
  }
};

/** \brief Below this a radix sort is slower than clearing its counters. */
constexpr std::size_t kSmallSort = 1024;

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

LinearOctreeBuilder::LinearOctreeBuilder(LinearOctree::Data& data, const PointArray& points)
    : data_(data), points_(points)
{
  if (points.size > static_cast<std::size_t>(std::numeric_limits<PointIndex>::max()))
    throw std::length_error("LinearOctree: more than 2^31 - 1 points");
}

void
LinearOctreeBuilder::build(const std::vector<PointIndex>* subset)
{
  takePoints(subset);
  data_.size = items_.size();
  const std::size_t padded = data_.size + kernels::kBlock;
  for (auto* v : {&data_.x, &data_.y, &data_.z})
    std::vector<float>(padded).swap(*v);
  std::vector<PointIndex>(padded).swap(data_.index);
  data_.nodes.clear();
  if (data_.size == 0)
    return;
  gather(0, data_.size);
  sortRange(0, data_.size);
  data_.nodes.reserve(data_.size / (kernels::kBottomSize / 2) + 1);
  data_.nodes.resize(1);
  fillNode(0, 0, static_cast<std::uint32_t>(data_.size));
  data_.nodes.shrink_to_fit();
  data_.tree = {data_.x.data(),     data_.y.data(),     data_.z.data(),
                data_.index.data(), data_.nodes.data(), static_cast<std::uint32_t>(data_.size)};
}

void
LinearOctreeBuilder::takePoints(const std::vector<PointIndex>* subset)
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
}

Box
LinearOctreeBuilder::boxOf(std::size_t begin, std::size_t end) const
{
  Box box;
  const float* const v[3] = {data_.x.data(), data_.y.data(), data_.z.data()};
  if (end - begin < 64) { // a run: six short chains side by side
    for (std::size_t i = begin; i < end; ++i)
      for (int a = 0; a < 3; ++a) {
        box.low[a] = v[a][i] < box.low[a] ? v[a][i] : box.low[a];
        box.high[a] = v[a][i] > box.high[a] ? v[a][i] : box.high[a];
      }
    return box;
  }
  for (int a = 0; a < 3; ++a)
    minMax(v[a] + begin, end - begin, box.low[a], box.high[a]);
  return box;
}

/** \brief Sorts the points in [begin, end), whose arrays are filled, by their key relative to their
 * box. One scale for all axes: cells are cubes. */
void
LinearOctreeBuilder::sortRange(std::size_t begin, std::size_t end)
{
  const Box box = boxOf(begin, end);
  float half = 0;
  for (int a = 0; a < 3; ++a)
    half = std::max(half, 0.5f * box.high[a] - 0.5f * box.low[a]);
  if (!(half > 0))
    return; // all at one place
  const Slices sx(box.low[0], half), sy(box.low[1], half), sz(box.low[2], half);
  const bool all = end - begin == items_.size();
  std::vector<Item> part;
  all ? part.swap(items_)
      : part.assign(items_.begin() + static_cast<std::ptrdiff_t>(begin),
                    items_.begin() + static_cast<std::ptrdiff_t>(end));
  for (std::size_t i = begin; i < end; ++i)
    part[i - begin].key =
        spread10(sx(data_.x[i])) | spread10(sy(data_.y[i])) << 1 | spread10(sz(data_.z[i])) << 2;
  if (part.size() < kSmallSort)
    std::sort(part.begin(), part.end(), [](const Item& a, const Item& b) {
      return a.key != b.key ? a.key < b.key : a.index < b.index;
    });
  else
    radixSort(part, scratch_, 3 * kDepth);
  if (all)
    items_.swap(part);
  else
    std::copy(part.begin(), part.end(), items_.begin() + static_cast<std::ptrdiff_t>(begin));
  gather(begin, end);
}

/** \brief Copies the points in the order of items_. */
void
LinearOctreeBuilder::gather(std::size_t begin, std::size_t end)
{
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t at = items_[i].index * points_.stride;
    data_.x[i] = points_.x[at];
    data_.y[i] = points_.y[at];
    data_.z[i] = points_.z[at];
    data_.index[i] = static_cast<PointIndex>(items_[i].index);
  }
}

bool
LinearOctreeBuilder::hasOneKey(std::uint32_t begin, std::uint32_t end) const
{
  return items_[begin].key == items_[end - 1].key;
}

/** \brief Where the sorted range [begin, end) falls into the two halves of its smallest cell, a
 * third of a digit: the place of the highest bit in which its keys differ. */
std::uint32_t
LinearOctreeBuilder::middle(std::uint32_t begin, std::uint32_t end) const
{
  if (hasOneKey(begin, end))
    return begin + (end - begin) / 2;
  std::uint32_t bit = std::uint32_t{1} << (3 * kDepth - 1);
  const std::uint32_t different = items_[begin].key ^ items_[end - 1].key;
  while (!(different & bit))
    bit >>= 1;
  const auto upper = std::partition_point(items_.begin() + begin, items_.begin() + end,
                                          [bit](const Item& i) { return !(i.key & bit); });
  return static_cast<std::uint32_t>(upper - items_.begin());
}

/** \brief Cuts [begin, end) into up to eight parts, always halving the fullest, while that has more
 * than \p enough points. Cells of one key are left whole, to be sorted anew, unless the range is
 * such a cell itself. \return number of parts; part i is [cuts[i], cuts[i + 1]) */
int
LinearOctreeBuilder::cutRange(std::uint32_t begin, std::uint32_t end, std::uint32_t enough,
                              std::uint32_t* cuts) const
{
  const bool bottom = end - begin <= kernels::kBottomSize, one_key = hasOneKey(begin, end);
  cuts[0] = begin;
  cuts[1] = end;
  int parts = 1;
  for (; parts < static_cast<int>(kernels::kFanOut); ++parts) {
    int fullest = -1;
    std::uint32_t most = enough;
    for (int i = 0; i < parts; ++i)
      if (cuts[i + 1] - cuts[i] > most && (bottom || one_key || !hasOneKey(cuts[i], cuts[i + 1]))) {
        most = cuts[i + 1] - cuts[i];
        fullest = i;
      }
    if (fullest < 0)
      break;
    const std::uint32_t cut = middle(cuts[fullest], cuts[fullest + 1]);
    std::copy_backward(cuts + fullest + 1, cuts + parts + 1, cuts + parts + 2);
    cuts[fullest + 1] = cut;
  }
  return parts;
}

/** \brief Makes the node over [begin, end) and everything below it; siblings lie side by side. */
void
LinearOctreeBuilder::fillNode(std::size_t node, std::uint32_t begin, std::uint32_t end)
{
  // Crowded at the depth of a key: a key relative to the box of these points tells them apart,
  // unless they are duplicates; those are cut anywhere.
  if (end - begin > kernels::kBlock && hasOneKey(begin, end))
    sortRange(begin, end);
  const bool bottom = end - begin <= kernels::kBottomSize;
  std::uint32_t cuts[kernels::kFanOut + 1];
  const int parts = cutRange(begin, end, bottom ? kernels::kBlock : kernels::kBottomSize, cuts);
  const std::size_t first_child = data_.nodes.size();
  if (!bottom)
    data_.nodes.resize(first_child + static_cast<std::size_t>(parts));
  kernels::RegionNode& made = data_.nodes[node];
  made.begin = begin;
  made.child = bottom ? 0 : static_cast<std::uint32_t>(first_child);
  made.cut[0] = static_cast<std::uint8_t>(parts);
  for (std::size_t k = 0; bottom && k < kernels::kFanOut; ++k)
    made.cut[k] =
        static_cast<std::uint8_t>(cuts[std::min(k + 1, static_cast<std::size_t>(parts))] - begin);
  for (int slot = 0; slot < static_cast<int>(kernels::kFanOut); ++slot) {
    Box box;
    if (slot < parts && bottom)
      box = boxOf(cuts[slot], cuts[slot + 1]);
    else if (slot < parts) {
      const std::size_t child = first_child + static_cast<std::size_t>(slot);
      fillNode(child, cuts[slot], cuts[slot + 1]);
      box = boxOfNode(child);
    }
    setBox(node, slot, box);
  }
}

void
LinearOctreeBuilder::setBox(std::size_t node, int slot, const Box& box)
{
  for (int a = 0; a < 3; ++a) {
    data_.nodes[node].low[a][slot] = box.low[a];
    data_.nodes[node].high[a][slot] = box.high[a];
  }
}

Box
LinearOctreeBuilder::boxOfNode(std::size_t node) const
{
  Box box;
  const kernels::RegionNode& n = data_.nodes[node];
  for (int a = 0; a < 3; ++a) {
    box.low[a] = *std::min_element(n.low[a], n.low[a] + kernels::kFanOut);
    box.high[a] = *std::max_element(n.high[a], n.high[a] + kernels::kFanOut);
  }
  return box;
}

} // namespace detail
} // namespace pcl_surflet
