#include "kernels/pair_kernels_impl.h"

namespace pcl_surflet {
namespace kernels {
namespace {

/** \brief Four lanes in the compiler's portable vectors: what every processor of the target has
 * (SSE2 on x86-64), and plain arithmetic where it has none. */
struct BaselineLanes {
  typedef float F __attribute__((vector_size(16)));
  typedef std::int32_t M __attribute__((vector_size(16)));
  static constexpr int kWidth = 4;

  static F
  load(const float* p)
  {
    F v;
    __builtin_memcpy(&v, p, sizeof(v));
    return v;
  }
  static void
  store(float* p, F v)
  {
    __builtin_memcpy(p, &v, sizeof(v));
  }
  static F
  set(float v)
  {
    return F{v, v, v, v};
  }
  static F
  minusAbs(F v)
  {
    return (F)((M)v | (M)set(-0.f));
  }
  static M
  less(F a, F b)
  {
    return a < b;
  }
  static M
  lessEqual(F a, F b)
  {
    return a <= b;
  }
  static F
  select(M m, F a, F b)
  {
    return (F)(((M)a & m) | ((M)b & ~m));
  }
  static F
  addIf(M m, F v, F step)
  {
    return v + (F)(m & (M)step);
  }
  static void
  storeIndex(std::uint32_t* p, F v)
  {
    const M index = __builtin_convertvector(v, M);
    __builtin_memcpy(p, &index, sizeof(index));
  }
  template <class L>
  static void
  loadRecords(const float* records, const std::uint32_t* index, L& s)
  {
    const float* r[kWidth];
    for (int k = 0; k < kWidth; ++k)
      r[k] = records + std::size_t{8} * index[k];
    const auto column = [&](int c) { return F{r[0][c], r[1][c], r[2][c], r[3][c]}; };
    s = {column(0), column(1), column(2), column(3), column(4), column(5)};
  }
};

} // namespace
} // namespace kernels
} // namespace pcl_surflet

PCL_SURFLET_DEFINE_KERNELS(baseline_kernels, "baseline", BaselineLanes)
