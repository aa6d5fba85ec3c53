/** \file
 * The one source of the pair kernels, instantiated by every pair_kernels_*.cpp for its lanes V.
 *
 * V offers: F (floats), M (mask), kWidth, load, store, set, sqrt, abs, less, lessEqual, select,
 * both, either, countIf, toIndex, loadRecords. */
#pragma once

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
  typename V::F angular; ///< bin of (alpha, beta, gamma), a whole number
  typename V::F length;  ///< delta
  typename V::M valid;
};

template <class V>
inline typename V::F
dot(typename V::F ax, typename V::F ay, typename V::F az, typename V::F bx, typename V::F by,
    typename V::F bz)
{
  return ax * bx + ay * by + az * bz;
}

/** \brief Whole-numbered interval of \p position among \p n: floor, clamped to [0, n - 1]; 0 for
 * NaN. */
template <class V>
inline typename V::F
interval(typename V::F position, float n)
{
  const auto low = V::select(V::less(V::set(0.f), position), position, V::set(0.f));
  return V::truncate(V::select(V::less(low, V::set(n - 1)), low, V::set(n - 1)));
}

/** \brief Interval of alpha = atan2(sine, cosine) without computing the angle: counts the interval
 * borders below |alpha| by half-plane tests and mirrors for negative alpha [Eq. 2.6, 2.12].
 *
 * Intervals are half open, so a border belongs to |alpha| >= border for positive and to
 * |alpha| > border for negative alpha; alpha = pi counts as -pi. */
template <class V>
inline typename V::F
alphaInterval(typename V::F sine, typename V::F cosine, const BinMap& map)
{
  const auto zero = V::set(0.f);
  const auto negative =
      V::either(V::less(sine, zero), V::both(V::lessEqual(sine, zero), V::less(cosine, zero)));
  const auto limit = V::select(negative, zero, V::set(-1e-37f));
  const auto magnitude = V::abs(sine);
  auto below = V::set(map.alpha_base);
  for (int k = 0; k < map.edges; ++k)
    below = V::countIf(
        V::less(limit, magnitude * V::set(map.edge_cos[k]) - cosine * V::set(map.edge_sin[k])),
        below);
  return V::select(negative, V::set(map.n_alpha - 1) - below, below);
}

/** \brief The feature of kWidth pairs from five scalar products [Wahl 2007, Eq. 2.2-2.9].
 *
 * With u = n1 and d seen from the origin: |d x u|^2 = d.d - (u.d)^2, beta = det(d, n1, n2)/|d x u|
 * (the same for either origin), and alpha = atan2(n2.d - (n1.n2)(u.d), (n1.n2)|d x u|). */
template <class V>
inline LaneFeatures<V>
features(const Lanes<V>& s1, const Lanes<V>& s2, const BinMap& map)
{
  using F = typename V::F;
  const F dx = s2.x - s1.x, dy = s2.y - s1.y, dz = s2.z - s1.z;
  const F dd = dot<V>(dx, dy, dz, dx, dy, dz);
  const F a = dot<V>(s1.nx, s1.ny, s1.nz, dx, dy, dz);
  const F b = dot<V>(s2.nx, s2.ny, s2.nz, dx, dy, dz);
  const F normals = dot<V>(s1.nx, s1.ny, s1.nz, s2.nx, s2.ny, s2.nz);
  const F determinant = dot<V>(dx, dy, dz, s1.ny * s2.nz - s1.nz * s2.ny,
                               s1.nz * s2.nx - s1.nx * s2.nz, s1.nx * s2.ny - s1.ny * s2.nx);
  const F length = V::sqrt(dd);

  // Eq. 2.2: the origin is the end whose normal is more orthogonal to d; at a tie larger gamma.
  const F zero = V::set(0.f);
  const F difference = V::abs(a) - V::abs(b);
  const auto tie = V::lessEqual(V::abs(difference), length * V::set(float(kOriginTieTolerance)));
  const auto second = V::select(tie, V::less(a, zero - b), V::less(zero, difference));
  const F ud = V::select(second, zero - b, a);
  const F nd = V::select(second, zero - a, b);

  const F v_squared = dd - ud * ud;
  const F v_length = V::sqrt(v_squared);
  const F inverse = V::set(1.f) / (length * v_length); // one division serves beta and gamma
  const F beta = determinant * (length * inverse);
  const F gamma = ud * (v_length * inverse);

  LaneFeatures<V> f;
  f.length = length;
  f.valid = V::both(V::both(V::less(V::set(kCoincidentSquared), dd), V::less(dd, V::set(1e30f))),
                    V::less(dd * V::set(float(kCollinearityTolerance)), v_squared));
  const F bin_alpha = alphaInterval<V>(nd - normals * ud, normals * v_length, map);
  const F bin_beta = interval<V>((beta + V::set(1.f)) * V::set(map.half_beta), map.n_beta);
  const F bin_gamma = interval<V>((gamma + V::set(1.f)) * V::set(map.half_gamma), map.n_gamma);
  f.angular = bin_alpha + V::set(map.n_alpha) * (bin_beta + V::set(map.n_beta) * bin_gamma);
  return f;
}

/** \brief Bin of each pair; the bin behind the last one for pairs without feature. */
template <class V>
inline void
bins(const Lanes<V>& s1, const Lanes<V>& s2, const BinMap& map, std::uint32_t* bin)
{
  const auto f = features<V>(s1, s2, map);
  const auto bin_delta = interval<V>(f.length * V::set(map.delta_scale), map.n_delta);
  const auto linear = f.angular + V::set(float(map.angular_bins)) * bin_delta;
  V::storeIndex(bin, V::select(f.valid, linear, V::set(float(map.bins))));
}

template <class V>
inline void
increment(const std::uint32_t* bin, std::uint32_t* counts, int stride)
{
  for (int lane = 0; lane < V::kWidth; ++lane)
    ++counts[(lane % kCounterCopies) * stride + static_cast<int>(bin[lane])];
}

template <class V>
inline Lanes<V>
loadColumns(const Columns& c, std::size_t i)
{
  return {V::load(c.x + i),  V::load(c.y + i),  V::load(c.z + i),
          V::load(c.nx + i), V::load(c.ny + i), V::load(c.nz + i)};
}

template <class V>
std::size_t
countStreamLanes(const Columns& a, const Columns& b, std::size_t first, std::size_t n,
                 const BinMap& map, std::uint32_t* counts)
{
  alignas(64) std::uint32_t bin[V::kWidth];
  std::size_t i = first;
  for (; i + V::kWidth <= n; i += V::kWidth) {
    bins<V>(loadColumns<V>(a, i), loadColumns<V>(b, i), map, bin);
    increment<V>(bin, counts, map.bins + 1);
  }
  return i;
}

template <class V>
void
countStream(Columns a, Columns b, std::size_t n, const BinMap& map, std::uint32_t* counts)
{
  const std::size_t done = countStreamLanes<V>(a, b, 0, n, map, counts);
  countStreamLanes<ScalarLanes>(a, b, done, n, map, counts);
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
drawIndices(const DrawnBlock& block, std::uint32_t* first, std::uint32_t* second)
{
  const std::uint64_t m = block.m;
  for (std::uint32_t c = 0; c < block.n; ++c) {
    const std::uint32_t h = mix32(c ^ block.keys.k1);
    const auto i = static_cast<std::uint32_t>((mix32(h + block.keys.k2) * m) >> 32);
    const auto j = static_cast<std::uint32_t>((mix32(h ^ block.keys.k3) * (m - 1)) >> 32);
    first[c] = i;
    second[c] = j + (j >= i ? 1u : 0u);
  }
}

/** \brief Calls process(lanes of first, lanes of second, offset) for every drawn pair of the block.
 *
 * Records lie scattered over a cache-busting array, so they are fetched ahead. */
template <class V, class Process>
inline std::uint32_t
forDrawnLanes(const DrawnBlock& block, const std::uint32_t* first, const std::uint32_t* second,
              std::uint32_t begin, const Process& process)
{
  constexpr std::uint32_t kAhead = 32;
  std::uint32_t i = begin;
  for (; i + V::kWidth <= block.n; i += V::kWidth) {
    for (std::uint32_t k = i + kAhead; k < i + kAhead + V::kWidth; ++k) {
      __builtin_prefetch(block.records + std::size_t{8} * first[k]);
      __builtin_prefetch(block.records + std::size_t{8} * second[k]);
    }
    Lanes<V> s1, s2;
    V::loadRecords(block.records, first + i, s1);
    V::loadRecords(block.records, second + i, s2);
    process(s1, s2, i);
  }
  return i;
}

/** \brief Indices of a block, padded so that prefetching may read past the end. */
struct BlockIndices {
  alignas(64) std::uint32_t first[kDrawBlock + 64];
  alignas(64) std::uint32_t second[kDrawBlock + 64];

  explicit BlockIndices(const DrawnBlock& block)
  {
    drawIndices(block, first, second);
    for (std::uint32_t k = block.n; k < block.n + 64; ++k)
      first[k] = second[k] = 0;
  }
};

template <class V>
void
countDrawn(const DrawnBlock& block, const BinMap& map, std::uint32_t* counts)
{
  const BlockIndices indices(block);
  alignas(64) std::uint32_t bin[V::kWidth];
  const auto vector = [&](const Lanes<V>& s1, const Lanes<V>& s2, std::uint32_t) {
    bins<V>(s1, s2, map, bin);
    increment<V>(bin, counts, map.bins + 1);
  };
  const auto scalar = [&](const Lanes<ScalarLanes>& s1, const Lanes<ScalarLanes>& s2,
                          std::uint32_t) {
    bins<ScalarLanes>(s1, s2, map, bin);
    increment<ScalarLanes>(bin, counts, map.bins + 1);
  };
  const auto done = forDrawnLanes<V>(block, indices.first, indices.second, 0, vector);
  forDrawnLanes<ScalarLanes>(block, indices.first, indices.second, done, scalar);
}

template <class V>
inline void
storeFeatures(const Lanes<V>& s1, const Lanes<V>& s2, const BinMap& map, std::uint32_t* angular_bin,
              float* delta)
{
  const auto f = features<V>(s1, s2, map);
  V::storeIndex(angular_bin, V::select(f.valid, f.angular, V::set(-1.f)));
  V::store(delta, f.length);
}

template <class V>
void
featuresDrawn(const DrawnBlock& block, const BinMap& map, std::uint32_t* angular_bin, float* delta)
{
  const BlockIndices indices(block);
  const auto vector = [&](const Lanes<V>& s1, const Lanes<V>& s2, std::uint32_t i) {
    storeFeatures<V>(s1, s2, map, angular_bin + i, delta + i);
  };
  const auto scalar = [&](const Lanes<ScalarLanes>& s1, const Lanes<ScalarLanes>& s2,
                          std::uint32_t i) {
    storeFeatures<ScalarLanes>(s1, s2, map, angular_bin + i, delta + i);
  };
  const auto done = forDrawnLanes<V>(block, indices.first, indices.second, 0, vector);
  forDrawnLanes<ScalarLanes>(block, indices.first, indices.second, done, scalar);
}

} // namespace
} // namespace kernels
} // namespace pcl_surflet

/** \brief Defines the table of kernels for the lanes \p V. */
#define PCL_SURFLET_DEFINE_KERNELS(variable, text, V)                                              \
  namespace pcl_surflet {                                                                          \
  namespace kernels {                                                                              \
  const PairKernels variable = {text, countStream<V>, countDrawn<V>, featuresDrawn<V>,             \
                                drawIndices};                                                      \
  }                                                                                                \
  }
