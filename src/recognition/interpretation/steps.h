/** \file
 * The seven steps of scene interpretation [Wahl 2007, Sec. 5.4]; internal, not installed.
 *
 * Surflets are named by their index in the scene. One function a step, in the order they run. */
#pragma once

#include "pcl_surflet/recognition/scene_interpretation.h"
#include "scene_models.h"

#include <array>
#include <cstdint>
#include <vector>

namespace pcl_surflet {
namespace interpretation {

/** \brief Models keep this distance between the streams of their random numbers. */
constexpr std::uint64_t kModelStride = std::uint64_t{1} << 24;

using Indices = std::vector<std::uint32_t>; ///< ascending, each once

/** \name Of ascending lists */
///@{
Indices common(const Indices& a, const Indices& b);
Indices united(const Indices& a, const Indices& b);
///@}

/** \brief A scene ready for the steps. */
struct SceneData {
  const SurfletSet& cells;
  const PairSource& source;
  const SceneModels& models;
};

/** \brief Surflets that can still belong to an object, and how well they fit it. */
struct Cluster {
  Indices surflets;
  double likelihood = 0; ///< mean log-likelihood of its regrouped surflets [Eq. 5.16]
  double margin = 0;     ///< step 5: the same above that of the best other model
  std::size_t seeds = 1; ///< n_C: cluster seeds merged into it
};

using ClustersOfModel = std::vector<Cluster>;

/** \brief Pairs the surflets at random, every one with one other (an odd one is left out)
 * [Wahl 2007, Eq. 5.14]. */
struct Regrouping {
  std::vector<std::uint32_t> first, second;
  PairFeatures features;

  void draw(const SceneData& scene, const Indices& surflets, std::uint64_t seed,
            std::uint64_t stream);
};

/** \brief Mean ln H over the features of a regrouping [Wahl 2007, Eq. 5.16]; -inf without any. */
double meanLogLikelihood(const Regrouping& groups, const SceneModel& model, float log_h_min);

/** \brief Mean ln of the model's density over the features of a regrouping; -inf without any. */
double meanLogDensity(const Regrouping& groups, const SceneModel& model);

/** \brief Step 1, pre-selection: S_M for every object [Wahl 2007, Eq. 5.1-5.11]. */
std::vector<Indices> preselect(const SceneData& scene, const DissertationParameters& parameters,
                               InterpretationDiagnostics& diagnostics);

/** \brief Step 2, cluster seeds: neighbourhoods of radius r_max about random surflets of the
 * selection [Wahl 2007, Eq. 5.12, 5.13], or about where these float to [Eq. 6.13]. */
ClustersOfModel plantSeeds(const SceneData& scene, std::size_t model, const Indices& selected,
                           const DissertationParameters& parameters, ModelDiagnostics& diagnostics);

/** \brief Step 3, refinement: regroups and erases crosstalk until a regrouping shows none; the seed
 * is empty if nothing is left [Wahl 2007, Eq. 5.14, 5.15]. Sets the likelihood. */
void refineSeed(const SceneData& scene, std::size_t model, std::uint64_t stream,
                const DissertationParameters& parameters, Cluster& seed);

/** \brief Step 4, merging: clusters of what seeds have in common [Wahl 2007, Eq. 5.16, 5.17].
 * \param lone number of seeds without partner */
ClustersOfModel mergeSeeds(ClustersOfModel seeds, double lambda_o, std::size_t& lone);

/** \brief Step 5, distribution check: does its own model explain the cluster best? Sets likelihood
 * and margin. */
bool distributionFits(const SceneData& scene, std::size_t model, std::uint64_t stream,
                      const DissertationParameters& parameters, Cluster& cluster);

/** \brief Step 6, similarity: drops clusters that are small, absolutely or beside the largest. */
void dropSmallClusters(const DissertationParameters& parameters, ClustersOfModel& clusters,
                       ModelDiagnostics& diagnostics);

/** \brief Step 7, competition: clusters of one model that collide merge, of rivals one stays
 * [Wahl 2007, Eq. 5.18-5.21]. \p clusters has one entry a model. */
void compete(const SceneData& scene, std::vector<ClustersOfModel>& clusters,
             InterpretationDiagnostics& diagnostics);

/** \brief Repetitive clustering [Wahl 2007, Sec. 6.1.3]: what new pairs about the centroid of each
 * cluster tell joins it. \p diagnostics hold the thresholds of step 1. */
void repeatClustering(const SceneData& scene, const DissertationParameters& parameters,
                      std::vector<ClustersOfModel>& clusters,
                      InterpretationDiagnostics& diagnostics);

/** \name What both methods share
 * \throws std::invalid_argument or DatabaseError naming what is wrong */
///@{
void checkParameters(const DissertationParameters& parameters);
void checkModels(const SceneModels& models, const DissertationParameters& parameters);
InterpretationDiagnostics emptyDiagnostics(const ModelDatabase& database);
/** \brief Steps 2 to 4 for one model. */
ClustersOfModel proposeClusters(const SceneData& scene, std::size_t model, const Indices& selected,
                                const DissertationParameters& parameters, ModelDiagnostics& d);
/** \brief Does the pair fall into a truly empty bin, or beyond the model? */
bool isCrosstalk(const SceneModel& model, std::uint32_t angular_bin, float delta_squared);
/** \brief Erases both surflets of every pair that is crosstalk. \return whether there was any */
bool eraseCrosstalk(const Regrouping& groups, const SceneModel& model, Indices& surflets);
///@}

/** \brief Mean position of the surflets. */
std::array<double, 3> centroidOf(const SurfletSet& cells, const Indices& surflets);

} // namespace interpretation
} // namespace pcl_surflet
