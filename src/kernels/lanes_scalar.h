/** \file
 * One pair at a time: the oracle of the vector lanes, and their remainder loop. */
#pragma once

#include <cstddef>
#include <cstdint>

namespace pcl_surflet {
namespace kernels {
namespace {

struct ScalarLanes {
  using F = float;
  using M = bool;
  static constexpr int kWidth = 1;

  static F
  load(const float* p)
  {
    return *p;
  }
  static void
  store(float* p, F v)
  {
    *p = v;
  }
  static F
  set(float v)
  {
    return v;
  }
  static F
  minusAbs(F v)
  {
    return -__builtin_fabsf(v);
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
    return m ? a : b;
  }
  /** \brief \p v + \p step where \p m. */
  static F
  addIf(M m, F v, F step)
  {
    return v + (m ? step : 0.f); // without a branch
  }
  static void
  storeIndex(std::uint32_t* p, F v)
  {
    *p = static_cast<std::uint32_t>(static_cast<std::int32_t>(v));
  }
  template <class Lanes>
  static void
  loadRecords(const float* records, const std::uint32_t* index, Lanes& s)
  {
    const float* r = records + std::size_t{8} * *index;
    s = {r[0], r[1], r[2], r[3], r[4], r[5]};
  }
};

} // namespace
} // namespace kernels
} // namespace pcl_surflet
