#include "pose_parts.h"

#include "pcl_surflet/core/geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_surflet {
namespace pose {
namespace {

constexpr double kSurfaceLeaf = 1.0 / 70;
constexpr std::size_t kMostSurface = 20000, kCells = 500, kFewestCells = 50;

/** \brief Centred, its diameter 1. */
SurfletSet
inUnitFrame(const SurfletSet& set, const Vector3& centre, double diameter)
{
  SurfletSet out;
  out.reserve(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    const auto p = detail::toFloat3(
        detail::scaled(detail::subtract(positionOf(set, i), centre), 1 / diameter));
    out.push_back({p[0], p[1], p[2], set.nx[i], set.ny[i], set.nz[i]});
  }
  return out;
}

/** \brief Edge of cells such that there are about kCells. */
double
leafFor(const SurfletSet& surface)
{
  double leaf = 0.06;
  for (int k = 0; k < 3; ++k)
    leaf *= std::sqrt(static_cast<double>(cellsByDirection(surface, leaf).size()) / kCells);
  return std::clamp(leaf, 0.02, 0.2);
}

/** \brief The cell of every surflet: the nearest one of those that face the same way. */
std::vector<std::uint16_t>
cellsOf(const SurfletSet& surface, const SurfletSet& cells)
{
  std::vector<std::uint16_t> out(surface.size(), 0);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const Vector3 d = detail::subtract(positionOf(surface, i), positionOf(cells, k));
      const double facing = detail::dot(normalOf(surface, i), normalOf(cells, k));
      const double far = detail::dot(d, d) + 0.02 * (1 - facing); // 0.2 for the opposite way
      if (far < best) {
        best = far;
        out[i] = static_cast<std::uint16_t>(k);
      }
    }
  }
  return out;
}

SurfletSet
checked(const std::string& label, const SurfletSet& surflets)
{
  SurfletSet out;
  out.reserve(surflets.size());
  for (std::size_t i = 0; i < surflets.size(); ++i)
    if (!out.appendChecked(surflets[i]))
      throw PoseModelError("'" + label + "': surflet " + std::to_string(i) +
                           " is not finite or has no normal; remove such points");
  return out;
}

} // namespace

ModelData::ModelData(std::string name, double model_diameter, const Vector3& model_centre,
                     SurfletSet unit_surface)
    : label(std::move(name)), diameter(model_diameter), centre(model_centre),
      surface(std::move(unit_surface)), lookup(surface), leaf(leafFor(surface)),
      cells(cellsByDirection(surface, leaf)), cell_of(cellsOf(surface, cells)), table(cells),
      visibility(surface, cells)
{
}

} // namespace pose

PoseModelError::~PoseModelError() = default;

PoseModel
PoseModel::train(const std::string& label, const SurfletSet& surflets, std::uint64_t seed)
{
  const SurfletSet usable = pose::checked(label, surflets);
  const double diameter = farthestDistance(usable);
  if (!(diameter > 1e-12) || !std::isfinite(diameter))
    throw PoseModelError("'" + label +
                         "' has no extent; give surflets of the whole surface, finite");
  const Extent extent = computeExtent(usable);
  const pose::Vector3 centre{extent.centroid[0], extent.centroid[1], extent.centroid[2]};
  SurfletSet surface = pose::thinned(
      pose::cellsByDirection(pose::inUnitFrame(usable, centre, diameter), pose::kSurfaceLeaf),
      pose::kMostSurface);
  if (surface.size() < pose::kFewestCells)
    throw PoseModelError("'" + label + "' has only " + std::to_string(surface.size()) +
                         " cells; give more surflets of its surface, 20,000 are a good number");
  const auto data = std::make_shared<pose::ModelData>(label, diameter, centre, std::move(surface));
  pose::findSymmetries(*data, seed);
  return PoseModel(data);
}

const std::string&
PoseModel::label() const
{
  return data_->label;
}

double
PoseModel::diameter() const
{
  return data_->diameter;
}

const Symmetry&
PoseModel::symmetry() const
{
  return data_->symmetry;
}

SurfletSet
PoseModel::cells() const
{
  SurfletSet out;
  const SurfletSet& cells = data_->cells;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto p = detail::toFloat3(
        detail::add(data_->centre, detail::scaled(pose::positionOf(cells, i), data_->diameter)));
    out.push_back({p[0], p[1], p[2], cells.nx[i], cells.ny[i], cells.nz[i]});
  }
  return out;
}

} // namespace pcl_surflet
