// Interpretation of PCL's clouds, compiled once; and the templates for common point types.

#include "pcl_surflet/impl/scene_interpreter.hpp"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/linear_octree.h"
#include "recognition/interpretation/scene_models.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace pcl_surflet {
namespace {

/** \brief Cells per diameter of the largest object, where the user does not say. */
constexpr double kCellsPerDiameter = 50;

/** \brief A scene smaller than the smallest model by this factor is not interpreted: the steps have
 * no absolute measure and would name it all the same. */
constexpr double kMuchSmaller = 20;

/** \brief From this share of pairs longer than every model on, the scene is called too large. */
constexpr double kMuchTooLong = 0.999;

/** \brief With fewer cells than this at a place where models are tried, it is called so as well. */
constexpr std::size_t kFewCells = 5;

/** \brief The cell of every point. Cells of thin walls, whose normals cancel, are none: their
 * points go with the nearest cell, if there is one within a leaf. */
std::vector<std::uint32_t>
cellsOfPoints(const CellReduction& reduction, const SurfletSet& points, double leaf)
{
  std::vector<std::uint32_t> cell_of = reduction.cell_of;
  if (reduction.cancelled_surflets == 0 || reduction.cells.empty())
    return cell_of;
  const SurfletSet& cells = reduction.cells;
  LinearOctree octree;
  octree.build({cells.x.data(), cells.y.data(), cells.z.data(), 1, cells.size()});
  std::vector<PointIndex> nearest;
  std::vector<float> squared;
  for (std::size_t i = 0; i < cell_of.size(); ++i) {
    if (cell_of[i] != CellReduction::no_cell)
      continue;
    octree.nearestSearch({points.x[i], points.y[i], points.z[i]}, 1, nearest, squared);
    if (!nearest.empty() && squared[0] <= leaf * leaf)
      cell_of[i] = static_cast<std::uint32_t>(nearest[0]);
  }
  return cell_of;
}

/** \brief The points of every detection, by their cells. */
void
findPoints(const CellReduction& reduction, const ConvertedSurflets& points, double leaf,
           std::vector<SceneDetection>& detections)
{
  std::vector<std::vector<std::uint32_t>> owners(reduction.cells.size());
  for (std::uint32_t k = 0; k < detections.size(); ++k)
    for (const auto cell : detections[k].cells)
      owners[cell].push_back(k);
  const auto cell_of = cellsOfPoints(reduction, points.surflets, leaf);
  for (std::size_t i = 0; i < points.indices.size(); ++i) {
    if (cell_of[i] == CellReduction::no_cell)
      continue;
    for (const auto k : owners[cell_of[i]])
      detections[k].indices.push_back(points.indices[i]);
  }
  for (auto& d : detections)
    std::sort(d.indices.begin(), d.indices.end());
}

struct SizeRange {
  double smallest = 0, largest = 0; ///< delta_max; 0 without an object
};

SizeRange
objectSizes(const ModelDatabase& database)
{
  SizeRange sizes;
  for (std::size_t i = 0; i < database.size(); ++i) {
    const double size = database[i].delta_max;
    if (database[i].role != ModelRole::Object)
      continue;
    sizes.smallest = sizes.largest == 0 ? size : std::min(sizes.smallest, size);
    sizes.largest = std::max(sizes.largest, size);
  }
  return sizes;
}

/** \brief Diagonal of the bounding box. */
double
diagonal(const SurfletSet& set)
{
  if (set.empty())
    return 0;
  double sum = 0;
  for (const auto* axis : {&set.x, &set.y, &set.z}) {
    const auto [low, high] = std::minmax_element(axis->begin(), axis->end());
    const double edge = static_cast<double>(*high) - static_cast<double>(*low);
    sum += edge * edge;
  }
  return std::sqrt(sum);
}

std::string
text(const char* format, double a, double b)
{
  std::array<char, 256> line{};
  std::snprintf(line.data(), line.size(), format, a, b);
  return line.data();
}

bool
muchTooSmall(const SceneDiagnostics& d, const SizeRange& sizes)
{
  return d.extent * kMuchSmaller < sizes.smallest;
}

/** \brief Is hardly anything so near to anything else that a model could hold both? Places are as
 * large as the smallest object; its cells are many. */
bool
muchTooLarge(const SceneDiagnostics& d)
{
  std::size_t places = 0;
  for (const auto& m : d.models)
    places = std::max(places, m.places);
  return d.cells - d.background_cells < kFewCells * places ||
         (d.drawn > 0 &&
          static_cast<double>(d.too_long) >= kMuchTooLong * static_cast<double>(d.drawn));
}

/** \brief Why there is no detection, as far as the counts tell. */
std::string
whyNothing(const SceneDiagnostics& d, const SizeRange& sizes)
{
  if (d.points == 0)
    return "no point is finite and has a usable normal";
  if (d.points == d.background_points)
    return "all points are background";
  if (d.cells == 0)
    return "the normals cancel in every cell: set a smaller leaf";
  if (d.background_points > 0 && d.extent < sizes.smallest)
    return "all but " + std::to_string(d.points - d.background_points) + " points are background";
  if (muchTooSmall(d, sizes))
    return text("the scene measures %g, the smallest model %g: are both in the same unit?",
                d.extent, sizes.smallest);
  if (muchTooLarge(d))
    return text("hardly anything of the scene, which measures %g, has its like within the size of "
                "a model, %g at most: are both in the same unit, is it sensed densely?",
                d.extent, sizes.largest);
  return "no model explains a part of the scene well enough: the counts of the models tell where "
         "they failed";
}

void
keepLargest(std::size_t most, std::vector<Detection>& found)
{
  if (most == 0 || found.size() <= most)
    return;
  std::stable_sort(found.begin(), found.end(), [](const Detection& a, const Detection& b) {
    return a.cells.size() > b.cells.size();
  });
  found.resize(most);
}

void
describe(const SceneInterpretation& result, const SizeRange& sizes, SceneDiagnostics& diagnostics)
{
  static_cast<InterpretationDiagnostics&>(diagnostics) = result.diagnostics;
  if (diagnostics.cancelled) {
    diagnostics.status = SceneStatus::Cancelled;
    diagnostics.reason = "cancelled by the progress callback";
  }
  else if (result.detections.empty()) {
    diagnostics.status = SceneStatus::NothingFound;
    diagnostics.reason = whyNothing(diagnostics, sizes);
  }
  else
    diagnostics.status = SceneStatus::Found;
}

SceneInterpretation
interpretOnce(const SurfletSet& cells, const ModelDatabase& database, Method method,
              const ExplanationParameters& parameters)
{
  return method == Method::Dissertation ? interpretByDissertation(cells, database, parameters.steps)
                                        : interpretByExplanation(cells, database, parameters);
}

/** \brief Is there time for one more run like those before? */
std::function<bool(std::size_t)>
withinBudget(double seconds)
{
  if (!(seconds >= 0) || !std::isfinite(seconds))
    throw std::invalid_argument("pcl_surflet: the time budget must be positive and finite, or 0");
  if (seconds == 0)
    return {};
  const auto begin = std::chrono::steady_clock::now();
  return [=](std::size_t runs) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    return spent.count() * static_cast<double>(runs + 1) <= seconds * static_cast<double>(runs);
  };
}

SceneInterpretation
interpretCells(const SurfletSet& cells, const ModelDatabase& database,
               const detail::InterpreterRequest& request, double leaf, std::size_t& runs)
{
  ExplanationParameters parameters = request.parameters;
  parameters.leaf = leaf;
  std::size_t run = 0;
  const auto most = static_cast<double>(request.accumulation.runs);
  if (const auto progress = request.parameters.steps.progress)
    parameters.steps.progress = [&run, progress, most](double share) {
      return progress((static_cast<double>(run) + share) / most);
    };
  return accumulateInterpretations(
      cells,
      [&](std::uint64_t seed) {
        parameters.steps.seed = seed;
        auto found = interpretOnce(cells, database, request.method, parameters);
        ++run;
        return found;
      },
      parameters.steps.seed, request.accumulation, withinBudget(request.seconds), &runs);
}

} // namespace

double
detail::trainedLeafOf(const ModelDatabase& database)
{
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (std::size_t i = 0; i < database.size(); ++i)
    if (database[i].role == ModelRole::Object) {
      least = std::min(least, database[i].leaf);
      most = std::max(most, database[i].leaf);
    }
  return least == most ? most : 0;
}

double
detail::leafOf(double leaf, const ModelDatabase& database)
{
  const double largest = objectSizes(database).largest;
  if (!(largest > 0))
    throw DatabaseError("the database has no object to find; call setDatabase()");
  if (!(leaf >= 0) || !std::isfinite(leaf))
    throw std::invalid_argument("pcl_surflet: the leaf size must be positive and finite, or 0");
  const double trained = trainedLeafOf(database);
  return leaf > 0 ? leaf : (trained > 0 ? trained : largest / kCellsPerDiameter);
}

double
detail::confidenceOf(const Detection& detection, std::size_t min_cluster)
{
  const auto logistic = [&](double x) { return detection.votes / (1 + std::exp(-x)); };
  const auto n = static_cast<double>(detection.cells.size());
  if (n == 0)
    return 0;
  if (detection.fit > 0 && std::isnan(detection.margin)) // nothing to compare with
    return logistic(31 * detection.fit - 26.3);
  if (detection.fit > 0)
    return logistic(19.7 * detection.fit + 12.5 * detection.margin - 18.4);
  constexpr double kIndependent = 10; // neighbouring pairs tell the same: far fewer than features
  return logistic(kIndependent * detection.score) * n / (n + static_cast<double>(min_cluster));
}

void
detail::checkWithin(const pcl::Indices& indices, std::size_t size)
{
  for (const auto i : indices)
    if (i < 0 || static_cast<std::size_t>(i) >= size)
      throw std::invalid_argument("pcl_surflet: a detection has the point " + std::to_string(i) +
                                  ", the input cloud " + std::to_string(size) +
                                  "; give the cloud that it was found in");
}

double
detail::coverageOf(std::size_t cells, double area, double leaf)
{
  return area > 0 ? interpretation::areaOfCells(static_cast<double>(cells), leaf) / area
                  : std::numeric_limits<double>::quiet_NaN();
}

std::vector<SceneDetection>
detail::interpretPoints(const ConvertedSurflets& points, const ModelDatabase& database,
                        const InterpreterRequest& request, SceneDiagnostics& diagnostics,
                        SurfletSet& cells)
{
  const double leaf = leafOf(request.leaf, database);
  const SizeRange sizes = objectSizes(database);
  CellReduction reduction = request.method == Method::Dissertation
                                ? reduceToCells(points.surflets, leaf)
                                : reduceToTwoSidedCells(points.surflets, leaf);
  diagnostics.leaf = leaf;
  diagnostics.cells = reduction.cells.size();
  diagnostics.extent = diagonal(reduction.cells);
  diagnostics.largest_model = sizes.largest;
  // Also an absurd scene is interpreted, as none: parameters and database are checked there.
  auto result = interpretCells(muchTooSmall(diagnostics, sizes) ? SurfletSet() : reduction.cells,
                               database, request, leaf, diagnostics.runs);
  describe(result, sizes, diagnostics);
  keepLargest(request.max_detections, result.detections);
  std::vector<SceneDetection> detections(result.detections.size());
  for (std::size_t k = 0; k < detections.size(); ++k) {
    auto& d = detections[k];
    static_cast<Detection&>(d) = std::move(result.detections[k]);
    d.confidence = confidenceOf(d, request.parameters.steps.min_cluster);
    d.coverage = coverageOf(d.cells.size(), database[d.model].areaOf(d.member), leaf);
  }
  findPoints(reduction, points, leaf, detections);
  cells = std::move(reduction.cells);
  return detections;
}

} // namespace pcl_surflet

PCL_SURFLET_INSTANTIATE_SceneInterpreter(pcl::PointXYZ, pcl::Normal);
PCL_SURFLET_INSTANTIATE_SceneInterpreter(pcl::PointXYZRGB, pcl::Normal);
PCL_SURFLET_INSTANTIATE_SceneInterpreter(pcl::PointNormal, pcl::PointNormal);
PCL_SURFLET_INSTANTIATE_SceneInterpreter(pcl::PointXYZRGBNormal, pcl::PointXYZRGBNormal);
