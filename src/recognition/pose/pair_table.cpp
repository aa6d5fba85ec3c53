#include "pose_parts.h"

#include "pcl_surflet/core/surflet_pair.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pcl_surflet {
namespace pose {
namespace {

// Intervals of alpha, beta, gamma, delta.
constexpr std::array<std::size_t, 4> kIntervals = {24, 10, 10, 20};
constexpr std::array<double, 4> kLow = {-M_PI, -1, -1, 0}, kRange = {2 * M_PI, 2, 2, 1};
/** \brief Most pairs of a bin that are kept: where all pairs are alike, as on a sphere, some of
 * them tell as much as all. */
constexpr std::uint32_t kMostPairs = 192;

std::size_t
binOf(const double (&feature)[4])
{
  std::size_t bin = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    const double at = (feature[a] - kLow[a]) / kRange[a] * static_cast<double>(kIntervals[a]);
    bin = bin * kIntervals[a] +
          static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(kIntervals[a] - 1)));
  }
  return bin;
}

struct BinnedPair {
  std::size_t bin;
  TablePair pair;
};

std::vector<BinnedPair>
allPairs(const SurfletSet& cells)
{
  std::vector<std::array<Vector3, 3>> frames;
  for (std::size_t i = 0; i < cells.size(); ++i)
    frames.push_back(frameOf(normalOf(cells, i)));
  std::vector<BinnedPair> all;
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (std::size_t j = i + 1; j < cells.size(); ++j) {
      bool second = false;
      const auto f = computePairFeature(cells[i], cells[j], second);
      if (!f)
        continue;
      const std::size_t origin = second ? j : i, other = second ? i : j;
      const Vector3 d = detail::subtract(positionOf(cells, other), positionOf(cells, origin));
      all.push_back(
          {binOf({f->alpha, f->beta, f->gamma, f->delta}),
           {static_cast<std::uint16_t>(origin), static_cast<float>(azimuthOf(d, frames[origin]))}});
    }
  return all;
}

} // namespace

std::array<Vector3, 3>
frameOf(const Vector3& n)
{
  std::size_t least = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (std::abs(n[a]) < std::abs(n[least]))
      least = a;
  Vector3 axis{0, 0, 0};
  axis[least] = 1;
  const Vector3 across = detail::cross(axis, n);
  const Vector3 e1 = detail::scaled(across, 1 / detail::norm(across));
  return {e1, detail::cross(n, e1), n};
}

double
azimuthOf(const Vector3& d, const std::array<Vector3, 3>& frame)
{
  return std::atan2(detail::dot(d, frame[1]), detail::dot(d, frame[0]));
}

PairTable::PairTable(const SurfletSet& cells)
{
  const std::size_t bins =
      std::accumulate(kIntervals.begin(), kIntervals.end(), std::size_t{1}, std::multiplies<>());
  const auto all = allPairs(cells);
  std::vector<std::uint32_t> count(bins, 0), met(bins, 0);
  for (const auto& p : all)
    ++count[p.bin];
  begin_.assign(bins + 1, 0);
  for (std::size_t b = 0; b < bins; ++b)
    begin_[b + 1] = begin_[b] + std::min(count[b], kMostPairs);
  pairs_.resize(begin_[bins]);
  for (const auto& p : all) {
    // Of n pairs the k-th is kept if k * most / n steps to the next number: evenly, exactly most.
    const std::uint64_t n = count[p.bin], k = met[p.bin]++,
                        most = std::min(count[p.bin], kMostPairs);
    const std::uint64_t place = k * most / n;
    if (k == 0 || (k - 1) * most / n != place)
      pairs_[begin_[p.bin] + place] = p.pair;
  }
}

PairTable::Range
PairTable::pairsLike(const double (&feature)[4]) const
{
  const std::size_t bin = binOf(feature);
  return {pairs_.data() + begin_[bin], pairs_.data() + begin_[bin + 1]};
}

} // namespace pose
} // namespace pcl_surflet
