#include "evaluation/extensions.h"

#include "app_common.h"
#include "evaluation/measures.h"
#include "evaluation/scoring.h"

#include "pcl_surflet/scene_interpreter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>

namespace pcl_surflet {
namespace apps {
namespace {

CellScene
cellsOf(const ExtensionStudy& study, std::uint64_t k)
{
  const Scene scene = study.scene(k);
  return withTruth(reduceToCells(scene.surflets, study.leaf), scene);
}

/** \brief Cells of every instance, their centroid and mean distance from it. */
struct Instance {
  std::string label;
  std::vector<std::uint32_t> cells;
  std::array<double, 3> centroid{};
  double r_mean = 0;
};

double
distanceTo(const std::array<double, 3>& place, const SurfletSet& cells, std::uint32_t i)
{
  return std::hypot(cells.x[i] - place[0], cells.y[i] - place[1], cells.z[i] - place[2]);
}

std::vector<Instance>
instancesOf(const CellScene& scene)
{
  std::vector<Instance> all(scene.items.size());
  for (std::size_t k = 0; k < all.size(); ++k)
    all[k].label = scene.items[k].label;
  for (std::uint32_t i = 0; i < scene.cells.size(); ++i)
    if (scene.instance[i] > 0)
      all[scene.instance[i] - 1].cells.push_back(i);
  for (auto& s : all) {
    const SurfletSet own = scene.cells.subset(s.cells);
    const Extent extent = computeExtent(own);
    std::copy_n(extent.centroid, 3, s.centroid.begin());
    s.r_mean = extent.r_mean;
  }
  return all;
}

/** \brief Instance that most of the cells are of, if it bears the detection's name. */
const Instance*
strictlyRight(const CellScene& scene, const std::vector<Instance>& instances, const Detection& d)
{
  std::map<std::uint32_t, std::size_t> cells;
  for (const auto i : d.cells)
    ++cells[scene.instance[i]];
  for (const auto& [instance, n] : cells)
    if (2 * n > d.cells.size() && instance > 0 && instances[instance - 1].label == d.label)
      return &instances[instance - 1];
  return nullptr;
}

/** \brief How much of the objects was found where. */
struct Shares {
  std::size_t detections = 0, cells = 0, right = 0;
  std::size_t middle = 0, middle_found = 0, border = 0, border_found = 0;

  void
  add(const CellScene& scene, const Instance& instance, const Detection& d)
  {
    ++detections;
    cells += d.cells.size();
    std::vector<std::uint32_t> held = d.cells;
    std::sort(held.begin(), held.end());
    for (const auto i : instance.cells) {
      const bool inside = distanceTo(instance.centroid, scene.cells, i) <= instance.r_mean;
      const bool found = std::binary_search(held.begin(), held.end(), i);
      ++(inside ? middle : border);
      (inside ? middle_found : border_found) += found ? 1 : 0;
      right += found ? 1 : 0;
    }
  }
};

/** \brief Wall-clock time, and time of processors, which other work on the machine hardly changes:
 * the calling thread's bounds what more threads can gain. */
struct Cost {
  double seconds = 0, all_threads = 0, calling_thread = 0;

  void
  add(const std::function<void()>& work)
  {
    const double all = now(CLOCK_PROCESS_CPUTIME_ID), calling = now(CLOCK_THREAD_CPUTIME_ID);
    seconds += secondsOf(work);
    all_threads += now(CLOCK_PROCESS_CPUTIME_ID) - all;
    calling_thread += now(CLOCK_THREAD_CPUTIME_ID) - calling;
  }

private:
  static double
  now(clockid_t clock)
  {
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
};

double
percent(std::size_t part, std::size_t whole)
{
  return whole == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
}

double
mean(double sum, std::size_t n)
{
  return n == 0 ? 0 : sum / static_cast<double>(n);
}

/** \brief One method after so many runs. */
struct RunRow {
  explicit RunRow(const std::vector<std::string>& labels) : score(labels) {}

  Score score;
  double seconds = 0, right_confidence = 0, wrong_confidence = 0;
  std::size_t right = 0, wrong = 0, points = 0, right_points = 0;

  void
  add(const CellScene& scene, const std::vector<Instance>& instances,
      const SceneInterpretation& found, double spent)
  {
    score.add(scene, found.detections);
    seconds += spent;
    for (const auto& d : found.detections) {
      const auto* instance = strictlyRight(scene, instances, d);
      const double confidence = detail::confidenceOf(d, DissertationParameters().min_cluster);
      ++(instance ? right : wrong);
      (instance ? right_confidence : wrong_confidence) += confidence;
      points += d.cells.size();
      if (!instance)
        continue;
      const auto number = static_cast<std::uint32_t>(instance - instances.data()) + 1;
      right_points += static_cast<std::size_t>(
          std::count_if(d.cells.begin(), d.cells.end(),
                        [&](std::uint32_t i) { return scene.instance[i] == number; }));
    }
  }

  std::string
  csv(const std::string& method, std::size_t runs) const
  {
    const Counts all = score.all();
    const auto scenes = score.scenes();
    const Rate recall = rateOf(all.found, all.present), exact = precisionOf(all);
    char text[400];
    std::snprintf(text, sizeof text,
                  "%s,%zu,%zu,%.4f,%.1f,%.1f,%.1f,%.1f,%.1f,%.1f,%.1f,%.1f,%.3f,%.3f,%.3f\n",
                  method.c_str(), scenes, runs, mean(seconds, scenes), mean(double(points), scenes),
                  mean(double(right_points), scenes), recall.percent, recall.low, recall.high,
                  exact.percent, exact.low, exact.high, score.falsePerScene(),
                  mean(right_confidence, right), mean(wrong_confidence, wrong));
    return text;
  }
};

/** \brief Adds a scene to the rows of a method: row r is what r + 1 runs give. */
void
accumulate(const ExtensionStudy& study, const Recogniser& method, const CellScene& scene,
           std::uint64_t seed, std::vector<RunRow>& rows)
{
  const auto instances = instancesOf(scene);
  std::vector<SceneInterpretation> runs;
  double spent = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    SceneInterpretation merged;
    spent += secondsOf([&] { runs.push_back(method.find(scene.cells, seedOfRun(seed, r))); });
    const double merging =
        secondsOf([&] { merged = mergeInterpretations(scene.cells, runs, study.accumulation); });
    rows[r].add(scene, instances, merged, spent + merging);
  }
}

/** \brief The lines of one seed's path, if it starts on \p instance. */
std::string
pathLines(const std::string& prefix, const std::vector<std::array<double, 3>>& path,
          const Instance& instance)
{
  std::string text;
  for (std::size_t step = 0; step < path.size(); ++step) {
    char line[120];
    std::snprintf(line, sizeof line, "%zu,%.6f,%.6f,%.6f\n", step,
                  path[step][0] - instance.centroid[0], path[step][1] - instance.centroid[1],
                  path[step][2] - instance.centroid[2]);
    text += prefix + line;
  }
  return text;
}

bool
startsOn(const Instance& instance, const CellScene& scene, const std::array<double, 3>& start)
{
  return std::any_of(instance.cells.begin(), instance.cells.end(),
                     [&](std::uint32_t i) { return distanceTo(start, scene.cells, i) < 1e-6; });
}

} // namespace

std::string
studyPaths(const ExtensionStudy& study)
{
  std::string text = "method,scene_seed,object,r_mean,seed,step,x,y,z\n";
  for (std::uint64_t k = 0; k < study.scenes; ++k) {
    const CellScene scene = cellsOf(study, k);
    const auto instances = instancesOf(scene);
    for (std::size_t m = 0; m < study.methods.size(); ++m) {
      const auto found = study.methods[m]->find(scene.cells, study.seed + k);
      for (const auto& model : found.diagnostics.models)
        for (std::size_t s = 0; s < model.seed_paths.size(); ++s)
          for (const auto& instance : instances)
            if (instance.label == model.label &&
                startsOn(instance, scene, model.seed_paths[s].front()))
              text += pathLines(study.names[m] + "," + std::to_string(study.seed + k) + "," +
                                    csvField(model.label) + "," + number(instance.r_mean) + "," +
                                    std::to_string(s) + ",",
                                model.seed_paths[s], instance);
    }
  }
  return text;
}

std::string
studyBorder(const ExtensionStudy& study)
{
  std::vector<Shares> shares(study.methods.size());
  std::vector<Cost> costs(study.methods.size());
  for (std::uint64_t k = 0; k < study.scenes; ++k) {
    const CellScene scene = cellsOf(study, k);
    const auto instances = instancesOf(scene);
    for (std::size_t m = 0; m < study.methods.size(); ++m) {
      SceneInterpretation found;
      costs[m].add([&] { found = study.methods[m]->find(scene.cells, study.seed + k); });
      for (const auto& d : found.detections)
        if (const auto* instance = strictlyRight(scene, instances, d))
          shares[m].add(scene, *instance, d);
    }
  }
  std::string text = "method,seed,scenes,detections,cells_each,right_each,right_percent,"
                     "middle_percent,border_percent,seconds,cpu_seconds,calling_thread_seconds\n";
  for (std::size_t m = 0; m < shares.size(); ++m) {
    const Shares& s = shares[m];
    char line[300];
    std::snprintf(line, sizeof line, "%s,%llu,%llu,%zu,%.1f,%.1f,%.1f,%.1f,%.1f,%.4f,%.4f,%.4f\n",
                  study.names[m].c_str(), static_cast<unsigned long long>(study.seed),
                  static_cast<unsigned long long>(study.scenes), s.detections,
                  mean(double(s.cells), s.detections), mean(double(s.right), s.detections),
                  percent(s.right, s.cells), percent(s.middle_found, s.middle),
                  percent(s.border_found, s.border), mean(costs[m].seconds, study.scenes),
                  mean(costs[m].all_threads, study.scenes),
                  mean(costs[m].calling_thread, study.scenes));
    text += line;
  }
  return text;
}

std::string
studyRuns(const ExtensionStudy& study)
{
  std::vector<std::vector<RunRow>> rows(
      study.methods.size(), std::vector<RunRow>(study.accumulation.runs, RunRow(study.labels)));
  for (std::uint64_t k = 0; k < study.scenes; ++k) {
    const CellScene scene = cellsOf(study, k);
    for (std::size_t m = 0; m < study.methods.size(); ++m)
      accumulate(study, *study.methods[m], scene, study.seed + k, rows[m]);
  }
  std::string text = "method,scenes,runs,seconds,points,right_points,recall,recall_low,recall_high,"
                     "precision,precision_low,precision_high,false_per_scene,confidence_right,"
                     "confidence_wrong\n";
  for (std::size_t m = 0; m < rows.size(); ++m)
    for (std::size_t r = 0; r < rows[m].size(); ++r)
      text += rows[m][r].csv(study.names[m], r + 1);
  return text;
}

} // namespace apps
} // namespace pcl_surflet
