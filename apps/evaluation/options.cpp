#include "evaluation/options.h"

#include "scene_items.h"
#include "sensor_options.h"

#include <cmath>

namespace pcl_surflet {
namespace apps {
namespace {

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
struct Contents : SceneContents {
  std::string extra;
  SceneSensing sensing;
};

void
addScenes(CommandLine& line, EvaluateOptions& o, Contents& contents)
{
  auto& scene = o.recogniser.scene;
  line.count("-scenes", "N", "number of scenes, default 10", o.scenes, 1, 1000000);
  addContents(line, contents);
  line.real("-presence", "P", "each item is present with this probability, in place of -present",
            o.presence, 0, 1);
  addArrangement(line, scene);
  addSensor(line, contents.sensing);
}

void
addSeries(CommandLine& line, EvaluateOptions& o, Contents& contents)
{
  addNumbers(line, "-critical", "F,...",
             "a row each: two instances of an item, F bounding radii apart [Wahl 2007, Fig. 5.5]",
             0, 1e3, o.critical);
  addChoice<Scaling>(line, "-scaling", "a row each for several times as much", o.scaling,
                     {{"area", Scaling::Area}, {"models", Scaling::Models}});
  addNumbers(line, "-times", "F,...", "whole numbers for -scaling, default 1,2,5,10", 1, 1000,
             o.factors);
  line.text("-extra", "ITEM,...", "items for -scaling models that are in no scene", contents.extra);
}

/** \brief Chapter 6. */
void
addExtensions(CommandLine& line, EvaluateOptions& o, std::uint64_t& steps, std::uint64_t& runs)
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
addOutput(CommandLine& line, EvaluateOptions& o)
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
  things.clutter = clutterOf(line, contents);
  if (line.given("-extra"))
    things.extra = itemsOf(parts(contents.extra, ','));
  return things;
}

void
settle(EvaluateOptions& o, const CommandLine& line, const Contents& contents, const Things& things)
{
  settleContents(line, contents, things.objects.size(), things.clutter.size(), o.recogniser.scene);
  if (line.given("-views"))
    o.recogniser.sensing = contents.sensing;
  requireViews(line);
  refuseNoiseOfViews(line);
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

} // namespace

bool
readEvaluateOptions(const std::string& program, int argc, char** argv, EvaluateOptions& o,
                    Things& things)
{
  Contents contents;
  CommandLine line(program, "ITEM...",
                   "Generates scenes of the ITEMs (see pcl_surflet_generate), lets one or more "
                   "methods interpret them and\ncounts what was found: classification rate and "
                   "accuracy [Wahl 2007, Eq. 5.9, 5.10], strict rate, recall,\nprecision, false "
                   "clusters. classic_vfh and classic_esf remove planes, cluster what is left and "
                   "name\nclusters by their nearest neighbour; exclusion_vfh leaves out the empty "
                   "scene in place of planes.");
  addNames(line, "-method", "default dissertation", recogniserNames(), o.methods);
  addParameters(line, o.recogniser, o.bins);
  addScenes(line, o, contents);
  addSeries(line, o, contents);
  std::uint64_t steps = o.recogniser.dissertation.floating.steps, runs = 8;
  addExtensions(line, o, steps, runs);
  addOutput(line, o);
  if (!line.parse(argc, argv))
    return false;
  line.requireFiles(1, 1000);
  things = thingsOf(line, contents);
  settle(o, line, contents, things);
  o.recogniser.dissertation.floating.steps = static_cast<unsigned>(steps);
  o.recogniser.dissertation.floating.keep_paths = o.study == Study::Paths;
  o.accumulation.runs = runs;
  return true;
}

} // namespace apps
} // namespace pcl_surflet
