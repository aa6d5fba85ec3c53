#include "progress.h"
#include "steps.h"

#include "pcl_surflet/core/parallel.h"

namespace pcl_surflet {
namespace {

using namespace interpretation;

// Progress after the steps before and after those that run model by model.
constexpr double kPreselected = 0.2, kClustered = 0.95;

constexpr std::uint64_t kCheckStream = std::uint64_t{2} << 40;

/** \brief Steps 2 to 6 for one model. */
ClustersOfModel
clustersOf(const SceneData& scene, std::size_t model, const Indices& selected,
           const DissertationParameters& parameters, ModelDiagnostics& d)
{
  const auto merged = proposeClusters(scene, model, selected, parameters, d); // steps 2 to 4
  const std::uint64_t stream = kCheckStream + model * kModelStride;
  ClustersOfModel clusters;
  for (std::size_t j = 0; j < merged.size(); ++j) { // step 5
    Cluster c = merged[j];
    if (distributionFits(scene, model, stream + j, parameters, c))
      clusters.push_back(std::move(c));
  }
  d.died_distribution = merged.size() - clusters.size();
  dropSmallClusters(parameters, clusters, d); // step 6
  return clusters;
}

std::vector<Detection>
detectionsOf(const SceneData& scene, std::vector<ClustersOfModel>& clusters)
{
  std::vector<Detection> detections;
  for (std::size_t k = 0; k < clusters.size(); ++k)
    for (auto& c : clusters[k]) {
      Detection d;
      d.model = scene.models.all[k].index;
      d.label = scene.models.all[k].model->label;
      d.centre = d.centroid = centroidOf(scene.cells, c.surflets);
      d.score = c.margin;
      d.seeds = c.seeds;
      d.cells = std::move(c.surflets);
      detections.push_back(std::move(d));
    }
  return detections;
}

} // namespace

SceneInterpretation
interpretByDissertation(const SurfletSet& cells, const ModelDatabase& database,
                        const DissertationParameters& parameters)
{
  checkParameters(parameters);
  const PairSource source(cells);
  const SceneModels models =
      sceneModels(database, parameters.background == BackgroundTreatment::Model, source.scale(),
                  parameters.threads);
  checkModels(models, parameters);
  const SceneData scene{cells, source, models};

  SceneInterpretation result;
  auto& diagnostics = result.diagnostics;
  diagnostics = emptyDiagnostics(database);

  ProgressReport progress(parameters.progress, diagnostics.cancelled);
  if (!progress.goesOn(0))
    return result;
  const auto selected = preselect(scene, parameters, diagnostics); // step 1
  std::vector<ClustersOfModel> clusters(models.objects);
  progress.beginPart(kPreselected, kClustered, models.objects);
  parallelFor(models.objects, parameters.threads, [&](std::size_t k, unsigned worker) {
    if (progress.goesOnInPart(worker)) // steps 2 to 6
      clusters[k] =
          clustersOf(scene, k, selected[k], parameters, diagnostics.models[models.all[k].index]);
  });
  if (!progress.goesOn(kClustered))
    return result;
  compete(scene, clusters, diagnostics); // step 7
  if (parameters.repetition.on)
    repeatClustering(scene, parameters, clusters, diagnostics);
  if (!progress.goesOn(1))
    return result;
  result.detections = detectionsOf(scene, clusters);
  for (const auto& d : result.detections)
    ++diagnostics.models[d.model].detections;
  return result;
}

} // namespace pcl_surflet
