#include "state.h"

#include "core/require.h"

#include <cmath>

namespace pcl_surflet {
namespace {

void
check(const OnlineParameters& p)
{
  require(p.leaf > 0 && std::isfinite(p.leaf), "the leaf size must be positive and finite");
  require(p.moved > 0 && std::isfinite(p.moved), "moved must be positive and finite");
  require(p.turned > 0 && p.turned <= 3.15, "turned must be in (0, pi]");
  require(p.coverage >= 0 && p.coverage <= 1, "the coverage of attractors must be in [0, 1]");
  require(p.margin >= -1 && p.margin <= 1, "the margin of attractors must be in [-1, 1]");
  require(p.stale >= 0 && std::isfinite(p.stale), "stale must be finite and not negative");
  require(p.behind >= 0 && std::isfinite(p.behind), "behind must be finite and not negative");
  require(p.rays > 0, "rays must be positive");
  require(p.distance >= 0 && std::isfinite(p.distance),
          "the distance from the empty scene must be positive and finite, or 0");
}

} // namespace

OnlineInterpretation::OnlineInterpretation(ModelDatabase database, OnlineParameters parameters)
{
  check(parameters);
  // Wrong parameters of the interpretation are told now, not at the first scan.
  auto silent = parameters.explanation;
  silent.steps.progress = nullptr;
  interpretByExplanation({}, database, silent);
  state_ = std::make_unique<State>(std::move(database), std::move(parameters));
}

OnlineInterpretation::~OnlineInterpretation() = default;
OnlineInterpretation::OnlineInterpretation(OnlineInterpretation&&) noexcept = default;
OnlineInterpretation& OnlineInterpretation::operator=(OnlineInterpretation&&) noexcept = default;

OnlineScan
OnlineInterpretation::addScan(const SurfletSet& surflets)
{
  return state_->addScan(surflets, nullptr);
}

OnlineScan
OnlineInterpretation::addScan(const SurfletSet& surflets, const std::array<double, 3>& sensor)
{
  for (const double v : sensor)
    require(std::isfinite(v), "the sensor's origin must be finite");
  return state_->addScan(surflets, &sensor);
}

const SurfletSet&
OnlineInterpretation::cells() const
{
  return state_->cells.means();
}

const std::vector<OnlineDetection>&
OnlineInterpretation::detections() const
{
  return state_->detections;
}

const std::vector<Attractor>&
OnlineInterpretation::attractors() const
{
  return state_->attractors;
}

const std::vector<Distractor>&
OnlineInterpretation::distractors() const
{
  return state_->distractors;
}

} // namespace pcl_surflet
