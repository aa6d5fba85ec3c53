#include "state.h"

#include "recognition/interpretation/scene_models.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

namespace pcl_surflet {

using namespace online;

namespace {

constexpr std::uint64_t kNobody = 0;
constexpr double kBlocksPerReach = 2; ///< blocks of cells within the reach of a change

/** \brief The caller does not want the scan to be interpreted any more. */
struct Cancelled {};

/** \brief The largest of \p value over the objects. */
template <class Value>
double
largestOf(const ModelDatabase& database, const Value& value)
{
  double largest = 0;
  for (std::size_t i = 0; i < database.size(); ++i)
    if (database[i].role == ModelRole::Object)
      largest = std::max(largest, value(database[i]));
  if (!(largest > 0))
    throw DatabaseError("the database has no object to find");
  return largest;
}

} // namespace

OnlineInterpretation::State::State(ModelDatabase d, OnlineParameters p)
    : database(std::move(d)), parameters(std::move(p)),
      largest(largestOf(database, [](const HistogramModel& m) { return m.delta_max; })),
      farthest(2 * parameters.explanation.reach *
               largestOf(database, [](const HistogramModel& m) { return m.r_max; })),
      cells(parameters.leaf, farthest / kBlocksPerReach)
{
  parameters.explanation.leaf = parameters.leaf;
  if (parameters.empty_scene.empty())
    return;
  empty.emplace(std::move(parameters.empty_scene),
                parameters.distance > 0 ? parameters.distance : parameters.leaf);
  parameters.empty_scene = SurfletSet();
}

OnlineScan
OnlineInterpretation::State::addScan(const SurfletSet& surflets, const Place* sensor)
{
  OnlineScan scan;
  cells.begin();
  try {
    const Changes changes = changesBy(surflets, sensor, scan);
    takeOver(next(changes, scan));
  }
  catch (const Cancelled&) {
    cells.rollBack();
    scan = OnlineScan();
    scan.cancelled = true;
  }
  catch (...) {
    cells.rollBack();
    throw;
  }
  return scan;
}

void
OnlineInterpretation::State::fill(const SurfletSet& surflets, OnlineScan& scan)
{
  SurfletSet usable;
  usable.reserve(surflets.size());
  for (std::size_t i = 0; i < surflets.size(); ++i)
    usable.appendChecked(surflets[i]);
  scan.rejected = surflets.size() - usable.size();
  for (std::size_t i = 0; i < usable.size(); ++i)
    ++(cells.add(usable, i) ? scan.surflets : scan.rejected);
}

/** \brief Marks those of the changed cells that belong to the empty scene. */
void
OnlineInterpretation::State::exclude(const Indices& changed, OnlineScan& scan)
{
  if (!empty)
    return;
  const Indices away = empty->away(cells.means(), changed, parameters.explanation.steps.threads);
  for (const auto c : changed)
    cells.setBackground(c, !std::binary_search(away.begin(), away.end(), c));
  scan.background = changed.size() - away.size();
}

/** \brief Takes away what rays have passed, and notes where it was. */
void
OnlineInterpretation::State::removeSeenThrough(const SurfletSet& ends, const Place& sensor,
                                               Changes& changes)
{
  const FreeSpace space(ends, sensor, parameters.leaf, parameters.behind * parameters.leaf,
                        parameters.rays);
  const Indices candidates = cells.untouched(
      [&](const Place& middle, double radius) { return space.looksAt(middle, radius); });
  changes.gone = space.seenThrough(cells, candidates, parameters.explanation.steps.threads);
  for (const auto c : changes.gone) {
    changes.places.push_back({cells.placeOf(c), owner[c]});
    cells.remove(c);
  }
}

OnlineInterpretation::State::Changes
OnlineInterpretation::State::changesBy(const SurfletSet& surflets, const Place* sensor,
                                       OnlineScan& scan)
{
  Changes changes;
  fill(surflets, scan);
  const Indices changed = cells.takeChanged(parameters.moved, parameters.turned);
  exclude(changed, scan);
  owner.resize(cells.means().size(), kNobody);
  for (const auto c : changed)
    if (cells.takesPart(c) || owner[c] != kNobody) {
      changes.cells.push_back(c);
      changes.places.push_back({cells.placeOf(c), owner[c]});
    }
  if (sensor != nullptr && parameters.behind > 0)
    removeSeenThrough(surflets, *sensor, changes);
  scan.changed_cells = changes.cells.size();
  scan.vanished_cells = changes.gone.size();
  scan.cells = cells.means().size();
  return changes;
}

/** \brief What is about the open places, less what the kept detections explain, is interpreted;
 * what is found counts if an open place lies in its ball, or if it has cells of what was reopened.
 */
std::vector<OnlineDetection>
OnlineInterpretation::State::interpretOpen(const Concern& concern, OnlineScan& scan) const
{
  std::vector<OnlineDetection> found;
  if (concern.open.empty())
    return found;
  std::unordered_set<std::uint64_t> reopened;
  for (const auto k : concern.reopened)
    reopened.insert(detections[k].id);
  Indices subset = cells.near(concern.open, farthest);
  subset.erase(std::remove_if(subset.begin(), subset.end(),
                              [&](std::uint32_t c) {
                                return owner[c] != kNobody && reopened.count(owner[c]) == 0;
                              }),
               subset.end());
  scan.interpreted_cells = subset.size();
  auto result =
      interpretByExplanation(cells.means().subset(subset), database, parameters.explanation);
  if (result.diagnostics.cancelled)
    throw Cancelled();
  for (auto& d : result.detections) {
    for (auto& c : d.cells)
      c = subset[c];
    const double ball = ballOf(database, d.model, parameters.explanation.reach);
    const bool counts = std::any_of(d.cells.begin(), d.cells.end(),
                                    [&](std::uint32_t c) { return owner[c] != kNobody; }) ||
                        std::any_of(concern.open.begin(), concern.open.end(), [&](const Place& p) {
                          return distanceOf(p, d.centroid) <= ball;
                        });
    if (!counts)
      continue;
    found.emplace_back();
    static_cast<Detection&>(found.back()) = std::move(d);
  }
  return found;
}

Note
OnlineInterpretation::State::noteOf(const OnlineDetection& d, const Indices& own) const
{
  Note note;
  note.patch = patchOf(cells.means(), own);
  const double area = database[d.model].surface_area;
  const auto cells_seen = static_cast<double>(own.size());
  note.coverage = area > 0 ? interpretation::areaOfCells(cells_seen, parameters.leaf) / area
                           : std::numeric_limits<double>::quiet_NaN();
  note.is_in_doubt = note.coverage < parameters.coverage || d.margin < parameters.margin;
  return note;
}

/** \brief Kept detections lose cells that are gone or turned out to be background. */
void
OnlineInterpretation::State::noteKept(Next& next) const
{
  for (const auto k : next.concern.kept) {
    const OnlineDetection& d = detections[k];
    Note note = notes[k];
    Indices own;
    if (next.concern.changes[k] > 0) {
      for (const auto c : d.cells)
        if (cells.takesPart(c))
          own.push_back(c);
      note = noteOf(d, own);
      note.changes = notes[k].changes + next.concern.changes[k];
    }
    next.kept_notes.push_back(note);
    next.kept_cells.push_back(std::move(own));
  }
}

void
OnlineInterpretation::State::regroup(const Changes& changes, Next& next) const
{
  std::unordered_set<std::uint32_t> freed, taken;
  for (const auto k : next.concern.reopened)
    freed.insert(detections[k].cells.begin(), detections[k].cells.end());
  for (const auto& d : next.found)
    taken.insert(d.cells.begin(), d.cells.end());
  const IsOpen is_open = [&](std::uint32_t c) {
    return (owner[c] == kNobody || freed.count(c) > 0) && taken.count(c) == 0;
  };
  // Cells that are open or were: new ones have no owner yet.
  std::vector<CellKey> changed;
  const auto consider = [&](std::uint32_t c) {
    if (owner[c] == kNobody || is_open(c))
      changed.push_back(cells.keyOf(c));
  };
  for (const auto* some : {&changes.cells, &changes.gone})
    std::for_each(some->begin(), some->end(), consider);
  std::for_each(freed.begin(), freed.end(), consider);
  std::for_each(taken.begin(), taken.end(), consider);
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  next.groups = regrouped(cells, groups, changed, parameters.leaf, 2 * largest, is_open);
}

/** \brief Finds attractors and distractors. */
void
OnlineInterpretation::State::lookAround(Next& next) const
{
  std::vector<const Detection*> there;
  const auto look = [&](const OnlineDetection& d, const Note& note) {
    there.push_back(&d);
    if (note.is_in_doubt)
      next.attractors.push_back(attractorAt(note.patch, d.id));
    else
      next.distractors.push_back({note.patch.centre, note.patch.radius, d.id});
  };
  for (std::size_t i = 0; i < next.concern.kept.size(); ++i)
    look(detections[next.concern.kept[i]], next.kept_notes[i]);
  for (std::size_t i = 0; i < next.found.size(); ++i)
    look(next.found[i], next.found_notes[i]);
  const auto by_id = [](const auto& a, const auto& b) { return a.id < b.id; };
  std::sort(next.attractors.begin(), next.attractors.end(), by_id);
  std::sort(next.distractors.begin(), next.distractors.end(), by_id);
  for (const auto& group : next.groups) {
    const Patch& patch = group->patch;
    // What lies within r_max of a detection is what that lost at its border.
    const bool is_rest = std::any_of(there.begin(), there.end(), [&](const Detection* d) {
      return distanceOf(d->centroid, patch.centre) < database[d->model].r_max;
    });
    if (group->cells.size() >= parameters.explanation.steps.min_cluster &&
        patch.radius <= largest && !is_rest) // what is larger is background
      next.attractors.push_back(attractorAt(patch, kNobody));
  }
}

OnlineInterpretation::State::Next
OnlineInterpretation::State::next(const Changes& changes, OnlineScan& scan) const
{
  Next next;
  next.concern = concernOf(detections, notes, changes.places, database,
                           parameters.explanation.reach, parameters.stale);
  next.found = interpretOpen(next.concern, scan);
  next.next_id = next_id;
  next.goes_on = adopt(next.found, detections, next.concern.reopened, database, next.next_id);
  for (auto& d : next.found) {
    next.found_notes.push_back(noteOf(d, d.cells));
    d.coverage = next.found_notes.back().coverage;
  }
  noteKept(next);
  regroup(changes, next);
  lookAround(next);
  next.detections.reserve(notes.size() + next.found.size());
  next.notes.reserve(notes.size() + next.found.size());
  scan.kept = next.concern.kept.size();
  scan.sought = next.concern.reopened.size();
  return next;
}

void
OnlineInterpretation::State::takeKept(Next& next) noexcept
{
  for (std::size_t i = 0; i < next.concern.kept.size(); ++i) {
    const std::size_t k = next.concern.kept[i];
    OnlineDetection& d = detections[k];
    d.state = OnlineState::Kept;
    if (next.concern.changes[k] > 0) {
      for (const auto c : d.cells)
        owner[c] = cells.takesPart(c) ? d.id : kNobody;
      d.cells.swap(next.kept_cells[i]);
      d.coverage = next.kept_notes[i].coverage;
    }
    next.detections.push_back(std::move(d));
    next.notes.push_back(next.kept_notes[i]);
  }
}

void
OnlineInterpretation::State::takeFound(Next& next) noexcept
{
  for (std::size_t i = 0; i < next.found.size(); ++i) {
    for (const auto c : next.found[i].cells)
      owner[c] = next.found[i].id;
    next.detections.push_back(std::move(next.found[i]));
    next.notes.push_back(next.found_notes[i]);
  }
}

void
OnlineInterpretation::State::takeOver(Next&& next) noexcept
{
  for (const auto k : next.concern.reopened)
    for (const auto c : detections[k].cells)
      owner[c] = kNobody;
  takeKept(next);
  takeFound(next);
  // Both lists by id: insertion, as what is kept is in order and found are few.
  for (std::size_t i = 1; i < next.detections.size(); ++i)
    for (std::size_t k = i; k > 0 && next.detections[k].id < next.detections[k - 1].id; --k) {
      std::swap(next.detections[k], next.detections[k - 1]);
      std::swap(next.notes[k], next.notes[k - 1]);
    }
  for (std::size_t i = 0; i < next.goes_on.size(); ++i)
    if (!next.goes_on[i]) {
      next.detections.push_back(std::move(detections[next.concern.reopened[i]]));
      next.detections.back().state = OnlineState::Vanished;
    }
  detections = std::move(next.detections);
  notes = std::move(next.notes);
  groups = std::move(next.groups);
  attractors = std::move(next.attractors);
  distractors = std::move(next.distractors);
  next_id = next.next_id;
}

} // namespace pcl_surflet
