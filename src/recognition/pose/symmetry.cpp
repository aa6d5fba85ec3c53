// Symmetries of a model, exact and near, by registering it with itself.
#include "pose_parts.h"

#include "pcl_surflet/core/conditions.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace pose {
namespace {

constexpr double kExact = 0.955; ///< share of a surface on itself that makes it symmetric
constexpr double kNear = 0.6;    ///< and one worth a try when a pose is decided
constexpr double kReachOfSelf = 0.02;
constexpr double kLeastTurn = 0.35; ///< radians
constexpr double kSameAxis = 0.09;
constexpr std::size_t kMostAxes = 24;
constexpr unsigned kMostOrder = 12;
constexpr int kSteps = 36; ///< turns about an axis that are tried

struct Axis {
  Vector3 direction, point;
};

/** \brief Axis of a turn: what it leaves as it is. */
Axis
axisOf(const RigidMotion& m)
{
  const auto& r = m.rotation;
  // (R + R^T) / 2 - cos I = (1 - cos) a a^T: the longest column is safe also for half turns.
  const double c = std::cos(angleOf(m));
  Vector3 best{0, 0, 1};
  double longest = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    Vector3 column;
    for (std::size_t i = 0; i < 3; ++i)
      column[i] = (r[i][j] + r[j][i]) / 2 - (i == j ? c : 0.0);
    if (detail::norm(column) > longest) {
      longest = detail::norm(column);
      best = detail::scaled(column, 1 / longest);
    }
  }
  // The fixed point nearest to the origin: (t + cot(angle / 2) a x t) / 2 for t across the axis.
  const Vector3 turned{r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]};
  if (detail::dot(turned, best) < 0)
    best = detail::scaled(best, -1);
  const Vector3 across =
      detail::subtract(m.translation, detail::scaled(best, detail::dot(m.translation, best)));
  const double cotangent = 1 / std::tan(angleOf(m) / 2);
  return {best,
          detail::scaled(
              detail::add(across, detail::scaled(detail::cross(best, across), cotangent)), 0.5)};
}

bool
same(const Axis& a, const Axis& b)
{
  return std::abs(detail::dot(a.direction, b.direction)) > std::cos(kSameAxis);
}

/** \brief The motion, moved to where it maps the model onto itself best. */
RigidMotion
settled(const ModelData& model, const RigidMotion& motion)
{
  return refined(model, thinned(model.surface, 800), motion, 0.06, kReachOfSelf, 8);
}

/** \brief Motions that might be symmetries: half turns about the principal axes, and what pairs
 * vote for. */
std::vector<RigidMotion>
candidates(const ModelData& model, std::uint64_t seed)
{
  std::vector<RigidMotion> all;
  for (const auto& axis : principalAxes(model.surface))
    for (const double angle : {M_PI, M_PI / 2, 2 * M_PI / 3})
      all.push_back(turnAbout(axis, {0, 0, 0}, angle));
  PoseParameters parameters;
  parameters.seed = seed;
  parameters.peaks = 8;
  const Cluster itself{model.cells, {}, {}, 0};
  auto voted = proposals(model, model.cells, parameters);
  for (auto& p : voted)
    p.score = fitOf(model, itself, p.to_model, kReach).score;
  for (const auto& p : distinct(std::move(voted), 60))
    all.push_back(p.to_model);
  return all;
}

/** \brief Axes of the candidates that nearly are symmetries, the best first. */
std::vector<Axis>
axesOf(const ModelData& model, std::uint64_t seed)
{
  std::vector<std::pair<double, Axis>> rated;
  for (const auto& candidate : candidates(model, seed)) {
    const RigidMotion m = settled(model, candidate);
    if (angleOf(m) < kLeastTurn)
      continue;
    const double share = selfShare(model, m, kReachOfSelf);
    if (share >= kNear)
      rated.emplace_back(share, axisOf(m));
  }
  std::stable_sort(rated.begin(), rated.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Axis> axes;
  for (const auto& entry : rated) {
    const Axis& axis = entry.second;
    if (axes.size() < kMostAxes &&
        std::none_of(axes.begin(), axes.end(), [&](const Axis& a) { return same(a, axis); }))
      axes.push_back(axis);
  }
  return axes;
}

double
shareOfTurn(const ModelData& model, const Axis& axis, double angle)
{
  return selfShare(model, turnAbout(axis.direction, axis.point, angle), kReachOfSelf);
}

bool
isContinuous(const ModelData& model, const Axis& axis)
{
  for (int k = 1; k <= 12; ++k) // no rational part of a turn
    if (shareOfTurn(model, axis, k * 2.39996) < kExact)
      return false;
  return true;
}

unsigned
orderOf(const ModelData& model, const Axis& axis)
{
  for (unsigned n = kMostOrder; n > 1; --n) {
    bool all = true;
    for (unsigned k = 1; k < n && all; ++k)
      all = shareOfTurn(model, axis, 2 * M_PI * k / n) >= kExact;
    if (all)
      return n;
  }
  return 1;
}

/** \brief Keeps the axis if it is a better one than what is known. */
void
rank(SymmetryKind kind, unsigned order, const Axis& axis, Symmetry& best)
{
  if (kind < best.kind || (kind == best.kind && order <= best.order))
    return;
  best.kind = kind;
  best.order = order;
  best.axis = axis.direction;
  best.point = axis.point;
}

/** \brief Turns about \p axis to try when a pose is decided. */
void
addTurns(const ModelData& model, const Axis& axis, std::vector<RigidMotion>& turns)
{
  for (int k = 1; k < kSteps; ++k)
    if (shareOfTurn(model, axis, k * 2 * M_PI / kSteps) >= kNear)
      turns.push_back(turnAbout(axis.direction, axis.point, k * 2 * M_PI / kSteps));
}

/** \brief From the unit frame to the model's coordinates. */
RigidMotion
inModelUnits(const ModelData& model, RigidMotion m)
{
  const Vector3 scaled_shift = detail::scaled(m.translation, model.diameter);
  m.translation = detail::add(detail::subtract(model.centre, m.turned(model.centre)), scaled_shift);
  return m;
}

} // namespace

void
findSymmetries(ModelData& model, std::uint64_t seed)
{
  Symmetry found;
  unsigned continuous = 0;
  for (const auto& axis : axesOf(model, seed)) {
    if (isContinuous(model, axis)) {
      rank(++continuous > 1 ? SymmetryKind::Spherical : SymmetryKind::Continuous, 0, axis, found);
      continue;
    }
    const unsigned order = orderOf(model, axis);
    for (unsigned k = 1; k < order; ++k)
      found.motions.push_back(
          inModelUnits(model, turnAbout(axis.direction, axis.point, 2 * M_PI * k / order)));
    if (order > 1)
      rank(SymmetryKind::Discrete, order, axis, found);
    addTurns(model, axis, model.turns);
  }
  if (found.kind == SymmetryKind::Spherical)
    found.motions.clear();
  found.point = detail::add(model.centre, detail::scaled(found.point, model.diameter));
  model.symmetry = std::move(found);
}

} // namespace pose
} // namespace pcl_surflet
