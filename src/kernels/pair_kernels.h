/** \file
 * The hot loops over surflet pairs, behind raw pointers and chosen at run time.
 *
 * Files of this room are compiled several times with different instruction sets. They include
 * neither Eigen nor PCL: a translation unit that mixes those with -mavx breaks the ABI of the
 * distribution's PCL. All variants perform the same IEEE operations in the same order (no fused
 * multiply-add, no approximate reciprocals), so their bins agree bit by bit and one seed gives one
 * result on every machine. */
#pragma once

#include "pcl_surflet/core/pair_histogram.h"

#include <cstddef>
#include <cstdint>

namespace pcl_surflet {
namespace kernels {

/** \brief Copies of the counters, used in turn: consecutive pairs often fall into the same bin, and
 * an increment has to wait for the one before it only in the same copy. The copies of a bin are
 * neighbours. */
constexpr int kCounterCopies = 4;

/** \brief Counter index of a pair without feature, where it is written. */
constexpr std::uint32_t kNoFeature = 0xffffffffu;

/** \brief Intervals of one angular dimension, symmetric about 0. */
struct AxisMap {
  float stride;                                   ///< step of the linear bin index
  float base;                                     ///< interval of +0, times stride
  float base_negative;                            ///< interval of values just below 0, times stride
  int borders;                                    ///< number of borders above 0
  float border[Resolution::kMaxPerDimension / 2]; ///< squared with sign, ascending in the interval
};

/** \brief Everything the mapping of a feature to its bin needs, in single precision. */
struct BinMap {
  BinMap(const Resolution& resolution, double delta_max);

  AxisMap alpha, beta, gamma;
  bool right_angle_border; ///< alpha has a border at +-pi/2
  float delta_stride;
  int delta_borders;
  float delta_border[Resolution::kMaxPerDimension]; ///< squared
  float no_feature; ///< counter index of the pairs without feature, behind the last bin
};

/** \brief Border \p k (0 ... n - 2) between the \p n intervals of delta, squared. */
float squaredDeltaBorder(int k, int n, double delta_max);

/** \brief Columns of a SurfletSet in unit scale. */
struct Columns {
  const float *x, *y, *z, *nx, *ny, *nz;

  Columns
  from(std::size_t offset) const
  {
    return {x + offset, y + offset, z + offset, nx + offset, ny + offset, nz + offset};
  }
};

/** \brief Keys of one block of drawn pairs. */
struct DrawKeys {
  std::uint32_t k1, k2, k3;
};

/** \brief A block of drawn pairs: the numbers first .. first + n - 1 of the block with \p keys, of
 * surflets stored as \p m records of 8 floats (x y z nx ny nz 0 0), 32-byte aligned. m < 2^29. */
struct DrawnBlock {
  const float* records;
  std::uint32_t m;
  DrawKeys keys;
  std::uint32_t n; ///< at most kDrawBlock
};

constexpr std::uint32_t kDrawBlock = 4096;

/** \brief A block of pairs chosen by the caller: (first[i], second[i]) of the records of a
 * DrawnBlock. */
struct GivenPairs {
  const float* records;
  const std::uint32_t* first;
  const std::uint32_t* second;
  std::uint32_t n; ///< at most kDrawBlock
};

/** \brief Rows of pairs: surflet[i] of the records with count[i] partners from begin[i] on, which
 * lie in columns and so stream through memory. */
struct RowPairs {
  const float* records;
  const std::uint32_t* surflet;
  Columns partners; ///< readable up to kRowPadding behind the last one
  const std::uint32_t* begin;
  const std::uint32_t* count;
  std::size_t rows;
};

constexpr std::size_t kRowPadding = 16;

struct PairKernels {
  const char* name;
  /** Counts the pairs (a[i], b[i]), i < n, into kCounterCopies counters for each of bins + 1. */
  void (*countStream)(Columns a, Columns b, std::size_t n, const BinMap& map,
                      std::uint32_t* counts);
  /** Counts a block of drawn pairs likewise. */
  void (*countDrawn)(const DrawnBlock& block, const BinMap& map, std::uint32_t* counts);
  /** Writes counter index (kNoFeature for none) of delta interval 0, and squared distance, of each
   * drawn pair. */
  void (*featuresDrawn)(const DrawnBlock& block, const BinMap& map, std::uint32_t* index,
                        float* delta_squared);
  /** The same of given pairs. */
  void (*featuresGiven)(const GivenPairs& pairs, const BinMap& map, std::uint32_t* index,
                        float* delta_squared);
  /** The same of rows of pairs, one row behind the other, and up to kRowPadding entries of no
   * meaning behind the last. */
  void (*featuresOfRows)(const RowPairs& pairs, const BinMap& map, std::uint32_t* index,
                         float* delta_squared);
  /** out[i] += weight * in[i], i < n, rounded twice. */
  void (*addWeighted)(const float* in, float weight, std::size_t n, float* out);
  /** Writes the indices of each drawn pair, for those who need the surflets themselves. */
  void (*drawIndices)(const DrawnBlock& block, std::uint32_t* first, std::uint32_t* second);
};

extern const PairKernels scalar_kernels;
extern const PairKernels baseline_kernels;
#if defined(PCL_SURFLET_X86_KERNELS)
extern const PairKernels avx2_kernels;
extern const PairKernels avx512_kernels;
#endif

/** \brief The kernels in use: the best the processor has unless selectInstructionSet() chose. */
const PairKernels& active();

} // namespace kernels
} // namespace pcl_surflet
