#include "interpretation/scene_worker.h"

#include "interpretation/selection.h"
#include "interpretation/text.h"
#include "labelled_pcd.h"
#include "model_cells.h"
#include "surfaces.h"

namespace pcl_surflet {
namespace apps {
namespace {

SurfaceFile
cloudIn(const std::string& path, const InterpretOptions& o, bool keep_points,
        std::vector<std::string>& notes)
{
  SurfaceFile file = readSurface(path, o.normals, o.threads, keep_points);
  if (file.mesh)
    throw DataError(path + ": is a mesh; give a cloud with normals");
  if (file.rejected > 0)
    notes.push_back(losses(path, file));
  return file;
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

/** \brief One PCD an object: SCENE_1_cup.pcd. */
std::vector<NamedContent>
objectFiles(const std::string& path, const SurfletSet& scene,
            const std::vector<SceneDetection>& detections)
{
  std::vector<NamedContent> files;
  for (const auto& d : detections) {
    const std::vector<std::uint32_t> points(d.indices.begin(), d.indices.end());
    files.push_back(
        {stemOf(path) + "_" + std::to_string(files.size() + 1) + "_" + fileName(d.label) + ".pcd",
         asPcd(scene.subset(points), nullptr)});
  }
  return files;
}

} // namespace

SceneWorker::SceneWorker(const ModelDatabase& database, const InterpretOptions& o,
                         std::vector<std::string>& notes)
    : o_(o)
{
  interpreter_.setDatabase(database);
  if (const auto text = otherCells(o.database, database, o.leaf); !text.empty())
    notes.push_back(text);
  interpreter_.setMethod(o.method);
  interpreter_.setBackgroundTreatment(o.background);
  interpreter_.setLeafSize(o.leaf);
  interpreter_.setSeed(o.seed);
  interpreter_.setNumberOfThreads(static_cast<unsigned>(o.threads));
  interpreter_.setMaximumDetections(o.pose.verify ? 0 : o.detections);
  auto parameters = interpreter_.getParameters();
  parameters.min_fit = o.pose.minFit();
  interpreter_.setParameters(parameters);
  ExclusionOptions exclusion;
  exclusion.distance = o.distance;
  interpreter_.setExclusionOptions(exclusion);
  if (o.planes > 0)
    interpreter_.setBackgroundPlanes(std::vector<BackgroundPlane>(o.planes));
  if (!o.empty.empty())
    interpreter_.setBackgroundCloud(cloudOf(cloudIn(o.empty, o, false, notes).surflets));
}

void
SceneWorker::interpretInto(const std::string& path, InterpretedScene& out)
{
  const bool labelled = !o_.out.empty() || !o_.picture.empty();
  const SurfaceFile file = cloudIn(path, o_, labelled, out.notes);
  const SurfletSet& scene = file.surflets;
  const auto cloud = cloudOf(scene);
  interpreter_.setInputCloud(cloud);
  auto found = interpreter_.interpret();
  const auto& diagnostics = interpreter_.getDiagnostics();
  if (diagnostics.status > SceneStatus::Cancelled)
    throw DataError(diagnostics.reason);
  Selection selection(o_, path, out.notes);
  selection.removeDoubtful(found);
  auto poses = o_.pose.estimate(cloud, found, o_.seed);
  selection.verify(found, poses);
  out.found = foundText(path, found, poses, diagnostics, o_.csv);
  if (o_.verbose)
    out.steps = stepsText(o_.method, diagnostics);
  if (!o_.objects_dir.empty())
    out.objects = objectFiles(path, scene, found);
  if (!labelled)
    return;
  out.labelled = asPcd(file, labelsOf(scene.size(), found));
  const SurfletSet surfaces = o_.pose.surfaces(found, poses);
  if (!o_.picture.empty() && !surfaces.empty())
    out.posed = asPcd(surfaces, nullptr);
}

InterpretedScene
SceneWorker::interpret(const std::string& path)
{
  InterpretedScene out;
  try {
    interpretInto(path, out);
  }
  catch (const std::exception& error) {
    out.error = error.what();
  }
  return out;
}

} // namespace apps
} // namespace pcl_surflet
