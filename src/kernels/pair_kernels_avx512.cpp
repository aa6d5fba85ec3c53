#include "kernels/pair_kernels_impl.h"

#include <immintrin.h>

namespace pcl_surflet {
namespace kernels {
namespace {

struct Avx512Lanes {
  using F = __m512;
  using M = __mmask16;
  static constexpr int kWidth = 16;

  static F
  load(const float* p)
  {
    return _mm512_loadu_ps(p);
  }
  static void
  store(float* p, F v)
  {
    _mm512_storeu_ps(p, v);
  }
  static F
  set(float v)
  {
    return _mm512_set1_ps(v);
  }
  static F
  minusAbs(F v)
  {
    return _mm512_or_ps(_mm512_set1_ps(-0.f), v);
  }
  static M
  less(F a, F b)
  {
    return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
  }
  static M
  lessEqual(F a, F b)
  {
    return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ);
  }
  static F
  select(M m, F a, F b)
  {
    return _mm512_mask_blend_ps(m, b, a);
  }
  static F
  addIf(M m, F v, F step)
  {
    return _mm512_mask_add_ps(v, m, v, step);
  }
  static void
  storeIndex(std::uint32_t* p, F v)
  {
    _mm512_storeu_si512(p, _mm512_cvttps_epi32(v));
  }
  /** \brief Sixteen records of eight floats, transposed in four-by-four blocks. */
  static void
  loadRecords(const float* records, const std::uint32_t* index, Lanes<Avx512Lanes>& s)
  {
    const auto part = [&](int k, int half) {
      return _mm_load_ps(records + std::size_t{8} * index[k] + 4 * half);
    };
    const auto row = [&](int k, int half) {
      __m512 v = _mm512_castps128_ps512(part(k, half));
      v = _mm512_insertf32x4(v, part(k + 4, half), 1);
      v = _mm512_insertf32x4(v, part(k + 8, half), 2);
      return _mm512_insertf32x4(v, part(k + 12, half), 3);
    };
    const __m512 r0 = row(0, 0), r1 = row(1, 0), r2 = row(2, 0), r3 = row(3, 0);
    const __m512 q0 = row(0, 1), q1 = row(1, 1), q2 = row(2, 1), q3 = row(3, 1);
    const __m512 t0 = _mm512_unpacklo_ps(r0, r1), t1 = _mm512_unpackhi_ps(r0, r1);
    const __m512 t2 = _mm512_unpacklo_ps(r2, r3), t3 = _mm512_unpackhi_ps(r2, r3);
    s.x = _mm512_shuffle_ps(t0, t2, 0x44);
    s.y = _mm512_shuffle_ps(t0, t2, 0xee);
    s.z = _mm512_shuffle_ps(t1, t3, 0x44);
    s.nx = _mm512_shuffle_ps(t1, t3, 0xee);
    const __m512 u0 = _mm512_unpacklo_ps(q0, q1), u2 = _mm512_unpacklo_ps(q2, q3);
    s.ny = _mm512_shuffle_ps(u0, u2, 0x44);
    s.nz = _mm512_shuffle_ps(u0, u2, 0xee);
  }
};

} // namespace
} // namespace kernels
} // namespace pcl_surflet

PCL_SURFLET_DEFINE_KERNELS(avx512_kernels, "avx512", Avx512Lanes)
