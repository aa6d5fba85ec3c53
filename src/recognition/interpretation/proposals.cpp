#include "steps.h"

#include "core/require.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace interpretation {
namespace {

constexpr std::uint64_t kRefineStream = std::uint64_t{1} << 40;

} // namespace

void
checkParameters(const DissertationParameters& p)
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
  require(p.floating.steps > 0 && p.floating.steps <= 10000,
          "floating.steps must be in [1, 10000]");
  require(p.floating.steepness > 0 && p.floating.steepness <= 1e6,
          "floating.steepness must be in (0, 1e6]");
  require(p.repetition.pairs_per_surflet > 0 && p.repetition.pairs_per_surflet <= 1e6,
          "repetition.pairs_per_surflet must be in (0, 1e6]");
}

void
checkModels(const SceneModels& models, const DissertationParameters& parameters)
{
  if (models.objects == 0)
    throw DatabaseError("the database has no object to find");
  if (parameters.background == BackgroundTreatment::Model && models.objects == models.all.size())
    throw DatabaseError("the database has no background model; train one with the background "
                        "role, or choose another treatment of the background");
}

InterpretationDiagnostics
emptyDiagnostics(const ModelDatabase& database)
{
  InterpretationDiagnostics diagnostics;
  diagnostics.models.resize(database.size());
  for (std::size_t i = 0; i < database.size(); ++i)
    diagnostics.models[i].label = database[i].label;
  return diagnostics;
}

ClustersOfModel
proposeClusters(const SceneData& scene, std::size_t model, const Indices& selected,
                const DissertationParameters& parameters, ModelDiagnostics& d)
{
  ClustersOfModel seeds = plantSeeds(scene, model, selected, parameters, d); // step 2
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

  auto merged = mergeSeeds(std::move(seeds), parameters.lambda_o, d.seeds_lone); // step 4
  d.clusters = merged.size();
  return merged;
}

} // namespace interpretation
} // namespace pcl_surflet
