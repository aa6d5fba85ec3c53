#include "experiment/chapter3/curves.h"

#include <map>
#include <utility>

namespace pcl_surflet {
namespace apps {

CurvePoint
pointOf(double x, std::uint64_t right, std::uint64_t tests)
{
  const auto [low, high] = confidenceInterval(right, tests);
  return {x, tests > 0 ? static_cast<double>(right) / static_cast<double>(tests) : 0, low, high};
}

std::vector<Curve>
curvesOf(const Rates& rates)
{
  std::vector<Curve> curves;
  for (std::size_t r = 0; r < rates.recognisers.size(); ++r) {
    curves.push_back({rates.recognisers[r]->name(), {}});
    for (std::size_t s = 0; s < rates.settings.size(); ++s) {
      const Tally& t = rates.tallies[s][r];
      curves.back().points.push_back(pointOf(rates.settings[s].x, t.right, t.tests));
    }
  }
  return curves;
}

Curve
seriesCurve(const Rates& rates, const std::string& series, const std::string& title,
            std::size_t object)
{
  std::map<double, std::pair<std::uint64_t, std::uint64_t>> counts; // right and all
  for (std::size_t s = 0; s < rates.settings.size(); ++s) {
    if (!series.empty() && rates.settings[s].series != series)
      continue;
    const Tally& t = rates.tallies[s].front();
    auto& [right, tests] = counts[rates.settings[s].x];
    const bool all = object == Answer::kNone;
    right += all ? t.right : t.confusion[object][object];
    tests += all ? t.tests : t.tests_of[object];
  }
  Curve curve{title, {}};
  for (const auto& [x, c] : counts)
    if (c.second > 0)
      curve.points.push_back(pointOf(x, c.first, c.second));
  return curve;
}

} // namespace apps
} // namespace pcl_surflet
