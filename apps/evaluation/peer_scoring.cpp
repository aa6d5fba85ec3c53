#include "evaluation/peer_scoring.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr double kShared = 0.5;      // of the smaller one's cells makes rivals
constexpr double kPoseLimit = 0.1;   // of the diameter
constexpr double kCentreLimit = 0.5; // of r_mean

bool
rivals(const FoundObject& a, const FoundObject& b)
{
  std::vector<std::uint32_t> both;
  std::set_intersection(a.cells.begin(), a.cells.end(), b.cells.begin(), b.cells.end(),
                        std::back_inserter(both));
  return static_cast<double>(both.size()) >
         kShared * static_cast<double>(std::min(a.cells.size(), b.cells.size()));
}

/** \brief Instance that most cells come from; 0 background. */
std::size_t
instanceOf(const CellScene& scene, const FoundObject& found)
{
  std::vector<std::size_t> votes(scene.items.size() + 1, 0);
  for (const auto c : found.cells)
    ++votes[scene.instance[c]];
  return static_cast<std::size_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
}

bool
poseIsRight(const FoundObject& found, const PlacedItem& item, const JudgedObject& object)
{
  if (!found.motion)
    return false;
  for (const auto& row : found.motion->rotation)
    for (const double v : row)
      if (!std::isfinite(v))
        return false;
  const RigidMotion truth = motionOf(item);
  const double error = object.symmetric ? object.error.nearest(*found.motion, truth)
                                        : object.error.distance(*found.motion, truth);
  return error < kPoseLimit * object.diameter;
}

bool
centreIsRight(const FoundObject& found, const PlacedItem& item)
{
  return std::hypot(found.centre[0] - item.centroid[0], found.centre[1] - item.centroid[1],
                    found.centre[2] - item.centroid[2]) < kCentreLimit * item.r_mean;
}

} // namespace

std::vector<FoundObject>
withoutRivals(std::vector<FoundObject> found)
{
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  std::vector<FoundObject> left;
  for (auto& f : found)
    if (!f.cells.empty() &&
        std::none_of(left.begin(), left.end(), [&](const auto& l) { return rivals(l, f); }))
      left.push_back(std::move(f));
  return left;
}

void
judge(const CellScene& scene, const std::vector<FoundObject>& found,
      const std::vector<JudgedObject>& objects, std::size_t least, PeerCounts& counts)
{
  std::vector<char> named(scene.items.size(), 0), centred = named, posed = named;
  for (const auto& item : scene.items)
    counts.present += !item.clutter && item.surflets >= least ? 1 : 0;
  ++counts.scenes;
  for (const auto& f : found) {
    JudgedDetection d;
    d.score = f.score;
    const std::size_t on = instanceOf(scene, f);
    for (std::size_t k = 0; k < scene.items.size(); ++k) {
      const auto& item = scene.items[k];
      if (item.number != f.object + 1 || item.surflets < least)
        continue;
      const auto first = [k](std::vector<char>& done, bool right) {
        return right && done[k] == 0 && (done[k] = 1) == 1;
      };
      d.name = d.name || first(named, on == k + 1);
      d.centre = d.centre || first(centred, centreIsRight(f, item));
      d.pose = d.pose || first(posed, poseIsRight(f, item, objects[f.object]));
    }
    counts.detections.push_back(d);
  }
}

AcceptedCounts
accepted(const PeerCounts& counts, double threshold)
{
  AcceptedCounts a;
  for (const auto& d : counts.detections)
    if (d.score >= threshold) {
      ++a.detections;
      a.names += d.name ? 1 : 0;
      a.centres += d.centre ? 1 : 0;
      a.poses += d.pose ? 1 : 0;
    }
  return a;
}

double
bestThreshold(const PeerCounts& counts)
{
  double best = -1, threshold = -std::numeric_limits<double>::infinity();
  std::vector<double> scores{threshold};
  for (const auto& d : counts.detections)
    scores.push_back(d.score);
  std::sort(scores.begin(), scores.end());
  for (const double s : scores) {
    const AcceptedCounts a = accepted(counts, s);
    const double names = static_cast<double>(a.names);
    const double value = a.detections == 0 ? 0 : names * names / static_cast<double>(a.detections);
    if (value > best) {
      best = value;
      threshold = s;
    }
  }
  return threshold;
}

} // namespace apps
} // namespace pcl_surflet
