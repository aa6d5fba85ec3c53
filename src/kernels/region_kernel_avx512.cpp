// Built with AVX-512 (F, VL, DQ, BW) and without contraction; includes no library header.
#include "region_kernel.h"

#include <immintrin.h>

namespace pcl_surflet {
namespace kernels {

namespace {

inline unsigned
atMost(__m256 a, __m256 b)
{
  return _mm256_cmp_ps_mask(a, b, _CMP_LE_OQ);
}

#include "region_children_256.inl"

inline __m512
squaredDistances(const RegionTree& tree, const __m512 q[3], std::uint32_t i)
{
  const __m512 dx = _mm512_sub_ps(_mm512_loadu_ps(tree.x + i), q[0]);
  const __m512 dy = _mm512_sub_ps(_mm512_loadu_ps(tree.y + i), q[1]);
  const __m512 dz = _mm512_sub_ps(_mm512_loadu_ps(tree.z + i), q[2]);
  return _mm512_add_ps(_mm512_add_ps(_mm512_mul_ps(dx, dx), _mm512_mul_ps(dy, dy)),
                       _mm512_mul_ps(dz, dz));
}

/** \brief Writes the hits among the first \p count points, up to a block, from \p begin on behind
 * the \p size results; returns how many there are now. */
template <int mode>
inline std::uint32_t
filterBlock(const RegionTree& tree, const RegionQuery& query, std::uint32_t begin,
            std::uint32_t count, std::uint32_t size, RegionSink& sink)
{
  const __m512 q[3] = {_mm512_set1_ps(query.q[0]), _mm512_set1_ps(query.q[1]),
                       _mm512_set1_ps(query.q[2])};
  const __m512 square = squaredDistances(tree, q, begin);
  const __mmask16 valid = static_cast<__mmask16>(count >= 16 ? 0xffffu : (1u << count) - 1u);
  const __mmask16 hits =
      _mm512_mask_cmp_ps_mask(valid, square, _mm512_set1_ps(query.square), _CMP_LE_OQ);
  const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const __m512i index = mode == kPositions
                            ? _mm512_add_epi32(lanes, _mm512_set1_epi32(static_cast<int>(begin)))
                            : _mm512_loadu_si512(tree.index + begin);
  // Compressing into a register and storing it whole: the compressing store is far slower.
  _mm512_storeu_si512(sink.index + size, _mm512_maskz_compress_epi32(hits, index));
  if (mode == kDistances)
    _mm512_storeu_ps(sink.square + size, _mm512_maskz_compress_ps(hits, square));
  return size + static_cast<std::uint32_t>(__builtin_popcount(hits));
}

/** \brief Writes the whole block at \p begin behind the \p size results. */
inline void
copyBlock(const RegionTree& tree, const RegionQuery& query, std::uint32_t begin, std::uint32_t size,
          RegionSink& sink)
{
  const __m512 q[3] = {_mm512_set1_ps(query.q[0]), _mm512_set1_ps(query.q[1]),
                       _mm512_set1_ps(query.q[2])};
  _mm512_storeu_si512(sink.index + size, _mm512_loadu_si512(tree.index + begin));
  _mm512_storeu_ps(sink.square + size, squaredDistances(tree, q, begin));
}

inline void
copyIndexBlock(const RegionTree& tree, std::uint32_t begin, std::uint32_t size, RegionSink& sink)
{
  _mm512_storeu_si512(sink.index + size, _mm512_loadu_si512(tree.index + begin));
}

#include "region_traversal.inl"

} // namespace

const RegionKernels&
regionKernelsAvx512()
{
  return kKernels;
}

} // namespace kernels
} // namespace pcl_surflet
