#include "experiment/chapter3.h"
#include "experiment/chapter3/curves.h"
#include "experiment/chapter3/settings.h"
#include "experiment/output.h"
#include "experiment/surflet_recognisers.h"

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief The six criteria by the dissertation's protocol, the likelihood by ours, and a bank. */
Recognisers
sixCriteria(const Training& training)
{
  const ModelDatabase database = trainObjects(training);
  Recognisers all = dissertationCriteria(database);
  all.push_back(likelihoodRecogniser("likelihood, defaults", database));
  all.push_back(bankRecogniser(training));
  return all;
}

/** \brief An experiment whose picture is one plot of all recognisers. */
RatesExperiment
curveExperiment(const std::string& name, const std::string& title, const std::string& x_label,
                std::vector<Setting> settings, const std::vector<Statement>& statements)
{
  const auto draw = [=](const Rates& rates, const std::string& directory) {
    return drawPanels(directory, name, {{title, x_label, curvesOf(rates), statements}}, 1);
  };
  return {name, title, std::move(settings), sixCriteria, draw};
}

} // namespace

int
runNoise(const ChapterOptions& options)
{
  const double radius = options.normal_radius;
  auto settings = settingsAt({0.25, 0.5, 0.75, 1, 1.5, 2, 3, 4, 6, 8, 12, 16, 20}, "noise",
                             [=](double share) { return noisy(share, radius); });
  settings.insert(settings.begin(), fixedSetting("noise 0 %", 0, {}));
  return reportRates(
      curveExperiment("noise", formatted("Fig. 3.5: noise, normals within %g spacings", radius),
                      "noise in % of the diameter", std::move(settings),
                      {{1, 80, "above 80 % (K, L)"}, {10, 12.5, "10-15 % (E, chi1, K, L)"}}),
      options.rates);
}

int
runVisibility(const ChapterOptions& options)
{
  return reportRates(
      curveExperiment("visibility", "Fig. 3.6: visible share of the surface",
                      "visible in % of the surface",
                      settingsAt({10, 15, 20, 25, 30, 40, 50, 65, 80, 90, 100}, "visible", cut),
                      {{65, 80, "above 80 % (K, L)"}}),
      options.rates);
}

int
runResolution(const ChapterOptions& options)
{
  return reportRates(
      curveExperiment(
          "resolution", "Fig. 3.7: resolution of the query", "resolution in % of training",
          settingsAt({15, 25, 35, 50, 75, 100, 150, 200, 300}, "resolution", sampled), {}),
      options.rates);
}

} // namespace apps
} // namespace pcl_surflet
