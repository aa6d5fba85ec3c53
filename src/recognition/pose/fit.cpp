// How well a cluster lies on a model, and how to make it lie better.
#include "core/cholesky.h"
#include "pose_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_surflet {
namespace pose {
namespace {

constexpr double kLeastCosine = 0.5;   ///< of normals that are alike
constexpr double kEnoughCosine = 0.87; ///< from here on, that is all one can ask of sensed normals
/** \brief Distance within a tangent plane that tells nothing: the surface's surflets are so far
 * apart. */
constexpr double kSpacing = 0.015;

/** \brief Of a cell beside the cluster that lies on the model: it may be there by chance. */
constexpr double kBesideWeight = 0.5;

/** \brief What a cell of the cluster meets on the model. */
struct Contact {
  std::uint16_t surflet = SurfaceLookup::none;
  Vector3 place;       ///< of the cell, in the model's frame
  Vector3 normal;      ///< of the model
  double distance = 0; ///< signed, from the tangent plane
  double weight = 0;   ///< 1 on the model, 0 out of reach or facing elsewhere
};

Contact
contactOf(const ModelData& model, const SurfletSet& cells, std::size_t i,
          const RigidMotion& to_model, double reach)
{
  Contact c;
  c.place = to_model.moved(positionOf(cells, i));
  const Vector3 n = to_model.turned(normalOf(cells, i));
  c.surflet = model.lookup.nearest(c.place, n);
  if (c.surflet == SurfaceLookup::none)
    return c;
  c.normal = normalOf(model.surface, c.surflet);
  const Vector3 d = detail::subtract(c.place, positionOf(model.surface, c.surflet));
  c.distance = detail::dot(d, c.normal);
  const double sideways = std::sqrt(std::max(0.0, detail::dot(d, d) - c.distance * c.distance));
  const double beyond = std::max(0.0, sideways - kSpacing);
  const double square = (c.distance * c.distance + beyond * beyond) / (reach * reach);
  const double alike = (detail::dot(n, c.normal) - kLeastCosine) / (kEnoughCosine - kLeastCosine);
  if (square < 1 && alike > 0)
    c.weight = (1 - square) * std::min(1.0, alike);
  return c;
}

/** \brief Sums over the contacts of a set. */
struct Contacts {
  double weight = 0, squares = 0;
};

/** \brief Marks the model's cells that are met in \p found. */
Contacts
contactsOf(const ModelData& model, const SurfletSet& cells, const RigidMotion& to_model,
           double reach, std::vector<char>& found)
{
  Contacts sum;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Contact c = contactOf(model, cells, i, to_model, reach);
    if (!(c.weight > 0))
      continue;
    sum.weight += c.weight;
    sum.squares += c.weight * c.distance * c.distance;
    found[model.cell_of[c.surflet]] = 1;
  }
  return sum;
}

/** \brief Cells of the model that the sensors should see. */
std::vector<char>
expected(const ModelData& model, const Cluster& cluster, const RigidMotion& to_model)
{
  std::vector<char> seen(model.cells.size(), 0);
  for (const auto& v : cluster.viewpoints) {
    const Vector3 there = to_model.moved(v);
    const double distance = detail::norm(there);
    if (distance > 0)
      model.visibility.addSeen(detail::scaled(there, 1 / distance), seen);
  }
  return seen;
}

/** \brief Share of what should be seen that was not found; 0 if nothing should be. */
double
unseenShare(const std::vector<char>& should, const std::vector<char>& found)
{
  std::size_t all = 0, missing = 0;
  for (std::size_t i = 0; i < should.size(); ++i) {
    all += should[i] != 0;
    missing += should[i] != 0 && found[i] == 0;
  }
  return all == 0 ? 0.0 : static_cast<double>(missing) / static_cast<double>(all);
}

/** \brief The small motion x -> x + turn x x + shift, made rigid. */
RigidMotion
smallMotion(const std::array<double, 6>& step)
{
  const Vector3 turn{step[0], step[1], step[2]};
  const double angle = detail::norm(turn);
  RigidMotion m;
  if (angle > 0)
    m = turnAbout(detail::scaled(turn, 1 / angle), {0, 0, 0}, angle);
  m.translation = {step[3], step[4], step[5]};
  return m;
}

} // namespace

Fit
fitOf(const ModelData& model, const Cluster& cluster, const RigidMotion& to_model, double reach)
{
  const double n = static_cast<double>(std::max<std::size_t>(cluster.cells.size(), 1));
  std::vector<char> found(model.cells.size(), 0);
  const auto own = contactsOf(model, cluster.cells, to_model, reach, found);
  const auto beside = contactsOf(model, cluster.beside, to_model, reach, found);
  Fit fit;
  fit.share = own.weight / n;
  fit.squares = own.weight > 0 ? own.squares / own.weight : 0;
  fit.score = (own.weight + kBesideWeight * beside.weight) / n;
  if (!cluster.viewpoints.empty() && cluster.unseen_weight > 0)
    fit.score -= cluster.unseen_weight * unseenShare(expected(model, cluster, to_model), found);
  return fit;
}

double
coverageOf(const ModelData& model, const Cluster& cluster, const RigidMotion& to_model,
           double reach)
{
  const auto should = expected(model, cluster, to_model);
  if (std::find(should.begin(), should.end(), 1) == should.end())
    return std::numeric_limits<double>::quiet_NaN();
  std::vector<char> found(model.cells.size(), 0);
  contactsOf(model, cluster.cells, to_model, reach, found);
  return 1 - unseenShare(should, found);
}

double
selfShare(const ModelData& model, const RigidMotion& motion, double reach)
{
  constexpr std::size_t kSurflets = 800;
  return fitOf(model, {thinned(model.surface, kSurflets), {}, {}, 0}, motion, reach).share;
}

std::array<double, 6>
NormalEquations::solved(double damping) const
{
  return solvedByCholesky(matrix, right, damping);
}

NormalEquations
normalEquations(const ModelData& model, const SurfletSet& cells, const RigidMotion& to_model,
                double reach)
{
  NormalEquations e;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Contact c = contactOf(model, cells, i, to_model, reach);
    if (!(c.weight > 0))
      continue;
    const Vector3 lever = detail::cross(c.place, c.normal);
    const std::array<double, 6> row = {lever[0],    lever[1],    lever[2],
                                       c.normal[0], c.normal[1], c.normal[2]};
    for (std::size_t a = 0; a < 6; ++a) {
      for (std::size_t b = 0; b < 6; ++b)
        e.matrix[a][b] += c.weight * row[a] * row[b];
      e.right[a] -= c.weight * row[a] * c.distance;
    }
    e.weight += c.weight;
    e.squares += c.weight * c.distance * c.distance;
    ++e.cells;
  }
  return e;
}

RigidMotion
refined(const ModelData& model, const SurfletSet& cells, RigidMotion to_model, double coarse,
        double fine, unsigned steps)
{
  constexpr double kDamping = 1e-4; // turns about an axis of revolution stay as they are
  for (unsigned k = 0; k < steps; ++k) {
    const double reach = coarse + (fine - coarse) * k / std::max(steps - 1, 1u);
    const auto equations = normalEquations(model, cells, to_model, reach);
    if (equations.cells < 6)
      break;
    to_model = smallMotion(equations.solved(kDamping * equations.weight)).after(to_model);
  }
  return to_model;
}

} // namespace pose
} // namespace pcl_surflet
