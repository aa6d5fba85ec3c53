// Runs the experiments of the dissertation and prints what they show.

#include "app_common.h"
#include "experiment/chapter3.h"
#include "experiment/output.h"
#include "experiment/peers/peer_recognisers.h"
#include "experiment/space_report.h"

#include <algorithm>
#include <functional>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_experiment";

/** \brief The options of all experiments: an option may stand before the NAME it belongs to, so the
 * line is read before the experiment is known. */
struct Options {
  std::string meshes, out, objects, peers = peerNames(), strangers = strangerNames();
  std::uint64_t tests = 0; ///< 0: the experiment's own number
  std::uint64_t intervals = ChapterOptions().intervals, skip = 0,
                saturations = SpaceOptions().saturations, radii = SpaceOptions().radii,
                queries = SpaceOptions().queries, seed = 1, threads = 0;
  double normal_radius = ChapterOptions().normal_radius;
};

struct Experiment {
  const char* name;
  const char* help;
  std::uint64_t tests;                      ///< per object and condition unless -tests is given
  std::vector<std::string> needed, allowed; ///< options
  std::function<int(const Options&, std::uint64_t tests)> run;
};

/** \brief An experiment of chapter 3. */
Experiment
ofChapter3(const char* name, const char* help, std::uint64_t tests,
           int (*run)(const ChapterOptions&), const std::vector<std::string>& more = {},
           const std::vector<std::string>& labels_by_default = experimentLabels())
{
  std::vector<std::string> allowed = {"-objects", "-tests", "-seed", "-threads"};
  allowed.insert(allowed.end(), more.begin(), more.end());
  const auto start = [=](const Options& o, std::uint64_t number) {
    const auto labels = o.objects.empty() ? labels_by_default : namesIn(o.objects);
    return run({{o.meshes, o.out, labels, number, o.seed, o.threads, o.skip},
                o.normal_radius,
                o.intervals,
                namesIn(o.peers),
                namesIn(o.strangers)});
  };
  return {name, help, tests, {"-meshes", "-out"}, allowed, start};
}

const std::vector<Experiment>&
experiments()
{
  static const std::vector<Experiment> all = {
      ofChapter3("classification", "rates of 20 objects, ideal, noisy and cut, by the likelihood",
                 100, runClassification),
      ofChapter3("criteria", "Table 3.1, Fig. 3.4: six criteria, ideal data, confusion matrices",
                 100, runCriteria),
      ofChapter3("noise", "Fig. 3.5: noise along the normals", 50, runNoise, {"-normal_radius"}),
      ofChapter3("visibility", "Fig. 3.6: share left by a random plane", 50, runVisibility),
      ofChapter3("resolution", "Fig. 3.7: query spacing other than in training", 50, runResolution),
      ofChapter3("elongation", "Fig. 3.9: one principal axis 0.4 to 2 times as long", 20,
                 runElongation, {"-intervals"}),
      ofChapter3("distortion", "Fig. 3.8, 3.10-3.14: one to three axes 0.2 to 2.3 times as long",
                 20, runDistortion, {"-intervals"}),
      ofChapter3("peers", "our recognisers beside PCL's global descriptors, same queries", 50,
                 runPeers, {"-peers", "-skip"}),
      ofChapter3("rejection", "unknown objects: how many strangers a model bank accepts", 5,
                 runRejection, {"-strangers"}),
      ofChapter3("retrieval", "collections with classes: tiers, precision over recall", 20,
                 runRetrieval, {}, allLabels()),
      {"space",
       "Exp. 4.6, Fig. 4.8: region search in a uniform cube; times and memory",
       0,
       {"-out"},
       {"-saturations", "-radii", "-queries", "-seed"},
       [](const Options& o, std::uint64_t) {
         return reportSpace({o.out, o.saturations, o.radii, o.queries, o.seed});
       }}};
  return all;
}

/** \brief The experiments' names, and what they do if \p explained. */
std::string
experimentList(bool explained)
{
  std::string out;
  for (const auto& e : experiments())
    out += explained ? formatted("\n  %-15s %s", e.name, e.help)
                     : (out.empty() ? "" : ", ") + std::string(e.name);
  return out;
}

std::string
testsByDefault()
{
  std::string out;
  for (const auto& e : experiments())
    if (e.tests > 0)
      out += (out.empty() ? "" : ", ") + std::string(e.name) + " " + std::to_string(e.tests);
  return out;
}

void
addChapter3Options(CommandLine& line, Options& o)
{
  line.text("-meshes", "DIR",
            "chapter 3: directory of the objects' OFF meshes, those of the Debian package "
            "libcgal-demo (required)",
            o.meshes);
  line.text("-objects", "LIST", "chapter 3: names of other meshes there, by commas", o.objects);
  line.count("-tests", "N",
             "chapter 3: tests per object and condition (retrieval: models per class), default: " +
                 testsByDefault(),
             o.tests, 1, 1000000);
  line.real("-normal_radius", "R",
            "noise: estimate normals within R spacings, default " + number(o.normal_radius),
            o.normal_radius, 1, 20);
  line.count("-intervals", "N",
             "elongation, distortion: steps, default " + std::to_string(o.intervals), o.intervals,
             1, 1000);
  line.text("-peers", "LIST", "peers: descriptors that take part, default " + o.peers, o.peers);
  line.count("-skip", "N",
             "peers: leave out the first N conditions, to go on with a run that was ended", o.skip,
             0, 11);
  line.text("-strangers", "LIST", "rejection: meshes that are not in the database, by commas",
            o.strangers);
}

CommandLine
commandLine(Options& o)
{
  CommandLine line(kProgram, "NAME",
                   "Runs an experiment of the dissertation and prints its result.\nNAME:" +
                       experimentList(true));
  const auto of = [](std::uint64_t value) { return ", default " + std::to_string(value); };
  line.text("-out", "DIR", "directory for results, made if missing (required)", o.out);
  addChapter3Options(line, o);
  line.count("-saturations", "N", "space: steps of the saturation" + of(o.saturations),
             o.saturations, 1, 1000);
  line.count("-radii", "N", "space: steps of the radius" + of(o.radii), o.radii, 1, 1000);
  line.count("-queries", "N", "space: searches per saturation and radius" + of(o.queries),
             o.queries, 1, 1000000);
  addSeed(line, o.seed);
  addThreads(line, o.threads);
  return line;
}

/** \brief An option that the experiment would not heed is a mistake of the user's. */
void
checkOptions(const CommandLine& line, const Experiment& experiment)
{
  const auto& needed = experiment.needed;
  const auto& allowed = experiment.allowed;
  for (const auto& option : needed)
    line.require(option);
  for (const auto& other : experiments())
    for (const auto* list : {&other.needed, &other.allowed})
      for (const auto& option : *list)
        if (line.given(option) && std::find(needed.begin(), needed.end(), option) == needed.end() &&
            std::find(allowed.begin(), allowed.end(), option) == allowed.end())
          throw UsageError("option " + option + " is not one of the experiment " + experiment.name);
}

int
run(int argc, char** argv)
{
  Options options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(1, 1);
  for (const auto& experiment : experiments())
    if (line.files()[0] == experiment.name) {
      checkOptions(line, experiment);
      return experiment.run(options, options.tests > 0 ? options.tests : experiment.tests);
    }
  throw UsageError("unknown experiment '" + line.files()[0] + "'; known: " + experimentList(false));
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return run(argc, argv); });
}
