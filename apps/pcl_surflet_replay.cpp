// How does the interpretation grow with the scans?

#include "app_common.h"
#include "labelled_pcd.h"
#include "model_cells.h"

#include "pcl_adapters/pcd_content.h"
#include "pcl_surflet/online_scene_interpreter.h"
#include "pcl_surflet/scene_interpreter.h"
#include "pcl_surflet/surface_file.h"

#include <pcl/conversions.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_replay";
struct Options {
  std::string database, empty, out;
  BackgroundTreatment background = BackgroundTreatment::Ignore;
  double leaf = 0, behind = OnlineParameters().behind;
  std::uint64_t seed = 1, threads = 0;
  bool csv = false;
};

pcl::PointCloud<pcl::PointNormal>
readScan(const std::string& path)
{
  SourcePoints content;
  if (const auto problem = detail::readPcd(path, content); !problem.empty())
    throw DataError(path + ": " + problem + "; give a scan in PCD");
  for (const char* name : {"x", "y", "z", "normal_x", "normal_y", "normal_z"}) {
    bool is_there = false;
    for (const auto& field : content.cloud.fields)
      is_there = is_there || (field.name == name && field.datatype == pcl::PCLPointField::FLOAT32);
    if (!is_there)
      throw DataError(path + ": has no field " + name +
                      " of 4-byte floats; give scans with normals, as pcl_surflet_generate -scans "
                      "writes them");
  }
  pcl::PointCloud<pcl::PointNormal> cloud;
  pcl::fromPCLPointCloud2(content.cloud, cloud);
  cloud.sensor_origin_ = content.origin;
  cloud.sensor_orientation_ = content.orientation;
  return cloud;
}

const char*
nameOf(OnlineState state)
{
  switch (state) {
  case OnlineState::New:
    return "new";
  case OnlineState::Updated:
    return "updated";
  case OnlineState::Kept:
    return "kept";
  case OnlineState::Vanished:
    break;
  }
  return "vanished";
}

/** \brief As "1 cup new, 2 bottle kept". */
std::string
textOf(const std::vector<OnlineDetection>& detections)
{
  std::string text;
  for (const auto& d : detections)
    text +=
        (text.empty() ? "" : ", ") + std::to_string(d.id) + " " + d.label + " " + nameOf(d.state);
  return text;
}

/** \brief A direction in words; it is 0 where normals cancel out. */
std::string
sideOf(const std::array<double, 3>& direction)
{
  if (direction == std::array<double, 3>{})
    return "any side";
  char text[64];
  std::snprintf(text, sizeof text, "the side of %.2f %.2f %.2f", direction[0], direction[1],
                direction[2]);
  return text;
}

void
print(const std::string& path, const OnlineScan& scan, const OnlineInterpretation& online,
      double seconds, bool csv)
{
  const std::string found = textOf(online.detections());
  if (csv) {
    std::printf("%s,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%s,%zu,%zu,%s\n", csvField(path).c_str(),
                scan.surflets, scan.cells, scan.changed_cells, scan.vanished_cells,
                scan.interpreted_cells, scan.kept, scan.sought, csvField(found).c_str(),
                online.attractors().size(), online.distractors().size(), number(seconds).c_str());
    return;
  }
  std::printf("%s: %zu points, %zu cells, %zu changed, %zu vanished, %zu interpreted, %.2f s: %s\n",
              path.c_str(), scan.surflets, scan.cells, scan.changed_cells, scan.vanished_cells,
              scan.interpreted_cells, seconds, found.empty() ? "nothing found" : found.c_str());
  for (const auto& a : online.attractors())
    std::printf("  look at %.3f %.3f %.3f from %s (%s)\n", a.centre[0], a.centre[1], a.centre[2],
                sideOf(a.view_from).c_str(),
                a.id == 0 ? "unexplained" : ("detection " + std::to_string(a.id)).c_str());
}

OnlineParameters
parametersFor(const ModelDatabase& database, const Options& o)
{
  OnlineParameters p;
  p.leaf = detail::leafOf(o.leaf, database);
  p.behind = o.behind;
  p.explanation.steps.background = o.background;
  p.explanation.steps.seed = o.seed;
  p.explanation.steps.threads = static_cast<unsigned>(o.threads);
  if (!o.empty.empty()) {
    const SurfaceFile file = loadSurface(o.empty);
    if (file.mesh)
      throw DataError(o.empty + ": is a mesh; give a cloud with normals");
    p.empty_scene = file.surflets;
    p.explanation.steps.background = BackgroundTreatment::Exclude;
  }
  return p;
}

void
writeLabels(const std::string& path, const OnlineInterpretation& online)
{
  const std::size_t n = online.cells().size();
  std::vector<std::uint32_t> label(n), instance(n);
  for (const auto& d : online.detections())
    for (const auto c : d.cells)
      if (d.state != OnlineState::Vanished) {
        label[c] = static_cast<std::uint32_t>(d.model + 1);
        instance[c] = static_cast<std::uint32_t>(d.id);
      }
  SurfletSet there; // cells that vanished hold NaN
  PointLabels labels;
  for (std::size_t c = 0; c < n; ++c)
    if (there.appendChecked(online.cells()[c])) {
      labels.labels.push_back(label[c]);
      labels.instances.push_back(instance[c]);
    }
  writeFile(path, asPcd(there, &labels));
}

/** \brief Goes on after a scan that cannot be used. \return exit code */
int
replay(const std::vector<std::string>& files, const Options& o)
{
  const ModelDatabase database = readDatabase(o.database);
  if (const auto text = otherCells(o.database, database, o.leaf); !text.empty())
    note(text);
  OnlineSceneInterpreter online(database, parametersFor(database, o));
  int code = kOk;
  if (o.csv)
    std::puts("file,points,cells,changed,vanished,interpreted,kept,sought,detections,attractors,"
              "distractors,seconds");
  for (const auto& path : files)
    try {
      const auto cloud = readScan(path);
      const auto begin = std::chrono::steady_clock::now();
      const OnlineScan scan = online.addScanInSensorFrame(cloud);
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
      print(path, scan, online, spent.count(), o.csv);
    }
    catch (const std::exception& error) {
      complain(std::string(kProgram) + ": " + about(path, error.what()));
      code = kBadData;
    }
  if (!o.out.empty())
    writeLabels(o.out, online);
  return code;
}

int
run(int argc, char** argv)
{
  Options o;
  CommandLine line(kProgram, "SCAN.pcd...",
                   "Takes in the scans of a scene one by one and tells after each what is found.\n"
                   "Scans lie in their sensor's frame; VIEWPOINT is its pose in the scene.");
  line.text("-database", "DB.pcd",
            "models, made by pcl_surflet_train -bins 7,7,7,7 -leaf S (required)", o.database);
  line.option("-background", "ignore|model", "default ignore", [&o](const std::string& text) {
    if (text != "ignore" && text != "model")
      throw UsageError("option -background is ignore or model; for exclude give -empty");
    o.background = text == "model" ? BackgroundTreatment::Model : BackgroundTreatment::Ignore;
  });
  line.text("-empty", "EMPTY.pcd", "the scene without objects, in its frame, to be left out",
            o.empty);
  line.real("-leaf", "S",
            "edge of the cells, default what all models were trained for, else a fiftieth of the "
            "largest",
            o.leaf, 1e-9, 1e9);
  line.real("-behind", "N",
            "a cell vanishes if rays past it end N leaves behind it, default 1.5; 0: never",
            o.behind, 0, 1e6);
  line.text("-out", "OUT.pcd",
            "the cells after the last scan; labels as pcl_surflet_interpret's, "
            "instances are ids",
            o.out);
  line.flag("-csv", "prints CSV", o.csv);
  addSeed(line, o.seed);
  addThreads(line, o.threads);
  if (!line.parse(argc, argv))
    return kOk;
  line.require("-database");
  line.requireFiles(1, 1000000);
  requirePcdName(o.out);
  checkOutput(o.out);
  return replay(line.files(), o);
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return run(argc, argv); });
}
