// How well are the objects of generated scenes found? Table 5.1 and beyond.

#include "app_common.h"
#include "evaluation/scoring.h"
#include "scene_items.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/recognition/scene_interpretation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_evaluate";
constexpr std::size_t kTrainingSurflets = 100000; // as in [Wahl 2007, Sec. 5.5.2]
constexpr std::uint64_t kOrientations = 4;
constexpr std::size_t kBackgroundPatches = 8;
constexpr std::uint64_t kTrainingSeed = 0x747261696eULL; // never the seed of a scene's sample

struct Options {
  SceneOptions scene;
  DissertationParameters parameters;
  ExplanationParameters explanation; ///< its steps are parameters
  bool by_explanation = false;
  std::uint64_t scenes = 10, seed = 1001, threads = 0, bins = 5;
  double leaf = 0.0058;
  bool on_cells = false, csv = false, verbose = false;
};

Resolution
resolutionOf(const Options& o)
{
  const int n = static_cast<int>(o.bins);
  return {n, n, n, n};
}

/** \brief A model of what the item looks like after reduction to cells: thin walls cancel and cells
 * on edges average there as in a scene. One member for each of a few orientations. */
HistogramModel
trainedOnCells(const HistogramModelTrainer& trainer, const SceneItem& item, const Options& o)
{
  const auto surflets =
      item.sample(static_cast<std::size_t>(item.area * o.scene.density) + 1, kTrainingSeed);
  HistogramModel model;
  for (std::uint64_t k = 0; k < kOrientations; ++k) {
    const auto cells = reduceToCells(randomlyRotated(surflets, kTrainingSeed + k), o.leaf).cells;
    HistogramModel turned = trainer.train(item.label, cells);
    turned.members.front().condition = "cells, orientation " + std::to_string(k);
    if (k == 0)
      model = std::move(turned);
    else
      model.members.push_back(turned.members.front());
  }
  return model;
}

/** \brief Surflets of \p set within \p radius of one of them, drawn at random. */
SurfletSet
patchOf(const SurfletSet& set, double radius, CounterRandom& random)
{
  const Surflet c = set[random.below(static_cast<std::uint32_t>(set.size()))];
  SurfletSet patch;
  for (std::size_t i = 0; i < set.size(); ++i)
    if (std::hypot(set.x[i] - c.x, set.y[i] - c.y, set.z[i] - c.z) <= radius)
      patch.push_back(set[i]);
  return patch;
}

/** \brief Models of pieces of the empty background, of the size of the largest object. */
void
addBackground(ModelDatabase& database, const Options& o, HistogramModelTrainer trainer)
{
  SceneOptions scene = o.scene;
  scene.seed = kTrainingSeed;
  const SurfletSet empty = reduceToCells(emptyBackground(scene), o.leaf).cells;
  const double radius = database.largestDelta() / 2;
  CounterRandom random(kTrainingSeed);
  trainer.setRole(ModelRole::Background);
  const std::size_t patches = scene.background == Background::Plane ? 1 : kBackgroundPatches;
  for (std::size_t k = 0; k < patches; ++k)
    database.add(trainer.train("background " + std::to_string(k), patchOf(empty, radius, random)));
}

ModelDatabase
trained(const std::vector<SceneItem>& objects, const Options& o)
{
  HistogramModelTrainer trainer;
  trainer.setResolution(resolutionOf(o));
  trainer.setNumberOfThreads(static_cast<unsigned>(o.threads));
  ModelDatabase database;
  for (const auto& item : objects)
    database.add(o.on_cells
                     ? trainedOnCells(trainer, item, o)
                     : trainer.train(item.label, item.sample(kTrainingSurflets, kTrainingSeed)));
  if (o.parameters.background == BackgroundTreatment::Model)
    addBackground(database, o, trainer);
  return database;
}

/** \brief A scene as the interpretation gets it, with the truth about every cell. */
CellScene
cellScene(const Scene& scene, const Options& o)
{
  const CellReduction reduction = reduceToCells(scene.surflets, o.leaf);
  CellScene out = withTruth(reduction, scene);
  if (o.parameters.background != BackgroundTreatment::Exclude)
    return out;
  SceneOptions options = o.scene;
  const SurfletSet empty = reduceToCells(emptyBackground(options), o.leaf).cells;
  return subsetOf(out, cellsAwayFrom(out.cells, empty, o.leaf));
}

void
printDiagnostics(const InterpretationDiagnostics& d)
{
  std::fprintf(stderr, "drawn %llu, too long %llu, background %llu\n",
               static_cast<unsigned long long>(d.drawn),
               static_cast<unsigned long long>(d.too_long),
               static_cast<unsigned long long>(d.background));
  std::fprintf(stderr, "%-14s %8s %8s %5s %8s %7s %8s %5s %5s %5s %5s %5s %5s %5s %5s\n", "model",
               "pairs", "surflets", "seeds", "in seeds", "cleared", "refined", "lone", "clust",
               "other", "small", "rel", "merge", "lost", "found");
  for (const auto& m : d.models)
    std::fprintf(
        stderr, "%-14s %8llu %8zu %5zu %8zu %7zu %8zu %5zu %5zu %5zu %5zu %5zu %5zu %5zu %5zu\n",
        m.label.c_str(), static_cast<unsigned long long>(m.pairs), m.surflets, m.seeds,
        m.seed_surflets, m.seeds_cleared, m.refined_surflets, m.seeds_lone, m.clusters,
        m.died_distribution, m.died_small, m.died_relative, m.merged, m.lost, m.detections);
}

void
evaluate(const std::vector<SceneItem>& objects, const std::vector<SceneItem>& clutter, Options& o)
{
  const ModelDatabase database = trained(objects, o);
  Score total(database);
  Progress progress(o.scenes);
  double seconds = 0, cells = 0;
  for (std::uint64_t k = 0; k < o.scenes; ++k) {
    progress.show(k, "scene");
    o.scene.seed = o.parameters.seed = o.seed + k;
    const CellScene scene = cellScene(generateScene(objects, clutter, o.scene), o);
    const auto begin = std::chrono::steady_clock::now();
    o.explanation.steps = o.parameters;
    const auto found = o.by_explanation
                           ? interpretByExplanation(scene.cells, database, o.explanation)
                           : interpretByDissertation(scene.cells, database, o.parameters);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    cells += static_cast<double>(scene.cells.size());
    total.add(scene, found.detections);
    if (o.verbose) {
      progress.clear();
      for (const auto& d : found.detections)
        std::fprintf(stderr, "%-12s cells %6zu score %.3f fit %.3f truth %s\n", d.label.c_str(),
                     d.cells.size(), d.score, d.fit, truthOf(scene, d).c_str());
      printDiagnostics(found.diagnostics);
    }
  }
  progress.clear();
  std::fputs(o.csv ? total.csv().c_str() : total.table().c_str(), stdout);
  const double n = static_cast<double>(o.scenes);
  note(number(cells / n) + " cells and " + number(seconds / n) + " s a scene");
}

void
addMethod(CommandLine& line, Options& o)
{
  addChoice<bool>(line, "-method", "default dissertation", o.by_explanation,
                  {{"dissertation", false}, {"explanation", true}});
  addChoice<BackgroundTreatment>(line, "-treatment", "of the background, default ignore",
                                 o.parameters.background,
                                 {{"ignore", BackgroundTreatment::Ignore},
                                  {"exclude", BackgroundTreatment::Exclude},
                                  {"model", BackgroundTreatment::Model}});
  line.count("-bins", "N", "intervals in each of the four dimensions, default 5", o.bins, 1, 32);
  line.flag("-on_cells", "trains on surflets reduced to cells, as scenes are", o.on_cells);
  line.real("-leaf", "S", "edge of the cells, default 0.0058", o.leaf, 1e-9, 1e9);
  line.count("-pairs", "N", "pairs drawn in step 1, default 232000", o.parameters.pairs, 1,
             1000000000);
  line.real("-lambda_h", "X", "step 1, default 1.3", o.parameters.lambda_h, 1e-3, 1e3);
  line.real("-lambda_o", "X", "step 4, default 0.3", o.parameters.lambda_o, 0, 0.999);
  line.real("-lambda_c", "X", "step 6, default 0.3", o.parameters.lambda_c, 0, 1);
  line.real("-min_fit", "X", "explanation: least histogram intersection, default 0.72",
            o.explanation.min_fit, 0, 1);
  line.real("-max_surprise", "X", "explanation: nats per feature, default 0.1",
            o.explanation.max_surprise, -10, 100);
}

/** \brief What else scenes hold, given on the command line. */
struct Contents {
  std::string clutter;
  std::uint64_t present = 0, unknown = 0;
};

void
addScenes(CommandLine& line, Options& o, Contents& contents)
{
  line.count("-scenes", "N", "number of scenes, default 10", o.scenes, 1, 1000000);
  line.count("-present", "N", "items present, chosen at random, default all", contents.present, 1,
             1000000);
  line.text("-clutter", "ITEM,...", "things unknown to the database", contents.clutter);
  line.count("-unknown", "N", "things present of the clutter, default all", contents.unknown, 0,
             1000000);
  addArrangement(line, o.scene);
  line.real("-density", "D", "points per squared unit, default 470000", o.scene.density, 1e-9,
            1e12);
  line.real("-noise", "S", "moves points along their normals by up to S, default 0", o.scene.noise,
            0, 1e6);
}

int
run(int argc, char** argv)
{
  Options o;
  Contents contents;
  CommandLine line(kProgram, "ITEM...",
                   "Generates scenes of the ITEMs (see pcl_surflet_generate), interprets them and "
                   "counts what was found:\nclassification rate and accuracy [Wahl 2007, Eq. 5.9, "
                   "5.10], strict rate, recall, false clusters.");
  addMethod(line, o);
  addScenes(line, o, contents);
  line.flag("-csv", "prints CSV", o.csv);
  line.flag("-verbose", "prints what each step did to stderr", o.verbose);
  line.count("-seed", "S", "seed of the first scene, the next one counts on, default 1001", o.seed,
             0, 1ULL << 62);
  addThreads(line, o.threads);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(1, 1000);
  const auto objects = itemsOf(line.files());
  const auto others = line.given("-clutter") ? itemsOf(parts(contents.clutter, ',')) : itemsOf({});
  o.scene.present = line.given("-present") ? contents.present : objects.size();
  o.scene.clutter = line.given("-unknown") ? contents.unknown : others.size();
  if (o.scene.present > objects.size() || o.scene.clutter > others.size())
    throw UsageError(std::string("option ") +
                     (o.scene.present > objects.size() ? "-present" : "-unknown") +
                     ": so many things were not given");
  o.parameters.threads = static_cast<unsigned>(o.threads);
  evaluate(objects, others, o);
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return run(argc, argv); });
}
