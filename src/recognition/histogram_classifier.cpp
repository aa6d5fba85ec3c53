#include "pcl_surflet/recognition/histogram_classifier.h"

#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl_surflet {
namespace {

constexpr std::uint64_t kFewestFeatures = 2000;

/** \brief n ln n. Most counts are small, and their logarithms known. */
double
timesOwnLogarithm(std::uint32_t n)
{
  static const auto table = [] {
    std::array<double, 256> t{};
    for (std::size_t i = 2; i < t.size(); ++i)
      t[i] = static_cast<double>(i) * std::log(static_cast<double>(i));
    return t;
  }();
  return n < table.size() ? table[n] : n * std::log(static_cast<double>(n));
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

/** \brief Classification::strangeness. */
double
strangeness(double relative_misfit, double misfit, double runner_up)
{
  return misfit < runner_up ? relative_misfit * std::sqrt(misfit / runner_up) : relative_misfit;
}

} // namespace

/** \brief A model's best member. */
struct HistogramClassifier::Candidate {
  ModelMatch match;
  double mean_log = 0; ///< mean log-likelihood per feature, as a density
};

/** \brief The drawn features, counted for one delta_max after the other. */
class HistogramClassifier::Query {
public:
  explicit Query(const FeatureSample& sample) : sample_(sample) {}

  /** \brief Maps delta with a model's \p delta_max [Wahl 2007, Eq. 3.4].
   * \param whole also makes the histogram q of all bins */
  void
  map(double delta_max, bool whole)
  {
    if (delta_max == mapped_with_)
      return;
    mapped_with_ = delta_max;
    sample_.bins(delta_max, bins_);
    count();
    if (whole)
      makeHistogram();
  }

  /** \brief Number of features. */
  double
  size() const
  {
    return static_cast<double>(sample_.size());
  }

  /** \brief Sum of Q ln Q over the bins, in nats. */
  double
  negentropy() const
  {
    double sum = 0;
    for (const auto& [bin, count] : filled)
      sum += timesOwnLogarithm(count);
    return sum / size() - std::log(size());
  }

  std::vector<std::pair<std::uint32_t, std::uint32_t>> filled; ///< bins with their counts
  Histogram q; ///< normalised, if map() was asked for it

private:
  /** \brief Fills counts_ and filled. Two rows of counters: features of one bin often follow each
   * other, and the second would wait for the first. The list is written without a branch that
   * nobody can predict. */
  void
  count()
  {
    counts_.assign(static_cast<std::size_t>(sample_.resolution.bins()), 0);
    other_counts_.assign(counts_.size(), 0);
    for (std::size_t i = 0; i + 1 < bins_.size(); i += 2) {
      ++counts_[bins_[i]];
      ++other_counts_[bins_[i + 1]];
    }
    if (bins_.size() % 2 == 1)
      ++counts_[bins_.back()];
    filled.resize(counts_.size());
    std::size_t n = 0;
    for (std::uint32_t b = 0; b < counts_.size(); ++b) {
      counts_[b] += other_counts_[b];
      filled[n] = {b, counts_[b]};
      n += counts_[b] > 0;
    }
    filled.resize(n);
  }

  void
  makeHistogram()
  {
    q.resize(counts_.size());
    std::transform(counts_.begin(), counts_.end(), q.begin(),
                   [this](auto count) { return count / size(); });
  }

  const FeatureSample& sample_;
  std::vector<std::uint32_t> bins_, counts_, other_counts_;
  double mapped_with_ = 0;
};

HistogramClassifier::HistogramClassifier(const ModelDatabase& database)
    : members_(database.penalized()), resolution_(database.resolution()),
      h_min_(database.empty() ? 0 : database.penaltyMinimum()),
      largest_delta_(database.largestDelta())
{
  if (database.empty())
    throw DatabaseError("the database has no models to classify with");
  for (std::size_t i = 0; i < database.size(); ++i) {
    const auto& model = database[i];
    models_.push_back({model.label, model.delta_max, infos_.size(), model.members.size()});
    LogTable table{model.members.size(), {}};
    for (std::size_t b = 0; b < static_cast<std::size_t>(resolution_.bins()); ++b)
      for (std::size_t k = 0; k < table.members; ++k)
        table.rows.push_back(static_cast<float>(members_[infos_.size() + k].log_h[b]));
    logs_.push_back(std::move(table));
    for (const auto& member : model.members)
      infos_.push_back({member.condition, member.misfit, member.misfit_limit});
  }
}

std::uint64_t
HistogramClassifier::defaultFeatures(const Resolution& resolution)
{
  return std::max<std::uint64_t>(kFewestFeatures,
                                 2 * static_cast<std::uint64_t>(resolution.bins()));
}

double
HistogramClassifier::nearestRival(std::size_t member) const
{
  const PenalizedHistogram& own = members_[member];
  double nearest = std::numeric_limits<double>::infinity();
  std::vector<float> mean_log;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    if (m == own.model)
      continue;
    const LogTable& table = logs_[m];
    mean_log.assign(table.members, 0);
    for (std::size_t b = 0; b < own.h.size(); ++b) {
      const float* row = table.rows.data() + b * table.members;
      const auto share = static_cast<float>(own.h[b]);
      for (std::size_t k = 0; k < table.members; ++k)
        mean_log[k] += share * row[k];
    }
    const float best = *std::max_element(mean_log.begin(), mean_log.end());
    nearest = std::min(nearest, std::max(0.0, own.expected_log - static_cast<double>(best)));
  }
  return nearest;
}

std::optional<double>
HistogramClassifier::calibratedMisfitLimit() const
{
  constexpr std::size_t kMostMembers = 256;
  const std::size_t step = (infos_.size() + kMostMembers - 1) / kMostMembers;
  double sum = 0;
  std::size_t measured = 0;
  for (std::size_t i = 0; i < infos_.size(); i += step) {
    const auto& info = infos_[i];
    if (info.misfit_limit <= 0)
      continue;
    // What a rival misses is what the member misses and what lies between the two.
    const double misfit = info.misfit * info.misfit_limit;
    const double rival = models_.size() > 1 ? misfit + nearestRival(i) : misfit;
    sum += strangeness(info.misfit_limit, misfit, rival);
    ++measured;
  }
  if (measured == 0)
    return std::nullopt;
  return sum / static_cast<double>(measured);
}

std::uint64_t
HistogramClassifier::getNumberOfFeatures() const
{
  return features_ > 0 ? features_ : defaultFeatures(resolution_);
}

bool
HistogramClassifier::better(double a, double b) const
{
  return smallerIsBetter(criterion_) ? a < b : a > b;
}

bool
HistogramClassifier::accepted(const Classification& answer) const
{
  const ModelMatch& match = answer.ranking.front();
  if (misfit_limit_ && answer.strangeness > *misfit_limit_)
    return false;
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

void
HistogramClassifier::meanLogs(const Query& query, std::size_t model, std::vector<float>& mean) const
{
  const LogTable& table = logs_[model];
  mean.assign(table.members, 0);
  for (const auto& [bin, count] : query.filled) {
    const float* row = table.rows.data() + bin * table.members;
    const auto weight = static_cast<float>(count);
    for (std::size_t k = 0; k < table.members; ++k)
      mean[k] += weight * row[k];
  }
  for (float& m : mean)
    m /= static_cast<float>(query.size());
}

HistogramClassifier::Candidate
HistogramClassifier::bestMember(const Query& query, std::size_t model,
                                std::vector<float>& means) const
{
  const ModelInfo& info = models_[model];
  const double density = scale_normalized_ ? 0 : std::log(info.delta_max / largest_delta_);
  meanLogs(query, model, means);
  Candidate best;
  for (std::size_t k = 0; k < info.members; ++k) {
    const double raw = static_cast<double>(means[k]);
    const double value = criterion_ == Criterion::Likelihood
                             ? raw - density
                             : score(members_[info.first_member + k], query.q, raw);
    if (k > 0 && !better(value, best.match.score))
      continue;
    best.match.member = k;
    best.match.score = value;
    best.mean_log = raw - density;
  }
  const std::size_t at = info.first_member + best.match.member;
  const double raw = best.mean_log + density;
  best.match.model = model;
  best.match.label = info.label;
  best.match.condition = infos_[at].condition;
  best.match.surprise = members_[at].expected_log - raw;
  best.match.misfit = std::max(0.0, query.negentropy() - raw);
  if (infos_[at].misfit > 0)
    best.match.relative_misfit = best.match.misfit / infos_[at].misfit;
  return best;
}

Classification
HistogramClassifier::classify(const SurfletSet& query) const
{
  const bool likelihood =
      criterion_ == Criterion::Likelihood || criterion_ == Criterion::NormalizedLikelihood;
  Classification answer;
  const PairSource source(query);
  const auto sample = drawFeatures(source, resolution_, getNumberOfFeatures(), seed_, 1);
  answer.features = sample.size();
  answer.rejected = sample.rejected;
  if (sample.size() == 0)
    return answer;
  const double query_delta = scale_normalized_ ? farthestDistance(query) : 0;
  Query features(sample);
  std::vector<double> mean_log;
  std::vector<float> means;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    features.map(scale_normalized_ ? query_delta : models_[m].delta_max, !likelihood);
    auto candidate = bestMember(features, m, means);
    mean_log.push_back(candidate.mean_log);
    answer.ranking.push_back(std::move(candidate.match));
  }
  const auto p = posteriors(mean_log, sample.size(), query.size());
  for (std::size_t m = 0; m < p.size(); ++m)
    answer.ranking[m].posterior = p[m];
  std::stable_sort(answer.ranking.begin(), answer.ranking.end(),
                   [this](const auto& a, const auto& b) { return better(a.score, b.score); });
  const auto& best = answer.ranking.front();
  const auto& next = answer.ranking[answer.ranking.size() > 1 ? 1 : 0];
  answer.strangeness = strangeness(best.relative_misfit, best.misfit, next.misfit);
  answer.unknown = !accepted(answer);
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
