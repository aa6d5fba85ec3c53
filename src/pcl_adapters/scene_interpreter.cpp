// Interpretation of PCL's clouds, compiled once; and the templates for common point types.

#include "pcl_surflet/impl/scene_interpreter.hpp"

#include "pcl_surflet/core/cell_reduction.h"

#include <algorithm>

namespace pcl_surflet {
namespace {

/** \brief Cells per diameter of the largest object, where the user does not say. */
constexpr double kCellsPerDiameter = 50;

/** \brief The points of every detection, by their cells. */
void
findPoints(const CellReduction& reduction, const ConvertedSurflets& points,
           std::vector<SceneDetection>& detections)
{
  std::vector<std::vector<std::uint32_t>> owners(reduction.cells.size());
  for (std::uint32_t k = 0; k < detections.size(); ++k)
    for (const auto cell : detections[k].cells)
      owners[cell].push_back(k);
  for (std::size_t i = 0; i < points.indices.size(); ++i) {
    const auto cell = reduction.cell_of[i];
    if (cell == CellReduction::no_cell)
      continue;
    for (const auto k : owners[cell])
      detections[k].indices.push_back(points.indices[i]);
  }
  for (auto& d : detections)
    std::sort(d.indices.begin(), d.indices.end());
}

double
largestObject(const ModelDatabase& database)
{
  double largest = 0;
  for (std::size_t i = 0; i < database.size(); ++i)
    if (database[i].role == ModelRole::Object)
      largest = std::max(largest, database[i].delta_max);
  return largest;
}

} // namespace

std::vector<SceneDetection>
detail::interpretPoints(const ConvertedSurflets& points, const ModelDatabase& database,
                        const InterpreterRequest& request, InterpretationDiagnostics& diagnostics)
{
  const double largest = largestObject(database);
  if (!(largest > 0))
    throw DatabaseError("the database has no object to find; call setDatabase()");
  const double leaf = request.leaf > 0 ? request.leaf : largest / kCellsPerDiameter;
  const CellReduction reduction = reduceToCells(points.surflets, leaf);
  auto result = request.method == Method::Dissertation
                    ? interpretByDissertation(reduction.cells, database, request.parameters.steps)
                    : interpretByExplanation(reduction.cells, database, request.parameters);
  diagnostics = std::move(result.diagnostics);
  auto& found = result.detections;
  if (request.max_detections > 0 && found.size() > request.max_detections) {
    std::stable_sort(found.begin(), found.end(), [](const Detection& a, const Detection& b) {
      return a.cells.size() > b.cells.size();
    });
    found.resize(request.max_detections);
  }
  std::vector<SceneDetection> detections(found.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    static_cast<Detection&>(detections[k]) = std::move(found[k]);
  findPoints(reduction, points, detections);
  return detections;
}

} // namespace pcl_surflet

PCL_INSTANTIATE_SceneInterpreter(pcl::PointXYZ, pcl::Normal)
    PCL_INSTANTIATE_SceneInterpreter(pcl::PointXYZRGB, pcl::Normal)
        PCL_INSTANTIATE_SceneInterpreter(pcl::PointNormal, pcl::PointNormal)
            PCL_INSTANTIATE_SceneInterpreter(pcl::PointXYZRGBNormal, pcl::PointXYZRGBNormal)
