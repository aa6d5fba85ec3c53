/** \file
 * Counter-based random numbers: the value of item i depends on (seed, stream, i) alone, so any
 * number of threads and any order of work give the same result. */
#pragma once

#include <cstdint>

namespace pcl_surflet {

/** \brief 64-bit finaliser of splitmix64. */
inline std::uint64_t
mix64(std::uint64_t v)
{
  v += 0x9e3779b97f4a7c15ULL;
  v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9ULL;
  v = (v ^ (v >> 27)) * 0x94d049bb133111ebULL;
  return v ^ (v >> 31);
}

/** \brief Random-access stream of numbers; also a C++ UniformRandomBitGenerator. */
class CounterRandom {
public:
  /** \brief What operator()() gives. */
  using result_type = std::uint64_t;

  /** \brief Streams of one seed are independent of each other. */
  explicit CounterRandom(std::uint64_t seed, std::uint64_t stream = 0)
      : key_(mix64(mix64(seed) ^ stream))
  {
  }

  /** \brief The \p i-th 64-bit value, whatever was drawn before. */
  std::uint64_t
  at(std::uint64_t i) const
  {
    return mix64(key_ ^ mix64(i));
  }
  /** \brief The next value: at(0), at(1) and so on. */
  result_type
  operator()()
  {
    return at(counter_++);
  }
  /** \brief Smallest value, as the standard library asks for it. */
  static constexpr result_type
  min()
  {
    return 0;
  }
  /** \brief Largest value. */
  static constexpr result_type
  max()
  {
    return ~result_type{0};
  }
  /** \brief Uniform in [0, 1). */
  double
  uniform()
  {
    return static_cast<double>((*this)() >> 11) * 0x1.0p-53;
  }
  /** \brief Uniform in [low, high). */
  double
  uniform(double low, double high)
  {
    return low + (high - low) * uniform();
  }
  /** \brief Uniform in {0, ..., n - 1}; \p n must be positive and below 2^32. */
  std::uint32_t
  below(std::uint32_t n)
  {
    return static_cast<std::uint32_t>((((*this)() >> 32) * n) >> 32);
  }

private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

} // namespace pcl_surflet
