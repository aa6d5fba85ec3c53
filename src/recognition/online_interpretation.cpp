#include "pcl_surflet/recognition/online_interpretation.h"

#include "online_cells.h"
#include "recognition/interpretation/scene_models.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <unordered_set>

namespace pcl_surflet {
namespace {

using online::CellKey;
using Indices = std::vector<std::uint32_t>;

constexpr std::uint64_t kNobody = 0;
/** \brief Blocks of the changed region per delta_max of the largest model. */
constexpr int kBlocksPerModel = 4;
/** \brief A mean normal shorter than this says nothing about where the sensor was. */
constexpr double kEveryWay = 0.1;

void
require(bool holds, const char* what)
{
  if (!holds)
    throw std::invalid_argument(std::string("pcl_surflet: ") + what);
}

void
check(const OnlineParameters& p)
{
  require(p.leaf > 0 && std::isfinite(p.leaf), "the leaf size must be positive and finite");
  require(p.moved > 0 && std::isfinite(p.moved), "moved must be positive and finite");
  require(p.turned > 0 && p.turned <= 3.15, "turned must be in (0, pi]");
  require(p.coverage >= 0 && p.coverage <= 1, "the coverage of attractors must be in [0, 1]");
  require(p.margin >= -1 && p.margin <= 1, "the margin of attractors must be in [-1, 1]");
  require(p.distance >= 0 && std::isfinite(p.distance),
          "the distance from the empty scene must be positive and finite, or 0");
}

double
largestModel(const ModelDatabase& database)
{
  double largest = 0;
  for (std::size_t i = 0; i < database.size(); ++i)
    if (database[i].role == ModelRole::Object)
      largest = std::max(largest, database[i].delta_max);
  if (!(largest > 0))
    throw DatabaseError("the database has no object to find");
  return largest;
}

/** \brief Balls about changed cells, as blocks of the grid that they touch. */
class Region {
public:
  explicit Region(double block) : block_(block) {}
  void
  grow(const SurfletSet& cells, const Indices& changed, int blocks)
  {
    std::unordered_set<CellKey, online::CellKeyHash> origins;
    for (const auto c : changed)
      origins.insert(keyOf(cells.x[c], cells.y[c], cells.z[c]));
    for (const auto& o : origins)
      for (int x = -blocks; x <= blocks; ++x)
        for (int y = -blocks; y <= blocks; ++y)
          for (int z = -blocks; z <= blocks; ++z)
            if (gap(x) + gap(y) + gap(z) <= blocks * blocks)
              blocks_.insert({o[0] + x, o[1] + y, o[2] + z});
  }
  bool
  holds(double x, double y, double z) const
  {
    return blocks_.count(keyOf(x, y, z)) > 0;
  }

private:
  /** \brief Squared least distance of two blocks along an axis. */
  static int
  gap(int steps)
  {
    const int between = std::max(std::abs(steps) - 1, 0);
    return between * between;
  }
  CellKey
  keyOf(double x, double y, double z) const
  {
    const auto at = [this](double v) { return static_cast<std::int64_t>(std::floor(v / block_)); };
    return {at(x), at(y), at(z)};
  }

  double block_;
  std::unordered_set<CellKey, online::CellKeyHash> blocks_;
};

/** \brief Where some cells are and whereto they look. */
struct Patch {
  std::array<double, 3> centre{}, normal{};
  double radius = 0;
};

Patch
patchOf(const SurfletSet& cells, const Indices& indices)
{
  Patch patch;
  const SurfletSet part = cells.subset(indices);
  const Extent extent = computeExtent(part);
  const auto n = static_cast<double>(std::max<std::size_t>(part.size(), 1));
  for (std::size_t a = 0; a < 3; ++a)
    patch.centre[a] = extent.centroid[a];
  patch.radius = extent.r_max;
  for (std::size_t i = 0; i < part.size(); ++i) {
    patch.normal[0] += part.nx[i] / n;
    patch.normal[1] += part.ny[i] / n;
    patch.normal[2] += part.nz[i] / n;
  }
  return patch;
}

Attractor
attractorAt(const Patch& patch, std::uint64_t id)
{
  Attractor a{patch.centre, patch.radius, {}, id};
  const auto& n = patch.normal;
  const double length = std::hypot(n[0], n[1], n[2]);
  if (length >= kEveryWay)
    for (std::size_t k = 0; k < 3; ++k)
      a.view_from[k] = -n[k] / length;
  return a;
}

std::size_t
sharedCells(const Detection& a, const Detection& b)
{
  Indices common;
  std::set_intersection(a.cells.begin(), a.cells.end(), b.cells.begin(), b.cells.end(),
                        std::back_inserter(common));
  return common.size();
}

double
distanceOf(const Detection& a, const Detection& b)
{
  return std::hypot(a.centroid[0] - b.centroid[0], a.centroid[1] - b.centroid[1],
                    a.centroid[2] - b.centroid[2]);
}

/** \brief Groups of neighbouring cells among \p open, each ascending. */
std::vector<Indices>
connected(const online::OnlineCells& cells, const Indices& open)
{
  std::unordered_map<CellKey, Indices, online::CellKeyHash> at;
  for (const auto c : open)
    at[cells.keyOf(c)].push_back(c);
  std::vector<Indices> groups;
  for (const auto first : open) {
    Indices group, next;
    const auto take = [&](const CellKey& key) {
      const auto found = at.find(key);
      if (found == at.end())
        return;
      next.insert(next.end(), found->second.begin(), found->second.end());
      at.erase(found);
    };
    take(cells.keyOf(first));
    while (!next.empty()) {
      const auto c = next.back();
      next.pop_back();
      group.push_back(c);
      const CellKey k = cells.keyOf(c);
      for (int step = 0; step < 27; ++step)
        take({k[0] + step % 3 - 1, k[1] + step / 3 % 3 - 1, k[2] + step / 9 - 1});
    }
    std::sort(group.begin(), group.end());
    if (!group.empty())
      groups.push_back(std::move(group));
  }
  return groups;
}

} // namespace

struct OnlineInterpretation::State {
  ModelDatabase database;
  OnlineParameters parameters;
  double largest; ///< delta_max
  online::OnlineCells cells;
  std::vector<OnlineDetection> detections;
  std::vector<Attractor> attractors;
  std::vector<Distractor> distractors;
  std::uint64_t next_id = 1;

  State(ModelDatabase d, OnlineParameters p)
      : database(std::move(d)), parameters(std::move(p)), largest(largestModel(database)),
        cells(parameters.leaf)
  {
    parameters.explanation.leaf = parameters.leaf;
  }

  void take(const SurfletSet& surflets, OnlineScan& scan);
  void interpretAgain(const Indices& changed, OnlineScan& scan);
  Indices cellsToInterpret(const Indices& changed, const std::vector<OnlineDetection>& kept) const;
  void adopt(const std::vector<Detection>& found, std::vector<OnlineDetection>& before,
             std::vector<OnlineDetection>& now);
  bool isSame(const Detection& a, const Detection& b) const;
  void lookAround();
  Indices unexplained() const;
  bool isRest(const Patch& patch) const;
};

/** \brief Fills the cells. */
void
OnlineInterpretation::State::take(const SurfletSet& surflets, OnlineScan& scan)
{
  SurfletSet usable;
  usable.reserve(surflets.size());
  for (std::size_t i = 0; i < surflets.size(); ++i)
    usable.appendChecked(surflets[i]);
  scan.rejected = surflets.size() - usable.size();
  if (!parameters.empty_scene.empty() && !usable.empty()) {
    const double distance = parameters.distance > 0 ? parameters.distance : parameters.leaf;
    const auto away = cellsAwayFrom(usable, parameters.empty_scene, distance);
    scan.background = usable.size() - away.size();
    usable = usable.subset(away);
  }
  for (std::size_t i = 0; i < usable.size(); ++i)
    ++(cells.add(usable, i) ? scan.surflets : scan.rejected);
}

/** \brief What may belong to an object whose centre lies in the region: as far again, less what
 * the detections outside of the region explain. */
Indices
OnlineInterpretation::State::cellsToInterpret(const Indices& changed,
                                              const std::vector<OnlineDetection>& kept) const
{
  const SurfletSet& means = cells.means();
  Region wide(largest / kBlocksPerModel);
  wide.grow(means, changed, 2 * kBlocksPerModel);
  std::vector<bool> is_taken(means.size());
  for (const auto& d : kept)
    for (const auto c : d.cells)
      is_taken[c] = true;
  Indices subset;
  for (std::uint32_t c = 0; c < means.size(); ++c)
    if (!is_taken[c] && wide.holds(means.x[c], means.y[c], means.z[c]))
      subset.push_back(c);
  return subset;
}

bool
OnlineInterpretation::State::isSame(const Detection& a, const Detection& b) const
{
  return a.model == b.model && (2 * sharedCells(a, b) > std::min(a.cells.size(), b.cells.size()) ||
                                distanceOf(a, b) < database[a.model].r_mean / 2);
}

/** \brief Gives \p found the ids of those \p before that they continue, the nearest first come. */
void
OnlineInterpretation::State::adopt(const std::vector<Detection>& found,
                                   std::vector<OnlineDetection>& before,
                                   std::vector<OnlineDetection>& now)
{
  for (const auto& d : found) {
    OnlineDetection next;
    static_cast<Detection&>(next) = d;
    auto best = before.end();
    for (auto b = before.begin(); b != before.end(); ++b)
      if (isSame(*b, d) && (best == before.end() || distanceOf(*b, d) < distanceOf(*best, d)))
        best = b;
    const bool is_known = best != before.end();
    next.state = is_known ? OnlineState::Updated : OnlineState::New;
    next.id = is_known ? best->id : next_id++;
    if (is_known)
      before.erase(best);
    now.push_back(std::move(next));
  }
  std::sort(now.begin(), now.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  for (auto& lost : before) {
    lost.state = OnlineState::Vanished;
    now.push_back(std::move(lost));
  }
}

void
OnlineInterpretation::State::interpretAgain(const Indices& changed, OnlineScan& scan)
{
  Region region(largest / kBlocksPerModel);
  region.grow(cells.means(), changed, kBlocksPerModel);
  const auto isOpen = [&](const Detection& d) {
    return region.holds(d.centroid[0], d.centroid[1], d.centroid[2]);
  };
  std::vector<OnlineDetection> now, before;
  for (auto& d : detections) {
    if (d.state == OnlineState::Vanished)
      continue;
    d.state = OnlineState::Kept;
    (isOpen(d) ? before : now).push_back(std::move(d));
  }
  std::vector<Detection> found;
  const Indices subset = cellsToInterpret(changed, now);
  if (!changed.empty()) {
    scan.interpreted_cells = subset.size();
    auto result =
        interpretByExplanation(cells.means().subset(subset), database, parameters.explanation);
    for (auto& d : result.detections) {
      for (auto& c : d.cells)
        c = subset[c];
      if (isOpen(d))
        found.push_back(std::move(d));
    }
  }
  adopt(found, before, now);
  detections = std::move(now);
}

Indices
OnlineInterpretation::State::unexplained() const
{
  std::vector<bool> is_taken(cells.means().size());
  for (const auto& d : detections)
    if (d.state != OnlineState::Vanished)
      for (const auto c : d.cells)
        is_taken[c] = true;
  Indices open;
  for (std::uint32_t c = 0; c < is_taken.size(); ++c)
    if (!is_taken[c])
      open.push_back(c);
  return open;
}

/** \brief Does it lie within r_max of a detection? Then it is what that lost at its border. */
bool
OnlineInterpretation::State::isRest(const Patch& patch) const
{
  return std::any_of(detections.begin(), detections.end(), [&](const OnlineDetection& d) {
    Detection at;
    at.centroid = patch.centre;
    return d.state != OnlineState::Vanished && distanceOf(d, at) < database[d.model].r_max;
  });
}

/** \brief Finds attractors and distractors. */
void
OnlineInterpretation::State::lookAround()
{
  const double s = parameters.leaf;
  attractors.clear();
  distractors.clear();
  for (auto& d : detections) {
    if (d.state == OnlineState::Vanished)
      continue;
    const double area = database[d.model].surface_area * interpretation::kCellsOfArea;
    d.coverage = area > 0 ? static_cast<double>(d.cells.size()) * s * s / area
                          : std::numeric_limits<double>::quiet_NaN();
    const Patch patch = patchOf(cells.means(), d.cells);
    const bool is_weak = database.size() > 1 && d.margin < parameters.margin;
    if (d.coverage < parameters.coverage || is_weak)
      attractors.push_back(attractorAt(patch, d.id));
    else
      distractors.push_back({patch.centre, patch.radius, d.id});
  }
  for (const auto& group : connected(cells, unexplained())) {
    if (group.size() < parameters.explanation.steps.min_cluster)
      continue;
    const Patch patch = patchOf(cells.means(), group);
    if (patch.radius <= largest && !isRest(patch)) // what is larger is background
      attractors.push_back(attractorAt(patch, kNobody));
  }
}

OnlineInterpretation::OnlineInterpretation(ModelDatabase database, OnlineParameters parameters)
{
  check(parameters);
  state_ = std::make_unique<State>(std::move(database), std::move(parameters));
  // Wrong parameters of the interpretation are told now, not at the first scan.
  interpretByExplanation({}, state_->database, state_->parameters.explanation);
}

OnlineInterpretation::~OnlineInterpretation() = default;
OnlineInterpretation::OnlineInterpretation(OnlineInterpretation&&) noexcept = default;
OnlineInterpretation& OnlineInterpretation::operator=(OnlineInterpretation&&) noexcept = default;

OnlineScan
OnlineInterpretation::addScan(const SurfletSet& surflets)
{
  OnlineScan scan;
  state_->take(surflets, scan);
  const auto changed =
      state_->cells.takeChanged(state_->parameters.moved, state_->parameters.turned);
  scan.changed_cells = changed.size();
  scan.cells = state_->cells.means().size();
  state_->interpretAgain(changed, scan);
  state_->lookAround();
  return scan;
}

const SurfletSet&
OnlineInterpretation::cells() const
{
  return state_->cells.means();
}

const std::vector<OnlineDetection>&
OnlineInterpretation::detections() const
{
  return state_->detections;
}

const std::vector<Attractor>&
OnlineInterpretation::attractors() const
{
  return state_->attractors;
}

const std::vector<Distractor>&
OnlineInterpretation::distractors() const
{
  return state_->distractors;
}

} // namespace pcl_surflet
