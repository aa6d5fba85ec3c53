#include "explanation.h"

#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace pcl_surflet {
namespace interpretation {
namespace {

/** \brief A sample serves models whose radii differ by less than this factor. */
constexpr double kRadiusClass = 1.3;
/** \brief Rough segments of one model nearer than this share of its r_mean are the same. */
constexpr double kSamePlace = 0.4;
/** \brief A rough segment needs this intersection. Few pairs make it lower than a fit: 0.5 to 0.7
 * where the model is right, 0.2 to 0.4 where it is not. */
constexpr double kLeastScanFit = 0.35;
/** \brief The same at first, with half as many cells and a quarter of the pairs. */
constexpr double kLeastFirstFit = 0.2;
constexpr double kScanBegins = 0.1, kScanEnds = 0.5; ///< shares of the work, about

/** \brief Middles of the occupied cubes of \p edge, in the order of their numbers. */
std::vector<Centre>
placesOf(const SceneData& scene, const LinearOctree& open, double edge)
{
  struct Sum {
    Centre sum{};
    std::size_t cells = 0;
  };
  std::map<std::array<long long, 3>, Sum> cubes;
  for (std::size_t k = 0; k < open.size(); ++k) {
    const auto i = static_cast<std::size_t>(open.indexData()[k]);
    const double p[3] = {scene.cells.x[i], scene.cells.y[i], scene.cells.z[i]};
    Sum& s = cubes[{std::llround(std::floor(p[0] / edge)), std::llround(std::floor(p[1] / edge)),
                    std::llround(std::floor(p[2] / edge))}];
    for (std::size_t a = 0; a < 3; ++a)
      s.sum[a] += p[a];
    ++s.cells;
  }
  std::vector<Centre> places;
  for (auto& [number, s] : cubes) {
    for (double& v : s.sum)
      v /= static_cast<double>(s.cells);
    places.push_back(s.sum);
  }
  return places;
}

/** \brief Models whose radii are alike, largest first. */
std::vector<std::vector<std::size_t>>
radiusClasses(const Explaining& work)
{
  std::vector<std::size_t> order(work.scene.models.objects);
  for (std::size_t k = 0; k < order.size(); ++k)
    order[k] = k;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return work.radiusOf(a) > work.radiusOf(b);
  });
  std::vector<std::vector<std::size_t>> classes;
  for (const auto k : order) {
    if (classes.empty() || work.radiusOf(classes.back().front()) > kRadiusClass * work.radiusOf(k))
      classes.emplace_back();
    classes.back().push_back(k);
  }
  return classes;
}

bool
isPromising(const Explaining& work, const Segment& s, double least_fit)
{
  return s.cells >= static_cast<double>(work.parameters.steps.min_cluster) &&
         s.rough_fit >= least_fit;
}

/** \brief Drops what is not promising and, of segments at one place, all but the most worthy. */
std::vector<Segment>
best(const Explaining& work, std::vector<Segment> all, double least_fit)
{
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const Segment& s) { return !isPromising(work, s, least_fit); }),
            all.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.worth() > b.worth(); });
  std::vector<Segment> kept;
  for (auto& s : all) {
    const double near = kSamePlace * work.scene.models.all[s.model].model->r_mean;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Segment& k) {
      return k.model == s.model && distance(k.centre, s.centre) < near;
    });
    if (!known)
      kept.push_back(std::move(s));
  }
  return kept;
}

/** \brief What is tried at a place: models of like radius, which share a sample. */
struct Trial {
  Centre place;
  const std::vector<std::size_t>* models;
};

/** \brief Every model all over the scene, larger ones at fewer places. */
std::vector<Segment>
tryEverywhere(Explaining& work)
{
  const auto classes = radiusClasses(work);
  std::vector<Trial> trials;
  std::vector<std::size_t> first; // of the segments of a trial
  std::size_t segments = 0;
  for (const auto& models : classes) {
    double smallest = work.scene.models.all[models.front()].model->r_mean;
    for (const auto k : models)
      smallest = std::min(smallest, work.scene.models.all[k].model->r_mean);
    for (const auto& place :
         placesOf(work.scene, work.open, work.parameters.place_spacing * smallest)) {
      trials.push_back({place, &models});
      first.push_back(segments);
      segments += models.size();
      for (const auto k : models)
        ++work.diagnosticsOf(k).places;
    }
  }
  std::vector<Segment> all(segments);
  work.progress.beginPart(kScanBegins, kScanEnds, trials.size());
  parallelFor(trials.size(), work.parameters.steps.threads, [&](std::size_t i, unsigned worker) {
    if (!work.progress.goesOnInPart(worker))
      return;
    SupportMemory& memory = work.memory[worker];
    const auto& [place, models] = trials[i];
    drawSample(work.scene, work.open, place, work.radiusOf(models->front()),
               work.parameters.scan_cells / 2, memory);
    for (std::size_t m = 0; m < models->size(); ++m)
      all[first[i] + m] =
          segment(work.scene, (*models)[m], place, work.radiusOf((*models)[m]), memory);
  });
  return all;
}

} // namespace

std::vector<Segment>
scan(Explaining& work)
{
  auto found = best(work, tryEverywhere(work), kLeastFirstFit);
  for (unsigned round = 1; round < work.parameters.recentrings; ++round) {
    parallelFor(found.size(), work.parameters.steps.threads, [&](std::size_t i, unsigned worker) {
      SupportMemory& memory = work.memory[worker];
      Segment& s = found[i];
      const double radius = work.radiusOf(s.model);
      drawSample(work.scene, work.open, s.centre, radius, work.parameters.scan_cells, memory);
      s = segment(work.scene, s.model, s.centre, radius, memory);
    });
    found = best(work, std::move(found), kLeastScanFit);
  }
  for (const auto& s : found)
    ++work.diagnosticsOf(s.model).promising;
  return found;
}

} // namespace interpretation
} // namespace pcl_surflet
