// Online interpretation beside the batch: a sensor moves along a table and back on the other side.

#include "app_common.h"
#include "evaluation/online_scenes.h"
#include "evaluation/scoring.h"
#include "evaluation/training.h"
#include "scene_items.h"
#include "sensor_options.h"
#include "thread_time.h"

#include "pcl_surflet/online_scene_interpreter.h"

#include <chrono>
#include <cstdio>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_evaluate_online";
constexpr int kBins = 7;

struct Options {
  LongTable table;
  OnlineParameters online;
  std::vector<double> lengths = {1, 2, 4};
  std::uint64_t scenes = 10, seed = 1001, threads = 1, batch_every = 0, taken = 0;
  bool csv = false;
};

/** \brief Seconds of work on a busy machine: CPU time of one thread, else by the clock. */
class Stopwatch {
public:
  explicit Stopwatch(std::uint64_t threads) : is_cpu_(threads == 1), begin_(now()) {}
  double
  seconds() const
  {
    return now() - begin_;
  }

private:
  double
  now() const
  {
    const std::chrono::duration<double> clock = std::chrono::steady_clock::now().time_since_epoch();
    return is_cpu_ ? threadSeconds() : clock.count();
  }
  bool is_cpu_;
  double begin_;
};

/** \brief Online and batch on scenes of one length. */
struct Contest {
  Score online, batch;
  std::vector<double> middle_seconds; ///< of online scans, from half of the way on
  std::vector<double> batch_seconds;  ///< after the last scan
  Taking taking;
};

/** \brief What is known before the first scan. */
struct Known {
  const ModelDatabase& database;
  const std::vector<SceneItem>& items;
  const Options& options;
};

OnlineParameters
parametersFor(const Options& o, const SurfletSet& empty, std::uint64_t seed)
{
  OnlineParameters p = o.online;
  p.leaf = o.table.leaf;
  p.explanation.steps.background = BackgroundTreatment::Exclude;
  p.explanation.steps.seed = seed;
  p.explanation.steps.threads = static_cast<unsigned>(o.threads);
  p.empty_scene = empty;
  return p;
}

/** \brief All scans so far at once. */
SceneInterpretation
batchOf(const SurfletSet& surflets, const SurfletSet& empty, const Known& known, std::uint64_t seed,
        CellReduction& reduction)
{
  const OnlineParameters p = parametersFor(known.options, {}, seed);
  reduction = reduceToTwoSidedCells(surflets, p.leaf);
  const auto away = cellsAwayFrom(reduction.cells, empty, p.leaf, p.explanation.steps.threads);
  ExplanationParameters explanation = p.explanation;
  explanation.leaf = p.leaf;
  auto found = interpretByExplanation(reduction.cells.subset(away), known.database, explanation);
  for (auto& d : found.detections)
    for (auto& c : d.cells)
      c = away[c];
  return found;
}

void
printScan(double length, std::uint64_t seed, std::size_t k, const OnlineScan& scan,
          const OnlineInterpretation& online, double seconds, double batch)
{
  std::printf("%s,%llu,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%s,%s\n", number(length).c_str(),
              static_cast<unsigned long long>(seed), k + 1, scan.cells, scan.changed_cells,
              scan.vanished_cells, scan.interpreted_cells, scan.kept, scan.sought,
              online.detections().size(), online.distractors().size(), number(seconds).c_str(),
              batch > 0 ? number(batch).c_str() : "");
}

/** \brief Lets the sensor pass a scene, and the batch look at all that it saw. */
void
pass(const Known& known, const SensedTable& table, double length, Contest& contest)
{
  const Options& o = known.options;
  OnlineSceneInterpreter online(known.database, parametersFor(o, table.empty, table.seed));
  SurfletSet so_far;
  CellReduction reduction;
  double last_batch = 0;
  for (std::size_t k = 0; k < table.scans.size(); ++k) {
    const auto cloud = cloudOf(table.scans[k]);
    const Stopwatch watch(o.threads);
    const OnlineScan scan = online.addScanInSensorFrame(cloud);
    const double seconds = watch.seconds();
    append(so_far, sensedSurflets({table.scans[k]}));
    const bool is_last = k + 1 == table.scans.size(), is_middle = 2 * k >= table.scans.size();
    double batch = 0;
    if (is_last || (o.batch_every > 0 && k % o.batch_every == 0)) {
      const Stopwatch batch_watch(o.threads);
      const auto found = batchOf(so_far, table.empty, known, table.seed, reduction);
      batch = last_batch = batch_watch.seconds();
      if (is_last)
        contest.batch.add(withNearestTruth(reduction.cells, table.scene), found.detections);
    }
    if (is_middle)
      contest.middle_seconds.push_back(seconds);
    if (o.csv)
      printScan(length, table.seed, k, scan, online, seconds, batch);
  }
  contest.batch_seconds.push_back(last_batch);
  const CellScene cells = withNearestTruth(online.cells(), table.scene);
  contest.online.add(cells, thereOf(online));
  if (o.taken > 0)
    takeAway(table, static_cast<std::size_t>(o.taken), cells, online, contest.taking);
}

void
printRow(double length, std::size_t items, const char* name, const Score& score, double seconds)
{
  const Counts c = score.all();
  const Rate recall = rateOf(c.found, c.present), precision = precisionOf(c),
             centre = rateOf(c.centred, c.present), right = rateOf(c.strict, c.clusters);
  std::printf("%4.1f %5zu  %-6s %7zu %8zu  %5.1f [%5.1f,%5.1f]  %5.1f [%5.1f,%5.1f]  %5.1f "
              "[%5.1f,%5.1f]  %5.1f [%5.1f,%5.1f]  %6.3f\n",
              length, items, name, c.present, c.clusters, right.percent, right.low, right.high,
              recall.percent, recall.low, recall.high, precision.percent, precision.low,
              precision.high, centre.percent, centre.low, centre.high, seconds);
}

void
print(double length, std::size_t items, const Contest& contest, const Options& o)
{
  const double scan = medianOf(contest.middle_seconds), batch = medianOf(contest.batch_seconds);
  printRow(length, items, "online", contest.online, scan);
  printRow(length, items, "batch", contest.batch, batch);
  std::printf("%4.1f %5zu  a scan of the second half takes 1 / %.1f of the last batch\n", length,
              items, scan > 0 ? batch / scan : 0);
  if (o.taken > 0) {
    const Taking& t = contest.taking;
    const Rate ended = rateOf(t.ended, t.taken), stayed = rateOf(t.stayed, t.others);
    std::printf("%4.1f %5zu  of %zu found and taken away %.1f [%.1f,%.1f] %% ended, of %zu others "
                "%.1f [%.1f,%.1f] %% kept their id\n",
                length, items, t.taken, ended.percent, ended.low, ended.high, t.others,
                stayed.percent, stayed.low, stayed.high);
  }
}

void
evaluate(const std::vector<SceneItem>& items, const Options& o)
{
  const ModelDatabase database = tableDatabase(items, o.table, kBins);
  const auto labels = labelsOf(items);
  if (o.csv)
    std::puts("length,seed,scan,cells,changed,vanished,interpreted,kept,sought,detections,"
              "confident,seconds,batch_seconds");
  else
    std::printf("%llu scenes, seeds %llu to %llu; in brackets 95 %% confidence (Wilson)\n"
                "   m items         present clusters  names %%               recall %%           "
                "   precision %%           centre %%              s\n",
                static_cast<unsigned long long>(o.scenes), static_cast<unsigned long long>(o.seed),
                static_cast<unsigned long long>(o.seed + o.scenes - 1));
  Progress progress(o.scenes * o.lengths.size());
  std::uint64_t done = 0;
  for (const double length : o.lengths) {
    Contest contest{Score(labels), Score(labels), {}, {}, {}};
    for (std::uint64_t k = 0; k < o.scenes; ++k) {
      progress.show(done++, "scenes");
      pass({database, items, o}, sensedTable(items, o.table, length, o.seed + k), length, contest);
    }
    progress.clear();
    if (!o.csv)
      print(length, itemsOn(o.table, length), contest, o);
  }
}

void
addOptions(CommandLine& line, Options& o)
{
  line.count("-scenes", "N", "number of scenes of each length, default 10", o.scenes, 1, 1000000);
  addNumbers(line, "-lengths", "L,...", "lengths of the table, default 1,2,4", 0.1, 1000,
             o.lengths);
  line.real("-per_length", "N", "items per unit of length, default 5", o.table.items_per_length,
            1e-3, 1e3);
  line.real("-stride", "S", "of the sensor between scans, default 0.15", o.table.stride, 1e-3, 1e3);
  line.real("-leaf", "S", "edge of the cells, default 0.006", o.table.leaf, 1e-9, 1e9);
  line.real("-stale", "P", "of OnlineParameters, default 0.1", o.online.stale, 0, 1e3);
  line.real("-behind", "N", "of OnlineParameters, default 1.5", o.online.behind, 0, 1e3);
  line.count("-batch_every", "N", "the batch also runs after every Nth scan, default 0: the last",
             o.batch_every, 0, 1000000);
  line.count("-take", "N", "takes so many things away after the pass and passes again", o.taken, 0,
             1000000);
  line.flag("-csv", "prints a line a scan, in place of the scores", o.csv);
  addPassingSensor(line, o.table.sensing);
  line.count("-seed", "S", "seed of the first scene, the next one counts on, default 1001", o.seed,
             0, 1ULL << 62);
  line.count("-threads", "N", "default 1, which is timed by what it computes; 0: all", o.threads, 0,
             4096);
}

int
run(int argc, char** argv)
{
  Options o;
  CommandLine line(kProgram, "ITEM...",
                   "Puts the ITEMs (see pcl_surflet_generate) in turn on long tables, lets a "
                   "sensor pass there and back on the other side,\nand compares what is found "
                   "online with what is found in all scans at once.");
  o.table.sensing.sensor.columns = 320;
  o.table.sensing.sensor.rows = 240;
  addOptions(line, o);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(1, 1000);
  o.table.sensing.threads = static_cast<unsigned>(o.threads);
  evaluate(itemsOf(line.files()), o);
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return run(argc, argv); });
}
