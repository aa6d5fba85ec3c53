// Makes labelled scenes of objects on a background, with the truth about them.

#include "app_common.h"
#include "labelled_pcd.h"
#include "scene_items.h"
#include "sensor_options.h"

#include "pcl_surflet/core/counter_random.h"

#include <cstdio>
#include <filesystem>
#include <set>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_generate";

struct Outputs {
  std::string scene, poses, empty, models, scans, alone;
};

/** \brief What is to be made, and of what. */
struct Job {
  SceneOptions scene;
  SceneSensing sensing;
  std::vector<SceneItem> objects, clutter;
  Outputs out;
};

constexpr std::uint64_t kEmptyStream = 0x656d7074ULL, kAloneStream = 0x616c6f6eULL;

std::string
asPoses(const Scene& scene)
{
  std::string text = "object,label,instance,known";
  for (const char* row : {"0", "1", "2", "3"})
    for (const char* column : {"0", "1", "2", "3"})
      text += std::string(",m") + row + column;
  text += ",cx,cy,cz,points\n";
  for (std::size_t k = 0; k < scene.items.size(); ++k) {
    const auto& item = scene.items[k];
    text += csvField(item.label) + "," + std::to_string(item.number) + "," + std::to_string(k + 1) +
            (item.clutter ? ",0" : ",1");
    for (const double v : item.pose)
      text += "," + number(v);
    for (const double v : item.centroid)
      text += "," + number(v);
    text += "," + std::to_string(item.surflets) + "\n";
  }
  return text;
}

std::string
inDirectory(const std::string& directory, const std::string& name)
{
  std::error_code failure; // writeFile() will say it better
  std::filesystem::create_directories(directory, failure);
  return (std::filesystem::path(directory) / name).string();
}

/** \brief Looks at the scene in place of taking complete surfaces. */
Scene
seen(const Scene& complete, const Job& job)
{
  const auto scans = senseViews(bodiesOf(complete, job.objects, job.clutter, job.scene),
                                job.sensing, job.scene.seed);
  if (!job.out.scans.empty())
    for (std::size_t k = 0; k < scans.size(); ++k) {
      char name[32];
      std::snprintf(name, sizeof(name), "scan_%02zu.pcd", k);
      writeFile(inDirectory(job.out.scans, name), asPcd(scans[k]));
    }
  return sensedScene(complete, scans);
}

void
writeBackground(const Job& job, bool sensed)
{
  const SurfletSet empty = sensed
                               ? sensedSurflets(senseViews(backgroundBodies(job.scene), job.sensing,
                                                           mix64(job.scene.seed ^ kEmptyStream)))
                               : emptyBackground(job.scene);
  writeFile(job.out.empty, asPcd(empty, nullptr));
}

/** \brief Every object by itself, seen from all sides but below. */
void
writeAlone(const Job& job)
{
  SceneSensing sensing = job.sensing;
  if (sensing.views.views != ViewSet::All24)
    sensing.views.views = ViewSet::Ring24;
  for (const auto& item : job.objects)
    writeFile(inDirectory(job.out.alone, item.label + ".pcd"),
              asPcd(senseAlone(item, sensing, mix64(job.scene.seed ^ kAloneStream)), nullptr));
}

void
addOutputs(CommandLine& line, Outputs& out)
{
  line.text("-out", "SCENE.pcd",
            "labelled scene: 0 background, i the i-th ITEM, then clutter (required)", out.scene);
  line.text("-poses", "POSES.csv", "pose (item to scene), centroid and points of what is there",
            out.poses);
  line.text("-empty", "EMPTY.pcd", "the same background without objects", out.empty);
  line.text("-models", "DIR", "every ITEM by itself as DIR/NAME.off, upright, to train models from",
            out.models);
  line.text("-scans", "DIR",
            "with -views: each view as an organised cloud DIR/scan_NN.pcd in its sensor's frame; "
            "VIEWPOINT is the sensor's pose",
            out.scans);
  line.text("-alone", "DIR",
            "with -views: what the sensor sees of every ITEM by itself, upright, from 24 places "
            "(of the ring, or all24), as DIR/NAME.pcd",
            out.alone);
}

void
write(const Job& job, bool sensed)
{
  const Outputs& out = job.out;
  const Scene complete = generateScene(job.objects, job.clutter, job.scene);
  const Scene scene = sensed ? seen(complete, job) : complete;
  const PointLabels labels{scene.labels, scene.instances};
  writeFile(out.scene, asPcd(scene.surflets, &labels));
  if (!out.poses.empty())
    writeFile(out.poses, asPoses(scene));
  if (!out.empty.empty())
    writeBackground(job, sensed);
  if (!out.alone.empty())
    writeAlone(job);
  note("wrote '" + out.scene + "': " + std::to_string(scene.surflets.size()) + " points, " +
       std::to_string(scene.items.size()) + " items");
}

/** \brief Options that say something about sensors only, or about complete surfaces only. */
void
requireConsistent(const CommandLine& line)
{
  const bool sensed = line.given("-views");
  for (const char* option : {"-scans", "-alone"})
    if (line.given(option) && !sensed)
      throw UsageError(std::string("option ") + option + ": give -views, too");
  requireViews(line);
  refuseNoiseOfViews(line);
}

/** \brief Before the first file is written. */
void
checkOutputs(const Outputs& out)
{
  std::set<std::filesystem::path> files;
  for (const auto& path : {out.scene, out.poses, out.empty}) {
    checkOutput(path);
    if (!path.empty() && !files.insert(std::filesystem::weakly_canonical(path)).second)
      throw DataError("not written: '" + path + "' is named twice; give another name");
  }
  for (const auto& path : {out.scene, out.empty})
    requirePcdName(path);
}

int
generate(int argc, char** argv)
{
  Job job;
  SceneOptions& o = job.scene;
  SceneContents contents;
  std::uint64_t threads = 0;
  CommandLine line(kProgram, "ITEM...",
                   "Makes a labelled scene of objects on a background. ITEM is the name of a shape "
                   "(see pcl_surflet_generate_shape)\nor FILE[:DIAMETER[:UP]], a mesh, its "
                   "diameter in the scene and which of its axes (x, y, z, -x, -y, -z) points up.");
  addOutputs(line, job.out);
  addContents(line, contents);
  addArrangement(line, o);
  addSensor(line, job.sensing);
  addSeed(line, o.seed);
  addThreads(line, threads);
  if (!line.parse(argc, argv))
    return kOk;
  line.require("-out");
  line.requireFiles(1, 1000);
  requireConsistent(line);
  checkOutputs(job.out);
  job.sensing.threads = static_cast<unsigned>(threads);
  job.objects = itemsOf(line.files());
  job.clutter = clutterOf(line, contents);
  settleContents(line, contents, job.objects.size(), job.clutter.size(), o);
  if (line.given("-models"))
    saveMeshes(line.files(), job.out.models);
  write(job, line.given("-views"));
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return generate(argc, argv); });
}
