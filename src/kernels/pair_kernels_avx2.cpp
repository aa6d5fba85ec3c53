#include "kernels/pair_kernels_impl.h"

#include <immintrin.h>

namespace pcl_surflet {
namespace kernels {
namespace {

struct Avx2Lanes {
  using F = __m256;
  using M = __m256;
  static constexpr int kWidth = 8;

  static F
  load(const float* p)
  {
    return _mm256_loadu_ps(p);
  }
  static void
  store(float* p, F v)
  {
    _mm256_storeu_ps(p, v);
  }
  static F
  set(float v)
  {
    return _mm256_set1_ps(v);
  }
  static F
  minusAbs(F v)
  {
    return _mm256_or_ps(_mm256_set1_ps(-0.f), v);
  }
  static M
  less(F a, F b)
  {
    return _mm256_cmp_ps(a, b, _CMP_LT_OQ);
  }
  static M
  lessEqual(F a, F b)
  {
    return _mm256_cmp_ps(a, b, _CMP_LE_OQ);
  }
  static F
  select(M m, F a, F b)
  {
    return _mm256_blendv_ps(b, a, m);
  }
  static F
  addIf(M m, F v, F step)
  {
    return v + _mm256_and_ps(m, step);
  }
  static void
  storeIndex(std::uint32_t* p, F v)
  {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm256_cvttps_epi32(v));
  }
  /** \brief Eight records of eight floats, transposed; hardware gathers take several times longer.
   */
  static void
  loadRecords(const float* records, const std::uint32_t* index, Lanes<Avx2Lanes>& s)
  {
    const auto row = [&](int a, int b, int half) {
      const float* low = records + std::size_t{8} * index[a] + 4 * half;
      const float* high = records + std::size_t{8} * index[b] + 4 * half;
      return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(low)), _mm_load_ps(high), 1);
    };
    const __m256 r0 = row(0, 4, 0), r1 = row(1, 5, 0), r2 = row(2, 6, 0), r3 = row(3, 7, 0);
    const __m256 q0 = row(0, 4, 1), q1 = row(1, 5, 1), q2 = row(2, 6, 1), q3 = row(3, 7, 1);
    const __m256 t0 = _mm256_unpacklo_ps(r0, r1), t1 = _mm256_unpackhi_ps(r0, r1);
    const __m256 t2 = _mm256_unpacklo_ps(r2, r3), t3 = _mm256_unpackhi_ps(r2, r3);
    s.x = _mm256_shuffle_ps(t0, t2, 0x44);
    s.y = _mm256_shuffle_ps(t0, t2, 0xee);
    s.z = _mm256_shuffle_ps(t1, t3, 0x44);
    s.nx = _mm256_shuffle_ps(t1, t3, 0xee);
    const __m256 u0 = _mm256_unpacklo_ps(q0, q1), u2 = _mm256_unpacklo_ps(q2, q3);
    s.ny = _mm256_shuffle_ps(u0, u2, 0x44);
    s.nz = _mm256_shuffle_ps(u0, u2, 0xee);
  }
};

} // namespace
} // namespace kernels
} // namespace pcl_surflet

PCL_SURFLET_DEFINE_KERNELS(avx2_kernels, "avx2", Avx2Lanes)
