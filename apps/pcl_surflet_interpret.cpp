// What is where in a scene?

#include "app_common.h"
#include "scene_items.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/scene_interpreter.h"
#include "pcl_surflet/surface_file.h"

#include <cstdio>
#include <numeric>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_interpret";

struct Options {
  std::string database, empty, out;
  detail::InterpreterRequest request;
  std::uint64_t neighbours = 0, threads = 0, detections = 0;
  bool csv = false, verbose = false;
};

SurfletSet
surfletsIn(const std::string& path, const Options& o)
{
  SurfaceFileOptions options;
  options.estimate_normals = static_cast<int>(o.neighbours);
  options.threads = static_cast<unsigned>(o.threads);
  const SurfaceFile file = loadSurface(path, options);
  if (file.mesh)
    throw DataError(path + ": is a mesh; give a cloud with normals");
  if (file.rejected > 0)
    note(path + ": left out " + std::to_string(file.rejected) +
         " points that are not finite or have no usable normal");
  return file.surflets;
}

/** \brief The points to look at: all, or those that are not in the empty scene. */
ConvertedSurflets
pointsIn(const SurfletSet& scene, const Options& o)
{
  ConvertedSurflets points;
  if (o.request.parameters.steps.background != BackgroundTreatment::Exclude) {
    points.surflets = scene;
    points.indices.resize(scene.size());
    std::iota(points.indices.begin(), points.indices.end(), 0);
    return points;
  }
  const auto empty = reduceToCells(surfletsIn(o.empty, o), o.request.leaf).cells;
  const auto away = cellsAwayFrom(scene, empty, o.request.leaf);
  points.surflets = scene.subset(away);
  points.indices.assign(away.begin(), away.end());
  return points;
}

/** \brief ASCII PCD of x y z label; 0 nothing, else index in the database + 1. */
std::string
labelled(const SurfletSet& scene, const std::vector<SceneDetection>& detections)
{
  std::vector<std::size_t> labels(scene.size(), 0);
  for (const auto& d : detections)
    for (const auto i : d.indices)
      labels[static_cast<std::size_t>(i)] = d.model + 1;
  const std::string n = std::to_string(scene.size());
  std::string text = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z label\n"
                     "SIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH " +
                     n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA ascii\n";
  for (std::size_t i = 0; i < scene.size(); ++i)
    text.append(number(scene.x[i]) + " " + number(scene.y[i]) + " " + number(scene.z[i]) + " ")
        .append(std::to_string(labels[i]) + "\n");
  return text;
}

void
print(const std::string& path, const std::vector<SceneDetection>& detections, bool csv)
{
  for (const auto& d : detections) {
    const auto& c = d.centroid;
    if (csv)
      std::printf("%s,%s,%zu,%s,%s,%s,%s,%s\n", csvField(path).c_str(), csvField(d.label).c_str(),
                  d.indices.size(), number(c[0]).c_str(), number(c[1]).c_str(),
                  number(c[2]).c_str(), number(d.score).c_str(), number(d.fit).c_str());
    else
      std::printf("%s: %-16s at %8.4f %8.4f %8.4f, %7zu points, score %6.3f, fit %5.3f\n",
                  path.c_str(), d.label.c_str(), c[0], c[1], c[2], d.indices.size(), d.score,
                  d.fit);
  }
  if (detections.empty() && !csv)
    std::printf("%s: nothing found\n", path.c_str());
}

void
printSteps(const InterpretationDiagnostics& d)
{
  std::fprintf(stderr, "drawn %llu, too long %llu, without feature %llu, background %llu\n",
               static_cast<unsigned long long>(d.drawn),
               static_cast<unsigned long long>(d.too_long),
               static_cast<unsigned long long>(d.featureless),
               static_cast<unsigned long long>(d.background));
  for (const auto& m : d.models)
    std::fprintf(stderr,
                 "%-16s pairs %llu, surflets %zu; seeds %zu, cleared %zu, lone %zu; clusters %zu; "
                 "died: distribution %zu, small %zu, relative %zu; merged %zu, lost %zu; found "
                 "%zu\n",
                 m.label.c_str(), static_cast<unsigned long long>(m.pairs), m.surflets, m.seeds,
                 m.seeds_cleared, m.seeds_lone, m.clusters, m.died_distribution, m.died_small,
                 m.died_relative, m.merged, m.lost, m.detections);
}

void
interpret(const std::string& path, const ModelDatabase& database, const Options& o)
{
  const SurfletSet scene = surfletsIn(path, o);
  InterpretationDiagnostics diagnostics;
  const auto found = detail::interpretPoints(pointsIn(scene, o), database, o.request, diagnostics);
  print(path, found, o.csv);
  if (o.verbose)
    printSteps(diagnostics);
  if (!o.out.empty())
    writeFile(o.out, labelled(scene, found));
}

/** \brief Goes on after a file that cannot be used. \return exit code */
int
interpretAll(const std::vector<std::string>& files, const Options& o)
{
  const ModelDatabase database = readDatabase(o.database);
  int code = kOk;
  if (o.csv)
    std::puts("file,label,points,x,y,z,score,fit");
  for (const auto& path : files)
    try {
      interpret(path, database, o);
    }
    catch (const std::exception& error) {
      complain(about(path, error.what()));
      code = kBadData;
    }
  return code;
}

void
addOptions(CommandLine& line, Options& o)
{
  auto& steps = o.request.parameters.steps;
  line.text("-database", "DB.pcd", "models, made by pcl_surflet_train (best with -bins 7,7,7,7)",
            o.database);
  addChoice<Method>(line, "-method", "default explanation", o.request.method,
                    {{"explanation", Method::Explanation}, {"dissertation", Method::Dissertation}});
  addChoice<BackgroundTreatment>(line, "-background", "default ignore; exclude needs -empty",
                                 steps.background,
                                 {{"ignore", BackgroundTreatment::Ignore},
                                  {"exclude", BackgroundTreatment::Exclude},
                                  {"model", BackgroundTreatment::Model}});
  line.text("-empty", "EMPTY.pcd", "exclude: the scene sensed without objects", o.empty);
  line.real("-leaf", "S", "edge of the cells, default a fiftieth of the largest model",
            o.request.leaf, 1e-9, 1e9);
  line.count("-max", "N", "detections, those of the most points, default all", o.detections, 1,
             1000000);
  line.text("-out", "OUT.pcd", "labelled points: 0 none, else number in the database, from 1",
            o.out);
  line.flag("-csv", "prints CSV", o.csv);
  line.flag("-verbose", "prints what each step did to stderr", o.verbose);
  addNeighbours(line, o.neighbours);
  addSeed(line, steps.seed);
  addThreads(line, o.threads);
}

int
run(int argc, char** argv)
{
  Options o;
  CommandLine line(kProgram, "SCENE...", "Finds and names the objects of scenes.");
  addOptions(line, o);
  if (!line.parse(argc, argv))
    return kOk;
  line.require("-database");
  line.requireFiles(1, line.given("-out") ? 1 : 1000000);
  const auto treatment = o.request.parameters.steps.background;
  if ((treatment == BackgroundTreatment::Exclude) != line.given("-empty"))
    throw UsageError("option -empty goes with -background exclude");
  if (line.given("-empty"))
    line.require("-leaf");
  o.request.parameters.steps.threads = static_cast<unsigned>(o.threads);
  o.request.max_detections = o.detections;
  return interpretAll(line.files(), o);
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return run(argc, argv); });
}
