#include "pcl_surflet/model_search.h"

#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/pair_counting.h"
#include "pcl_surflet/recognition/histogram_classifier.h"

#include <flann/flann.hpp>

#include <algorithm>
#include <cmath>
#include <deque>

namespace pcl_surflet {
namespace {

using Index = flann::Index<flann::L2<float>>;

/** \brief Trees of the index. More find more with as many checks, and take longer to build. */
constexpr int kTrees = 4;

/** \brief FLANN rebuilds its trees when the members have become so many times more. */
constexpr float kRebuild = 2;

/** \brief FLANN draws from the C library's generator. */
constexpr unsigned kTreeSeed = 1;

/** \brief Bins that are not empty, and their shares. */
using Shares = std::vector<std::pair<std::uint32_t, float>>;

template <class Histogram>
Shares
filled(const Histogram& h)
{
  Shares shares;
  for (std::size_t b = 0; b < h.size(); ++b)
    if (h[b] > 0)
      shares.emplace_back(static_cast<std::uint32_t>(b), static_cast<float>(h[b]));
  return shares;
}

double
meanLog(const std::vector<float>& log_h, const Shares& query)
{
  double sum = 0;
  for (const auto& [bin, share] : query)
    sum += static_cast<double>(share * log_h[bin]);
  return sum;
}

} // namespace

struct ModelSearch::Data {
  struct Member {
    std::size_t model;
    std::vector<float> log_h, roots;
  };

  Resolution resolution;
  double h_min = 0;
  std::vector<std::string> labels;
  std::deque<Member> members; ///< FLANN keeps pointers to the roots
  std::unique_ptr<Index> index;
  std::size_t shortlist = 100;
  int checks = 1000;
  std::uint64_t features = 0, seed = 1;

  std::size_t
  bins() const
  {
    return static_cast<std::size_t>(resolution.bins());
  }

  void add(const HistogramModel& model);
  void addToIndex(Member& member);
  Shares sharesOf(const SurfletSet& query) const;
  Shares sharesOf(const std::vector<float>& histogram) const;
  std::vector<std::size_t> nearest(const Shares& query) const;
  std::vector<SearchHit> ranked(const Shares& query, const std::vector<std::size_t>& candidates,
                                std::size_t k) const;
  std::vector<SearchHit> rankedShortlist(const Shares& query, std::size_t k) const;
  std::vector<SearchHit> rankedAll(const Shares& query, std::size_t k) const;
};

void
ModelSearch::Data::addToIndex(Member& member)
{
  const flann::Matrix<float> row(member.roots.data(), 1, bins());
  flann::seed_random(kTreeSeed);
  if (index) {
    index->addPoints(row, kRebuild);
    return;
  }
  index = std::make_unique<Index>(row, flann::KDTreeIndexParams(kTrees));
  index->buildIndex();
}

void
ModelSearch::Data::add(const HistogramModel& model)
{
  if (const auto problem = model.problem(); !problem.empty())
    throw DatabaseError(problem);
  if (model.resolution != resolution)
    throw DatabaseError("model '" + model.label + "' has resolution " +
                        model.resolution.toString() + ", the search " + resolution.toString() +
                        ": train it with that resolution");
  for (const auto& from : model.members) {
    Member member{labels.size(), {}, {}};
    for (const double v : penalize({from.histogram.begin(), from.histogram.end()}, h_min))
      member.log_h.push_back(static_cast<float>(std::log(v)));
    for (const float v : from.histogram)
      member.roots.push_back(std::sqrt(v));
    members.push_back(std::move(member));
    addToIndex(members.back());
  }
  labels.push_back(model.label);
}

Shares
ModelSearch::Data::sharesOf(const SurfletSet& query) const
{
  const double delta_max = farthestDistance(query);
  if (!(delta_max > 0))
    return {};
  const auto n = features > 0 ? features : HistogramClassifier::defaultFeatures(resolution);
  return filled(countDrawnPairs(PairSource(query), resolution, delta_max, n, seed, 1).normalized());
}

Shares
ModelSearch::Data::sharesOf(const std::vector<float>& histogram) const
{
  if (histogram.size() != bins())
    throw std::invalid_argument("pcl_surflet: the histogram to search for has " +
                                std::to_string(histogram.size()) + " bins instead of " +
                                std::to_string(bins()));
  return filled(histogram);
}

std::vector<std::size_t>
ModelSearch::Data::nearest(const Shares& query) const
{
  std::vector<float> roots(bins(), 0);
  for (const auto& [bin, share] : query)
    roots[bin] = std::sqrt(share);
  std::vector<std::vector<std::size_t>> found;
  std::vector<std::vector<float>> distances;
  flann::SearchParams parameters(checks);
  parameters.cores = 1;
  parameters.sorted = false;
  index->knnSearch(flann::Matrix<float>(roots.data(), 1, bins()), found, distances,
                   std::min(shortlist, members.size()), parameters);
  return found.front();
}

std::vector<SearchHit>
ModelSearch::Data::ranked(const Shares& query, const std::vector<std::size_t>& candidates,
                          std::size_t k) const
{
  std::vector<std::pair<double, std::size_t>> scores; // of models: larger is better
  scores.reserve(candidates.size());
  for (const auto c : candidates)
    scores.emplace_back(meanLog(members[c].log_h, query), members[c].model);
  std::sort(scores.begin(), scores.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  std::vector<SearchHit> hits;
  std::vector<bool> listed(labels.size(), false);
  for (const auto& [score, model] : scores) {
    if (hits.size() == k)
      break;
    if (!listed[model])
      hits.push_back({model, labels[model], score});
    listed[model] = true;
  }
  return hits;
}

std::vector<SearchHit>
ModelSearch::Data::rankedShortlist(const Shares& query, std::size_t k) const
{
  if (query.empty() || members.empty())
    return {};
  return ranked(query, nearest(query), k);
}

std::vector<SearchHit>
ModelSearch::Data::rankedAll(const Shares& query, std::size_t k) const
{
  std::vector<std::size_t> all(query.empty() ? 0 : members.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = i;
  return ranked(query, all, k);
}

ModelSearch::ModelSearch(const Resolution& resolution, double floor)
    : data_(std::make_unique<Data>())
{
  if (const auto problem = resolution.problem(); !problem.empty())
    throw std::invalid_argument("pcl_surflet: " + problem);
  if (!(floor > 0 && floor < 1))
    throw std::invalid_argument("pcl_surflet: the floor of a search must be in (0, 1)");
  data_->resolution = resolution;
  data_->h_min = std::min(floor, 0.5 / resolution.bins());
}

ModelSearch::ModelSearch(const ModelDatabase& database)
    : ModelSearch(database.resolution(), database.penaltyMinimum())
{
  for (std::size_t i = 0; i < database.size(); ++i)
    add(database[i]);
}

ModelSearch::~ModelSearch() = default;
ModelSearch::ModelSearch(ModelSearch&&) noexcept = default;
ModelSearch& ModelSearch::operator=(ModelSearch&&) noexcept = default;

void
ModelSearch::add(const HistogramModel& model)
{
  data_->add(model);
}

std::size_t
ModelSearch::size() const
{
  return data_->labels.size();
}

void
ModelSearch::setShortlist(std::size_t members)
{
  if (members == 0)
    throw std::invalid_argument("pcl_surflet: the shortlist must not be empty");
  data_->shortlist = members;
}

void
ModelSearch::setChecks(int checks)
{
  if (checks <= 0)
    throw std::invalid_argument("pcl_surflet: a search must check at least one leaf");
  data_->checks = checks;
}

void
ModelSearch::setNumberOfFeatures(std::uint64_t features)
{
  data_->features = features;
}

void
ModelSearch::setSeed(std::uint64_t seed)
{
  data_->seed = seed;
}

std::size_t
ModelSearch::getShortlist() const
{
  return data_->shortlist;
}

int
ModelSearch::getChecks() const
{
  return data_->checks;
}

std::uint64_t
ModelSearch::getNumberOfFeatures() const
{
  return data_->features;
}

std::uint64_t
ModelSearch::getSeed() const
{
  return data_->seed;
}

std::vector<SearchHit>
ModelSearch::search(const SurfletSet& query, std::size_t k) const
{
  return data_->rankedShortlist(data_->sharesOf(query), k);
}

std::vector<SearchHit>
ModelSearch::search(const std::vector<float>& histogram, std::size_t k) const
{
  return data_->rankedShortlist(data_->sharesOf(histogram), k);
}

std::vector<SearchHit>
ModelSearch::searchAll(const SurfletSet& query, std::size_t k) const
{
  return data_->rankedAll(data_->sharesOf(query), k);
}

std::vector<SearchHit>
ModelSearch::searchAll(const std::vector<float>& histogram, std::size_t k) const
{
  return data_->rankedAll(data_->sharesOf(histogram), k);
}

} // namespace pcl_surflet
