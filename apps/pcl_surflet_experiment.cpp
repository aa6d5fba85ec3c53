// Runs the experiments of the dissertation on real meshes and prints what they show.

#include "app_common.h"
#include "experiment/classification.h"
#include "experiment/gallery.h"
#include "pcl_surflet/database_file.h"

#include <cstdio>
#include <filesystem>
#include <sstream>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

struct Options {
  std::string meshes, out;
  std::uint64_t tests = 100, seed = 1, threads = 0;
};

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

void
makeDirectory(const std::string& path)
{
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error)
    throw DataError("cannot make the directory '" + path + "': " + error.message());
}

/** \brief Runs \p work with a function that shows its progress over \p steps. */
template <class Result, class Work>
Result
withProgress(std::size_t steps, const Work& work)
{
  Progress progress(steps);
  return work([&](std::size_t done, const std::string& what) { progress.show(done, what); });
}

/** \brief Table 3.1 and points of Fig. 3.5 and 3.6 by the likelihood criterion. */
int
classification(const Options& options)
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

int
run(int argc, char** argv)
{
  Options options;
  CommandLine line(
      "pcl_surflet_experiment", "NAME",
      "Runs an experiment of the dissertation and prints its result.\n"
      "NAME: classification  Table 3.1, Fig. 3.5, 3.6: rates of 20 objects under ideal and\n"
      "                      disturbed conditions");
  line.text("-meshes", "DIR",
            "directory of the OFF meshes of the Debian package libcgal-demo (needed)",
            options.meshes);
  line.text("-out", "DIR", "directory for results, made if missing (needed)", options.out);
  line.count("-tests", "N", "tests per object and condition", options.tests, 1, 1000000);
  addSeed(line, options.seed);
  addThreads(line, options.threads);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(1, 1);
  line.require("-meshes");
  line.require("-out");
  if (line.files()[0] != "classification")
    throw UsageError("unknown experiment '" + line.files()[0] + "'; known: classification");
  return classification(options);
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain("pcl_surflet_experiment", [&] { return run(argc, argv); });
}
