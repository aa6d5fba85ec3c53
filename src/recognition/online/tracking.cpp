#include "tracking.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

namespace pcl_surflet {
namespace online {
namespace {

std::size_t
sharedCells(const Detection& a, const Detection& b)
{
  Indices common;
  std::set_intersection(a.cells.begin(), a.cells.end(), b.cells.begin(), b.cells.end(),
                        std::back_inserter(common));
  return common.size();
}

/** \brief Two detections that mean the same thing. */
struct Match {
  double distance;
  std::size_t found, reopened;

  bool
  operator<(const Match& other) const
  {
    return std::tie(distance, found, reopened) <
           std::tie(other.distance, other.found, other.reopened);
  }
};

} // namespace

double
distanceOf(const Place& a, const Place& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double
ballOf(const ModelDatabase& database, std::size_t model, double reach)
{
  return reach * database[model].r_max;
}

Concern
concernOf(const std::vector<OnlineDetection>& detections, const std::vector<Note>& notes,
          const std::vector<ChangedPlace>& changed, const ModelDatabase& database, double reach,
          double stale)
{
  Concern concern;
  concern.changes.resize(notes.size());
  std::vector<char> is_left(changed.size()), is_wanted(changed.size());
  for (std::size_t k = 0; k < notes.size(); ++k) {
    const OnlineDetection& d = detections[k];
    const double ball = ballOf(database, d.model, reach);
    std::vector<std::size_t> inside;
    for (std::size_t i = 0; i < changed.size(); ++i)
      if (changed[i].owner == d.id || distanceOf(changed[i].at, d.centroid) <= ball)
        inside.push_back(i);
    concern.changes[k] = inside.size();
    const auto changes = static_cast<double>(notes[k].changes + inside.size());
    const bool is_kept = inside.empty() || (!notes[k].is_in_doubt &&
                                            changes < stale * static_cast<double>(d.cells.size()));
    (is_kept ? concern.kept : concern.reopened).push_back(k);
    for (const auto i : inside)
      (is_kept ? is_left : is_wanted)[i] = 1;
  }
  for (std::size_t i = 0; i < changed.size(); ++i)
    if (is_wanted[i] != 0 || is_left[i] == 0)
      concern.open.push_back(changed[i].at);
  return concern;
}

bool
isSame(const Detection& a, const Detection& b, const ModelDatabase& database)
{
  return a.model == b.model && (2 * sharedCells(a, b) > std::min(a.cells.size(), b.cells.size()) ||
                                distanceOf(a.centroid, b.centroid) < database[a.model].r_mean / 2);
}

std::vector<bool>
adopt(std::vector<OnlineDetection>& found, const std::vector<OnlineDetection>& before,
      const std::vector<std::size_t>& reopened, const ModelDatabase& database,
      std::uint64_t& next_id)
{
  std::vector<Match> matches;
  for (std::size_t f = 0; f < found.size(); ++f)
    for (std::size_t r = 0; r < reopened.size(); ++r)
      if (isSame(found[f], before[reopened[r]], database))
        matches.push_back({distanceOf(found[f].centroid, before[reopened[r]].centroid), f, r});
  std::sort(matches.begin(), matches.end());
  std::vector<bool> goes_on(reopened.size());
  for (const auto& m : matches)
    if (found[m.found].id == 0 && !goes_on[m.reopened]) {
      found[m.found].id = before[reopened[m.reopened]].id;
      found[m.found].state = OnlineState::Updated;
      goes_on[m.reopened] = true;
    }
  for (auto& d : found)
    if (d.id == 0)
      d.id = next_id++;
  return goes_on;
}

} // namespace online
} // namespace pcl_surflet
