// Built with AVX2 and without contraction; includes no library header.
#include "region_kernel.h"

#include <immintrin.h>

namespace pcl_surflet {
namespace kernels {

namespace {

/** \brief For every set of hits among eight lanes the lanes that hit, first to last: AVX2 has no
 * compressing instruction. */
struct HitLanes {
  std::uint8_t lanes[256][8];
  constexpr HitLanes() : lanes()
  {
    for (int hits = 0; hits < 256; ++hits)
      for (int lane = 0, n = 0; lane < 8; ++lane)
        if (hits >> lane & 1)
          lanes[hits][n++] = static_cast<std::uint8_t>(lane);
  }
};
constexpr HitLanes kHitLanes;

inline unsigned
atMost(__m256 a, __m256 b)
{
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)));
}

#include "region_children_256.inl"

inline __m256
squaredDistances(const RegionTree& tree, const __m256 q[3], std::uint32_t i)
{
  const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(tree.x + i), q[0]);
  const __m256 dy = _mm256_sub_ps(_mm256_loadu_ps(tree.y + i), q[1]);
  const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(tree.z + i), q[2]);
  return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)),
                       _mm256_mul_ps(dz, dz));
}

inline __m256i
loadIndices(const std::int32_t* p)
{
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
}

inline void
storeIndices(std::int32_t* p, __m256i v)
{
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), v);
}

/** \brief Writes the hits among the first \p count points, up to a block, from \p begin on behind
 * the \p size results; returns how many there are now. */
template <int mode>
inline std::uint32_t
filterBlock(const RegionTree& tree, const RegionQuery& query, std::uint32_t begin,
            std::uint32_t count, std::uint32_t size, RegionSink& sink)
{
  const __m256 q[3] = {_mm256_set1_ps(query.q[0]), _mm256_set1_ps(query.q[1]),
                       _mm256_set1_ps(query.q[2])};
  const __m256 limit = _mm256_set1_ps(query.square);
  const __m256i lane_numbers = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const unsigned valid = count >= 16 ? 0xffffu : (1u << count) - 1u;
  for (std::uint32_t i = begin; i < begin + kBlock; i += 8) {
    const __m256 square = squaredDistances(tree, q, i);
    const unsigned hits = atMost(square, limit) & valid >> (i - begin) & 0xffu;
    const __m256i lanes = _mm256_cvtepu8_epi32(
        _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kHitLanes.lanes[hits])));
    const __m256i index =
        mode == kPositions ? _mm256_add_epi32(lane_numbers, _mm256_set1_epi32(static_cast<int>(i)))
                           : loadIndices(tree.index + i);
    storeIndices(sink.index + size, _mm256_permutevar8x32_epi32(index, lanes));
    if (mode == kDistances)
      _mm256_storeu_ps(sink.square + size, _mm256_permutevar8x32_ps(square, lanes));
    size += static_cast<std::uint32_t>(__builtin_popcount(hits));
  }
  return size;
}

/** \brief Writes the whole block at \p begin behind the \p size results. */
inline void
copyBlock(const RegionTree& tree, const RegionQuery& query, std::uint32_t begin, std::uint32_t size,
          RegionSink& sink)
{
  const __m256 q[3] = {_mm256_set1_ps(query.q[0]), _mm256_set1_ps(query.q[1]),
                       _mm256_set1_ps(query.q[2])};
  for (std::uint32_t i = 0; i < kBlock; i += 8) {
    storeIndices(sink.index + size + i, loadIndices(tree.index + begin + i));
    _mm256_storeu_ps(sink.square + size + i, squaredDistances(tree, q, begin + i));
  }
}

inline void
copyIndexBlock(const RegionTree& tree, std::uint32_t begin, std::uint32_t size, RegionSink& sink)
{
  for (std::uint32_t i = 0; i < kBlock; i += 8)
    storeIndices(sink.index + size + i, loadIndices(tree.index + begin + i));
}

#include "region_traversal.inl"

} // namespace

const RegionKernels&
regionKernelsAvx2()
{
  return kKernels;
}

} // namespace kernels
} // namespace pcl_surflet
