#include "explanation.h"
#include "progress.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pcl_surflet {
namespace interpretation {
namespace {

/** \brief Segments whose few pairs fit less than this are not completed. */
constexpr double kLeastRoughFit = 0.45;
constexpr double kBackgroundKnown = 0.1, kScanned = 0.5; ///< shares of the work, about
constexpr unsigned kSettlings = 2;
/** \brief One cell of so many is asked at first: their core is enough to ask all. */
constexpr std::size_t kFirstCompletion = 4;
constexpr std::uint64_t kScoreStream = std::uint64_t{4} << 40;
constexpr std::uint64_t kMarginStream = std::uint64_t{5} << 40, kMarginPairs = 20000;

void
check(const ExplanationParameters& p)
{
  checkParameters(p.steps);
  const auto require = [](bool holds, const char* what) {
    if (!holds)
      throw std::invalid_argument(std::string("pcl_surflet: ") + what);
  };
  require(p.leaf >= 0 && std::isfinite(p.leaf), "leaf must be positive and finite, or 0");
  require(p.uniform_vote_share > 0 && p.uniform_vote_share <= 1,
          "uniform_vote_share must be in (0, 1]");
  require(p.uniform_vote_radius > 0 && std::isfinite(p.uniform_vote_radius),
          "uniform_vote_radius must be positive");
  require(p.reach >= 1 && std::isfinite(p.reach), "reach must be at least 1 and finite");
  require(p.place_spacing > 0 && std::isfinite(p.place_spacing), "place_spacing must be positive");
  require(p.scan_cells > 2 && p.scan_cells <= 4096, "scan_cells must be in [3, 4096]");
  require(p.settling_cells > 2 && p.settling_cells <= 4096, "settling_cells must be in [3, 4096]");
  require(p.recentrings > 0, "recentrings must be positive");
  require(p.probes > 0, "probes must be positive");
  require(p.features > 0, "features must be positive");
  require(p.min_fit >= 0 && p.min_fit <= 1, "min_fit must be in [0, 1]");
  require(p.junk_fit >= 0 && p.junk_fit <= 1, "junk_fit must be in [0, 1]");
  require(p.strong_fit >= 0 && p.strong_fit <= 1, "strong_fit must be in [0, 1]");
  require(p.rounds > 0 && p.rounds < 256, "rounds must be in [1, 255]");
  require(p.vote_pairs > 0, "vote_pairs must be positive");
  require(p.vote_share > 0 && p.vote_share <= 1, "vote_share must be in (0, 1]");
  require(p.vote_radius > 0 && std::isfinite(p.vote_radius), "vote_radius must be positive");
}

/** \brief Are there enough open cells for the model? Most are explained when this is asked again.
 */
bool
enoughCells(const Explaining& work, const Segment& s)
{
  std::vector<PlaceRange> ranges;
  const auto& p = work.parameters;
  const double fewest = std::max(static_cast<double>(p.steps.min_cluster),
                                 kLeastCoverage * work.scene.models.all[s.model].expected_cells);
  return static_cast<double>(
             cellsWithin(work.open, s.centre, work.radiusOf(s.model), ranges).size()) >= fewest;
}

/** \brief Nats per pair by which the model exceeds the best other one on the cells. */
double
scoreOf(const SceneData& scene, const Explanation& e, std::uint64_t seed)
{
  Regrouping groups;
  groups.draw(scene, e.cells, seed, kScoreStream);
  const auto& models = scene.models;
  const double own = meanLogDensity(groups, models.all[e.model]);
  double rival = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < models.objects; ++k)
    if (k != e.model)
      rival = std::max(rival, meanLogDensity(groups, models.all[k]));
  return std::isfinite(rival) ? own - rival : 0;
}

/** \brief Fit above that of the best other model on the same cells. Fewer pairs than for the fit
 * do, as scatter lowers all alike. */
double
marginOf(const SceneData& scene, const Explanation& e, std::uint64_t seed)
{
  const auto& models = scene.models;
  if (models.objects < 2)
    return std::numeric_limits<double>::quiet_NaN();
  const auto fit = [&](std::size_t k) {
    return fitOf(scene, models.all[k], e.cells, kMarginPairs, seed ^ kMarginStream).share;
  };
  double rival = 0;
  for (std::size_t k = 0; k < models.objects; ++k)
    if (k != e.model)
      rival = std::max(rival, fit(k));
  return fit(e.model) - rival;
}

Detection
detectionOf(const SceneData& scene, Explanation&& e, std::uint64_t seed)
{
  const SceneModel& model = scene.models.all[e.model];
  Detection d;
  d.model = model.index;
  d.label = model.model->label;
  d.centroid = centroidOf(scene.cells, e.cells);
  d.centre = ObjectCentre::guess(scene.cells, e.cells, model.model->r_mean, model.model->centre);
  d.score = scoreOf(scene, e, seed);
  d.fit = e.fit;
  d.margin = marginOf(scene, e, seed);
  d.member = e.member;
  d.cells = std::move(e.cells);
  std::sort(d.cells.begin(), d.cells.end());
  return d;
}

/** \brief What was found; the other explanations that fitted lost. */
void
countDetections(SceneInterpretation& result)
{
  for (const auto& d : result.detections)
    ++result.diagnostics.models[d.model].detections;
  for (auto& m : result.diagnostics.models)
    m.lost = m.explanations - m.died_fit - m.detections;
}

/** \brief Of the member that shows least; 0 if unknown. */
double
expectedCells(const HistogramModel& model, double leaf)
{
  if (!(leaf > 0))
    return 0;
  double least = model.areaOf(0);
  for (std::size_t k = 1; k < model.members.size(); ++k)
    least = std::min(least, model.areaOf(k));
  return least / areaOfCells(1, leaf);
}

} // namespace

Explaining::Explaining(const SceneData& s, const ExplanationParameters& p, ProgressReport& r,
                       InterpretationDiagnostics& d)
    : scene(s), parameters(p), progress(r), diagnostics(d), memory(resolveThreads(p.steps.threads))
{
  openExcept(std::vector<char>(s.cells.size(), 0));
}

void
Explaining::openExcept(const std::vector<char>& taken)
{
  std::vector<PointIndex> left;
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (!taken[i] && !(background.size() == taken.size() && background[i]))
      left.push_back(static_cast<PointIndex>(i));
  open.build(
      {scene.cells.x.data(), scene.cells.y.data(), scene.cells.z.data(), 1, scene.cells.size()},
      &left);
}

Explanation
lookClosely(Explaining& work, const Segment& rough, SupportMemory& memory)
{
  const auto& p = work.parameters;
  const SceneModel& model = work.scene.models.all[rough.model];
  const double radius = work.radiusOf(rough.model);
  Segment s = rough;
  for (unsigned k = 0; k < kSettlings; ++k) {
    if (!enoughCells(work, s))
      return {};
    drawSample(work.scene, work.open, s.centre, radius, p.settling_cells, memory);
    s = segment(work.scene, rough.model, s.centre, radius, memory);
    if (s.core.size() < 3 || s.rough_fit < kLeastRoughFit)
      return {};
  }
  Explanation e;
  e.model = rough.model;
  e.cells = s.core;
  const Indices ball = cellsWithin(work.open, s.centre, radius, memory.ranges);
  Indices some;
  for (std::size_t i = 0; i < ball.size(); i += kFirstCompletion)
    some.push_back(ball[i]);
  for (const Indices* asked : {static_cast<const Indices*>(&some), &ball}) {
    if (e.cells.size() < 3)
      break;
    supportOf(work.scene, model, *asked, e.cells, p.probes, memory, e.supported);
    e.cells.clear();
    for (const auto& c : e.supported)
      e.cells.push_back(c.cell);
  }
  e.centre = centroidOf(work.scene.cells, e.cells);
  for (const auto c : e.cells)
    e.reach = std::max(e.reach, distance(e.centre, {work.scene.cells.x[c], work.scene.cells.y[c],
                                                    work.scene.cells.z[c]}));
  return e;
}

} // namespace interpretation

SceneInterpretation
interpretByExplanation(const SurfletSet& cells, const ModelDatabase& database,
                       const ExplanationParameters& p)
{
  using namespace interpretation;
  check(p);
  const PairSource source(cells);
  const bool modelled = p.steps.background == BackgroundTreatment::Model;
  SceneModels models = sceneModels(database, modelled, source.scale(), p.steps.threads);
  checkModels(models, p.steps);
  for (auto& m : models.all)
    m.expected_cells = expectedCells(*m.model, p.leaf);
  const SceneData scene{cells, source, models};
  SceneInterpretation result;
  result.diagnostics = emptyDiagnostics(database);

  ProgressReport progress(p.steps.progress, result.diagnostics.cancelled);
  if (!progress.goesOn(0))
    return result;
  Explaining work(scene, p, progress, result.diagnostics);
  if (p.steps.background != BackgroundTreatment::Exclude) {
    work.background = modelled ? voteForBackground(scene, work.open, p)
                               : voteForUniformBackground(scene, work.open, p);
    work.openExcept(std::vector<char>(cells.size(), 0));
    result.diagnostics.background_cells = cells.size() - work.open.size();
  }
  const auto candidates = progress.goesOn(kBackgroundKnown) ? scan(work) : std::vector<Segment>();
  // The calling thread may have had no part in the scan, so it is asked again.
  if (!progress.goesOn(kScanned))
    return result;
  auto chosen = choose(work, candidates);
  if (!progress.goesOn(1))
    return result;
  result.detections.resize(chosen.size());
  parallelFor(chosen.size(), p.steps.threads, [&](std::size_t k, unsigned) {
    result.detections[k] = detectionOf(scene, std::move(chosen[k]), p.steps.seed);
  });
  std::stable_sort(result.detections.begin(), result.detections.end(),
                   [](const auto& a, const auto& b) { return a.model < b.model; });
  countDetections(result);
  return result;
}

} // namespace pcl_surflet
