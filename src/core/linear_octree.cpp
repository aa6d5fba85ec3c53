#include "pcl_surflet/core/linear_octree.h"

#include "linear_octree_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pcl_surflet {

namespace {

using kernels::RegionKernels;
using kernels::RegionNode;
using kernels::RegionQuery;
using kernels::RegionSink;

const RegionKernels&
kernelsOf(InstructionSet set)
{
#ifdef PCL_SURFLET_X86_KERNELS
  if ((set == InstructionSet::Automatic || set == InstructionSet::Avx512) &&
      isSupported(InstructionSet::Avx512))
    return kernels::regionKernelsAvx512();
  if (set != InstructionSet::Scalar && set != InstructionSet::Baseline &&
      isSupported(InstructionSet::Avx2))
    return kernels::regionKernelsAvx2();
#endif
  (void)set;
  return kernels::regionKernelsScalar();
}

/** \brief Moves results from the kernels' buffers to the caller's vectors.
 *
 * Vectors grow by insertion of whole blocks: resizing them beforehand would fill them with zeros
 * first, which costs small queries more than the search. */
struct ResultBuffers {
  static constexpr std::uint32_t kCapacity = 2 * kernels::kShortRange;

  std::vector<PointIndex>* indices = nullptr;
  std::vector<float>* squares = nullptr;
  const PointIndex* source = nullptr; ///< indices in the order of the tree
  PointIndex index[kCapacity + kernels::kBlock];
  float square[kCapacity + kernels::kBlock];

  RegionSink
  sink()
  {
    return {index, square, 0, kCapacity, this, flush, appendRange};
  }

  static void
  flush(RegionSink& sink)
  {
    auto& self = *static_cast<ResultBuffers*>(sink.context);
    self.indices->insert(self.indices->end(), sink.index, sink.index + sink.size);
    if (self.squares)
      self.squares->insert(self.squares->end(), sink.square, sink.square + sink.size);
    sink.size = 0;
  }

  static void
  appendRange(RegionSink& sink, std::uint32_t begin, std::uint32_t count)
  {
    auto& self = *static_cast<ResultBuffers*>(sink.context);
    flush(sink);
    self.indices->insert(self.indices->end(), self.source + begin, self.source + begin + count);
  }
};

/** \brief Joins places and ranges of places, which arrive in ascending order, into ranges. */
struct RangeBuffers {
  static constexpr std::uint32_t kCapacity = kernels::kShortRange;

  std::vector<PlaceRange>* ranges = nullptr;
  PointIndex place[kCapacity + kernels::kBlock];

  static void
  flush(RegionSink& sink)
  {
    auto& ranges = *static_cast<RangeBuffers*>(sink.context)->ranges;
    PlaceRange joined[kCapacity + 1];
    joined[0] = ranges.empty() ? PlaceRange{0, 0} : ranges.back();
    std::uint32_t last = 0; // no branch on whether a place continues the last range
    for (std::uint32_t i = 0; i < sink.size; ++i) {
      const auto at = static_cast<std::uint32_t>(sink.index[i]);
      const bool fresh = at != joined[last].end || joined[last].end == 0;
      last += fresh;
      joined[last].begin = fresh ? at : joined[last].begin;
      joined[last].end = at + 1;
    }
    if (!ranges.empty())
      ranges.back() = joined[0];
    ranges.insert(ranges.end(), joined + 1, joined + 1 + last);
    sink.size = 0;
  }

  static void
  appendRange(RegionSink& sink, std::uint32_t begin, std::uint32_t count)
  {
    flush(sink);
    auto& ranges = *static_cast<RangeBuffers*>(sink.context)->ranges;
    if (!ranges.empty() && ranges.back().end == begin)
      ranges.back().end = begin + count;
    else
      ranges.push_back({begin, begin + count});
  }
};

bool
isFinite(const Position& q)
{
  return std::isfinite(q[0]) && std::isfinite(q[1]) && std::isfinite(q[2]);
}

using Candidate =
    std::pair<float, PointIndex>; // squared distance, then index: the order of results

/** \brief Descent for the nearest neighbours: nearest box first, heap of the best so far. */
class NearestSearch {
public:
  NearestSearch(const RegionKernels& kernel, const kernels::RegionTree& tree, const Position& q,
                std::size_t k)
      : kernel_(kernel), tree_(tree), k_(k)
  {
    std::copy(q.begin(), q.end(), query_.q);
    query_.square = squaredRadius(std::numeric_limits<double>::infinity());
    sink_ = {index_, square_, 0, kCapacity, this, flush, nullptr};
  }

  std::vector<Candidate>
  run()
  {
    descend(tree_.nodes[0]);
    std::sort_heap(best_.begin(), best_.end());
    return std::move(best_);
  }

private:
  static constexpr std::uint32_t kCapacity = kernels::kShortRange;

  void
  descend(const RegionNode& node)
  {
    float square[kernels::kFanOut];
    unsigned order[kernels::kFanOut] = {0, 1, 2, 3, 4, 5, 6, 7};
    kernel_.boxes(node, query_.q, square);
    std::sort(order, order + kernels::kFanOut, [&](unsigned a, unsigned b) {
      return square[a] != square[b] ? square[a] < square[b] : a < b;
    });
    for (const unsigned c : order) {
      if (!(square[c] <= query_.square)) // equal distances compete by index: do not prune them
        return;
      if (node.child != 0)
        descend(tree_.nodes[node.child + c]);
      else {
        kernel_.run(tree_, query_, node.begin + (c == 0 ? 0u : node.cut[c - 1]),
                    node.begin + node.cut[c], sink_);
        flush(sink_);
      }
    }
  }

  static void
  flush(RegionSink& sink)
  {
    auto& self = *static_cast<NearestSearch*>(sink.context);
    for (std::uint32_t i = 0; i < sink.size; ++i)
      self.offer({sink.square[i], sink.index[i]});
    sink.size = 0;
  }

  void
  offer(const Candidate& candidate)
  {
    if (best_.size() < k_) {
      best_.push_back(candidate);
      std::push_heap(best_.begin(), best_.end());
    }
    else if (candidate < best_.front()) {
      std::pop_heap(best_.begin(), best_.end());
      best_.back() = candidate;
      std::push_heap(best_.begin(), best_.end());
    }
    if (best_.size() == k_)
      query_.square = best_.front().first;
  }

  const RegionKernels& kernel_;
  const kernels::RegionTree& tree_;
  const std::size_t k_;
  RegionQuery query_;
  RegionSink sink_;
  std::vector<Candidate> best_;
  PointIndex index_[kCapacity + kernels::kBlock];
  float square_[kCapacity + kernels::kBlock];
};

/** \brief Appends the points of a node, which ends at \p end, in the box [low, high]. */
void
collectBox(const kernels::RegionTree& tree, const RegionNode& node, std::uint32_t end,
           const Position& low, const Position& high, std::vector<PointIndex>& indices)
{
  const RegionNode* const children = tree.nodes + node.child;
  for (unsigned c = 0; c < kernels::kFanOut; ++c) {
    bool reached = node.low[0][c] <= node.high[0][c], inside = true; // else there is no child
    for (int a = 0; a < 3; ++a) {
      reached = reached && node.low[a][c] <= high[a] && low[a] <= node.high[a][c];
      inside = inside && low[a] <= node.low[a][c] && node.high[a][c] <= high[a];
    }
    if (!reached)
      continue;
    const bool bottom = node.child == 0;
    const std::uint32_t first =
        bottom ? node.begin + (c == 0 ? 0u : node.cut[c - 1]) : children[c].begin;
    const std::uint32_t last = bottom                 ? node.begin + node.cut[c]
                               : c + 1u < node.cut[0] ? children[c + 1].begin
                                                      : end;
    if (inside)
      indices.insert(indices.end(), tree.index + first, tree.index + last);
    else if (!bottom)
      collectBox(tree, children[c], last, low, high, indices);
    else
      for (std::uint32_t i = first; i < last; ++i)
        if (low[0] <= tree.x[i] && tree.x[i] <= high[0] && low[1] <= tree.y[i] &&
            tree.y[i] <= high[1] && low[2] <= tree.z[i] && tree.z[i] <= high[2])
          indices.push_back(tree.index[i]);
  }
}

} // namespace

bool
isSupported(InstructionSet set)
{
#ifdef PCL_SURFLET_X86_KERNELS
  if (set == InstructionSet::Avx2)
    return __builtin_cpu_supports("avx2");
  if (set == InstructionSet::Avx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
#endif
  return set == InstructionSet::Automatic || set == InstructionSet::Scalar ||
         set == InstructionSet::Baseline;
}

LinearOctree::LinearOctree() : data_(std::make_unique<Data>())
{
  data_->kernels = &kernelsOf(InstructionSet::Automatic);
}

LinearOctree::~LinearOctree() = default;
LinearOctree::LinearOctree(LinearOctree&&) noexcept = default;
LinearOctree& LinearOctree::operator=(LinearOctree&&) noexcept = default;

void
LinearOctree::setOptions(const Options& options)
{
  data_->options = options;
  data_->kernels = &kernelsOf(options.instruction_set);
}

const LinearOctree::Options&
LinearOctree::options() const
{
  return data_->options;
}

void
LinearOctree::build(const PointArray& points, const std::vector<PointIndex>* subset)
{
  detail::LinearOctreeBuilder(*data_, points).build(subset);
}

std::size_t
LinearOctree::size() const
{
  return data_->size;
}

std::size_t
LinearOctree::memoryUsage() const
{
  return sizeof(Data) + data_->nodes.capacity() * sizeof(RegionNode) +
         (data_->x.capacity() + data_->y.capacity() + data_->z.capacity()) * sizeof(float) +
         data_->index.capacity() * sizeof(PointIndex);
}

void
LinearOctree::regionSearch(const Position& q, double radius, std::vector<PointIndex>& indices,
                           std::vector<float>* sqr_distances) const
{
  indices.clear();
  if (sqr_distances)
    sqr_distances->clear();
  if (data_->size == 0 || !(radius >= 0) || !isFinite(q))
    return;
  ResultBuffers buffers;
  buffers.indices = &indices;
  buffers.squares = sqr_distances;
  buffers.source = data_->index.data();
  RegionSink sink = buffers.sink();
  const RegionQuery query = {{q[0], q[1], q[2]}, squaredRadius(radius)};
  (sqr_distances ? data_->kernels->distances : data_->kernels->indices)(data_->tree, query, sink);
  ResultBuffers::flush(sink);
}

void
LinearOctree::regionRanges(const Position& q, double radius, std::vector<PlaceRange>& ranges) const
{
  ranges.clear();
  if (data_->size == 0 || !(radius >= 0) || !isFinite(q))
    return;
  RangeBuffers buffers;
  buffers.ranges = &ranges;
  RegionSink sink = {buffers.place,
                     nullptr,
                     0,
                     RangeBuffers::kCapacity,
                     &buffers,
                     RangeBuffers::flush,
                     RangeBuffers::appendRange};
  const RegionQuery query = {{q[0], q[1], q[2]}, squaredRadius(radius)};
  data_->kernels->positions(data_->tree, query, sink);
  RangeBuffers::flush(sink);
}

void
LinearOctree::nearestSearch(const Position& q, std::size_t k, std::vector<PointIndex>& indices,
                            std::vector<float>& sqr_distances) const
{
  indices.clear();
  sqr_distances.clear();
  if (data_->size == 0 || k == 0 || !isFinite(q))
    return;
  NearestSearch search(*data_->kernels, data_->tree, q, std::min(k, data_->size));
  for (const auto& [square, index] : search.run()) {
    indices.push_back(index);
    sqr_distances.push_back(square);
  }
}

void
LinearOctree::boxSearch(const Position& low, const Position& high,
                        std::vector<PointIndex>& indices) const
{
  indices.clear();
  if (data_->size > 0)
    collectBox(data_->tree, data_->nodes[0], data_->tree.size, low, high, indices);
}

PointIndex
LinearOctree::indexAt(std::uint32_t place) const
{
  return data_->index[place];
}

Position
LinearOctree::positionAt(std::uint32_t place) const
{
  return {data_->x[place], data_->y[place], data_->z[place]};
}

const PointIndex*
LinearOctree::indexData() const
{
  return data_->index.data();
}

std::array<const float*, 3>
LinearOctree::coordinates() const
{
  return {data_->x.data(), data_->y.data(), data_->z.data()};
}

} // namespace pcl_surflet
