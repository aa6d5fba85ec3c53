/** \file
 * The one source of the pair kernels, instantiated by every pair_kernels_*.cpp for its lanes V.
 *
 * V offers: F (floats), M (mask), kWidth, load, store, set, minusAbs, less, lessEqual, select,
 * addIf, storeIndex, loadRecords. */
#pragma once

#include "kernels/lanes_scalar.h"
#include "kernels/pair_kernels.h"

namespace pcl_surflet {
namespace kernels {
namespace {

/** \brief kWidth surflets side by side. */
template <class V>
struct Lanes {
  typename V::F x, y, z, nx, ny, nz;
};

/** \brief Features of kWidth pairs, as far as bins need them. */
template <class V>
struct LaneFeatures {
  typename V::F index;         ///< counter index of (alpha, beta, gamma), a whole number
  typename V::F delta_squared; ///< delta^2
  typename V::M valid;
};

template <class V>
inline typename V::F
dot(typename V::F ax, typename V::F ay, typename V::F az, typename V::F bx, typename V::F by,
    typename V::F bz)
{
  return ax * bx + ay * by + az * bz;
}

/** \brief Numbers of interval borders known at compile time, so that the loops over them unroll; 0
 * where only BinMap knows. */
template <int angular, int delta>
struct Borders {
  static constexpr int kAngular = angular, kDelta = delta;
};

/** \brief Adds to \p bin the interval of a value that is known by sign and squared ratio.
 *
 * The intervals lie symmetric about 0, so it is enough to count the borders that the magnitude
 * exceeds, \p over >= border^2 * \p under, upwards from the middle for positive and downwards for
 * negative values. No root and no division is needed, and no clamping either. */
template <class V, class B>
inline typename V::F
addInterval(typename V::F bin, typename V::M negative, typename V::F over, typename V::F under,
            const AxisMap& axis)
{
  const auto step = V::select(negative, V::set(-axis.stride), V::set(axis.stride));
  bin = bin + V::select(negative, V::set(axis.base_negative), V::set(axis.base));
  const int borders = B::kAngular > 0 ? B::kAngular : axis.borders;
  for (int k = 0; k < borders; ++k)
    bin = V::addIf(V::lessEqual(under * V::set(axis.border[k]), over), bin, step);
  return bin;
}

/** \brief Is p2 the origin of each pair [Wahl 2007, Eq. 2.2]? At a tie (kOriginTieTolerance) the
 * end with the larger gamma. \p a = n1.d, \p minus_b = -n2.d. */
template <class V>
inline typename V::M
originIsSecond(typename V::F a, typename V::F minus_b)
{
  constexpr float kTolerance = static_cast<float>(kOriginTieTolerance);
  const auto factor =
      V::select(V::less(a, minus_b), V::set(1 - kTolerance), V::set(1 + kTolerance));
  return V::less(minus_b * minus_b * factor, a * a);
}

/** \brief The feature of kWidth pairs from five scalar products [Wahl 2007, Eq. 2.2-2.9].
 *
 * With u = n1 and d seen from the origin: |d x u|^2 = d.d - (u.d)^2, beta = det(d, n1, n2)/|d x u|
 * (the same for either origin), gamma = u.d/|d|, and alpha = atan2(n2.d - (n1.n2)(u.d),
 * (n1.n2)|d x u|). Only signs and squares of these are formed: their intervals need no more. */
template <class V, class B>
inline LaneFeatures<V>
features(const Lanes<V>& s1, const Lanes<V>& s2, const BinMap& map)
{
  using F = typename V::F;
  const F zero = V::set(0.f);
  const F dx = s2.x - s1.x, dy = s2.y - s1.y, dz = s2.z - s1.z;
  const F dd = dot<V>(dx, dy, dz, dx, dy, dz);
  const F a = dot<V>(s1.nx, s1.ny, s1.nz, dx, dy, dz);
  const F b = dot<V>(s2.nx, s2.ny, s2.nz, dx, dy, dz);
  const F normals = dot<V>(s1.nx, s1.ny, s1.nz, s2.nx, s2.ny, s2.nz);
  const F determinant = dot<V>(dx, dy, dz, s1.ny * s2.nz - s1.nz * s2.ny,
                               s1.nz * s2.nx - s1.nx * s2.nz, s1.nx * s2.ny - s1.ny * s2.nx);
  const F minus_b = zero - b;
  const auto second = originIsSecond<V>(a, minus_b);
  const F ud = V::select(second, minus_b, a);
  const F nd = V::select(second, zero - a, b);
  const F ud_squared = ud * ud;
  const F v_squared = dd - ud_squared;

  // cot(alpha) = cosine / sine falls from +inf to -inf over (0, pi). The tiny term gives alpha = pi
  // (sine 0, cosine negative) the sign of -pi, as Eq. 2.12 wants it.
  const F sine = nd - normals * ud + normals * V::set(1e-30f);
  const F sine_squared = sine * sine;
  F minus_cosine = normals * V::minusAbs(normals) * v_squared; // -(signed square)
  const auto alpha_negative = V::less(sine, zero);
  // Intervals are half open: on a border, +alpha belongs above and -alpha below it. It matters for
  // the right angles of boxes, where the cosine is exactly 0.
  if (map.right_angle_border)
    minus_cosine = V::addIf(alpha_negative, minus_cosine, sine_squared * V::set(-1e-14f));

  LaneFeatures<V> f;
  f.delta_squared = dd;
  f.valid = V::less(dd * V::set(float(kCollinearityTolerance)), v_squared);
  f.index = addInterval<V, B>(zero, alpha_negative, minus_cosine, sine_squared, map.alpha);
  f.index = addInterval<V, B>(f.index, V::less(determinant, zero), determinant * determinant,
                              v_squared, map.beta);
  f.index = addInterval<V, B>(f.index, V::less(ud, zero), ud_squared, dd, map.gamma);
  return f;
}

/** \brief Counter index of each pair; that behind the last bin for pairs without feature. */
template <class V, class B>
inline typename V::F
counterIndex(const Lanes<V>& s1, const Lanes<V>& s2, const BinMap& map)
{
  auto f = features<V, B>(s1, s2, map);
  const int borders = B::kDelta > 0 ? B::kDelta : map.delta_borders;
  for (int k = 0; k < borders; ++k)
    f.index = V::addIf(V::lessEqual(V::set(map.delta_border[k]), f.delta_squared), f.index,
                       V::set(map.delta_stride));
  return V::select(f.valid, f.index, V::set(map.no_feature));
}

/** \brief Counts bins some vectors after they were stored.
 *
 * Reading single lanes right behind the vector store that wrote them stalls (the store cannot be
 * forwarded), and extracting them from the register costs as much as the feature itself. The delay
 * made streamed pairs 1.8 times as fast; separate loops over blocks were slower because they do not
 * overlap. */
class DelayedCounter {
public:
  explicit DelayedCounter(std::uint32_t* counts) : counts_(counts) {}

  template <class V>
  inline void
  add(typename V::F index)
  {
    V::storeIndex(ring_ + head_ % kRing, index);
    head_ += V::kWidth;
    if (head_ - tail_ > kLag)
      count<V::kWidth>();
  }

  void
  flush()
  {
    while (tail_ < head_)
      count<1>();
  }

private:
  static constexpr std::uint32_t kRing = 128, kLag = 64;

  template <int n>
  inline void
  count()
  {
    const std::uint32_t* index = ring_ + tail_ % kRing;
    for (int lane = 0; lane < n; ++lane)
      ++counts_[std::size_t{index[lane]} + lane % kCounterCopies];
    tail_ += n;
  }

  alignas(64) std::uint32_t ring_[kRing];
  std::uint32_t* counts_;
  std::uint32_t head_ = 0, tail_ = 0;
};

/** \brief Calls \p run with the Borders of \p map: the resolutions 5, 7 and 8 (all dimensions
 * alike), which matter, unroll. */
template <class Run>
inline void
withBorders(const BinMap& map, const Run& run)
{
  const int a = map.alpha.borders, d = map.delta_borders;
  const bool alike = map.beta.borders == a && map.gamma.borders == a;
  if (alike && a == 2 && d == 4)
    run(Borders<2, 4>());
  else if (alike && a == 3 && d == 6)
    run(Borders<3, 6>());
  else if (alike && a == 3 && d == 7)
    run(Borders<3, 7>());
  else
    run(Borders<0, 0>());
}

template <class V>
inline Lanes<V>
loadColumns(const Columns& c, std::size_t i)
{
  return {V::load(c.x + i),  V::load(c.y + i),  V::load(c.z + i),
          V::load(c.nx + i), V::load(c.ny + i), V::load(c.nz + i)};
}

template <class V, class B>
inline std::size_t
countStreamLanes(const Columns& a, const Columns& b, std::size_t first, std::size_t n,
                 const BinMap& map, DelayedCounter& counter)
{
  std::size_t i = first;
  for (; i + V::kWidth <= n; i += V::kWidth)
    counter.add<V>(counterIndex<V, B>(loadColumns<V>(a, i), loadColumns<V>(b, i), map));
  return i;
}

template <class V>
void
countStream(Columns a, Columns b, std::size_t n, const BinMap& shared_map, std::uint32_t* counts)
{
  const BinMap map = shared_map; // a copy of our own may stay in registers
  DelayedCounter counter(counts);
  withBorders(map, [&](auto borders) {
    using B = decltype(borders);
    const std::size_t done = countStreamLanes<V, B>(a, b, 0, n, map, counter);
    counter.flush();
    countStreamLanes<ScalarLanes, Borders<0, 0>>(a, b, done, n, map, counter);
    counter.flush();
  });
}

/** \brief A bijective 32-bit mixing function (integer finaliser of low bias). */
inline std::uint32_t
mix32(std::uint32_t v)
{
  v = (v ^ (v >> 16)) * 0x7feb352du;
  v = (v ^ (v >> 15)) * 0x846ca68bu;
  return v ^ (v >> 16);
}

/** \brief Draws ordered pairs of different indices, uniform up to 2^-32. Number i of a block
 * depends on the block's keys and i alone. */
inline void
drawIndices(const DrawnBlock& block, std::uint32_t* __restrict first,
            std::uint32_t* __restrict second)
{
  // Copies: the compiler could not rule out that the stores change the block, and then it does not
  // vectorise.
  const std::uint32_t m = block.m, n = block.n;
  const DrawKeys keys = block.keys;
  for (std::uint32_t c = 0; c < n; ++c) {
    const std::uint32_t h = mix32(c ^ keys.k1);
    const auto i = static_cast<std::uint32_t>((std::uint64_t{mix32(h + keys.k2)} * m) >> 32);
    const auto j = static_cast<std::uint32_t>((std::uint64_t{mix32(h ^ keys.k3)} * (m - 1)) >> 32);
    first[c] = i;
    second[c] = j + (j >= i ? 1u : 0u);
  }
}

/** \brief Places of the records of a block of pairs, in floats, padded so that prefetching may read
 * past the end.
 */
struct BlockIndices {
  static constexpr std::uint32_t kPadding = 64;

  alignas(64) std::uint32_t first[kDrawBlock + kPadding];
  alignas(64) std::uint32_t second[kDrawBlock + kPadding];

  explicit BlockIndices(const DrawnBlock& block)
  {
    drawIndices(block, first, second);
    toPlaces(first, second, block.n);
  }
  explicit BlockIndices(const GivenPairs& pairs) { toPlaces(pairs.first, pairs.second, pairs.n); }

private:
  void
  toPlaces(const std::uint32_t* a, const std::uint32_t* b, std::uint32_t n)
  {
    for (std::uint32_t k = 0; k < n; ++k) {
      first[k] = 8 * a[k];
      second[k] = 8 * b[k];
    }
    for (std::uint32_t k = n; k < n + kPadding; ++k)
      first[k] = second[k] = 0;
  }
};

/** \brief Calls process(lanes of first, lanes of second, offset) for a block's pairs from \p begin
 * on, as long as they fill the lanes. \return where it stopped
 *
 * Records lie scattered over memory, so they are fetched ahead. */
template <class V, class Block, class Process>
inline std::uint32_t
forPairLanes(const Block& block, const BlockIndices& indices, std::uint32_t begin,
             const Process& process)
{
  constexpr std::uint32_t kAhead = 32;
  std::uint32_t i = begin;
  for (; i + V::kWidth <= block.n; i += V::kWidth) {
    for (std::uint32_t k = i + kAhead; k < i + kAhead + V::kWidth; ++k) {
      __builtin_prefetch(block.records + indices.first[k]);
      __builtin_prefetch(block.records + indices.second[k]);
    }
    Lanes<V> s1, s2;
    V::loadRecords(block.records, indices.first + i, s1);
    V::loadRecords(block.records, indices.second + i, s2);
    process(s1, s2, i);
  }
  return i;
}

template <class V>
void
countDrawn(const DrawnBlock& block, const BinMap& shared_map, std::uint32_t* counts)
{
  const BinMap map = shared_map;
  const BlockIndices indices(block);
  DelayedCounter counter(counts);
  withBorders(map, [&](auto borders) {
    using B = decltype(borders);
    const auto done = forPairLanes<V>(block, indices, 0, [&](const auto& s1, const auto& s2, auto) {
      counter.add<V>(counterIndex<V, B>(s1, s2, map));
    });
    counter.flush();
    forPairLanes<ScalarLanes>(block, indices, done, [&](const auto& s1, const auto& s2, auto) {
      counter.add<ScalarLanes>(counterIndex<ScalarLanes, Borders<0, 0>>(s1, s2, map));
    });
    counter.flush();
  });
}

template <class V, class B>
inline void
storeFeatures(const Lanes<V>& s1, const Lanes<V>& s2, const BinMap& map, std::uint32_t* index,
              float* delta_squared)
{
  const auto f = features<V, B>(s1, s2, map);
  V::storeIndex(index, V::select(f.valid, f.index, V::set(-1.f)));
  V::store(delta_squared, f.delta_squared);
}

template <class V, class Block>
void
featuresOfBlock(const Block& block, const BinMap& shared_map, std::uint32_t* index,
                float* delta_squared)
{
  const BinMap map = shared_map;
  const BlockIndices indices(block);
  withBorders(map, [&](auto borders) {
    using B = decltype(borders);
    const auto done = forPairLanes<V>(
        block, indices, 0, [&](const Lanes<V>& s1, const Lanes<V>& s2, std::uint32_t i) {
          storeFeatures<V, B>(s1, s2, map, index + i, delta_squared + i);
        });
    forPairLanes<ScalarLanes>(
        block, indices, done,
        [&](const Lanes<ScalarLanes>& s1, const Lanes<ScalarLanes>& s2, std::uint32_t i) {
          storeFeatures<ScalarLanes, Borders<0, 0>>(s1, s2, map, index + i, delta_squared + i);
        });
  });
}

template <class V>
void
featuresOfRows(const RowPairs& pairs, const BinMap& shared_map, std::uint32_t* index,
               float* delta_squared)
{
  const BinMap map = shared_map;
  withBorders(map, [&](auto borders) {
    using B = decltype(borders);
    for (std::size_t row = 0; row < pairs.rows; ++row) {
      const float* r = pairs.records + std::size_t{8} * pairs.surflet[row];
      const Lanes<V> s = {V::set(r[0]), V::set(r[1]), V::set(r[2]),
                          V::set(r[3]), V::set(r[4]), V::set(r[5])};
      const std::uint32_t n = pairs.count[row];
      // The last lanes may hold what is behind the row: the next row writes over it.
      for (std::uint32_t i = 0; i < n; i += V::kWidth)
        storeFeatures<V, B>(s, loadColumns<V>(pairs.partners, pairs.begin[row] + i), map, index + i,
                            delta_squared + i);
      index += n;
      delta_squared += n;
    }
  });
}

template <class V>
void
addWeighted(const float* in, float weight, std::size_t n, float* out)
{
  std::size_t i = 0;
  for (const auto w = V::set(weight); i + V::kWidth <= n; i += V::kWidth)
    V::store(out + i, V::load(out + i) + w * V::load(in + i));
  for (; i < n; ++i)
    out[i] += weight * in[i];
}

} // namespace
} // namespace kernels
} // namespace pcl_surflet

/** \brief Defines the table of kernels for the lanes \p V. */
#define PCL_SURFLET_DEFINE_KERNELS(variable, text, V)                                              \
  namespace pcl_surflet {                                                                          \
  namespace kernels {                                                                              \
  const PairKernels variable = {text,                                                              \
                                countStream<V>,                                                    \
                                countDrawn<V>,                                                     \
                                featuresOfBlock<V, DrawnBlock>,                                    \
                                featuresOfBlock<V, GivenPairs>,                                    \
                                featuresOfRows<V>,                                                 \
                                addWeighted<V>,                                                    \
                                drawIndices};                                                      \
  }                                                                                                \
  }
