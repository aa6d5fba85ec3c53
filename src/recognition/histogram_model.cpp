#include "pcl_surflet/recognition/histogram_model.h"

#include <cmath>

namespace pcl_surflet {
namespace {

/** \brief Sums of single-precision shares are 1 only up to rounding. */
constexpr double kSumTolerance = 1e-3;

/** \brief What programs answer where no model fits. */

std::string
textProblem(const std::string& text, const char* what, bool may_be_empty)
{
  if (text.empty() && !may_be_empty)
    return std::string("the ") + what + " is empty";
  if (text.size() > HistogramModel::kMaxLabelBytes)
    return std::string("the ") + what + " is longer than 63 bytes";
  for (const char c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      return std::string("the ") + what + " has a control character";
  return {};
}

std::string
lengthProblem(const HistogramModel& m)
{
  const std::pair<const char*, double> values[] = {{"delta_max", m.delta_max},
                                                   {"r_mean", m.r_mean},
                                                   {"r_max", m.r_max},
                                                   {"r_min", m.r_min},
                                                   {"surface_area", m.surface_area},
                                                   {"leaf", m.leaf}};
  for (const auto& [name, v] : values)
    if (!std::isfinite(v) || v < 0)
      return std::string(name) + " is negative or not finite";
  if (!(m.delta_max > 0))
    return "delta_max is not positive";
  // The radii come from single-precision points: allow for their rounding.
  const double slack = 1e-5 * m.delta_max;
  if (m.r_min > m.r_mean + slack || m.r_mean > m.r_max + slack || m.r_max > m.delta_max + slack)
    return "the radii contradict r_min <= r_mean <= r_max <= delta_max";
  return {};
}

std::string
memberProblem(const ModelMember& member, const Resolution& resolution)
{
  if (auto problem = textProblem(member.condition, "condition", true); !problem.empty())
    return problem;
  if (member.histogram.size() != static_cast<std::size_t>(resolution.bins()))
    return "the histogram has " + std::to_string(member.histogram.size()) + " bins, resolution " +
           resolution.toString() + " needs " + std::to_string(resolution.bins());
  for (const double v : {member.misfit, member.misfit_limit})
    if (!std::isfinite(v) || v < 0)
      return "its misfit is negative or not finite";
  if (!std::isfinite(member.area) || member.area < 0)
    return "its area is negative or not finite";
  double sum = 0;
  for (const float v : member.histogram) {
    if (!std::isfinite(v) || v < 0)
      return "a bin of its histogram is negative or not finite";
    sum += v;
  }
  if (std::abs(sum - 1) > kSumTolerance)
    return "the bins of its histogram sum to " + std::to_string(sum) + " instead of 1";
  return {};
}

} // namespace

std::string
HistogramModel::problem() const
{
  const auto in_model = [this](const std::string& text) {
    return "model '" + label + "': " + text;
  };
  if (auto text = textProblem(label, "label", false); !text.empty())
    return in_model(text);
  if (label == kReservedLabel)
    return in_model("the label is reserved for what no model fits; give it another");
  if (auto text = resolution.problem(); !text.empty())
    return in_model(text);
  if (auto text = lengthProblem(*this); !text.empty())
    return in_model(text);
  for (const double w : centre)
    if (!std::isfinite(w))
      return in_model("a weight of its centre is not finite");
  if (members.empty())
    return in_model("it has no histogram");
  for (const auto& member : members)
    if (auto text = memberProblem(member, resolution); !text.empty())
      return in_model(text);
  return {};
}

double
HistogramModel::areaOf(std::size_t member) const
{
  const double own = members.at(member).area;
  return own > 0 || member > 0 ? own : surface_area;
}

} // namespace pcl_surflet
