// What is where in a scene?

#include "app_common.h"
#include "labelled_pcd.h"
#include "picture.h"
#include "poses.h"
#include "scene_items.h"

#include "pcl_surflet/scene_interpreter.h"
#include "pcl_surflet/surface_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <unistd.h>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_interpret";

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Interpreter = SceneInterpreter<pcl::PointNormal>;

struct Options {
  std::string database, empty, out, objects_dir, picture;
  Method method = Method::Explanation;
  BackgroundTreatment background = BackgroundTreatment::Ignore;
  double leaf = 0, distance = 0;
  double min_confidence = 0.1; ///< of what is below, few are right: detail::confidenceOf()
  std::uint64_t planes = 0, neighbours = 0, threads = 0, detections = 0, seed = 1;
  bool csv = false, verbose = false;
  PoseJob pose;
};

SurfletSet
surfletsIn(const std::string& path, const Options& o)
{
  SurfaceFileOptions options;
  options.estimate_normals = static_cast<int>(o.neighbours);
  options.threads = static_cast<unsigned>(o.threads);
  SurfaceFile file = loadSurface(path, options);
  if (file.mesh)
    throw DataError(path + ": is a mesh; give a cloud with normals");
  if (file.rejected > 0)
    note(path + ": left out " + std::to_string(file.rejected) +
         " points that are not finite or have no usable normal");
  return std::move(file.surflets);
}

Cloud::Ptr
cloudOf(const SurfletSet& set)
{
  Cloud::Ptr cloud(new Cloud);
  cloud->reserve(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    pcl::PointNormal p;
    p.getVector3fMap() << set.x[i], set.y[i], set.z[i];
    p.getNormalVector3fMap() << set.nx[i], set.ny[i], set.nz[i];
    cloud->push_back(p);
  }
  return cloud;
}

/** \brief Instances are numbered in the order of the detections, as the objects' files are. */
PointLabels
labelsOf(std::size_t points, const std::vector<SceneDetection>& detections)
{
  PointLabels labels{std::vector<std::uint32_t>(points), std::vector<std::uint32_t>(points)};
  for (std::size_t k = 0; k < detections.size(); ++k)
    for (const auto i : detections[k].indices) {
      labels.labels[static_cast<std::size_t>(i)] =
          static_cast<std::uint32_t>(detections[k].model + 1);
      labels.instances[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(k + 1);
    }
  return labels;
}

/** \brief \p label as part of a file name: what could lead elsewhere becomes '_'. */
std::string
fileName(std::string label)
{
  for (char& c : label)
    if (c == '/' || c == '\\' || c == ':' || c == ' ')
      c = '_';
  return label;
}

/** \brief One PCD an object: DIR/SCENE_1_cup.pcd. */
void
writeObjects(const std::string& path, const SurfletSet& scene,
             const std::vector<SceneDetection>& detections, const std::string& directory)
{
  std::error_code failure;
  std::filesystem::create_directories(directory, failure); // writeFile() will say it better
  for (std::size_t k = 0; k < detections.size(); ++k) {
    const auto& d = detections[k];
    const std::vector<std::uint32_t> points(d.indices.begin(), d.indices.end());
    const std::string name =
        stemOf(path) + "_" + std::to_string(k + 1) + "_" + fileName(d.label) + ".pcd";
    writeFile((std::filesystem::path(directory) / name).string(),
              asPcd(scene.subset(points), nullptr));
  }
}

/** \brief A file that is gone with the object. */
struct TemporaryFile {
  std::string path;
  explicit TemporaryFile(const std::string& what)
      : path((std::filesystem::temp_directory_path() /
              ("pcl_surflet_interpret_" + std::to_string(::getpid()) + what + ".pcd"))
                 .string())
  {
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile()
  {
    std::error_code failure;
    std::filesystem::remove(path, failure);
  }
};

void
writeResults(const std::string& path, const SurfletSet& scene,
             const std::vector<SceneDetection>& found, const std::vector<PoseEstimate>& poses,
             const Options& o)
{
  if (!o.objects_dir.empty())
    writeObjects(path, scene, found, o.objects_dir);
  if (o.out.empty() && o.picture.empty())
    return;
  const PointLabels labels = labelsOf(scene.size(), found);
  const TemporaryFile temporary(""), overlay("_poses");
  const std::string labelled = o.out.empty() ? temporary.path : o.out;
  writeFile(labelled, asPcd(scene, &labels));
  if (o.picture.empty())
    return;
  const SurfletSet surfaces = o.pose.surfaces(found, poses);
  if (!surfaces.empty())
    writeFile(overlay.path, asPcd(surfaces, nullptr));
  drawPicture(labelled, o.database, o.picture, surfaces.empty() ? "" : overlay.path);
}

/** \brief Empty for what is unknown: NaN is no number of a table. */
std::string
numberOrNothing(double value)
{
  return std::isnan(value) ? "" : number(value);
}

void
printCsv(const std::string& path, const SceneDetection& d, const PoseEstimate* pose)
{
  std::string line =
      csvField(path) + "," + csvField(d.label) + "," + std::to_string(d.indices.size());
  for (const double v :
       {d.centre[0], d.centre[1], d.centre[2], d.score, d.fit, d.confidence, d.coverage})
    line += "," + numberOrNothing(v);
  if (pose != nullptr)
    line += poseCsv(*pose);
  std::puts(line.c_str());
}

void
print(const std::string& path, const std::vector<SceneDetection>& detections,
      const std::vector<PoseEstimate>& poses, const SceneDiagnostics& diagnostics, bool csv)
{
  for (std::size_t k = 0; k < detections.size(); ++k) {
    const auto& d = detections[k];
    const PoseEstimate* pose = k < poses.size() ? &poses[k] : nullptr;
    if (csv) {
      printCsv(path, d, pose);
      continue;
    }
    const auto& c = d.centre;
    std::printf("%s: %-16s at %8.4f %8.4f %8.4f, %7zu points, confidence %4.2f", path.c_str(),
                d.label.c_str(), c[0], c[1], c[2], d.indices.size(), d.confidence);
    std::printf(std::isnan(d.coverage) ? "\n" : ", coverage %4.2f\n", d.coverage);
    if (pose != nullptr)
      std::printf("%s: %-16s %s\n", path.c_str(), d.label.c_str(), poseText(*pose).c_str());
  }
  if (detections.empty() && !csv)
    std::printf("%s: nothing found: %s\n", path.c_str(),
                diagnostics.reason.empty() ? "nothing is sure enough, see -min_confidence"
                                           : diagnostics.reason.c_str());
}

using Count = unsigned long long;

void
printScene(const SceneDiagnostics& d)
{
  std::fprintf(stderr,
               "points %zu, background %zu (planes %zu), cells %zu of %g, extent %g, largest model "
               "%g\n",
               d.points, d.background_points, d.planes, d.cells, d.leaf, d.extent, d.largest_model);
}

/** \brief What Method::Explanation did. */
void
printExplanations(const SceneDiagnostics& d)
{
  std::fprintf(stderr,
               "background cells %zu\n"
               "                 |       scan        |            choice           |\n"
               "model            |  places promising | explained  no fit      lost | found\n",
               d.background_cells);
  for (const auto& m : d.models)
    std::fprintf(stderr, "%-16.16s | %7zu %9zu | %9zu %7zu %9zu | %5zu\n", m.label.c_str(),
                 m.places, m.promising, m.explanations, m.died_fit, m.lost, m.detections);
}

/** \brief What Method::Dissertation did. */
void
printSteps(const SceneDiagnostics& d)
{
  std::fprintf(stderr, "pairs drawn %llu, too long %llu, without feature %llu, background %llu\n",
               Count{d.drawn}, Count{d.too_long}, Count{d.featureless}, Count{d.background});
  std::fprintf(stderr,
               "                 |  1 selected       |  2 seeds  3 cleared | 4 lone  clusters |"
               " 5 distr. | 6 small relative | 7 merged  lost |\n"
               "model            |   pairs  surflets |                    |                  |"
               "          |                  |                | found\n");
  for (const auto& m : d.models)
    std::fprintf(stderr,
                 "%-16.16s | %7llu %9zu | %8zu %9zu | %6zu %9zu | %8zu | %7zu %8zu | %8zu %5zu | "
                 "%5zu\n",
                 m.label.c_str(), Count{m.pairs}, m.surflets, m.seeds, m.seeds_cleared,
                 m.seeds_lone, m.clusters, m.died_distribution, m.died_small, m.died_relative,
                 m.merged, m.lost, m.detections);
}

/** \brief An interpreter as the options want it. */
Interpreter
interpreterFor(const ModelDatabase& database, const Options& o)
{
  Interpreter interpreter;
  interpreter.setDatabase(database);
  interpreter.setMethod(o.method);
  interpreter.setBackgroundTreatment(o.background);
  interpreter.setLeafSize(o.leaf);
  interpreter.setSeed(o.seed);
  interpreter.setNumberOfThreads(static_cast<unsigned>(o.threads));
  interpreter.setMaximumDetections(o.detections);
  ExclusionOptions exclusion;
  exclusion.distance = o.distance;
  interpreter.setExclusionOptions(exclusion);
  if (o.planes > 0)
    interpreter.setBackgroundPlanes(std::vector<BackgroundPlane>(o.planes));
  if (!o.empty.empty())
    interpreter.setBackgroundCloud(cloudOf(surfletsIn(o.empty, o)));
  return interpreter;
}

/** \return how many */
std::size_t
removeDoubtful(double min_confidence, std::vector<SceneDetection>& found)
{
  const auto end = std::remove_if(found.begin(), found.end(), [=](const SceneDetection& d) {
    return d.confidence < min_confidence;
  });
  const auto removed = static_cast<std::size_t>(found.end() - end);
  found.erase(end, found.end());
  return removed;
}

void
interpret(const std::string& path, Interpreter& interpreter, const Options& o)
{
  const SurfletSet scene = surfletsIn(path, o);
  const Cloud::Ptr cloud = cloudOf(scene);
  interpreter.setInputCloud(cloud);
  auto found = interpreter.interpret();
  const auto& diagnostics = interpreter.getDiagnostics();
  if (diagnostics.status > SceneStatus::Cancelled)
    throw DataError(diagnostics.reason);
  const std::size_t doubtful = removeDoubtful(o.min_confidence, found);
  if (doubtful > 0)
    note(path + ": left out " + std::to_string(doubtful) + " of a confidence below " +
         number(o.min_confidence) + ", see -min_confidence");
  const auto poses = o.pose.estimate(cloud, found, o.seed);
  print(path, found, poses, diagnostics, o.csv);
  if (o.verbose) {
    printScene(diagnostics);
    (o.method == Method::Explanation ? printExplanations : printSteps)(diagnostics);
  }
  writeResults(path, scene, found, poses, o);
}

/** \brief Goes on after a file that cannot be used. \return exit code */
int
interpretAll(const std::vector<std::string>& files, const Options& o)
{
  Interpreter interpreter = interpreterFor(readDatabase(o.database), o);
  int code = kOk;
  if (o.csv)
    std::puts(("file,label,points,x,y,z,score,fit,confidence,coverage" +
               (o.pose.models.empty() ? "" : poseCsvHeader()))
                  .c_str());
  for (const auto& path : files)
    try {
      interpret(path, interpreter, o);
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
  line.text("-database", "DB.pcd", "models, made by pcl_surflet_train (best with -bins 7,7,7,7)",
            o.database);
  addChoice<Method>(line, "-method", "default explanation", o.method,
                    {{"explanation", Method::Explanation}, {"dissertation", Method::Dissertation}});
  addChoice<BackgroundTreatment>(line, "-background", "default ignore", o.background,
                                 {{"ignore", BackgroundTreatment::Ignore},
                                  {"exclude", BackgroundTreatment::Exclude},
                                  {"model", BackgroundTreatment::Model}});
  line.text("-empty", "EMPTY.pcd", "exclude: the scene sensed without objects", o.empty);
  line.count("-planes", "N", "exclude: the N largest planes, 1 for a table, 2 for a shelf",
             o.planes, 1, 100);
  line.real("-distance", "D", "exclude: what is so near to the background, default a cell",
            o.distance, 1e-9, 1e9);
  line.real("-leaf", "S", "edge of the cells, default a fiftieth of the largest model", o.leaf,
            1e-9, 1e9);
  line.count("-max", "N", "detections, those of the most points, default all", o.detections, 1,
             1000000);
  line.real("-min_confidence", "X", "explanation: leaves out what is less sure, default 0.1",
            o.min_confidence, 0, 1);
  line.text("-out", "OUT.pcd",
            "labelled points: 0 none, else number in the database, from 1; one scene only", o.out);
  line.text("-objects_dir", "DIR", "every object by itself as DIR/SCENE_NUMBER_NAME.pcd",
            o.objects_dir);
  line.text("-picture", "OUT.png",
            "the scene with its objects coloured and named, and with -pose the models as dark "
            "points; one scene only",
            o.picture);
  o.pose.addOptions(line);
  line.flag("-csv", "prints CSV", o.csv);
  line.flag("-verbose", "prints what each step did for each model to stderr", o.verbose);
  addNeighbours(line, o.neighbours);
  addSeed(line, o.seed);
  addThreads(line, o.threads);
}

void
checkBackground(const CommandLine& line, const Options& o)
{
  const bool excludes = o.background == BackgroundTreatment::Exclude;
  for (const char* name : {"-empty", "-planes", "-distance"})
    if (!excludes && line.given(name))
      throw UsageError(std::string("option ") + name + " goes with -background exclude");
  if (excludes && !line.given("-empty") && !line.given("-planes"))
    throw UsageError("option -background exclude needs -empty or -planes");
}

int
run(int argc, char** argv)
{
  Options o;
  CommandLine line(kProgram, "SCENE...",
                   "Finds and names the objects of scenes (PCD or PLY with normals, or see -k).");
  addOptions(line, o);
  if (!line.parse(argc, argv))
    return kOk;
  line.require("-database");
  line.requireFiles(1, line.given("-out") || line.given("-picture") ? 1 : 1000000);
  checkBackground(line, o);
  if (o.method == Method::Dissertation && !line.given("-min_confidence"))
    o.min_confidence = 0; // its confidence is not calibrated
  if (line.given("-viewpoints") && !line.given("-pose"))
    throw UsageError("option -viewpoints goes with -pose");
  o.pose.load();
  return interpretAll(line.files(), o);
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return run(argc, argv); });
}
