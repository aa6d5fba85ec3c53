#include "steps.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/linear_octree.h"
#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace interpretation {
namespace {

constexpr std::uint64_t kDrawStream = 0x726570656174ULL;
constexpr std::uint64_t kRepeatStream = std::uint64_t{3} << 40;

/** \brief Does the feature suit the model as in step 1, regardless of other objects? */
bool
suits(const SceneModels& models, std::size_t model, double threshold, std::uint32_t angular_bin,
      float delta_squared)
{
  if (angular_bin == kNoPairFeature)
    return false;
  const float h = models.all[model].value(angular_bin, delta_squared);
  if (!(h > 0) || h < threshold) // Eq. 5.4
    return false;
  for (std::size_t k = models.objects; k < models.all.size(); ++k)
    if (models.all[k].value(angular_bin, delta_squared) > h) // Eq. 5.9
      return false;
  return true;
}

/** \brief Surflets of \p region in newly drawn pairs that suit the model. */
Indices
redraw(const SceneData& scene, std::size_t model, double threshold, const Indices& region,
       double pairs_per_surflet, std::uint64_t seed)
{
  const auto n =
      static_cast<std::uint64_t>(std::ceil(pairs_per_surflet * static_cast<double>(region.size())));
  Regrouping pairs;
  for (const auto& [a, b] : drawPairs(region.size(), n, seed)) {
    pairs.first.push_back(region[a]);
    pairs.second.push_back(region[b]);
  }
  featuresOfPairs(scene.source, scene.models.resolution, pairs.first, pairs.second, pairs.features);
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < pairs.first.size(); ++i)
    if (suits(scene.models, model, threshold, pairs.features.angular_bin[i],
              pairs.features.delta_squared[i])) {
      chosen.push_back(pairs.first[i]);
      chosen.push_back(pairs.second[i]);
    }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

/** \brief All surflets of the scene within the model's r_max of the cluster's centroid. */
Indices
supportRegion(const SceneData& scene, std::size_t model, const LinearOctree& octree,
              const Cluster& cluster)
{
  const auto centre = centroidOf(scene.cells, cluster.surflets);
  std::vector<PointIndex> found;
  octree.regionSearch(
      {static_cast<float>(centre[0]), static_cast<float>(centre[1]), static_cast<float>(centre[2])},
      scene.models.all[model].model->r_max, found, nullptr);
  Indices region(found.begin(), found.end());
  std::sort(region.begin(), region.end());
  return region;
}

} // namespace

void
repeatClustering(const SceneData& scene, const DissertationParameters& parameters,
                 std::vector<ClustersOfModel>& clusters, InterpretationDiagnostics& diagnostics)
{
  const auto& cells = scene.cells;
  LinearOctree octree;
  octree.build({cells.x.data(), cells.y.data(), cells.z.data(), 1, cells.size()});
  parallelFor(clusters.size(), parameters.threads, [&](std::size_t k, unsigned) {
    ModelDiagnostics& d = diagnostics.models[scene.models.all[k].index];
    for (std::size_t j = 0; j < clusters[k].size(); ++j) {
      Cluster& c = clusters[k][j];
      const Indices region = supportRegion(scene, k, octree, c);
      if (region.size() < 2)
        continue;
      const std::uint64_t stream = k * kModelStride + j;
      Cluster again;
      again.surflets =
          redraw(scene, k, d.threshold, region, parameters.repetition.pairs_per_surflet,
                 CounterRandom(parameters.seed, kDrawStream).at(stream));
      refineSeed(scene, k, kRepeatStream + stream, parameters, again); // step 3
      const std::size_t before = c.surflets.size();
      c.surflets = united(c.surflets, again.surflets);
      d.regained += c.surflets.size() - before;
    }
  });
}

} // namespace interpretation
} // namespace pcl_surflet
