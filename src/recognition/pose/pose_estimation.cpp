// The pose of a model in a cluster: votes, scores, refinement, choice among look-alikes.
#include "pose_parts.h"

#include "pcl_surflet/core/conditions.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pcl_surflet {
namespace pose {
namespace {

constexpr std::size_t kScoringCells = 200; ///< by which proposals are compared
constexpr double kEqual = 0.01;            ///< scores nearer than this do not decide
constexpr std::size_t kMostPoints = 20000; ///< more add time and no precision
constexpr double kFinalLeaf = 1.0 / 40;
constexpr double kAlikeReach = 0.03,
                 kLooksAlike = 0.95; ///< share of the model on itself that no one can tell apart

void
check(const PoseParameters& p)
{
  const auto require = [](bool fine, const char* what) {
    if (!fine)
      throw std::invalid_argument(std::string("estimatePose: ") + what);
  };
  require(p.references >= 1 && p.partners >= 1 && p.peaks >= 1 && p.refined >= 1,
          "references, partners, peaks and refined must be positive");
  require(p.final_cells >= 50, "final_cells must be at least 50");
  require(p.coarse_reach > 0 && p.coarse_reach <= kReach, "coarse_reach must be in (0, 0.08]");
  require(p.fine_reach > 0 && p.fine_reach <= p.coarse_reach,
          "fine_reach must be in (0, coarse_reach]");
  require(p.unseen_weight >= 0 && p.unseen_weight <= 1, "unseen_weight must be in [0, 1]");
  require(p.min_inliers >= 0 && p.min_inliers <= 1, "min_inliers must be in [0, 1]");
  for (const auto& v : p.viewpoints)
    require(std::isfinite(v[0] + v[1] + v[2]), "viewpoints must be finite");
}

/** \brief Moves and scales the scene so that lengths are the model's unit. */
struct SceneFrame {
  Vector3 centre;
  double unit;

  Vector3
  into(const Vector3& p) const
  {
    return detail::scaled(detail::subtract(p, centre), 1 / unit);
  }
};

SceneFrame
frameAround(const SurfletSet& cluster, double unit)
{
  const Extent extent = computeExtent(cluster);
  return {{extent.centroid[0], extent.centroid[1], extent.centroid[2]}, unit};
}

SurfletSet
usable(const SurfletSet& cluster)
{
  SurfletSet out;
  out.reserve(cluster.size());
  for (std::size_t i = 0; i < cluster.size(); ++i)
    out.appendChecked(cluster[i]);
  return out;
}

/** \brief At most \p most cells of the part of \p set within \p radius of the middle, where the
 * model can be. */
SurfletSet
cellsAround(const SurfletSet& set, const SceneFrame& frame, double radius, std::size_t most)
{
  SurfletSet near;
  near.reserve(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Vector3 p = frame.into(positionOf(set, i));
    if (!(detail::dot(p, p) <= radius * radius))
      continue;
    const auto q = detail::toFloat3(p);
    near.push_back({q[0], q[1], q[2], set.nx[i], set.ny[i], set.nz[i]});
  }
  return thinned(cellsByDirection(near, kFinalLeaf), most);
}

/** \brief Variance of the normals along their second principal direction, both signs alike: 0 if
 * all are parallel. */
double
secondSpread(const SurfletSet& cells)
{
  SurfletSet normals;
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (const float sign : {1.0F, -1.0F})
      normals.push_back({sign * cells.nx[i], sign * cells.ny[i], sign * cells.nz[i], 0, 0, 1});
  const auto axes = principalAxes(normals);
  double sum = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double along = detail::dot(axes[1], normalOf(cells, i));
    sum += along * along;
  }
  return sum / static_cast<double>(cells.size());
}

PoseEstimate
refusal(PoseStatus status, const std::string& reason, std::size_t cells)
{
  PoseEstimate e;
  e.status = status;
  e.reason = reason;
  e.cells = cells;
  return e;
}

SurfletSet
joined(SurfletSet a, const SurfletSet& b)
{
  for (std::size_t i = 0; i < b.size(); ++i)
    a.push_back(b[i]);
  return a;
}

/** \brief One estimation. */
class Search {
public:
  Search(const ModelData& model, Cluster cluster, const PoseParameters& parameters)
      : model_(model), cluster_(std::move(cluster)), parameters_(parameters)
  {
  }

  /** \brief The motions that were refined, the best first; empty if nothing was voted for. */
  std::vector<Proposal>
  run() const
  {
    Cluster some = cluster_;
    some.cells = thinned(cluster_.cells, kScoringCells);
    auto voted = proposals(model_, cellsByDirection(cluster_.cells, model_.leaf), parameters_);
    for (auto& p : voted)
      p.score = fitOf(model_, some, p.to_model, parameters_.coarse_reach).score;
    auto best = distinct(std::move(voted), parameters_.refined);
    for (auto& p : best)
      p = settled(p.to_model, some.cells, parameters_.coarse_reach, 6);
    best = distinct(std::move(best), parameters_.refined);
    for (unsigned round = 0; round < 2 && !best.empty(); ++round)
      tryTurns(best);
    const SurfletSet all = joined(cluster_.cells, cluster_.beside);
    if (!best.empty())
      best.insert(best.begin(), {middleOfEquals(best.front().to_model), 0});
    for (auto& p : best)
      p = settled(p.to_model, all, 2 * parameters_.fine_reach, 6);
    return ranked(std::move(best));
  }

private:
  Proposal
  settled(const RigidMotion& start, const SurfletSet& cells, double reach, unsigned steps) const
  {
    Proposal p;
    p.to_model = refined(model_, cells, start, std::max(reach, parameters_.fine_reach),
                         parameters_.fine_reach, steps);
    p.score = fitOf(model_, cluster_, p.to_model, parameters_.fine_reach).score;
    return p;
  }

  /** \brief The first stays the first unless another one is clearly better. */
  static std::vector<Proposal>
  ranked(std::vector<Proposal> best)
  {
    if (best.empty())
      return best;
    best.front().score += kEqual;
    const double first = best.front().score;
    const std::size_t all = best.size();
    best = distinct(std::move(best), all);
    if (best.front().score == first)
      best.front().score -= kEqual;
    return best;
  }

  /** \brief Of all turns that fit as well as \p best, the one in their middle: a hidden handle is
   * somewhere in the shadow, and the middle of the shadow is the least wrong. */
  RigidMotion
  middleOfEquals(const RigidMotion& best) const
  {
    const double reach = 2 * parameters_.fine_reach;
    const double least = fitOf(model_, cluster_, best, reach).score - kEqual;
    std::vector<RigidMotion> equal = {best};
    for (const auto& turn : model_.turns)
      if (fitOf(model_, cluster_, turn.after(best), reach).score >= least)
        equal.push_back(turn.after(best));
    const auto spread = [&](const RigidMotion& from) {
      double sum = 0;
      for (const auto& m : equal)
        sum += angleOf(m.after(from.inverse()));
      return sum;
    };
    return *std::min_element(equal.begin(), equal.end(), [&](const auto& a, const auto& b) {
      return spread(a) < spread(b) - 1e-9;
    });
  }

  /** \brief Near symmetries of the best: only what disagrees with them can decide. */
  void
  tryTurns(std::vector<Proposal>& best) const
  {
    constexpr std::size_t kSettled = 4;
    const double reach = 2 * parameters_.fine_reach; // half a step between turns must not matter
    std::vector<Proposal> turned;
    for (const auto& turn : model_.turns) {
      const RigidMotion m = turn.after(best.front().to_model);
      turned.push_back({m, fitOf(model_, cluster_, m, reach).score});
    }
    const SurfletSet some = joined(thinned(cluster_.cells, 2 * kScoringCells), cluster_.beside);
    for (const auto& p : distinct(std::move(turned), kSettled))
      best.push_back(settled(p.to_model, some, reach, 4));
    best = distinct(std::move(best), parameters_.refined);
  }

  const ModelData& model_;
  Cluster cluster_;
  const PoseParameters& parameters_;
};

/** \brief Score of the best less that of the best one that looks different. */
double
marginOf(const ModelData& model, const std::vector<Proposal>& found)
{
  for (std::size_t k = 1; k < found.size(); ++k) {
    const RigidMotion between = found[k].to_model.after(found[0].to_model.inverse());
    if (selfShare(model, between, kAlikeReach) < kLooksAlike)
      return std::max(0.0, found[0].score - found[k].score);
  }
  return found[0].score;
}

/** \brief Standard deviations from the normal equations, without the turn about a continuous axis.
 */
void
setDeviations(const ModelData& model, const SurfletSet& cells, const Proposal& best, double reach,
              PoseEstimate& e)
{
  auto equations = normalEquations(model, cells, best.to_model, reach);
  if (model.symmetry.kind == SymmetryKind::Continuous)
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        equations.matrix[a][b] +=
            1e6 * equations.weight * model.symmetry.axis[a] * model.symmetry.axis[b];
  const double variance = equations.weight > 0 ? equations.squares / equations.weight : 0;
  std::array<double, 6> diagonal{};
  for (std::size_t a = 0; a < 6; ++a) {
    auto unit = equations;
    unit.right = {};
    unit.right[a] = 1;
    diagonal[a] = unit.solved(1e-9 * equations.weight)[a] * variance;
  }
  e.rotation_deviation = std::sqrt(diagonal[0] + diagonal[1] + diagonal[2]);
  e.position_deviation = std::sqrt(diagonal[3] + diagonal[4] + diagonal[5]) * model.diameter;
}

/** \brief From the unit frames to the model's and the scene's coordinates. */
RigidMotion
toScene(const ModelData& model, const SceneFrame& frame, const RigidMotion& to_model)
{
  RigidMotion m = to_model.inverse();
  m.translation =
      detail::subtract(detail::add(frame.centre, detail::scaled(m.translation, model.diameter)),
                       m.turned(model.centre));
  return m;
}

Symmetry
movedSymmetry(Symmetry s, const RigidMotion& motion)
{
  s.axis = motion.turned(s.axis);
  s.point = motion.moved(s.point);
  for (auto& m : s.motions)
    m = motion.after(m).after(motion.inverse());
  return s;
}

/** \brief What the first of \p found tells. */
PoseEstimate
described(const ModelData& model, const Cluster& cluster, const SceneFrame& frame,
          const std::vector<Proposal>& found, const PoseParameters& p)
{
  const Fit fit = fitOf(model, cluster, found[0].to_model, p.fine_reach);
  PoseEstimate e;
  e.cells = cluster.cells.size();
  e.motion = toScene(model, frame, found[0].to_model);
  e.score = fit.score;
  e.inlier_share = fit.share;
  e.coverage = coverageOf(model, cluster, found[0].to_model, p.fine_reach);
  e.residual = std::sqrt(fit.squares) * model.diameter;
  e.margin = marginOf(model, found);
  e.symmetry = movedSymmetry(model.symmetry, e.motion);
  setDeviations(model, cluster.cells, found[0], p.fine_reach, e);
  e.status = fit.share < p.min_inliers ? PoseStatus::NoAgreement : PoseStatus::Found;
  if (e.status == PoseStatus::NoAgreement)
    e.reason = "at the best pose only " + std::to_string(std::lround(100 * fit.share)) +
               " % of the cluster lie on the model";
  return e;
}

} // namespace
} // namespace pose

PoseEstimate
estimatePose(const SurfletSet& given, const PoseModel& pose_model, const PoseParameters& p,
             const SurfletSet& beside)
{
  using namespace pose;
  check(p);
  const ModelData& model = pose_model.data();
  const SurfletSet points = usable(thinned(given, kMostPoints));
  const SceneFrame frame = frameAround(points, model.diameter);
  pose::Cluster cluster;
  cluster.cells = cellsAround(points, frame, 2, p.final_cells);
  cluster.beside = cellsAround(usable(thinned(beside, kMostPoints)), frame, 1, p.final_cells);
  cluster.unseen_weight = p.unseen_weight;
  for (const auto& v : p.viewpoints)
    cluster.viewpoints.push_back(frame.into(v));
  const std::size_t n = cluster.cells.size();
  if (n < 3)
    return refusal(PoseStatus::TooFewCells,
                   "the cluster has " + std::to_string(n) +
                       " cells, three are needed: give more of its points, with finite normals",
                   n);
  if (secondSpread(cluster.cells) < 0.01)
    return refusal(PoseStatus::Undetermined,
                   "all normals of the cluster are parallel, a plane fits in many poses: see the "
                   "object from more sides",
                   n);
  const auto found = Search(model, cluster, p).run();
  if (found.empty())
    return refusal(PoseStatus::NoAgreement, "no pair of the cluster is like one of the model", n);
  return described(model, cluster, frame, found, p);
}

} // namespace pcl_surflet
