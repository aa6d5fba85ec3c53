#include "experiment/chapter3.h"

#include "app_common.h"
#include "experiment/gallery.h"
#include "experiment/peers/peer_recognisers.h"
#include "experiment/plots.h"
#include "experiment/surflet_recognisers.h"
#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/database_file.h"
#include "pcl_surflet/recognition/histogram_classifier.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace pcl_surflet {
namespace apps {
namespace {

Condition
noisy(double share, double normal_radius = Condition().normal_radius)
{
  Condition c;
  c.noise = share;
  c.normal_radius = normal_radius;
  return c;
}

Condition
cut(double visible)
{
  Condition c;
  c.visible = visible;
  return c;
}

Condition
sampled(double resolution)
{
  Condition c;
  c.resolution = resolution;
  return c;
}

/** \brief Conditions of doc/classification.md. */
std::vector<Setting>
classificationSettings()
{
  std::vector<Setting> all = {fixedSetting("ideal", 0, {})};
  for (const int percent : {1, 2, 4})
    all.push_back(fixedSetting(formatted("noise %d %%", percent), percent, noisy(percent / 100.0)));
  for (const int percent : {65, 40, 25})
    all.push_back(fixedSetting(formatted("visible %d %%", percent), percent, cut(percent / 100.0)));
  return all;
}

/** \brief Those and half resolution: by these the peers choose their metric. */
std::vector<Setting>
choosingSettings()
{
  auto all = classificationSettings();
  all.push_back(fixedSetting("half resolution", 50, sampled(0.5)));
  return all;
}

/** \brief Those, levels that no model was trained with, and several things at once: the table
 * against the peers. New ones go to the end, so that the others keep their queries. */
std::vector<Setting>
peerSettings()
{
  auto all = choosingSettings();
  all.push_back(fixedSetting("noise 3 %", 3, noisy(0.03)));
  all.push_back(fixedSetting("visible 55 %", 55, cut(0.55)));
  Condition both = noisy(0.04);
  both.visible = 0.5;
  all.push_back(fixedSetting("noise 4 %, 50 %", 4, both));
  Condition view = noisy(0.003);
  view.view = true;
  all.push_back(fixedSetting("single view", 0.3, view));
  return all;
}

/** \brief Settings of one condition at each of \p percents; \p condition is given the share. */
std::vector<Setting>
settingsAt(const std::vector<double>& percents, const std::string& what,
           const std::function<Condition(double share)>& condition)
{
  std::vector<Setting> all;
  for (const double p : percents)
    all.push_back(fixedSetting(what + formatted(" %g %%", p), p, condition(p / 100)));
  return all;
}

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

Recognisers
likelihoodOnly(const Training& training)
{
  Recognisers all;
  all.push_back(likelihoodRecogniser("likelihood", trainObjects(training)));
  return all;
}

CurvePoint
pointOf(double x, std::uint64_t right, std::uint64_t tests)
{
  const auto [low, high] = confidenceInterval(right, tests);
  return {x, tests > 0 ? static_cast<double>(right) / static_cast<double>(tests) : 0, low, high};
}

/** \brief One curve a recogniser. */
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

/** \brief The first recogniser's curve over the settings of \p series ("" for all of them, those at
 * one x pooled) for \p object, or for all objects. */
Curve
seriesCurve(const Rates& rates, const std::string& series, const std::string& title,
            std::size_t object = Answer::kNone)
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

std::string
drawCriteria(const Rates& rates, const std::string& directory)
{
  std::vector<ConfusionPicture> pictures;
  for (std::size_t r = 0; r < tableCriteria().size(); ++r) {
    const Tally& t = rates.tallies.front()[r];
    pictures.push_back({rates.recognisers[r]->name(), {}});
    for (const auto& row : t.confusion) {
      pictures.back().rates.emplace_back();
      for (const auto count : row)
        pictures.back().rates.back().push_back(static_cast<double>(count) /
                                               static_cast<double>(t.tests_of.front()));
    }
  }
  return drawConfusions(directory, "criteria_confusion", pictures, 3);
}

const char* const kAxisNames[] = {"1st axis", "2nd axis", "3rd axis"};

} // namespace

std::vector<Setting>
elongationSettings(std::uint64_t intervals)
{
  std::vector<Setting> all;
  const double step = (2.0 - 0.4) / static_cast<double>(intervals);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::uint64_t i = 0; i < intervals; ++i) {
      const double low = 0.4 + step * static_cast<double>(i), x = low + step / 2;
      const auto condition = [=](std::uint64_t seed) {
        Condition c;
        c.stretch[axis] = CounterRandom(seed, 1).uniform(low, low + step);
        return c;
      };
      all.push_back(
          {kAxisNames[axis], x, formatted("%s times %.3f", kAxisNames[axis], x), condition});
    }
  return all;
}

namespace {

std::string
drawElongation(const Rates& rates, const std::string& directory)
{
  std::vector<Panel> panels;
  for (const char* axis : kAxisNames)
    panels.push_back({std::string("elongation of the ") + axis,
                      "factor",
                      {seriesCurve(rates, axis, "likelihood")},
                      {{0.5, 40, "below 40 %"}, {1.5, 70, "above 70 %"}}});
  return drawPanels(directory, "elongation", panels, 3);
}

/** \brief Least and largest factor of an axis in the multi-axial experiment. */
constexpr double kShortest = 0.2, kLongest = 2.3;

/** \brief Draws \p axes random axes' factors until the measure lies in [low, high); none if that
 * does not succeed. */
std::optional<Condition>
drawDistortion(std::size_t axes, double low, double high, std::uint64_t seed)
{
  constexpr int kDraws = 1000000; // the rarest interval, all axes at their longest, takes 1e5
  CounterRandom random(seed, 1);
  for (int draw = 0; draw < kDraws; ++draw) {
    Condition c;
    const auto odd_one = random.below(3);
    for (std::uint32_t a = 0; a < 3; ++a)
      if (axes == 3 || (axes == 1) == (a == odd_one))
        c.stretch[a] = random.uniform(kShortest, kLongest);
    const double measure = distortionMeasure(c.stretch);
    if (measure >= low && measure < high)
      return c;
  }
  return std::nullopt;
}

} // namespace

std::vector<Setting>
distortionSettings(std::uint64_t intervals)
{
  std::vector<Setting> all;
  const double low = std::sqrt(3.0) * (kShortest - 1), high = std::sqrt(3.0) * (kLongest - 1);
  const double step = (high - low) / static_cast<double>(intervals);
  for (std::size_t axes = 1; axes <= 3; ++axes)
    for (std::uint64_t i = 0; i < intervals; ++i) {
      const double from = low + step * static_cast<double>(i), to = from + step;
      const double reach = std::sqrt(static_cast<double>(axes));
      if (to <= reach * (kShortest - 1) || from >= reach * (kLongest - 1))
        continue; // so few axes cannot be distorted so much
      const std::string series = formatted("%zu ax%cs", axes, axes == 1 ? 'i' : 'e');
      all.push_back({series, from + step / 2, series + formatted(" by %+.3f", from + step / 2),
                     [=](std::uint64_t seed) { return drawDistortion(axes, from, to, seed); }});
    }
  return all;
}

namespace {

std::string
drawDistortions(const Rates& rates, const std::string& directory)
{
  const std::string label = "distortion";
  Panel mean{"Fig. 3.8: all objects", label, {seriesCurve(rates, "", "mean")}, {}};
  for (const std::string series : {"1 axis", "2 axes", "3 axes"})
    mean.curves.push_back(seriesCurve(rates, series, series));
  const auto no_picture = drawPanels(directory, "distortion", {mean}, 1);
  std::vector<Panel> panels;
  for (std::size_t o = 0; o < rates.objects.size(); ++o)
    panels.push_back({rates.objects[o].label, "", {seriesCurve(rates, "", "", o)}, {}});
  drawPanels(directory, "distortion_objects", panels, 5);
  return no_picture;
}

std::string
noPicture(const Rates&, const std::string&)
{
  return {};
}

} // namespace

int
runClassification(const ChapterOptions& options)
{
  ModelDatabase database;
  const auto train = [&](const Training& training) {
    database = trainObjects(training);
    saveDatabase(database, options.rates.out + "/objects.pcd");
    Recognisers all;
    all.push_back(likelihoodRecogniser("likelihood", database));
    return all;
  };
  const auto draw = [&](const Rates& rates, const std::string& directory) {
    return drawGallery(rates.objects, database, directory);
  };
  const int code = reportRates(
      {"classification", "Likelihood criterion, resolution 5,5,5,5: ideal, noise, visibility",
       classificationSettings(), train, draw},
      options.rates);
  std::printf("wrote objects.pcd (the database)\n");
  return code;
}

int
runCriteria(const ChapterOptions& options)
{
  const auto train = [](const Training& training) {
    const ModelDatabase database = trainObjects(training);
    Recognisers all = dissertationCriteria(database);
    for (auto& recogniser : defaultCriteria(database))
      all.push_back(std::move(recogniser));
    return all;
  };
  return reportRates({"criteria",
                      "Table 3.1, Fig. 3.4: six criteria under ideal conditions",
                      {fixedSetting("ideal", 0, {})},
                      train,
                      drawCriteria},
                     options.rates);
}

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

int
runElongation(const ChapterOptions& options)
{
  return reportRates({"elongation", "Fig. 3.9: elongation of one principal axis",
                      elongationSettings(options.intervals), likelihoodOnly, drawElongation},
                     options.rates);
}

int
runDistortion(const ChapterOptions& options)
{
  return reportRates({"distortion", "Fig. 3.8, 3.10-3.14: distortion of several principal axes",
                      distortionSettings(options.intervals), likelihoodOnly, drawDistortions},
                     options.rates);
}

int
runPeers(const ChapterOptions& options)
{
  requirePeers(options.peer_list);
  const auto train = [&](const Training& training) {
    auto all = peers(training, options.peer_list, choosingSettings());
    auto own = ours(training);
    std::move(all.begin(), all.end(), std::back_inserter(own));
    return own;
  };
  return reportRates(
      {"peers", "Ours beside PCL's global descriptors by 1-NN", peerSettings(), train, noPicture},
      options.rates);
}

namespace {

/** \brief Misfits of the winners, sorted; infinite where nobody answers. */
using Misfits = std::vector<double>;

/** \brief Misfits of all \p objects under a setting.
 * \param first number of the first object, for the queries' seeds */
Misfits
misfitsOf(const std::vector<ExperimentObject>& objects, const HistogramClassifier& classifier,
          const TrialPlan& plan, std::size_t setting, std::size_t first)
{
  Misfits all(objects.size() * plan.tests, std::numeric_limits<double>::infinity());
  parallelFor(all.size(), plan.threads, [&](std::size_t i, unsigned) {
    const std::size_t o = i / plan.tests;
    const auto seed = querySeed(plan.seed, setting, first + o, i % plan.tests);
    const auto condition = plan.settings[setting].condition(seed);
    const auto answer =
        classifier.classify(makeQuery(objects[o], condition.value(), seed, false).sampled);
    if (!answer.ranking.empty())
      all[i] = answer.ranking.front().relative_misfit;
  });
  std::sort(all.begin(), all.end());
  return all;
}

std::uint64_t
accepted(const Misfits& sorted, double limit)
{
  return static_cast<std::uint64_t>(std::upper_bound(sorted.begin(), sorted.end(), limit) -
                                    sorted.begin());
}

/** \brief Misfits of one condition, or of all. */
struct RejectionRow {
  std::string condition;
  Misfits known, strange;
};

/** \brief A row a condition, the last for all of them. */
std::vector<RejectionRow>
rejectionRows(const std::vector<ExperimentObject>& known,
              const std::vector<ExperimentObject>& strange, const HistogramClassifier& classifier,
              const TrialPlan& plan)
{
  std::vector<RejectionRow> rows;
  RejectionRow all{"all", {}, {}};
  withProgress<int>(plan.settings.size(), [&](const auto& show) {
    for (std::size_t s = 0; s < plan.settings.size(); ++s) {
      show(s, plan.settings[s].name);
      rows.push_back({plan.settings[s].name, misfitsOf(known, classifier, plan, s, 0),
                      misfitsOf(strange, classifier, plan, s, known.size())});
      all.known.insert(all.known.end(), rows.back().known.begin(), rows.back().known.end());
      all.strange.insert(all.strange.end(), rows.back().strange.begin(), rows.back().strange.end());
    }
    return 0;
  });
  std::sort(all.known.begin(), all.known.end());
  std::sort(all.strange.begin(), all.strange.end());
  rows.push_back(std::move(all));
  return rows;
}

std::string
reportLimit(const std::string& name, double limit, const std::vector<RejectionRow>& rows)
{
  std::printf("\nlimit %.3f: %s\n%-20s %-26s %s\n", limit, name.c_str(), "condition",
              "known accepted % (95 %)", "strangers accepted % (95 %)");
  std::string csv;
  for (const auto& row : rows) {
    csv += name + ',' + number(limit) + ',' + csvField(row.condition);
    std::printf("%-20s", row.condition.c_str());
    for (const auto* misfits : {&row.known, &row.strange}) {
      const auto passed = accepted(*misfits, limit);
      const CurvePoint p = pointOf(0, passed, misfits->size());
      const auto text = formatted("%.1f (%.1f-%.1f)", 100 * p.rate, 100 * p.low, 100 * p.high);
      std::printf(" %-26s", text.c_str());
      csv += ',' + std::to_string(misfits->size()) + ',' + std::to_string(passed);
    }
    std::printf("\n");
    csv += '\n';
  }
  return csv;
}

} // namespace

std::string
strangerNames()
{
  return "bear,cactus,couplingdown,elk,fandisk,hand,head,helmet,homer,joint,knot1,lion-head,"
         "mannequin-devil,nefertiti,pipe,spool,star,bones,retinal,dragknob,handle,pinion_small,"
         "oblong,part,tripod,blobby,eight,mech-holes-shark";
}

int
runRejection(const ChapterOptions& options)
{
  const auto& o = options.rates;
  makeDirectory(o.out);
  const auto known = loadObjects(o.meshes, o.labels);
  const auto strange = loadObjects(o.meshes, options.strangers);
  const TrialPlan plan{peerSettings(), o.tests, o.seed, static_cast<unsigned>(o.threads), 0};
  const HistogramClassifier classifier(
      withProgress<ModelDatabase>(known.size(), [&](const auto& show) {
        return trainBanks({known, o.seed, plan.threads, show});
      }));
  const auto rows = rejectionRows(known, strange, classifier, plan);
  const Misfits& all = rows.back().known;
  const double of_most = all[(all.size() * 95 + 99) / 100 - 1];
  std::printf(
      "Unknown objects: %zu known, %zu strangers, %llu tests per object and condition, seed "
      "%llu\n",
      known.size(), strange.size(), static_cast<unsigned long long>(o.tests),
      static_cast<unsigned long long>(o.seed));
  std::string csv = "limit,value,condition,known,known_accepted,strangers,strangers_accepted\n";
  csv += reportLimit("calibrated", classifier.calibratedMisfitLimit().value(), rows);
  csv += reportLimit("95 % of the known", of_most, rows);
  writeFile(o.out + "/rejection.csv", csv);
  std::printf("\nwrote %s/rejection.csv\n", o.out.c_str());
  return kOk;
}

} // namespace apps
} // namespace pcl_surflet
