/** \file
 * The hot part of region search over the linear octree: raw pointers only, no C++ library, so that
 * it can be compiled for several instruction sets. */
#pragma once

#include <cstdint>

namespace pcl_surflet {
namespace kernels {

constexpr std::uint32_t kBlock = 16;       ///< points filtered at once: one widest vector
constexpr std::uint32_t kFanOut = 8;       ///< children of a node
constexpr std::uint32_t kBottomSize = 192; ///< most points of a bottom node
/** \brief Ranges up to this length are copied by the kernels, longer ones are handed to range(). */
constexpr std::uint32_t kShortRange = 512;

/** \brief The tight boxes of up to eight consecutive children side by side, so that all are tested
 * at once. Where there is no child, the box is empty (low = +inf, high = -inf).
 *
 * Children of an inner node are the nodes child, child + 1, ... and hold consecutive points; those
 * of a bottom node (child = 0) are runs of about 16 points, child c ending at begin + cut[c]. */
struct RegionNode {
  float low[3][kFanOut];
  float high[3][kFanOut];
  std::uint32_t begin;       ///< first point
  std::uint32_t child;       ///< first child node, 0 for a bottom node
  std::uint8_t cut[kFanOut]; ///< bottom: ends of the runs; inner: cut[0] is the number of children
};

/** \brief The tree as the kernels see it; the root is nodes[0]. All arrays of points are padded by
 * a block. */
struct RegionTree {
  const float* x;
  const float* y;
  const float* z;
  const std::int32_t* index; ///< the user's index of each point
  const RegionNode* nodes;
  std::uint32_t size; ///< number of points
};

/** \brief Region of interest F(r, q): points with squared distance <= square [Wahl 2007, Eq. 4.13].
 */
struct RegionQuery {
  float q[3];
  float square;
};

/** \brief Where results go: two buffers that flush() empties when full. They may be overwritten by
 * a block past their capacity.
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
  RegionSearchKernel indices;   ///< border hits: the user's indices
  RegionSearchKernel distances; ///< every hit: the user's index and the squared distance
  RegionSearchKernel positions; ///< border hits: positions in the sorted arrays
  /** \brief Border filter of the run [begin, end) with indices and squared distances. */
  void (*run)(const RegionTree&, const RegionQuery&, std::uint32_t begin, std::uint32_t end,
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
