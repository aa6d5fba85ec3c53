// The oracle of the vectorised kernels.
//
// Boxes are tested with the very operations the points are: rounding is monotone, so the squared
// distance to a box, computed in this order, never exceeds that of a point in it, and no safety
// margin is needed anywhere.
#include "region_kernel.h"

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

/** \brief Writes the hits among the first \p count points, up to a block, from \p begin on behind
 * the \p size results; returns how many there are now. */
template <int mode>
inline std::uint32_t
filterBlock(const RegionTree& tree, const RegionQuery& query, std::uint32_t begin,
            std::uint32_t count, std::uint32_t size, RegionSink& sink)
{
  count = count < kBlock ? count : kBlock;
  for (std::uint32_t i = begin; i < begin + count; ++i) {
    const float square = squaredDistance(tree, query, i);
    sink.index[size] = mode == kPositions ? static_cast<std::int32_t>(i) : tree.index[i];
    if (mode == kDistances)
      sink.square[size] = square;
    size += square <= query.square; // no branch: on a border it would be mispredicted
  }
  return size;
}

/** \brief Writes the whole block at \p begin behind the \p size results. */
inline void
copyBlock(const RegionTree& tree, const RegionQuery& query, std::uint32_t begin, std::uint32_t size,
          RegionSink& sink)
{
  for (std::uint32_t i = 0; i < kBlock; ++i) {
    sink.index[size + i] = tree.index[begin + i];
    sink.square[size + i] = squaredDistance(tree, query, begin + i);
  }
}

inline void
copyIndexBlock(const RegionTree& tree, std::uint32_t begin, std::uint32_t size, RegionSink& sink)
{
  for (std::uint32_t i = 0; i < kBlock; ++i)
    sink.index[size + i] = tree.index[begin + i];
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
