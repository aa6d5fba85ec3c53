#include "pcl_surflet/core/pair_histogram.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pcl_surflet {
namespace {

/** \brief Interval of \p share in [0, 1] among \p n equal ones; the closed upper end, and whatever
 * lies beyond, goes to the last. */
int
interval(double share, int n)
{
  return static_cast<int>(std::clamp(std::floor(share * n), 0.0, n - 1.0));
}

} // namespace

std::string
Resolution::problem() const
{
  std::int64_t product = 1;
  for (const int n : {alpha, beta, gamma, delta}) {
    if (n < 1 || n > kMaxPerDimension)
      return "resolution " + toString() + ": every dimension must be 1 to " +
             std::to_string(kMaxPerDimension);
    product *= n;
  }
  if (product > kMaxBins)
    return "resolution " + toString() + ": more than " + std::to_string(kMaxBins) + " bins";
  return {};
}

std::string
Resolution::toString() const
{
  return std::to_string(alpha) + "," + std::to_string(beta) + "," + std::to_string(gamma) + "," +
         std::to_string(delta);
}

int
binIndex(const PairFeature& f, const Resolution& r, double delta_max)
{
  const int a = interval((f.alpha + M_PI) / (2 * M_PI), r.alpha);
  const int b = interval((f.beta + 1) / 2, r.beta);
  const int g = interval((f.gamma + 1) / 2, r.gamma);
  const int d = interval(f.delta / delta_max, r.delta);
  return a + r.alpha * (b + r.beta * (g + r.gamma * d));
}

void
PairHistogram::merge(const PairHistogram& other)
{
  if (resolution != other.resolution)
    throw std::invalid_argument("pcl_surflet: cannot merge histograms of resolution " +
                                resolution.toString() + " and " + other.resolution.toString());
  for (std::size_t b = 0; b < counts.size(); ++b)
    counts[b] += other.counts[b];
  features += other.features;
  rejected += other.rejected;
}

std::vector<double>
PairHistogram::normalized() const
{
  std::vector<double> h(counts.size(), 0.0);
  if (features > 0)
    for (std::size_t b = 0; b < h.size(); ++b)
      h[b] = static_cast<double>(counts[b]) / static_cast<double>(features);
  return h;
}

} // namespace pcl_surflet
