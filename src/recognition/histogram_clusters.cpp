#include "recognition/histogram_clusters.h"

#include "pcl_surflet/core/similarity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pcl_surflet {
namespace {

using Roots = std::vector<double>;

constexpr int kMostRounds = 20; ///< k-means of so few histograms has settled long before

double
squaredDistance(const Roots& a, const Roots& b)
{
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

Roots
meanOf(const std::vector<Roots>& all, const std::vector<std::size_t>& chosen)
{
  Roots mean(all.front().size(), 0.0);
  for (const auto i : chosen)
    for (std::size_t b = 0; b < mean.size(); ++b)
      mean[b] += all[i][b] / static_cast<double>(chosen.size());
  return mean;
}

std::size_t
nearest(const std::vector<Roots>& all, const Roots& to)
{
  const auto closer = [&](const Roots& a, const Roots& b) {
    return squaredDistance(a, to) < squaredDistance(b, to);
  };
  return static_cast<std::size_t>(std::min_element(all.begin(), all.end(), closer) - all.begin());
}

/** \brief The middle one, then always the one farthest from those before. */
std::vector<Roots>
startingCentres(const std::vector<Roots>& all, std::size_t groups)
{
  std::vector<std::size_t> everyone(all.size());
  std::iota(everyone.begin(), everyone.end(), std::size_t{0});
  std::vector<Roots> centres = {all[nearest(all, meanOf(all, everyone))]};
  std::vector<double> gap(all.size(), std::numeric_limits<double>::max());
  while (centres.size() < groups) {
    for (std::size_t i = 0; i < all.size(); ++i)
      gap[i] = std::min(gap[i], squaredDistance(all[i], centres.back()));
    const auto farthest = std::max_element(gap.begin(), gap.end());
    if (!(*farthest > 0))
      break; // all histograms are centres already
    centres.push_back(all[static_cast<std::size_t>(farthest - gap.begin())]);
  }
  return centres;
}

/** \brief Members of the nearest centre, for each centre. */
std::vector<std::vector<std::size_t>>
assigned(const std::vector<Roots>& all, const std::vector<Roots>& centres)
{
  std::vector<std::vector<std::size_t>> groups(centres.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    groups[nearest(centres, all[i])].push_back(i);
  return groups;
}

} // namespace

std::vector<HistogramGroup>
groupHistograms(const std::vector<PairHistogram>& histograms, std::size_t groups)
{
  std::vector<std::size_t> usable;
  std::vector<Roots> all;
  for (std::size_t i = 0; i < histograms.size(); ++i) {
    if (histograms[i].features == 0)
      continue;
    usable.push_back(i);
    all.push_back(histograms[i].normalized());
    for (double& v : all.back())
      v = std::sqrt(v);
  }
  if (all.empty() || groups == 0)
    return {};
  auto centres = startingCentres(all, groups);
  auto parts = assigned(all, centres);
  for (int round = 0; round < kMostRounds; ++round) {
    for (std::size_t c = 0; c < centres.size(); ++c)
      if (!parts[c].empty())
        centres[c] = meanOf(all, parts[c]);
    auto next = assigned(all, centres);
    if (next == parts)
      break;
    parts = std::move(next);
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  std::vector<HistogramGroup> found;
  for (const auto& part : parts) {
    if (part.empty())
      break;
    found.push_back({PairHistogram(histograms[usable[part.front()]].resolution), {}});
    for (const auto i : part) {
      found.back().sum.merge(histograms[usable[i]]);
      found.back().parts.push_back(usable[i]);
    }
  }
  return found;
}

double
misfit(const PairHistogram& sample, const std::vector<double>& h, double floor)
{
  if (sample.features == 0)
    return std::numeric_limits<double>::infinity();
  const Histogram penalized = penalize(h, std::min(floor, 0.5 / static_cast<double>(h.size())));
  const auto q = sample.normalized();
  double sum = 0;
  for (std::size_t b = 0; b < q.size(); ++b)
    if (q[b] > 0)
      sum += q[b] * std::log(q[b] / penalized[b]);
  return sum;
}

std::vector<double>
leftOutMisfits(const std::vector<PairHistogram>& samples,
               const std::vector<PairHistogram>& histograms,
               const std::vector<HistogramGroup>& groups, double floor)
{
  std::vector<double> found;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double best = std::numeric_limits<double>::infinity();
    for (const auto& group : groups) {
      PairHistogram rest = group.sum;
      if (std::binary_search(group.parts.begin(), group.parts.end(), i)) {
        for (std::size_t b = 0; b < rest.counts.size(); ++b)
          rest.counts[b] -= histograms[i].counts[b];
        rest.features -= histograms[i].features;
      }
      if (rest.features > 0)
        best = std::min(best, misfit(samples[i], rest.normalized(), floor));
    }
    if (std::isfinite(best))
      found.push_back(best);
  }
  return found;
}

} // namespace pcl_surflet
