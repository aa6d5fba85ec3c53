#include "experiment/peers/nearest_signature.h"

#include <flann/flann.hpp>

#include <stdexcept>
#include <utility>

namespace pcl_surflet {
namespace apps {

struct NearestSignature::Search {
  virtual ~Search() = default;
  /** \brief Row and distance of the nearest neighbour. */
  virtual std::pair<std::size_t, float> nearest(const std::vector<float>& query) const = 0;
};

namespace {

template <class Distance>
class FlannSearch : public NearestSignature::Search {
public:
  FlannSearch(std::vector<float> values, std::size_t rows)
      : values_(std::move(values)), columns_(values_.size() / rows),
        index_(flann::Matrix<float>(values_.data(), rows, columns_), flann::LinearIndexParams())
  {
    index_.buildIndex();
  }

  std::pair<std::size_t, float>
  nearest(const std::vector<float>& query) const override
  {
    std::size_t row = 0;
    float distance = 0;
    flann::Matrix<std::size_t> rows(&row, 1, 1);
    flann::Matrix<float> distances(&distance, 1, 1);
    const flann::Matrix<float> point(const_cast<float*>(query.data()), 1, columns_);
    index_.knnSearch(point, rows, distances, 1, flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    return {row, distance};
  }

private:
  std::vector<float> values_;
  std::size_t columns_;
  flann::Index<Distance> index_;
};

std::unique_ptr<NearestSignature::Search>
searchBy(Metric metric, std::vector<float> values, std::size_t rows)
{
  switch (metric) {
  case Metric::L1:
    return std::make_unique<FlannSearch<flann::L1<float>>>(std::move(values), rows);
  case Metric::L2:
    return std::make_unique<FlannSearch<flann::L2<float>>>(std::move(values), rows);
  case Metric::ChiSquared:
    break;
  }
  return std::make_unique<FlannSearch<flann::ChiSquareDistance<float>>>(std::move(values), rows);
}

} // namespace

const std::vector<Metric>&
allMetrics()
{
  static const std::vector<Metric> all = {Metric::L1, Metric::L2, Metric::ChiSquared};
  return all;
}

const char*
metricName(Metric metric)
{
  static const char* const names[] = {"L1", "L2", "chi-squared"};
  return names[static_cast<int>(metric)];
}

NearestSignature::NearestSignature(const std::vector<Signatures>& signatures,
                                   const std::vector<std::size_t>& objects, Metric metric)
{
  std::vector<float> values;
  for (std::size_t i = 0; i < signatures.size(); ++i)
    for (const auto& s : signatures[i]) {
      values.insert(values.end(), s.begin(), s.end());
      owners_.push_back(objects[i]);
    }
  if (owners_.empty())
    throw std::invalid_argument("no signature to compare with");
  search_ = searchBy(metric, std::move(values), owners_.size());
}

NearestSignature::NearestSignature(NearestSignature&&) noexcept = default;
NearestSignature::~NearestSignature() = default;

std::size_t
NearestSignature::object(const Signatures& query) const
{
  std::pair<std::size_t, float> best;
  bool first = true;
  for (const auto& s : query) {
    const auto found = search_->nearest(s);
    if (first || found.second < best.second)
      best = found;
    first = false;
  }
  return owners_[best.first];
}

} // namespace apps
} // namespace pcl_surflet
