/** \file
 * The hot part of region search over the linear octree: raw pointers only, no C++ library, so that
 * it can be compiled for several instruction sets. */
#pragma once

#include <cstdint>

namespace pcl_surflet {
namespace kernels {

/** \brief Points are padded by this many, and result buffers may be overwritten by this many past
 * their capacity: one widest vector. */
constexpr std::uint32_t kRegionSlack = 16;
constexpr std::uint32_t kLeafChild = 0xffffffffu;

/** \brief An inner node: the tight boxes of up to eight children side by side, so that all are
 * tested at once. Unused children have empty boxes (low = +inf, high = -inf). */
struct alignas(32) RegionNode {
  float low[3][8];
  float high[3][8];
  std::uint32_t begin[8]; ///< first point of the child
  std::uint32_t count[8]; ///< number of points of the child
  std::uint32_t child[8]; ///< index of the child's node, or kLeafChild
};

/** \brief The tree as the kernels see it; the root is nodes[0]. */
struct RegionTree {
  const float* x;
  const float* y;
  const float* z;
  const std::int32_t* index; ///< the user's index of each point
  const RegionNode* nodes;
};

/** \brief Region of interest F(r, q): points with squared distance <= square [Wahl 2007, Eq. 4.13].
 */
struct RegionQuery {
  float q[3];
  float square;
};

/** \brief Where results go: two buffers that flush() empties when full.
 *
 * range() receives whole ranges of points that need no test (not in the distance mode). */
struct RegionSink {
  std::int32_t* index;
  float* square;
  std::uint32_t size;
  std::uint32_t capacity;
  void* context;
  void (*flush)(RegionSink& sink);
  void (*range)(RegionSink& sink, std::uint32_t begin, std::uint32_t count);
};

/** \brief What a search delivers, see RegionKernels. */
enum RegionMode : int { kIndices, kDistances, kPositions };

using RegionSearchKernel = void (*)(const RegionTree&, const RegionQuery&, RegionSink&);

/** \brief One instruction set's kernels. All sets return the same bits in the same order. */
struct RegionKernels {
  const char* name;
  RegionSearchKernel indices;   ///< border hits: the user's indices
  RegionSearchKernel distances; ///< every hit: the user's index and the squared distance
  RegionSearchKernel positions; ///< border hits: positions in the sorted arrays
  /** \brief Border filter of one leaf, with indices and squared distances. */
  void (*leaf)(const RegionTree&, const RegionQuery&, std::uint32_t begin, std::uint32_t count,
               RegionSink&);
  /** \brief Squared distances from q to the boxes of a node's children. */
  void (*boxes)(const RegionNode&, const float* q, float* square);
};

const RegionKernels& regionKernelsScalar();
#ifdef PCL_SURFLET_X86_KERNELS
const RegionKernels& regionKernelsAvx2();
const RegionKernels& regionKernelsAvx512();
#endif

} // namespace kernels
} // namespace pcl_surflet
