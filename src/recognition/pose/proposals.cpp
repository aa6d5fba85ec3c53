// Pairs of the cluster vote for motions of the model.
#include "pose_parts.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/surflet_pair.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace pose {
namespace {

constexpr std::size_t kAngles = 30; ///< of the turn about a reference's normal

/** \brief Votes of one reference: which cell of the model is it, turned how? */
class Ballot {
public:
  explicit Ballot(std::size_t cells) : votes_(cells * kAngles) {}

  void
  clear()
  {
    std::fill(votes_.begin(), votes_.end(), 0);
  }
  void
  vote(std::uint16_t cell, double turn)
  {
    double at = turn / (2 * M_PI);
    at -= std::floor(at);
    const auto bin = std::min(static_cast<std::size_t>(at * kAngles), kAngles - 1);
    ++votes_[cell * kAngles + bin];
  }
  /** \brief Votes of a bin and its neighbours, which share what falls beside a border. */
  std::uint32_t
  support(std::size_t place) const
  {
    const std::size_t cell = place / kAngles * kAngles, bin = place % kAngles;
    return 2 * votes_[place] + votes_[cell + (bin + 1) % kAngles] +
           votes_[cell + (bin + kAngles - 1) % kAngles];
  }
  /** \brief The places of most support, of different cells. */
  std::vector<std::size_t>
  peaks(std::size_t most) const
  {
    std::vector<std::pair<std::uint32_t, std::size_t>> best;
    for (std::size_t first = 0; first < votes_.size(); first += kAngles) {
      std::size_t place = first;
      for (std::size_t k = first + 1; k < first + kAngles; ++k)
        if (support(k) > support(place))
          place = k;
      if (support(place) > 0)
        best.emplace_back(~support(place), place); // ascending: most first, then the first place
    }
    const auto n = std::min(most, best.size());
    std::partial_sort(best.begin(), best.begin() + static_cast<std::ptrdiff_t>(n), best.end());
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < n; ++k)
      out.push_back(best[k].second);
    return out;
  }
  static double
  turnOf(std::size_t place)
  {
    return (static_cast<double>(place % kAngles) + 0.5) * 2 * M_PI / kAngles;
  }

private:
  std::vector<std::uint16_t> votes_;
};

/** \brief The motion that takes \p scene to \p model, point and normal, and turns by \p turn about
 * the normal from frame to frame. */
RigidMotion
motionOf(const SurfletSet& cells, std::size_t scene, const SurfletSet& model_cells,
         std::size_t model, double turn)
{
  const auto from = frameOf(normalOf(cells, scene)), to = frameOf(normalOf(model_cells, model));
  const double c = std::cos(turn), s = std::sin(turn);
  // Azimuth a in the scene is azimuth a - turn in the model.
  const std::array<Vector3, 3> turned = {
      detail::add(detail::scaled(from[0], c), detail::scaled(from[1], s)),
      detail::add(detail::scaled(from[0], -s), detail::scaled(from[1], c)), from[2]};
  RigidMotion m;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      m.rotation[i][j] =
          to[0][i] * turned[0][j] + to[1][i] * turned[1][j] + to[2][i] * turned[2][j];
  m.translation =
      detail::subtract(positionOf(model_cells, model), m.turned(positionOf(cells, scene)));
  return m;
}

/** \brief Pairs of cell \p reference with others vote, where Eq. 2.2 makes it the origin. */
void
voteOf(const ModelData& model, const SurfletSet& cells, std::size_t reference,
       const std::vector<std::uint32_t>& partners, Ballot& ballot)
{
  const auto frame = frameOf(normalOf(cells, reference));
  const Surflet s = cells[reference];
  for (const auto i : partners) {
    const Vector3 d = detail::subtract(positionOf(cells, i), positionOf(cells, reference));
    if (detail::dot(d, d) > 1) // longer than the model
      continue;
    bool second = false;
    const auto f = computePairFeature(s, cells[i], second);
    if (!f || second)
      continue;
    const double azimuth = azimuthOf(d, frame);
    const auto range = model.table.pairsLike({f->alpha, f->beta, f->gamma, f->delta});
    for (auto* p = range.first; p != range.last; ++p)
      ballot.vote(p->origin, azimuth - p->azimuth);
  }
}

/** \brief \p count different numbers below \p n, at random; all if there are no more. */
std::vector<std::uint32_t>
drawn(std::size_t n, std::size_t count, CounterRandom& random)
{
  std::vector<std::uint32_t> all(n);
  for (std::uint32_t i = 0; i < n; ++i)
    all[i] = i;
  const std::size_t k = std::min(n, count);
  for (std::size_t i = 0; i < k; ++i)
    std::swap(all[i], all[i + random.below(static_cast<std::uint32_t>(n - i))]);
  all.resize(k);
  return all;
}

double
angleBetween(const RigidMotion& a, const RigidMotion& b)
{
  return angleOf(a.after(b.inverse()));
}

} // namespace

double
angleOf(const RigidMotion& m)
{
  return std::acos(
      std::clamp((m.rotation[0][0] + m.rotation[1][1] + m.rotation[2][2] - 1) / 2, -1.0, 1.0));
}

std::vector<Proposal>
proposals(const ModelData& model, const SurfletSet& cells, const PoseParameters& parameters)
{
  CounterRandom random(parameters.seed, 0x706f7365ULL);
  const auto references = drawn(cells.size(), parameters.references, random);
  const auto partners = drawn(cells.size(), parameters.partners, random);
  Ballot ballot(model.cells.size());
  std::vector<Proposal> all;
  for (const auto r : references) {
    ballot.clear();
    voteOf(model, cells, r, partners, ballot);
    for (const auto place : ballot.peaks(parameters.peaks))
      all.push_back({motionOf(cells, r, model.cells, place / kAngles, Ballot::turnOf(place)), 0});
  }
  return all;
}

std::vector<Proposal>
distinct(std::vector<Proposal> all, std::size_t most)
{
  constexpr double kSameAngle = 0.15, kSamePlace = 0.04;
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  std::vector<Proposal> kept;
  for (const auto& p : all) {
    if (kept.size() == most)
      break;
    // The model's centre is the origin of its frame: where each motion has it in the cluster.
    const Vector3 centre = p.to_model.inverse().translation;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Proposal& q) {
      return detail::norm(detail::subtract(centre, q.to_model.inverse().translation)) <
                 kSamePlace &&
             angleBetween(p.to_model, q.to_model) < kSameAngle;
    });
    if (!known)
      kept.push_back(p);
  }
  return kept;
}

} // namespace pose
} // namespace pcl_surflet
