#include "steps.h"

#include "pcl_surflet/core/linear_octree.h"
#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pcl_surflet {
namespace {

using namespace interpretation;

// Independent random numbers for the regroupings of seeds and of clusters.
constexpr std::uint64_t kRefineStream = std::uint64_t{1} << 40;
constexpr std::uint64_t kCheckStream = std::uint64_t{2} << 40;
constexpr std::uint64_t kModelStride = std::uint64_t{1} << 24;

void
require(bool holds, const char* what)
{
  if (!holds)
    throw std::invalid_argument(std::string("pcl_surflet: ") + what);
}

void
check(const DissertationParameters& p)
{
  require(p.pairs > 0, "pairs must be positive");
  require(p.draws_per_pair > 0, "draws_per_pair must be positive");
  require(p.pairs <= (std::uint64_t{1} << 40) / p.draws_per_pair,
          "pairs times draws_per_pair must not exceed 2^40");
  require(p.lambda_h > 0 && std::isfinite(p.lambda_h), "lambda_h must be positive and finite");
  require(p.seeds > 0 && p.seeds < kModelStride, "seeds must be in [1, 2^24)");
  require(p.max_regroupings > 0, "max_regroupings must be positive");
  require(p.lambda_o >= 0 && p.lambda_o < 1, "lambda_o must be in [0, 1)");
  require(p.check_regroupings > 0, "check_regroupings must be positive");
  require(p.lambda_c >= 0 && p.lambda_c <= 1, "lambda_c must be in [0, 1]");
}

void
check(const SceneModels& models, const DissertationParameters& parameters)
{
  if (models.objects == 0)
    throw DatabaseError("the database has no object to find");
  if (parameters.background == BackgroundTreatment::Model && models.objects == models.all.size())
    throw DatabaseError("the database has no background model; train one with the background "
                        "role, or choose another treatment of the background");
}

/** \brief Steps 2 to 6 for one model. */
ClustersOfModel
clustersOf(const SceneData& scene, std::size_t model, const Indices& selected,
           const DissertationParameters& parameters, ModelDiagnostics& d)
{
  ClustersOfModel seeds = plantSeeds(scene, model, selected, parameters); // step 2
  d.seeds = seeds.size();
  const std::uint64_t stream = model * kModelStride;
  for (std::size_t j = 0; j < seeds.size(); ++j) { // step 3
    d.seed_surflets += seeds[j].surflets.size();
    refineSeed(scene, model, kRefineStream + stream + j, parameters, seeds[j]);
    d.refined_surflets += seeds[j].surflets.size();
  }
  const auto empty = std::remove_if(seeds.begin(), seeds.end(),
                                    [](const Cluster& c) { return c.surflets.empty(); });
  d.seeds_cleared = static_cast<std::size_t>(seeds.end() - empty);
  seeds.erase(empty, seeds.end());

  const auto merged = mergeSeeds(std::move(seeds), parameters.lambda_o, d.seeds_lone); // step 4
  d.clusters = merged.size();
  ClustersOfModel clusters;
  for (std::size_t j = 0; j < merged.size(); ++j) { // step 5
    Cluster c = merged[j];
    if (distributionFits(scene, model, kCheckStream + stream + j, parameters, c))
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
      d.centroid = centroidOf(scene.cells, c.surflets);
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
  check(parameters);
  const PairSource source(cells);
  const SceneModels models =
      sceneModels(database, parameters.background == BackgroundTreatment::Model, source.scale());
  check(models, parameters);
  const SceneData scene{cells, source, models};

  SceneInterpretation result;
  auto& diagnostics = result.diagnostics;
  diagnostics.models.resize(database.size());
  for (std::size_t i = 0; i < database.size(); ++i)
    diagnostics.models[i].label = database[i].label;

  const auto selected = preselect(scene, parameters, diagnostics); // step 1
  std::vector<ClustersOfModel> clusters(models.objects);
  parallelFor(models.objects, parameters.threads, [&](std::size_t k, unsigned) { // steps 2 to 6
    clusters[k] =
        clustersOf(scene, k, selected[k], parameters, diagnostics.models[models.all[k].index]);
  });
  compete(scene, clusters, diagnostics); // step 7
  result.detections = detectionsOf(scene, clusters);
  for (const auto& d : result.detections)
    ++diagnostics.models[d.model].detections;
  return result;
}

std::vector<std::uint32_t>
cellsAwayFrom(const SurfletSet& cells, const SurfletSet& background, double distance)
{
  require(distance > 0 && std::isfinite(distance), "distance must be positive and finite");
  LinearOctree octree;
  octree.build(
      {background.x.data(), background.y.data(), background.z.data(), 1, background.size()});
  std::vector<std::uint32_t> away;
  std::vector<PlaceRange> near;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    octree.regionRanges({cells.x[i], cells.y[i], cells.z[i]}, distance, near);
    if (near.empty())
      away.push_back(static_cast<std::uint32_t>(i));
  }
  return away;
}

} // namespace pcl_surflet
