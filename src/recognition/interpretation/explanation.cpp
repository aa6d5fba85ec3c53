#include "explanation.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pcl_surflet {
namespace interpretation {
namespace {

constexpr std::uint64_t kAgainStream = std::uint64_t{1} << 32; ///< explanations tried again
constexpr std::uint64_t kRoundStride = std::uint64_t{1} << 24; ///< between the streams of rounds

/** \brief Two places of which one is within this share of the smaller model's r_mean of the other
 * are the same. */
constexpr double kSamePlace = 0.25;

bool
acceptable(const Explanation& e, const ExplanationParameters& p)
{
  return e.cells.size() >= p.steps.min_cluster && e.ratio >= p.min_ratio && e.fit >= p.min_fit;
}

/** \brief Centroids of proposed clusters, those next to each other once. */
std::vector<std::array<double, 3>>
placesOf(const SceneData& scene, const std::vector<ClustersOfModel>& clusters)
{
  double smallest = scene.models.all[0].model->r_mean;
  for (std::size_t k = 0; k < scene.models.objects; ++k)
    smallest = std::min(smallest, scene.models.all[k].model->r_mean);
  std::vector<std::array<double, 3>> places;
  for (const auto& list : clusters)
    for (const auto& c : list) {
      const auto p = centroidOf(scene.cells, c.surflets);
      const bool known = std::any_of(places.begin(), places.end(), [&](const auto& q) {
        return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) < kSamePlace * smallest;
      });
      if (!known)
        places.push_back(p);
    }
  return places;
}

/** \brief Leaves the most worthy of those explanations that came to the same place. */
std::vector<Explanation>
withoutRepetitions(const SceneData& scene, std::vector<Explanation> all)
{
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.worth() > b.worth(); });
  std::vector<Explanation> kept;
  for (auto& e : all) {
    const double near = kSamePlace * scene.models.all[e.model].model->r_mean;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Explanation& k) {
      return k.model == e.model && std::hypot(k.place[0] - e.place[0], k.place[1] - e.place[1],
                                              k.place[2] - e.place[2]) < near;
    });
    if (!known && !e.cells.empty())
      kept.push_back(std::move(e));
  }
  return kept;
}

/** \brief Takes the best explanation again and again; the others must do without its cells. */
std::vector<Explanation>
bestFirst(const SceneData& scene, OpenCells& open, std::vector<Explanation> all,
          std::uint64_t stream, const ExplanationParameters& p)
{
  std::vector<Explanation> accepted;
  stream += kAgainStream;
  const auto worthLess = [](const auto& a, const auto& b) { return a.worth() < b.worth(); };
  while (!all.empty()) {
    const auto best = std::max_element(all.begin(), all.end(), worthLess);
    Explanation e = std::move(*best);
    all.erase(best);
    if (!acceptable(e, p))
      continue;
    const bool stale = std::any_of(e.cells.begin(), e.cells.end(),
                                   [&](std::uint32_t i) { return open.taken[i] != 0; });
    if (stale) {
      e = settle(scene, open, e.model, e.place, ++stream, p);
      if (!e.cells.empty())
        confirm(scene, open, stream, p, e);
      all.push_back(std::move(e));
      continue;
    }
    for (const auto i : e.cells)
      open.taken[i] = 1;
    accepted.push_back(std::move(e));
  }
  return accepted;
}

Detection
detectionOf(const SceneData& scene, Explanation&& e)
{
  Detection d;
  d.model = scene.models.all[e.model].index;
  d.label = scene.models.all[e.model].model->label;
  d.centroid = centroidOf(scene.cells, e.cells);
  d.score = e.ratio;
  d.fit = e.fit;
  d.cells = std::move(e.cells);
  return d;
}

void
check(const ExplanationParameters& p)
{
  checkParameters(p.steps);
  const auto require = [](bool holds, const char* what) {
    if (!holds)
      throw std::invalid_argument(std::string("pcl_surflet: ") + what);
  };
  require(p.reach >= 1 && std::isfinite(p.reach), "reach must be at least 1 and finite");
  require(p.rounds > 0 && p.rounds < 256, "rounds must be in [1, 255]");
  require(p.settling_cells > 1, "settling_cells must be at least 2");
  require(p.probes > 0, "probes must be positive");
  require(p.max_crosstalk >= 0 && p.max_crosstalk <= 1, "max_crosstalk must be in [0, 1]");
  require(p.max_regroupings > 0, "max_regroupings must be positive");
  require(std::isfinite(p.max_surprise), "max_surprise must be finite");
  require(p.peeled_share > 0 && p.peeled_share < 1, "peeled_share must be in (0, 1)");
  require(p.recentrings > 0, "recentrings must be positive");
  require(p.features > 0, "features must be positive");
  require(std::isfinite(p.min_ratio), "min_ratio must be finite");
  require(p.min_fit >= 0 && p.min_fit <= 1, "min_fit must be in [0, 1]");
  require(p.vote_pairs > 0, "vote_pairs must be positive");
  require(p.vote_share > 0 && p.vote_share <= 1, "vote_share must be in (0, 1]");
  require(p.vote_radius > 0 && std::isfinite(p.vote_radius), "vote_radius must be positive");
}

/** \brief Steps 1 to 4 of the open cells of the scene: places to look at. */
std::vector<std::array<double, 3>>
proposePlaces(const SceneData& scene, const OpenCells& open, const ModelDatabase& database,
              const ExplanationParameters& p, InterpretationDiagnostics& diagnostics)
{
  Indices left;
  for (std::uint32_t i = 0; i < open.taken.size(); ++i)
    if (!open.taken[i])
      left.push_back(i);
  const SurfletSet cells = scene.cells.subset(left);
  const PairSource source(cells);
  const SceneModels models = sceneModels(database, false, source.scale()); // the background is gone
  const SceneData rest{cells, source, models};
  const auto selected = preselect(rest, p.steps, diagnostics);
  std::vector<ClustersOfModel> clusters(models.objects);
  parallelFor(models.objects, p.steps.threads, [&](std::size_t k, unsigned) {
    clusters[k] =
        proposeClusters(rest, k, selected[k], p.steps, diagnostics.models[models.all[k].index]);
  });
  return placesOf(rest, clusters);
}

/** \brief One round: proposes places, tries every model there, takes the best explanations. */
std::vector<Explanation>
explainOpenCells(const SceneData& scene, OpenCells& open, const ModelDatabase& database,
                 unsigned round, ExplanationParameters p, InterpretationDiagnostics& diagnostics)
{
  p.steps.seed = mix64(p.steps.seed) + round; // fresh draws
  const std::uint64_t stream = round * kRoundStride;
  const std::size_t models = scene.models.objects;
  const auto places = proposePlaces(scene, open, database, p, diagnostics);
  std::vector<Explanation> all(places.size() * models);
  parallelFor(all.size(), p.steps.threads, [&](std::size_t i, unsigned) {
    all[i] = settle(scene, open, i % models, places[i / models], stream + i, p);
  });
  all = withoutRepetitions(scene, std::move(all));
  parallelFor(all.size(), p.steps.threads,
              [&](std::size_t i, unsigned) { confirm(scene, open, stream + i, p, all[i]); });
  return bestFirst(scene, open, std::move(all), stream, p);
}

} // namespace

} // namespace interpretation

SceneInterpretation
interpretByExplanation(const SurfletSet& cells, const ModelDatabase& database,
                       const ExplanationParameters& p)
{
  using namespace interpretation;
  check(p);
  const PairSource source(cells);
  const bool modelled = p.steps.background == BackgroundTreatment::Model;
  const SceneModels models = sceneModels(database, modelled, source.scale());
  checkModels(models, p.steps);
  const SceneData scene{cells, source, models};
  SceneInterpretation result;
  result.diagnostics = emptyDiagnostics(database);

  OpenCells open;
  open.octree.build({cells.x.data(), cells.y.data(), cells.z.data(), 1, cells.size()});
  open.taken.assign(cells.size(), 0);
  if (modelled)
    open.taken = voteForBackground(scene, open.octree, p);
  for (unsigned round = 0; round < p.rounds; ++round) {
    InterpretationDiagnostics later = emptyDiagnostics(database);
    auto found =
        explainOpenCells(scene, open, database, round, p, round == 0 ? result.diagnostics : later);
    for (auto& e : found)
      result.detections.push_back(detectionOf(scene, std::move(e)));
  }
  for (const auto& d : result.detections)
    ++result.diagnostics.models[d.model].detections;
  return result;
}

} // namespace pcl_surflet
