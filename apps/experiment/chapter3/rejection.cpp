#include "experiment/chapter3.h"
#include "experiment/chapter3/curves.h"
#include "experiment/chapter3/settings.h"
#include "experiment/output.h"
#include "experiment/surflet_recognisers.h"
#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/recognition/histogram_classifier.h"

#include <algorithm>
#include <cstdio>
#include <limits>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief Strangeness of the answers, sorted; infinite where nobody answers. */
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
      all[i] = answer.strangeness;
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
