#include "pcl_surflet/recognition/histogram_classifier.h"

#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace {

constexpr std::uint64_t kFewestFeatures = 2000;

/** \brief Mean of ln H over the features, in a fixed order of additions. */
double
meanOver(const Histogram& log_h, const std::vector<std::uint32_t>& bins)
{
  double sum[4] = {0, 0, 0, 0}; // four chains of additions run at once
  std::size_t i = 0;
  for (; i + 4 <= bins.size(); i += 4)
    for (std::size_t k = 0; k < 4; ++k)
      sum[k] += log_h[bins[i + k]];
  for (; i < bins.size(); ++i)
    sum[0] += log_h[bins[i]];
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) / static_cast<double>(bins.size());
}

Histogram
histogramOf(const std::vector<std::uint32_t>& bins, std::size_t size)
{
  Histogram q(size, 0.0);
  for (const auto b : bins)
    q[b] += 1;
  for (double& v : q)
    v /= static_cast<double>(bins.size());
  return q;
}

/** \brief Softmax of the log-likelihoods of all features.
 *
 * n pairs drawn from m surflets are not independent: no more than m / 2 pairs share no surflet, so
 * no more than that many features count as evidence. */
std::vector<double>
posteriors(const std::vector<double>& mean_log, std::uint64_t features, std::size_t surflets)
{
  const double evidence =
      std::min(static_cast<double>(features), 0.5 * static_cast<double>(surflets));
  const double top = *std::max_element(mean_log.begin(), mean_log.end());
  std::vector<double> p;
  double sum = 0;
  for (const double l : mean_log) {
    p.push_back(std::exp((l - top) * evidence));
    sum += p.back();
  }
  for (double& v : p)
    v /= sum;
  return p;
}

} // namespace

/** \brief A model's best member. */
struct HistogramClassifier::Candidate {
  ModelMatch match;
  double mean_log = 0; ///< mean log-likelihood per feature, as a density
};

HistogramClassifier::HistogramClassifier(const ModelDatabase& database)
    : members_(database.penalized()), resolution_(database.resolution()),
      h_min_(database.empty() ? 0 : database.penaltyMinimum()),
      largest_delta_(database.largestDelta())
{
  if (database.empty())
    throw DatabaseError("the database has no models to classify with");
  for (std::size_t i = 0; i < database.size(); ++i)
    models_.push_back({database[i].label, database[i].delta_max});
}

std::uint64_t
HistogramClassifier::getNumberOfFeatures() const
{
  if (features_ > 0)
    return features_;
  return std::max<std::uint64_t>(kFewestFeatures,
                                 2 * static_cast<std::uint64_t>(resolution_.bins()));
}

bool
HistogramClassifier::better(double a, double b) const
{
  return smallerIsBetter(criterion_) ? a < b : a > b;
}

bool
HistogramClassifier::accepted(const ModelMatch& match) const
{
  if (!threshold_)
    return true;
  if (criterion_ == Criterion::Likelihood)
    return std::abs(match.surprise) <=
           *threshold_; // features that are too typical are foreign as well
  return !better(*threshold_, match.score);
}

double
HistogramClassifier::score(const PenalizedHistogram& p, const Histogram& q, double mean_log) const
{
  switch (criterion_) {
  case Criterion::SquaredEuclidean:
    return squaredEuclidean(p.h, q);
  case Criterion::Intersection:
    return intersection(p.h, q);
  case Criterion::ChiSquared1:
    return chiSquared1(p.h, q);
  case Criterion::ChiSquared2:
    return chiSquared2(p.h, q);
  case Criterion::KullbackLeibler:
    return kullbackLeibler(p.h, q, h_min_);
  case Criterion::NormalizedLikelihood: // Eq. 3.18, per feature
    return mean_log / p.log_sum;
  case Criterion::Likelihood:
    break;
  }
  return mean_log;
}

std::vector<HistogramClassifier::Candidate>
HistogramClassifier::candidates(const FeatureSample& sample, double query_delta_max) const
{
  const bool likelihood =
      criterion_ == Criterion::Likelihood || criterion_ == Criterion::NormalizedLikelihood;
  std::vector<Candidate> found(models_.size());
  std::vector<std::uint32_t> bins;
  Histogram q;
  double mapped_with = 0;
  for (const auto& p : members_) {
    const auto& info = models_[p.model];
    const double delta_max = scale_normalized_ ? query_delta_max : info.delta_max;
    if (delta_max != mapped_with) { // Eq. 3.4: the model's own delta_max
      sample.bins(delta_max, bins);
      if (!likelihood)
        q = histogramOf(bins, p.h.size());
      mapped_with = delta_max;
    }
    const double raw = meanOver(p.log_h, bins);
    const double density = scale_normalized_ ? 0 : std::log(info.delta_max / largest_delta_);
    Candidate c;
    c.mean_log = raw - density;
    c.match = {p.model, p.member, info.label, score(p, q, raw), p.expected_log - raw, 0};
    if (criterion_ == Criterion::Likelihood)
      c.match.score = c.mean_log;
    if (p.member == 0 || better(c.match.score, found[p.model].match.score))
      found[p.model] = std::move(c);
  }
  return found;
}

Classification
HistogramClassifier::classify(const SurfletSet& query) const
{
  Classification answer;
  const PairSource source(query);
  const auto sample = drawFeatures(source, resolution_, getNumberOfFeatures(), seed_, 1);
  answer.features = sample.size();
  answer.rejected = sample.rejected;
  if (sample.size() == 0)
    return answer;
  auto found = candidates(sample, scale_normalized_ ? farthestDistance(query) : 0);
  std::vector<double> mean_log;
  for (const auto& c : found)
    mean_log.push_back(c.mean_log);
  const auto p = posteriors(mean_log, sample.size(), query.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    found[i].match.posterior = p[i];
    answer.ranking.push_back(std::move(found[i].match));
  }
  std::stable_sort(answer.ranking.begin(), answer.ranking.end(),
                   [this](const auto& a, const auto& b) { return better(a.score, b.score); });
  answer.unknown = !accepted(answer.ranking.front());
  if (answer.ranking.size() > 1)
    answer.margin = std::abs(answer.ranking[0].score - answer.ranking[1].score);
  return answer;
}

std::vector<Classification>
HistogramClassifier::classifyBatch(const std::vector<SurfletSet>& queries) const
{
  std::vector<Classification> answers(queries.size());
  parallelFor(queries.size(), threads_,
              [&](std::size_t i, unsigned) { answers[i] = classify(queries[i]); });
  return answers;
}

} // namespace pcl_surflet
