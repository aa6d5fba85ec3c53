// Runs the experiments of the dissertation and prints what they show.

#include "app_common.h"
#include "experiment/classification_report.h"
#include "experiment/space_report.h"

#include <algorithm>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_experiment";

/** \brief The options of all experiments: an option may stand before the NAME it belongs to, so the
 * line is read before the experiment is known. */
struct Options {
  std::string meshes, out;
  std::uint64_t tests = ClassificationOptions().tests, saturations = SpaceOptions().saturations,
                radii = SpaceOptions().radii, queries = SpaceOptions().queries, seed = 1,
                threads = 0;
};

struct Experiment {
  const char* name;
  std::vector<std::string> needed, allowed; ///< options
  int (*run)(const Options&);
};

int
classification(const Options& o)
{
  return reportClassification({o.meshes, o.out, o.tests, o.seed, o.threads});
}

int
space(const Options& o)
{
  return reportSpace({o.out, o.saturations, o.radii, o.queries, o.seed});
}

const std::vector<Experiment>&
experiments()
{
  static const std::vector<Experiment> all = {
      {"classification", {"-meshes", "-out"}, {"-tests", "-seed", "-threads"}, classification},
      {"space", {"-out"}, {"-saturations", "-radii", "-queries", "-seed"}, space}};
  return all;
}

CommandLine
commandLine(Options& o)
{
  CommandLine line(
      kProgram, "NAME",
      "Runs an experiment of the dissertation and prints its result.\n"
      "NAME: classification  Table 3.1, Fig. 3.5, 3.6: rates of 20 objects under ideal and\n"
      "                      disturbed conditions\n"
      "      space           Exp. 4.6, Fig. 4.8: region search in a uniform cube by a list, the\n"
      "                      octree, the AVL tree and the linear octree; times and memory");
  const auto of = [](std::uint64_t value) { return ", default " + std::to_string(value); };
  line.text("-out", "DIR", "directory for results, made if missing (needed)", o.out);
  line.text("-meshes", "DIR",
            "classification: directory of the OFF meshes of the Debian package libcgal-demo "
            "(needed)",
            o.meshes);
  line.count("-tests", "N", "classification: tests per object and condition" + of(o.tests), o.tests,
             1, 1000000);
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
  const auto& [name, needed, allowed, run] = experiment;
  for (const auto& option : needed)
    line.require(option);
  for (const auto& other : experiments())
    for (const auto* list : {&other.needed, &other.allowed})
      for (const auto& option : *list)
        if (line.given(option) && std::find(needed.begin(), needed.end(), option) == needed.end() &&
            std::find(allowed.begin(), allowed.end(), option) == allowed.end())
          throw UsageError("option " + option + " is not one of the experiment " + name);
}

int
run(int argc, char** argv)
{
  Options options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(1, 1);
  std::string known;
  for (const auto& experiment : experiments()) {
    if (line.files()[0] == experiment.name) {
      checkOptions(line, experiment);
      return experiment.run(options);
    }
    known += (known.empty() ? "" : ", ") + std::string(experiment.name);
  }
  throw UsageError("unknown experiment '" + line.files()[0] + "'; known: " + known);
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return run(argc, argv); });
}
