#include "experiment/classification_report.h"

#include "app_common.h"
#include "experiment/classification.h"
#include "experiment/gallery.h"
#include "experiment/output.h"
#include "pcl_surflet/database_file.h"

#include <cstdio>
#include <sstream>

namespace pcl_surflet {
namespace apps {
namespace {

std::vector<Condition>
conditions()
{
  return {{"ideal", 0, 1},          {"noise 1 %", 0.01, 1},    {"noise 2 %", 0.02, 1},
          {"noise 4 %", 0.04, 1},   {"visible 65 %", 0, 0.65}, {"visible 40 %", 0, 0.40},
          {"visible 25 %", 0, 0.25}};
}

std::string
percent(double share)
{
  char text[16];
  std::snprintf(text, sizeof(text), "%.1f", 100 * share);
  return text;
}

/** \brief The object most often taken for another, and which: "anchor > pig (8)". */
std::string
worstConfusion(const ConditionResult& r, const std::vector<ExperimentObject>& objects)
{
  std::uint64_t most = 0;
  std::string text = "-";
  for (std::size_t o = 0; o < objects.size(); ++o)
    for (std::size_t m = 0; m < objects.size(); ++m)
      if (o != m && r.confusion[o][m] > most) {
        most = r.confusion[o][m];
        text = objects[o].label + " > " + objects[m].label + " (" + std::to_string(most) + ")";
      }
  return text;
}

void
printTable(const std::vector<ConditionResult>& results,
           const std::vector<ExperimentObject>& objects)
{
  std::printf("%-14s %8s  %-15s %8s  %s\n", "condition", "right %", "95 % interval", "ms/query",
              "most frequent confusion");
  for (const auto& r : results) {
    const auto [low, high] = confidenceInterval(r.right, r.tests);
    const std::string interval = "[" + percent(low) + ", " + percent(high) + "]";
    std::printf("%-14s %8s  %-15s %8.3f  %s\n", r.condition.name.c_str(), percent(r.rate()).c_str(),
                interval.c_str(), 1000 * r.seconds_per_query, worstConfusion(r, objects).c_str());
  }
}

std::string
csvOf(const std::vector<ConditionResult>& results, const std::vector<ExperimentObject>& objects)
{
  std::ostringstream out;
  out << "condition,object,answer,count\n";
  for (const auto& r : results)
    for (std::size_t o = 0; o < objects.size(); ++o)
      for (std::size_t m = 0; m < objects.size(); ++m)
        if (r.confusion[o][m] > 0)
          out << csvField(r.condition.name) << ',' << csvField(objects[o].label) << ','
              << csvField(objects[m].label) << ',' << r.confusion[o][m] << '\n';
  return out.str();
}

} // namespace

int
reportClassification(const ClassificationOptions& options)
{
  makeDirectory(options.out);
  const auto objects = loadObjects(options.meshes, experimentLabels());
  const auto threads = static_cast<unsigned>(options.threads);
  const ClassificationPlan plan{conditions(), options.tests, options.seed, threads};
  const auto database = withProgress<ModelDatabase>(objects.size(), [&](const auto& show) {
    return trainObjects(objects, {}, options.seed, threads, show);
  });
  saveDatabase(database, options.out + "/objects.pcd");
  const auto results = withProgress<std::vector<ConditionResult>>(
      plan.conditions.size() * objects.size(), [&](const auto& show) {
        return runClassification(objects, HistogramClassifier(database), plan, show);
      });
  std::printf(
      "%zu objects of one diameter, resolution %s, likelihood criterion, %llu tests per object "
      "and condition, seed %llu\n\n",
      objects.size(), database.resolution().toString().c_str(),
      static_cast<unsigned long long>(options.tests),
      static_cast<unsigned long long>(options.seed));
  printTable(results, objects);
  writeFile(options.out + "/classification.csv", csvOf(results, objects));
  const auto no_picture = drawGallery(objects, database, options.out);
  std::printf("\nwrote %s/objects.pcd (the database) and classification.csv\n",
              options.out.c_str());
  if (no_picture.empty())
    std::printf("wrote %s/objects.png (the objects and their histograms)\n", options.out.c_str());
  else
    complain("no picture: " + no_picture);
  return kOk;
}

} // namespace apps
} // namespace pcl_surflet
