#include "evaluation/comparison.h"

#include "app_common.h"
#include "evaluation/measures.h"

#include <algorithm>
#include <cstdio>
#include <map>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr double kBytesPerSurflet = 6 * sizeof(float);
/** \brief Memory is measured apart from time, by interpreting again: the first scenes will do. */
constexpr std::size_t kMemoryScenes = 3;

void
printDetections(const std::string& method, const CellScene& scene,
                const std::vector<Detection>& detections)
{
  for (const auto& d : detections)
    std::fprintf(stderr, "%-14s %-12s cells %6zu score %.3f fit %.3f truth %s\n", method.c_str(),
                 d.label.c_str(), d.cells.size(), d.score, d.fit, truthOf(scene, d).c_str());
}

void
printDiagnostics(const InterpretationDiagnostics& d)
{
  if (d.models.empty())
    return;
  std::fprintf(stderr, "drawn %llu, too long %llu, background %llu\n",
               static_cast<unsigned long long>(d.drawn),
               static_cast<unsigned long long>(d.too_long),
               static_cast<unsigned long long>(d.background));
  std::fprintf(stderr, "%-14s %8s %8s %5s %8s %7s %8s %5s %5s %5s %5s %5s %5s %5s %5s\n", "model",
               "pairs", "surflets", "seeds", "in seeds", "cleared", "refined", "lone", "clust",
               "other", "small", "rel", "merge", "lost", "found");
  for (const auto& m : d.models)
    std::fprintf(
        stderr, "%-14s %8llu %8zu %5zu %8zu %7zu %8zu %5zu %5zu %5zu %5zu %5zu %5zu %5zu %5zu\n",
        m.label.c_str(), static_cast<unsigned long long>(m.pairs), m.surflets, m.seeds,
        m.seed_surflets, m.seeds_cleared, m.refined_surflets, m.seeds_lone, m.clusters,
        m.died_distribution, m.died_small, m.died_relative, m.merged, m.lost, m.detections);
}

/** \brief Nothing if nothing was measured. */
std::string
medianField(const std::vector<double>& values)
{
  return values.empty() ? "" : number(medianOf(values));
}

double
largest(const std::vector<double>& values)
{
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

} // namespace

Comparison::Comparison(std::string row, const std::vector<std::string>& labels,
                       const ComparisonOptions& options)
    : row_(std::move(row)), labels_(labels), options_(options)
{
}

void
Comparison::enter(const std::string& name, std::shared_ptr<const Recogniser> method)
{
  contestants_.push_back({name, std::move(method), Score(labels_), {}, {}, {}, {}, {}});
}

void
Comparison::measure(Contestant& c, const Scene& scene, const Prepared& seen, std::uint64_t seed)
{
  SceneInterpretation found;
  c.cells.push_back(static_cast<double>(seen.cells.cells.size()));
  c.seconds.push_back(secondsOf([&] { found = c.method->find(seen.cells.cells, seed); }));
  if (seen.normals_seconds > 0) {
    c.normals_ratio.push_back(c.seconds.back() / seen.normals_seconds);
    c.voxel_ratio.push_back(seen.voxel_ratio);
  }
  c.score.add(seen.cells, found.detections);
  if (options_.verbose) {
    printDetections(c.name, seen.cells, found.detections);
    printDiagnostics(found.diagnostics);
  }
  if (!options_.memory || c.seconds.size() > kMemoryScenes)
    return;
  found = {};
  const double bytes = bytesOf([&] {
    const auto reduced = reduceToCells(scene.surflets, reduction(c.method->splitBelow()));
    c.method->find(reduced.cells, seed);
  });
  if (bytes >= 0)
    c.memory_ratio.push_back(bytes /
                             (kBytesPerSurflet * static_cast<double>(scene.surflets.size())));
}

CellReductionOptions
Comparison::reduction(double split_below) const
{
  CellReductionOptions o;
  o.leaf = options_.leaf;
  o.split_below = split_below;
  return o;
}

Comparison::Prepared
Comparison::prepared(const Scene& scene, double split_below) const
{
  CellReduction reduced;
  const double reducing =
      secondsOf([&] { reduced = reduceToCells(scene.surflets, reduction(split_below)); });
  Prepared p;
  p.cells = withTruth(reduced, scene);
  if (options_.peers) {
    p.normals_seconds = normalEstimationSeconds(p.cells.cells, options_.threads);
    p.voxel_ratio = reducing / voxelGridSeconds(scene.surflets, options_.leaf);
  }
  return p;
}

void
Comparison::run(const Scene& scene, std::uint64_t seed)
{
  std::map<double, Prepared> seen; // by the split that methods ask for
  for (auto& c : contestants_) {
    const double split_below = c.method->splitBelow();
    if (seen.count(split_below) == 0)
      seen[split_below] = prepared(scene, split_below);
    measure(c, scene, seen[split_below], seed);
  }
}

std::string
Comparison::table() const
{
  std::string text;
  for (const auto& c : contestants_) {
    text += row_ + ", " + c.name + "\n" + c.score.table() + "seconds a scene " +
            number(medianOf(c.seconds)) + " (median, " + number(medianOf(c.cells)) + " cells)";
    if (!c.normals_ratio.empty())
      text += ", " + number(medianOf(c.normals_ratio)) + " of NormalEstimationOMP; reduction " +
              number(medianOf(c.voxel_ratio)) + " of VoxelGrid";
    if (!c.memory_ratio.empty())
      text += "; memory at most " + number(largest(c.memory_ratio)) + " of the scene's surflets";
    text += "\n\n";
  }
  return text;
}

std::string
Comparison::csvHeader()
{
  return "row,method,treatment,seed,scenes,models,scene_cells,seconds,normals_ratio,voxelgrid_"
         "ratio,"
         "memory_ratio," +
         Score::csvHeader() + "\n";
}

std::string
Comparison::csv(std::size_t models, const std::string& treatment, std::uint64_t seed) const
{
  std::string text;
  for (const auto& c : contestants_) {
    const std::string memory = c.memory_ratio.empty() ? "" : number(largest(c.memory_ratio));
    text += c.score.csv(csvField(row_) + "," + c.name + "," + treatment + "," +
                        std::to_string(seed) + "," + std::to_string(c.score.scenes()) + "," +
                        std::to_string(models) + "," + number(medianOf(c.cells)) + "," +
                        number(medianOf(c.seconds)) + "," + medianField(c.normals_ratio) + "," +
                        medianField(c.voxel_ratio) + "," + memory + ",");
  }
  return text;
}

} // namespace apps
} // namespace pcl_surflet
