#include "interpretation/selection.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief Removes the detections, and their poses if there are any, that \p leaves says so of, by
 * their number. \return how many */
std::size_t
removeWhere(const std::function<bool(std::size_t)>& leaves, std::vector<SceneDetection>& found,
            std::vector<PoseEstimate>& poses)
{
  std::vector<SceneDetection> kept;
  std::vector<PoseEstimate> kept_poses;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (leaves(k))
      continue;
    kept.push_back(std::move(found[k]));
    if (!poses.empty())
      kept_poses.push_back(std::move(poses[k]));
  }
  const std::size_t removed = found.size() - kept.size();
  found = std::move(kept);
  poses = std::move(kept_poses);
  return removed;
}

/** \brief Which detections are among the \p most of the most cells. */
std::vector<char>
largest(const std::vector<SceneDetection>& found, std::size_t most)
{
  std::vector<std::size_t> order(found.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return found[a].cells.size() > found[b].cells.size();
  });
  std::vector<char> is_large(found.size(), 0);
  for (std::size_t k = 0; k < std::min(most, order.size()); ++k)
    is_large[order[k]] = 1;
  return is_large;
}

} // namespace

void
Selection::note(std::size_t removed, const std::string& why) const
{
  if (removed > 0)
    notes_.push_back(path_ + ": left out " + std::to_string(removed) + " " + why);
}

void
Selection::removeDoubtful(std::vector<SceneDetection>& found) const
{
  if (o_.pose.verify)
    return;
  std::vector<PoseEstimate> none;
  note(removeWhere([&](std::size_t k) { return found[k].confidence < o_.min_confidence; }, found,
                   none),
       "of a confidence below " + number(o_.min_confidence) + ", see -min_confidence");
}

void
Selection::verify(std::vector<SceneDetection>& found, std::vector<PoseEstimate>& poses) const
{
  if (!o_.pose.verify)
    return;
  note(keepVerified(found, poses), "that their poses refute");
  const auto is_doubtful = [&](std::size_t k) {
    return poses[k].status != PoseStatus::Found && found[k].confidence < o_.min_confidence;
  };
  note(removeWhere(is_doubtful, found, poses), "without pose, of a confidence below " +
                                                   number(o_.min_confidence) +
                                                   ", see -min_confidence");
  if (o_.detections == 0)
    return;
  const auto is_large = largest(found, o_.detections);
  removeWhere([&](std::size_t k) { return is_large[k] == 0; }, found, poses);
}

} // namespace apps
} // namespace pcl_surflet
