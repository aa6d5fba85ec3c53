// The oracle of the vectorised kernels.
//
// Boxes are tested with the very operations the points are: rounding is monotone, so the squared
// distance to a box, computed in this order, never exceeds that of a point in it, and no safety
// margin is needed anywhere.
#include "region_kernel.h"

#define PCL_SURFLET_KERNEL_NAME "scalar"

namespace pcl_surflet {
namespace kernels {

namespace {

inline float
larger(float a, float b)
{
  return a > b ? a : b;
}

inline void
childDistances(const RegionNode& node, const float* q, float* square)
{
  for (int c = 0; c < 8; ++c) {
    const float dx = larger(larger(node.low[0][c] - q[0], q[0] - node.high[0][c]), 0.0f);
    const float dy = larger(larger(node.low[1][c] - q[1], q[1] - node.high[1][c]), 0.0f);
    const float dz = larger(larger(node.low[2][c] - q[2], q[2] - node.high[2][c]), 0.0f);
    square[c] = dx * dx + dy * dy + dz * dz;
  }
}

/** \brief Bit sets of the children the region reaches and of those wholly inside. */
inline unsigned
testChildren(const RegionNode& node, const RegionQuery& query, unsigned& inside)
{
  float nearest[8];
  childDistances(node, query.q, nearest);
  unsigned reached = 0;
  inside = 0;
  for (int c = 0; c < 8; ++c) {
    const float* const q = query.q;
    const float dx = larger(q[0] - node.low[0][c], node.high[0][c] - q[0]);
    const float dy = larger(q[1] - node.low[1][c], node.high[1][c] - q[1]);
    const float dz = larger(q[2] - node.low[2][c], node.high[2][c] - q[2]);
    reached |= static_cast<unsigned>(nearest[c] <= query.square) << c;
    inside |= static_cast<unsigned>(dx * dx + dy * dy + dz * dz <= query.square) << c;
  }
  return reached;
}

inline float
squaredDistance(const RegionTree& tree, const RegionQuery& query, std::uint32_t i)
{
  const float dx = tree.x[i] - query.q[0], dy = tree.y[i] - query.q[1], dz = tree.z[i] - query.q[2];
  return dx * dx + dy * dy + dz * dz;
}

template <int mode>
inline void
filterBlock(const RegionTree& tree, const RegionQuery& query, std::uint32_t begin,
            std::uint32_t end, RegionSink& sink)
{
  std::uint32_t size = sink.size;
  for (std::uint32_t i = begin; i < end; ++i) {
    const float square = squaredDistance(tree, query, i);
    sink.index[size] = mode == kPositions ? static_cast<std::int32_t>(i) : tree.index[i];
    if (mode == kDistances)
      sink.square[size] = square;
    size += square <= query.square; // no branch: on a border it would be mispredicted
  }
  sink.size = size;
}

template <int mode>
void
filterLeaf(const RegionTree& tree, const RegionQuery& query, std::uint32_t begin,
           std::uint32_t count, RegionSink& sink)
{
  for (std::uint32_t i = 0; i < count; i += kRegionSlack) {
    if (sink.size + kRegionSlack > sink.capacity)
      sink.flush(sink);
    const std::uint32_t n = count - i < kRegionSlack ? count - i : kRegionSlack;
    filterBlock<mode>(tree, query, begin + i, begin + i + n, sink);
  }
}

inline void
copyRange(const RegionTree& tree, const RegionQuery& query, std::uint32_t begin,
          std::uint32_t count, RegionSink& sink)
{
  for (std::uint32_t i = begin; i < begin + count; ++i) {
    if (sink.size == sink.capacity)
      sink.flush(sink);
    sink.index[sink.size] = tree.index[i];
    sink.square[sink.size++] = squaredDistance(tree, query, i);
  }
}

#include "region_traversal.inl"

} // namespace

const RegionKernels&
regionKernelsScalar()
{
  return kKernels;
}

} // namespace kernels
} // namespace pcl_surflet
