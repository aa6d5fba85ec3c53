// How well are the objects of generated scenes found? Table 5.1, Fig. 5.5 and beyond.

#include "app_common.h"
#include "evaluation/comparison.h"
#include "evaluation/extensions.h"
#include "scene_items.h"
#include "sensor_options.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_evaluate";

enum class Scaling { None, Area, Models };
enum class Study { None, Paths, Border, Runs };

struct Options {
  RecogniserOptions recogniser;
  ComparisonOptions comparison;
  std::vector<std::string> methods = {"dissertation"};
  std::string row = "scenes";
  std::vector<double> critical; ///< distance factors
  Scaling scaling = Scaling::None;
  Study study = Study::None;
  AccumulationParameters accumulation;
  std::vector<double> factors = {1, 2, 5, 10};
  double presence = 1;   ///< probability that an item is present
  std::size_t items = 0; ///< that scenes choose from
  std::uint64_t scenes = 10, seed = 1001, threads = 0, bins = 0;
  bool csv = false;
};

/** \brief The things of an evaluation. */
struct Things {
  std::vector<SceneItem> objects, clutter, extra;
};

using Methods = std::vector<std::shared_ptr<const Recogniser>>;
using SceneMaker = std::function<Scene(std::uint64_t k)>;

std::string
treatmentName(BackgroundTreatment treatment)
{
  switch (treatment) {
  case BackgroundTreatment::Exclude:
    return "exclude";
  case BackgroundTreatment::Model:
    return "model";
  default:
    return "ignore";
  }
}

Methods
trained(const std::vector<SceneItem>& objects, const Options& o)
{
  Methods methods;
  for (const auto& name : o.methods)
    methods.push_back(recogniser(name, objects, o.recogniser));
  return methods;
}

std::vector<std::string>
labelsOf(const std::vector<SceneItem>& items)
{
  std::vector<std::string> labels;
  labels.reserve(items.size());
  for (const auto& item : items)
    labels.push_back(item.label);
  return labels;
}

/** \brief One row: every method on all scenes. \p objects are what the methods know. */
void
evaluateRow(const std::string& name, const std::vector<SceneItem>& objects, const Methods& methods,
            const SceneMaker& scene, const Options& o)
{
  Comparison comparison(name, labelsOf(objects), o.comparison);
  for (std::size_t m = 0; m < methods.size(); ++m)
    comparison.enter(o.methods[m], methods[m]);
  Progress progress(o.scenes);
  for (std::uint64_t k = 0; k < o.scenes; ++k) {
    progress.show(k, name);
    comparison.run(scene(k), o.seed + k);
  }
  progress.clear();
  const auto treatment = treatmentName(o.recogniser.dissertation.background);
  const std::string text =
      o.csv ? comparison.csv(objects.size(), treatment, o.seed) : comparison.table();
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout); // rows take long
}

SceneOptions
sceneOptions(const Options& o, std::uint64_t k)
{
  SceneOptions scene = o.recogniser.scene;
  scene.seed = o.seed + k;
  if (o.presence < 1)
    scene.present = presentOf(o.items, o.presence, scene.seed);
  return scene;
}

/** \brief Fig. 5.5: two instances of one object, which changes from scene to scene. */
void
evaluateCritical(const Things& things, const Options& o)
{
  const Methods methods = trained(things.objects, o);
  for (const double factor : o.critical)
    evaluateRow(
        o.row + " " + number(factor), things.objects, methods,
        [&](std::uint64_t k) {
          SceneOptions scene = sceneOptions(o, k);
          scene.spacing = Spacing::Pair;
          scene.distance_factor = factor;
          scene.present = 2;
          const auto& item = things.objects[k % things.objects.size()];
          return seenScene({item, item}, things.clutter, scene, o.recogniser.sensing);
        },
        o);
}

/** \brief Scenes of several times the area and the objects, and methods that know them: their empty
 * scene is as large. */
void
evaluateArea(const Things& things, const Options& base)
{
  for (const double factor : base.factors) {
    Options o = base;
    o.recogniser.scene.size *= std::sqrt(factor);
    o.recogniser.scene.present *= static_cast<std::size_t>(factor);
    std::vector<SceneItem> objects;
    for (int k = 0; k < factor; ++k)
      objects.insert(objects.end(), things.objects.begin(), things.objects.end());
    evaluateRow(
        o.row + " " + number(factor), things.objects, trained(things.objects, o),
        [&](std::uint64_t k) {
          return seenScene(objects, things.clutter, sceneOptions(o, k), o.recogniser.sensing);
        },
        o);
  }
}

/** \brief The same scenes with \p factor times the models. */
void
evaluateModels(const Things& things, const Options& o)
{
  for (const double factor : o.factors) {
    const auto more =
        static_cast<std::size_t>((factor - 1) * static_cast<double>(things.objects.size()));
    if (more > things.extra.size())
      throw UsageError("option -extra: " + std::to_string(more) + " items are needed, not " +
                       std::to_string(things.extra.size()));
    auto known = things.objects;
    known.insert(known.end(), things.extra.begin(),
                 things.extra.begin() + static_cast<std::ptrdiff_t>(more));
    evaluateRow(
        o.row + " " + number(factor), known, trained(known, o),
        [&](std::uint64_t k) {
          return seenScene(things.objects, things.clutter, sceneOptions(o, k),
                           o.recogniser.sensing);
        },
        o);
  }
}

/** \brief The extensions of chapter 6. */
void
evaluateStudy(const Things& things, const Options& o)
{
  ExtensionStudy study;
  study.names = o.methods;
  study.methods = trained(things.objects, o);
  study.labels = labelsOf(things.objects);
  study.scene = [&](std::uint64_t k) {
    return generateScene(things.objects, things.clutter, sceneOptions(o, k));
  };
  study.scenes = o.scenes;
  study.seed = o.seed;
  study.leaf = o.recogniser.leaf;
  study.accumulation = o.accumulation;
  const std::string csv = o.study == Study::Paths    ? studyPaths(study)
                          : o.study == Study::Border ? studyBorder(study)
                                                     : studyRuns(study);
  std::fputs(csv.c_str(), stdout);
}

void
evaluate(const Things& things, const Options& o)
{
  if (o.study != Study::None)
    return evaluateStudy(things, o);
  if (o.csv)
    std::fputs(Comparison::csvHeader().c_str(), stdout);
  if (!o.critical.empty())
    evaluateCritical(things, o);
  else if (o.scaling == Scaling::Area)
    evaluateArea(things, o);
  else if (o.scaling == Scaling::Models)
    evaluateModels(things, o);
  else
    evaluateRow(
        o.row, things.objects, trained(things.objects, o),
        [&](std::uint64_t k) {
          return seenScene(things.objects, things.clutter, sceneOptions(o, k),
                           o.recogniser.sensing);
        },
        o);
}

void
addMethods(CommandLine& line, Options& o)
{
  std::string names;
  for (const auto& name : recogniserNames())
    names += (names.empty() ? "" : ", ") + name;
  line.option("-method", "NAME,...", "default dissertation: " + names,
              [&o, names](const std::string& text) {
                o.methods = parts(text, ',');
                const auto& known = recogniserNames();
                for (const auto& name : o.methods)
                  if (std::find(known.begin(), known.end(), name) == known.end())
                    throw UsageError("option -method: there is no '" + name + "'; the names are " +
                                     names);
              });
}

void
addParameters(CommandLine& line, RecogniserOptions& o, std::uint64_t& bins)
{
  auto& steps = o.dissertation;
  addChoice<BackgroundTreatment>(line, "-treatment", "of the background, default ignore",
                                 steps.background,
                                 {{"ignore", BackgroundTreatment::Ignore},
                                  {"exclude", BackgroundTreatment::Exclude},
                                  {"model", BackgroundTreatment::Model}});
  line.count("-bins", "N", "intervals in each of the four dimensions, default as suits the method",
             bins, 1, 32);
  line.flag("-on_surfaces", "explanation: trains on the surfaces, not on cells of them",
            o.on_surfaces);
  line.real("-leaf", "S", "edge of the cells, default 0.0058", o.leaf, 1e-9, 1e9);
  line.count("-pairs", "N", "pairs drawn in step 1, default 232000", steps.pairs, 1, 1000000000);
  line.real("-lambda_h", "X", "step 1, default 1.3", steps.lambda_h, 1e-3, 1e3);
  line.real("-lambda_o", "X", "step 4, default 0.3", steps.lambda_o, 0, 0.999);
  line.real("-lambda_c", "X", "step 6, default 0.3", steps.lambda_c, 0, 1);
  line.real("-min_fit", "X", "explanation: least histogram intersection, default 0.72",
            o.explanation.min_fit, 0, 1);
  line.real("-min_confidence", "X",
            "explanation: leaves out what is less sure, default 0 (pcl_surflet_interpret: 0.1)",
            o.min_confidence, 0, 1);
}

/** \brief What scenes hold and methods know, given on the command line. */
struct Contents {
  std::string clutter, extra;
  std::uint64_t present = 0, unknown = 0;
  SceneSensing sensing;
};

void
addScenes(CommandLine& line, Options& o, Contents& contents)
{
  auto& scene = o.recogniser.scene;
  line.count("-scenes", "N", "number of scenes, default 10", o.scenes, 1, 1000000);
  line.count("-present", "N", "items present, chosen at random, default all", contents.present, 1,
             1000000);
  line.real("-presence", "P", "each item is present with this probability, in place of -present",
            o.presence, 0, 1);
  line.text("-clutter", "ITEM,...", "things unknown to the database", contents.clutter);
  line.count("-unknown", "N", "things present of the clutter, default all", contents.unknown, 0,
             1000000);
  addArrangement(line, scene);
  line.real("-density", "D", "points per squared unit, default 470000", scene.density, 1e-9, 1e12);
  line.real("-noise", "S", "moves points along their normals by up to S, default 0", scene.noise, 0,
            1e6);
  addSensor(line, contents.sensing);
}

/** \brief An option that takes several numbers. */
void
addNumbers(CommandLine& line, const std::string& name, const std::string& help, double low,
           double high, std::vector<double>& target)
{
  line.option(name, "F,...", help, [=, &target](const std::string& text) {
    target.clear();
    for (const auto& part : parts(text, ','))
      target.push_back(parseReal(name, part, low, high));
  });
}

void
addSeries(CommandLine& line, Options& o, Contents& contents)
{
  addNumbers(line, "-critical",
             "a row each: two instances of an item, F bounding radii apart [Wahl 2007, Fig. 5.5]",
             0, 1e3, o.critical);
  addChoice<Scaling>(line, "-scaling", "a row each for several times as much", o.scaling,
                     {{"area", Scaling::Area}, {"models", Scaling::Models}});
  addNumbers(line, "-times", "whole numbers for -scaling, default 1,2,5,10", 1, 1000, o.factors);
  line.text("-extra", "ITEM,...", "items for -scaling models that are in no scene", contents.extra);
}

/** \brief Chapter 6. */
void
addExtensions(CommandLine& line, Options& o, std::uint64_t& steps, std::uint64_t& runs)
{
  auto& dissertation = o.recogniser.dissertation;
  addChoice<Study>(
      line, "-study",
      "a CSV of its own: where seeds float, cells of found objects, or what runs accumulate",
      o.study, {{"paths", Study::Paths}, {"border", Study::Border}, {"runs", Study::Runs}});
  line.count("-float_steps", "N", "floating: steps of a seed, default 25", steps, 1, 10000);
  line.real("-steepness", "X", "floating: s times r_max, default 60",
            dissertation.floating.steepness, 1e-3, 1e6);
  line.real("-repeat_pairs", "X", "repeated: pairs for each surflet, default 4",
            dissertation.repetition.pairs_per_surflet, 1e-3, 1e6);
  line.count("-runs", "N", "-study runs: interpretations of a scene, default 8", runs, 1, 10000);
  line.real("-min_votes", "X", "share of the runs that must find an object, default 0.5",
            o.accumulation.min_votes, 0, 1);
  line.real("-min_cell_share", "X", "share of them that must give it a cell, default 0",
            o.accumulation.min_cell_share, 0, 1);
}

void
addOutput(CommandLine& line, Options& o)
{
  line.text("-row", "NAME", "what the results are called, default scenes", o.row);
  line.flag("-csv", "prints CSV", o.csv);
  line.flag("-peers",
            "compares times with pcl::NormalEstimationOMP (20 neighbours) on the same cells and "
            "pcl::VoxelGrid",
            o.comparison.peers);
  line.flag("-memory", "measures memory beside the scene", o.comparison.memory);
  line.flag("-verbose", "prints what was found and what each step did to stderr",
            o.comparison.verbose);
  line.count("-seed", "S", "seed of the first scene, the next one counts on, default 1001", o.seed,
             0, 1ULL << 62);
  addThreads(line, o.threads);
}

Things
thingsOf(const CommandLine& line, const Contents& contents)
{
  Things things;
  things.objects = itemsOf(line.files());
  if (line.given("-clutter"))
    things.clutter = itemsOf(parts(contents.clutter, ','));
  if (line.given("-extra"))
    things.extra = itemsOf(parts(contents.extra, ','));
  return things;
}

void
settle(Options& o, const CommandLine& line, const Contents& contents, const Things& things)
{
  auto& scene = o.recogniser.scene;
  scene.present = line.given("-present") ? contents.present : things.objects.size();
  scene.clutter = line.given("-unknown") ? contents.unknown : things.clutter.size();
  if (scene.present > things.objects.size() || scene.clutter > things.clutter.size())
    throw UsageError(std::string("option ") +
                     (scene.present > things.objects.size() ? "-present" : "-unknown") +
                     ": so many things were not given");
  if (line.given("-views"))
    o.recogniser.sensing = contents.sensing;
  if (line.given("-views") && line.given("-noise"))
    throw UsageError("option -noise: is for complete surfaces; with -views give -sensor_noise");
  if (line.given("-presence") && (line.given("-present") || o.scaling != Scaling::None))
    throw UsageError("option -presence: goes neither with -present nor with -scaling");
  o.items = things.objects.size();
  for (auto& factor : o.factors)
    factor = std::floor(factor);
  o.recogniser.bins = static_cast<int>(o.bins);
  o.recogniser.dissertation.threads = static_cast<unsigned>(o.threads);
  if (o.recogniser.sensing)
    o.recogniser.sensing->threads = static_cast<unsigned>(o.threads);
  o.comparison.threads = static_cast<unsigned>(o.threads);
  o.comparison.leaf = o.recogniser.leaf;
}

int
run(int argc, char** argv)
{
  Options o;
  Contents contents;
  CommandLine line(kProgram, "ITEM...",
                   "Generates scenes of the ITEMs (see pcl_surflet_generate), lets one or more "
                   "methods interpret them and\ncounts what was found: classification rate and "
                   "accuracy [Wahl 2007, Eq. 5.9, 5.10], strict rate, recall,\nprecision, false "
                   "clusters. classic_vfh and classic_esf remove planes, cluster what is left and "
                   "name\nclusters by their nearest neighbour; exclusion_vfh leaves out the empty "
                   "scene in place of planes.");
  addMethods(line, o);
  addParameters(line, o.recogniser, o.bins);
  addScenes(line, o, contents);
  addSeries(line, o, contents);
  std::uint64_t steps = o.recogniser.dissertation.floating.steps, runs = 8;
  addExtensions(line, o, steps, runs);
  addOutput(line, o);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(1, 1000);
  const Things things = thingsOf(line, contents);
  settle(o, line, contents, things);
  o.recogniser.dissertation.floating.steps = static_cast<unsigned>(steps);
  o.recogniser.dissertation.floating.keep_paths = o.study == Study::Paths;
  o.accumulation.runs = runs;
  evaluate(things, o);
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return run(argc, argv); });
}
