#include "pcl_surflet/recognition/histogram_model_trainer.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/pair_counting.h"

#include <algorithm>
#include <cstdio>

namespace pcl_surflet {
namespace {

constexpr std::size_t kFewestSurflets = 3;

std::string
formatted(double v)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", v);
  return text;
}

/** \brief Cells wide enough to hold surflets also on all but the sparsest 5 % of the surface. */
SurfletSet
evenedOut(const SurfletSet& set, const SurfaceDensity& density)
{
  return reduceToCells(set, density.widest).cells;
}

} // namespace

TrainingError::~TrainingError() = default;

void
HistogramModelTrainer::setResolution(const Resolution& resolution)
{
  if (const auto problem = resolution.problem(); !problem.empty())
    throw std::invalid_argument("pcl_surflet: " + problem);
  resolution_ = resolution;
}

void
HistogramModelTrainer::setNumberOfPairs(std::uint64_t pairs)
{
  if (pairs == 0)
    throw std::invalid_argument("pcl_surflet: the number of pairs must be positive");
  pairs_ = pairs;
}

void
HistogramModelTrainer::setMeshSampling(std::size_t surflets, unsigned samplings)
{
  if (surflets < 2 || samplings < 1)
    throw std::invalid_argument("pcl_surflet: at least 2 surflets and 1 sampling of a mesh");
  mesh_surflets_ = surflets;
  mesh_samplings_ = samplings;
}

void
HistogramModelTrainer::setPairShare(const PairShare& share,
                                    std::function<PairHistogram(const PairHistogram&)> sum)
{
  if (share.part >= share.parts)
    throw std::invalid_argument("pcl_surflet: the share of the pairs is none of its parts");
  share_ = share;
  sum_ = std::move(sum);
}

PairHistogram
HistogramModelTrainer::summed(const PairHistogram& own) const
{
  return sum_ ? sum_(own) : own;
}

SurfletSet
HistogramModelTrainer::evened(const std::string& label, const SurfletSet& set) const
{
  if (uneven_ == UnevenDensity::Accept)
    return set;
  const SurfaceDensity density = surfaceDensity(set);
  if (density.contrast < kUnevenContrast)
    return set;
  if (uneven_ == UnevenDensity::Refuse)
    throw TrainingError(
        "'" + label + "': the surface density varies by a factor of " +
        formatted(density.contrast) +
        " and dense areas would dominate the model; reduce the cloud to cells of about " +
        formatted(density.widest) + " first, or allow evening out");
  return evenedOut(set, density);
}

HistogramModel
HistogramModelTrainer::train(const std::string& label, const SurfletSet& surflets) const
{
  if (surflets.size() < kFewestSurflets)
    throw TrainingError(
        "'" + label + "': " + std::to_string(surflets.size()) +
        " oriented points are too few to train a model; are points or normals not finite?");
  const SurfletSet even = evened(label, surflets);
  const double delta_max = farthestDistance(even);
  if (!(delta_max > 0))
    throw TrainingError("'" + label + "': all points coincide");
  const PairSource source(even);
  const std::uint64_t all = std::uint64_t{even.size()} * (even.size() - 1) / 2;
  const auto histogram =
      all <= pairs_
          ? countAllPairs(source, resolution_, delta_max, threads_, share_)
          : countDrawnPairs(source, resolution_, delta_max, pairs_, seed_, threads_, share_);
  return finish(label, summed(histogram), even, delta_max, 0);
}

HistogramModel
HistogramModelTrainer::train(const std::string& label, const TriangleMesh& mesh) const
{
  if (const auto problem = mesh.problem(); !problem.empty())
    throw TrainingError("'" + label + "': " + problem);
  std::vector<SurfletSet> samplings;
  double delta_max = 0;
  for (unsigned k = 0; k < mesh_samplings_; ++k) {
    // Hashed: seeds next to each other share no sampling, and no query drawn with the same seed is
    // one.
    samplings.push_back(sampleIsoMesh(mesh, mesh_surflets_, mix64(mix64(seed_) + k)));
    delta_max = std::max(delta_max, farthestDistance(samplings.back()));
  }
  if (!(delta_max > 0))
    throw TrainingError("'" + label + "': the mesh has no extent");
  PairHistogram sum(resolution_);
  SurfletSet all;
  for (const auto& sampling : samplings) {
    sum.merge(countAllPairs(PairSource(sampling), resolution_, delta_max, threads_, share_));
    for (std::size_t i = 0; i < sampling.size(); ++i)
      all.push_back(sampling[i]);
  }
  return finish(label, summed(sum), all, delta_max, surfaceArea(mesh));
}

HistogramModel
HistogramModelTrainer::finish(const std::string& label, const PairHistogram& histogram,
                              const SurfletSet& surflets, double delta_max, double area) const
{
  if (histogram.features == 0)
    throw TrainingError(
        "'" + label +
        "': no pair of points has a feature (all points on one line along their normals?)");
  const Extent extent = computeExtent(surflets);
  HistogramModel model;
  model.label = label;
  model.role = role_;
  model.resolution = resolution_;
  model.delta_max = delta_max;
  model.r_mean = extent.r_mean;
  model.r_max = extent.r_max;
  model.r_min = extent.r_min;
  model.surface_area = area;
  const auto h = histogram.normalized();
  model.members.push_back({"complete", std::vector<float>(h.begin(), h.end()), histogram.features});
  model.members.back().area = area;
  if (const auto problem = model.problem(); !problem.empty())
    throw TrainingError(problem);
  return model;
}

} // namespace pcl_surflet
