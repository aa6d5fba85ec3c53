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
  sqrt(F v)
  {
    return __builtin_sqrtf(v);
  }
  static F
  abs(F v)
  {
    return __builtin_fabsf(v);
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
  static M
  both(M a, M b)
  {
    return a & b;
  }
  static M
  either(M a, M b)
  {
    return a | b;
  }
  template <class T>
  static T
  select(M m, T a, T b)
  {
    return m ? a : b;
  }
  /** \brief \p v + 1 where \p m. */
  static F
  countIf(M m, F v)
  {
    return v + static_cast<float>(m);
  }
  /** \brief Whole part of a value in [0, 2^31). */
  static F
  truncate(F v)
  {
    return static_cast<float>(static_cast<std::int32_t>(v));
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
