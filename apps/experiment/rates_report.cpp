#include "experiment/rates_report.h"

#include "app_common.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief "99.5 (98.7-99.8)" */
std::string
rateText(const Tally& t)
{
  const auto [low, high] = confidenceInterval(t.right, t.tests);
  return formatted("%.1f (%.1f-%.1f)", 100 * t.rate(), 100 * low, 100 * high);
}

/** \brief Time and failures of each recogniser over all settings. */
void
printCosts(const Rates& rates)
{
  std::printf("%-32s %10s %16s\n", "", "ms/query", "without answer");
  for (std::size_t r = 0; r < rates.recognisers.size(); ++r) {
    Tally all(rates.objects.size());
    for (const auto& tallies : rates.tallies)
      all.add(tallies[r]);
    std::printf("%-32s %10.3f %7llu of %llu\n", rates.recognisers[r]->name().c_str(),
                1000 * all.secondsPerQuery(), static_cast<unsigned long long>(all.failed),
                static_cast<unsigned long long>(all.tests));
  }
}

/** \brief The object most often taken for another, and which: "anchor > pig (8)". */
std::string
worstConfusion(const Tally& t, const std::vector<ExperimentObject>& objects)
{
  std::uint64_t most = 0;
  std::string text = "-";
  for (std::size_t o = 0; o < objects.size(); ++o)
    for (std::size_t a = 0; a < objects.size(); ++a)
      if (o != a && t.confusion[o][a] > most) {
        most = t.confusion[o][a];
        text = objects[o].label + " > " + objects[a].label + " (" + std::to_string(most) + ")";
      }
  return text;
}

/** \brief One recogniser: a row a setting. */
void
printSettings(const Rates& rates)
{
  std::printf("%-26s %-20s %8s  %s\n", "condition", "right % (95 %)", "ms/query",
              "most frequent confusion");
  for (std::size_t s = 0; s < rates.settings.size(); ++s) {
    const Tally& t = rates.tallies[s].front();
    std::printf("%-26s %-20s %8.3f  %s\n", rates.settings[s].name.c_str(), rateText(t).c_str(),
                1000 * t.secondsPerQuery(), worstConfusion(t, rates.objects).c_str());
  }
}

constexpr std::size_t kColumns = 8; ///< settings beside each other

/** \brief Several recognisers: a row each, and a table for every few settings. */
void
printRecognisers(const Rates& rates)
{
  for (std::size_t first = 0; first < rates.settings.size(); first += kColumns) {
    const std::size_t end = std::min(first + kColumns, rates.settings.size());
    std::printf("%-32s", "right % (95 %)");
    for (std::size_t s = first; s < end; ++s)
      std::printf(" %16s", rates.settings[s].name.c_str());
    std::printf("\n");
    for (std::size_t r = 0; r < rates.recognisers.size(); ++r) {
      std::printf("%-32s", rates.recognisers[r]->name().c_str());
      for (std::size_t s = first; s < end; ++s)
        std::printf(" %16s", rateText(rates.tallies[s][r]).c_str());
      std::printf("\n");
    }
    std::printf("\n");
  }
  printCosts(rates);
}

std::string
keyOf(const Rates& rates, std::size_t s, std::size_t r)
{
  const Setting& setting = rates.settings[s];
  return csvField(setting.series) + ',' + number(setting.x) + ',' + csvField(setting.name) + ',' +
         csvField(rates.recognisers[r]->name());
}

std::string
ratesCsv(const Rates& rates)
{
  std::string out = "series,x,condition,recogniser,tests,right,rate,low,high,failed,ms_per_query\n";
  for (std::size_t s = 0; s < rates.tallies.size(); ++s)
    for (std::size_t r = 0; r < rates.recognisers.size(); ++r) {
      const Tally& t = rates.tallies[s][r];
      const auto [low, high] = confidenceInterval(t.right, t.tests);
      out += keyOf(rates, s, r) + ',' + std::to_string(t.tests) + ',' + std::to_string(t.right) +
             ',' + number(t.rate()) + ',' + number(low) + ',' + number(high) + ',' +
             std::to_string(t.failed) + ',' + number(1000 * t.secondsPerQuery()) + '\n';
    }
  return out;
}

std::string
confusionCsv(const Rates& rates)
{
  std::ostringstream out;
  out << "series,x,condition,recogniser,object,answer,count\n";
  for (std::size_t s = 0; s < rates.tallies.size(); ++s)
    for (std::size_t r = 0; r < rates.recognisers.size(); ++r)
      for (std::size_t o = 0; o < rates.objects.size(); ++o)
        for (std::size_t a = 0; a < rates.objects.size(); ++a)
          if (const auto count = rates.tallies[s][r].confusion[o][a]; count > 0)
            out << keyOf(rates, s, r) << ',' << csvField(rates.objects[o].label) << ','
                << csvField(rates.objects[a].label) << ',' << count << '\n';
  return out.str();
}

void
printResults(const RatesExperiment& experiment, const RatesOptions& options, const Rates& rates)
{
  std::printf("%s\n%zu objects of one diameter, %llu tests per object and condition, seed %llu\n\n",
              experiment.title.c_str(), rates.objects.size(),
              static_cast<unsigned long long>(options.tests),
              static_cast<unsigned long long>(options.seed));
  if (rates.recognisers.size() == 1)
    printSettings(rates);
  else
    printRecognisers(rates);
}

} // namespace

int
reportRates(const RatesExperiment& experiment, const RatesOptions& options)
{
  makeDirectory(options.out);
  const auto objects = loadObjects(options.meshes, options.labels);
  const auto threads = static_cast<unsigned>(options.threads);
  const auto recognisers = withProgress<Recognisers>(objects.size(), [&](const auto& show) {
    return experiment.recognisers({objects, options.seed, threads, show});
  });
  const std::size_t first = std::min<std::size_t>(options.skip, experiment.settings.size());
  const std::vector<Setting> settings(
      experiment.settings.begin() + static_cast<std::ptrdiff_t>(first), experiment.settings.end());
  const TrialPlan plan{settings, options.tests, options.seed, threads, first};
  Rates rates{objects, recognisers, settings, {}};
  const std::string base = options.out + "/" + experiment.name;
  const auto keep = [&](const Tallies& done) {
    rates.tallies = done;
    writeFile(base + ".csv", ratesCsv(rates));
    writeFile(base + "_confusion.csv", confusionCsv(rates));
  };
  withProgress<Tallies>(plan.settings.size(), [&](const auto& show) {
    return runTrials(objects, recognisers, plan, show, keep);
  });
  printResults(experiment, options, rates);
  std::printf("\nwrote %s.csv and %s_confusion.csv\n", base.c_str(), experiment.name.c_str());
  if (const auto no_picture = experiment.draw(rates, options.out); !no_picture.empty())
    complain("no picture: " + no_picture);
  return kOk;
}

} // namespace apps
} // namespace pcl_surflet
