#include "pcl_surflet/recognition/model_database.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace {

PenalizedHistogram
penalizedMember(const ModelMember& member, double h_min)
{
  PenalizedHistogram p;
  const Histogram raw(member.histogram.begin(), member.histogram.end());
  p.h = penalize(raw, h_min);
  p.empty_bin.resize(raw.size());
  p.log_h.resize(raw.size());
  for (std::size_t b = 0; b < raw.size(); ++b) {
    p.empty_bin[b] = raw[b] == 0;
    p.log_h[b] = std::log(p.h[b]);
    p.log_sum += p.log_h[b];
    p.expected_log += p.h[b] * p.log_h[b];
  }
  return p;
}

} // namespace

DatabaseError::~DatabaseError() = default;

void
ModelDatabase::check(const HistogramModel& model, bool only) const
{
  if (const auto problem = model.problem(); !problem.empty())
    throw DatabaseError(problem);
  if (!only && model.resolution != resolution())
    throw DatabaseError("model '" + model.label + "' has resolution " +
                        model.resolution.toString() + ", the database " + resolution().toString() +
                        ": train it with the database's resolution or keep two databases");
}

void
ModelDatabase::add(HistogramModel model)
{
  check(model, models_.empty());
  if (find(model.label) != nullptr)
    throw DatabaseError("the database already has a model '" + model.label + "'");
  models_.push_back(std::move(model));
}

bool
ModelDatabase::replace(HistogramModel model)
{
  const auto same = std::find_if(models_.begin(), models_.end(),
                                 [&](const auto& m) { return m.label == model.label; });
  check(model, models_.empty() || (models_.size() == 1 && same != models_.end()));
  if (same == models_.end()) {
    models_.push_back(std::move(model));
    return false;
  }
  *same = std::move(model);
  return true;
}

bool
ModelDatabase::remove(const std::string& label)
{
  const auto same =
      std::find_if(models_.begin(), models_.end(), [&](const auto& m) { return m.label == label; });
  if (same == models_.end())
    return false;
  models_.erase(same);
  return true;
}

const HistogramModel*
ModelDatabase::find(const std::string& label) const
{
  for (const auto& model : models_)
    if (model.label == label)
      return &model;
  return nullptr;
}

Resolution
ModelDatabase::resolution() const
{
  return models_.empty() ? Resolution{} : models_.front().resolution;
}

double
ModelDatabase::largestDelta() const
{
  double largest = 0;
  for (const auto& model : models_)
    largest = std::max(largest, model.delta_max);
  return largest;
}

void
ModelDatabase::setPenalty(const PenaltyParameters& penalty)
{
  if (!(penalty.tau > 0 && penalty.tau <= 1))
    throw DatabaseError("the penalty's tau must be in (0, 1]");
  if (!(penalty.floor >= 0 && penalty.floor < 1))
    throw DatabaseError("the penalty's floor must be in [0, 1)");
  penalty_ = penalty;
}

double
ModelDatabase::penaltyMinimum() const
{
  double h_min = penalty_.floor;
  if (!(h_min > 0)) {
    double smallest = 1;
    for (const auto& model : models_)
      for (const auto& member : model.members)
        for (const float v : member.histogram)
          if (v > 0)
            smallest = std::min(smallest, static_cast<double>(v));
    h_min = penalty_.tau * smallest; // Eq. 3.20
  }
  return std::min(h_min, 0.5 / resolution().bins());
}

std::vector<PenalizedHistogram>
ModelDatabase::penalized() const
{
  const double h_min = penaltyMinimum();
  std::vector<PenalizedHistogram> all;
  for (std::size_t m = 0; m < models_.size(); ++m)
    for (std::size_t k = 0; k < models_[m].members.size(); ++k) {
      all.push_back(penalizedMember(models_[m].members[k], h_min));
      all.back().model = m;
      all.back().member = k;
    }
  return all;
}

} // namespace pcl_surflet
