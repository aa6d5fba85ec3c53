#include "steps.h"

#include "pcl_surflet/core/counter_random.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_surflet {
namespace interpretation {
namespace {

/** \brief A cluster in the competition of all models. */
struct Competitor {
  std::size_t model = 0;
  Cluster cluster;
  std::array<double, 3> centroid{};
};

/** \brief Largest cluster size and number of seeds of each model, p_max and n_max. */
struct LargestOfModel {
  std::vector<double> surflets, seeds;

  LargestOfModel(std::size_t models, const std::vector<Competitor>& all)
      : surflets(models, 1), seeds(models, 1)
  {
    for (const auto& c : all) {
      surflets[c.model] = std::max(surflets[c.model], double(c.cluster.surflets.size()));
      seeds[c.model] = std::max(seeds[c.model], double(c.cluster.seeds));
    }
  }
};

double
distance(const Competitor& a, const Competitor& b)
{
  return std::hypot(a.centroid[0] - b.centroid[0], a.centroid[1] - b.centroid[1],
                    a.centroid[2] - b.centroid[2]);
}

/** \brief Two competitors too close to both be right, and how close. */
struct Collision {
  std::size_t a = 0, b = 0;
  double distance = 0;
};

/** \brief Nearest collision of clusters of one model, or of rivals [Wahl 2007, Eq. 5.18]; a == b if
 * there is none. */
Collision
nearestCollision(const SceneData& scene, const std::vector<Competitor>& all, bool one_model)
{
  Collision nearest;
  nearest.distance = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < all.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      const double d = distance(all[a], all[b]);
      const double reach = std::max(scene.models.all[all[a].model].model->r_mean,
                                    scene.models.all[all[b].model].model->r_mean);
      if ((all[a].model == all[b].model) == one_model && d <= reach && d < nearest.distance)
        nearest = {a, b, d};
    }
  return nearest;
}

/** \brief Joins \p b to \p a. */
void
join(const SceneData& scene, Competitor& a, const Competitor& b)
{
  a.cluster.surflets = united(a.cluster.surflets, b.cluster.surflets);
  a.cluster.seeds += b.cluster.seeds;
  a.cluster.likelihood = std::max(a.cluster.likelihood, b.cluster.likelihood);
  a.cluster.margin = std::max(a.cluster.margin, b.cluster.margin);
  a.centroid = centroidOf(scene.cells, a.cluster.surflets);
}

/** \brief Does \p a stay and \p b go? */
bool
wins(const Competitor& a, const Competitor& b, const LargestOfModel& largest)
{
  const double p_a = double(a.cluster.surflets.size()), p_b = double(b.cluster.surflets.size());
  const double n_a = double(a.cluster.seeds), n_b = double(b.cluster.seeds);
  const double quotients[3][2] = {
      {p_a / largest.surflets[a.model], p_b / largest.surflets[b.model]}, // Eq. 5.19
      {p_a / n_a, p_b / n_b},                                             // Eq. 5.20
      {n_a / largest.seeds[a.model], n_b / largest.seeds[b.model]}};      // Eq. 5.21
  int won = 0, won_by_b = 0;
  for (const auto& q : quotients) {
    won += q[0] > q[1] ? 1 : 0;
    won_by_b += q[1] > q[0] ? 1 : 0;
  }
  if (won >= 2 || won_by_b >= 2)
    return won >= 2;
  return a.cluster.margin >= b.cluster.margin;
}

} // namespace

bool
distributionFits(const SceneData& scene, std::size_t model, std::uint64_t stream,
                 const DissertationParameters& parameters, Cluster& cluster)
{
  const std::size_t models = scene.models.all.size();
  std::vector<double> likelihood(models, 0.0);
  Regrouping groups;
  for (unsigned k = 0; k < parameters.check_regroupings; ++k) {
    groups.draw(scene, cluster.surflets, parameters.seed, mix64(~stream) + k);
    for (std::size_t j = 0; j < models; ++j)
      likelihood[j] += meanLogLikelihood(groups, scene.models.all[j], scene.models.log_h_min) /
                       parameters.check_regroupings;
  }
  double rival = -std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < models; ++j)
    if (j != model)
      rival = std::max(rival, likelihood[j]);
  cluster.likelihood = likelihood[model];
  if (!std::isfinite(cluster.likelihood)) // not one pair with a feature
    return false;
  // With a single model there is no rival: it is then compared with a chance hit of any bin.
  const double chance = -std::log(double(scene.models.resolution.bins()));
  cluster.margin = cluster.likelihood - (std::isfinite(rival) ? rival : chance);
  return cluster.margin >= 0;
}

void
dropSmallClusters(const DissertationParameters& parameters, ClustersOfModel& clusters,
                  ModelDiagnostics& diagnostics)
{
  std::size_t largest = 0; // p_max
  for (const auto& c : clusters)
    largest = std::max(largest, c.surflets.size());
  ClustersOfModel kept;
  for (auto& c : clusters) {
    const double p = static_cast<double>(c.surflets.size());
    if (c.surflets.size() < parameters.min_cluster)
      ++diagnostics.died_small;
    else if (p < parameters.lambda_c * static_cast<double>(largest))
      ++diagnostics.died_relative;
    else
      kept.push_back(std::move(c));
  }
  clusters = std::move(kept);
}

void
compete(const SceneData& scene, std::vector<ClustersOfModel>& clusters,
        InterpretationDiagnostics& diagnostics)
{
  std::vector<Competitor> all;
  for (std::size_t k = 0; k < clusters.size(); ++k)
    for (auto& c : clusters[k]) {
      const auto centroid = centroidOf(scene.cells, c.surflets);
      all.push_back({k, std::move(c), centroid});
    }
  const auto diagnosticsOf = [&](std::size_t i) -> ModelDiagnostics& {
    return diagnostics.models[scene.models.all[all[i].model].index];
  };
  const auto remove = [&](std::size_t i) {
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
  };
  const auto nearest = [&](bool of_one_model) {
    return nearestCollision(scene, all, of_one_model);
  };
  for (Collision c = nearest(true); c.a != c.b; c = nearest(true)) {
    join(scene, all[c.a], all[c.b]);
    ++diagnosticsOf(c.b).merged;
    remove(c.b);
  }
  const LargestOfModel largest(clusters.size(), all);
  for (Collision c = nearest(false); c.a != c.b; c = nearest(false)) {
    const std::size_t loser = wins(all[c.a], all[c.b], largest) ? c.b : c.a;
    ++diagnosticsOf(loser).lost;
    remove(loser);
  }
  for (auto& list : clusters)
    list.clear();
  for (auto& c : all)
    clusters[c.model].push_back(std::move(c.cluster));
}

std::array<double, 3>
centroidOf(const SurfletSet& cells, const Indices& surflets)
{
  std::array<double, 3> sum{};
  for (const auto i : surflets) {
    sum[0] += cells.x[i];
    sum[1] += cells.y[i];
    sum[2] += cells.z[i];
  }
  for (double& v : sum)
    v /= std::max<double>(1, static_cast<double>(surflets.size()));
  return sum;
}

} // namespace interpretation
} // namespace pcl_surflet
