#include "evaluation/peers.h"

#include "evaluation/pose_peers.h"
#include "experiment/peers/isolation.h"
#include "thread_time.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/pose_estimator.h"
#include "pcl_surflet/pose_verification.h"

#include <algorithm>
#include <optional>

namespace pcl_surflet {
namespace apps {
namespace {

std::array<double, 3>
centroidOf(const SurfletSet& set)
{
  const Extent extent = computeExtent(set);
  return {extent.centroid[0], extent.centroid[1], extent.centroid[2]};
}

/** \brief A method of pcl_surflet_evaluate; ours has poses, too, which may judge its names. */
class RecogniserPeer : public Peer {
public:
  RecogniserPeer(const std::string& name, const std::vector<SceneItem>& items,
                 const std::vector<Known>& known, const RecogniserOptions& o)
      : known_(known), poses_(name == "ours" || name == "ours_verified"),
        verified_(name == "ours_verified")
  {
    RecogniserOptions own = o;
    if (verified_)
      own.explanation.min_fit = VerificationParameters::kProposalFit;
    method_ = recogniser(poses_ ? "explanation" : name, items, own);
    if (o.sensing)
      for (const auto& place : sensorPoses(o.sensing->views))
        parameters_.viewpoints.push_back(place.position);
  }

  Answer
  answer(const Given& given) const override
  {
    Answer a;
    const double start = threadSeconds();
    const auto& cells = given.all.cells;
    const auto detections = method_->find(cells, given.seed).detections;
    std::vector<char> taken(cells.size(), 0);
    for (const auto& d : detections)
      for (const auto c : d.cells)
        taken[c] = 1;
    for (const auto& d : detections)
      if (const auto f = found(d, cells, taken))
        a.found.push_back(*f);
    a.seconds = threadSeconds() - start;
    return a;
  }

private:
  /** \return nothing if the pose refutes the name */
  std::optional<FoundObject>
  found(const Detection& d, const SurfletSet& cells, const std::vector<char>& taken) const
  {
    FoundObject f;
    f.object = d.model;
    f.cells = d.cells;
    f.score = d.score;
    const SurfletSet cluster = cells.subset(d.cells);
    f.centre = centroidOf(cluster);
    if (!poses_)
      return f;
    const auto& known = known_[d.model];
    const PoseEstimate e =
        estimatePose(cluster, known.pose, parameters_,
                     detail::pointsBeside(cells, taken, cluster, known.pose.diameter()));
    if (verified_ && !isVerified(e, d.fit))
      return std::nullopt;
    if (e.status == PoseStatus::Found) {
      f.motion = e.motion;
      f.centre = e.motion.moved(known.centre);
    }
    return f;
  }

  const std::vector<Known>& known_;
  bool poses_, verified_;
  std::unique_ptr<Recogniser> method_;
  PoseParameters parameters_;
};

/** \brief Searches for every model in what is not background; the best supported pose counts. */
class PosePeer : public Peer {
public:
  PosePeer(const std::string& name, const std::vector<Known>& known, double leaf, unsigned limit)
      : known_(known), leaf_(leaf), limit_(limit)
  {
    PosePeerParameters p;
    p.leaf = leaf;
    for (const auto& k : known)
      finders_.push_back(poseFinder(name, k.cells, p));
  }

  Answer
  answer(const Given& given) const override
  {
    Answer a;
    const SurfletSet scene = given.all.cells.subset(given.visible);
    if (scene.empty())
      return a;
    for (std::size_t k = 0; k < known_.size(); ++k) {
      const auto result = runIsolated([&] { return rowsOf(finders_[k]->find(scene)); }, limit_);
      a.failures += result ? 0 : 1;
      a.seconds += result ? result->seconds : limit_;
      if (!result)
        continue;
      const double start = threadSeconds();
      FoundObject best;
      best.score = -1;
      for (const auto& row : result->signatures)
        best = better(std::move(best), k, row, scene);
      if (best.score > 0)
        a.found.push_back(std::move(best));
      a.seconds += threadSeconds() - start;
    }
    a.found = withoutRivals(std::move(a.found));
    for (auto& f : a.found)
      for (auto& c : f.cells)
        c = given.visible[c];
    return a;
  }

private:
  static std::vector<std::vector<float>>
  rowsOf(const std::vector<RigidMotion>& motions)
  {
    std::vector<std::vector<float>> rows;
    for (const auto& m : motions) {
      const Eigen::Matrix4f matrix = matrixOf(m);
      rows.emplace_back(matrix.data(), matrix.data() + matrix.size());
    }
    return rows;
  }

  FoundObject
  better(FoundObject best, std::size_t object, const std::vector<float>& row,
         const SurfletSet& scene) const
  {
    const RigidMotion motion = apps::motionOf(Eigen::Matrix4f(row.data()));
    Support support = supportOf(known_[object].cells, motion, scene, leaf_);
    if (support.share <= best.score)
      return best;
    return {object, std::move(support.cells), motion.moved(known_[object].centre), motion,
            support.share};
  }

  const std::vector<Known>& known_;
  double leaf_;
  unsigned limit_;
  std::vector<std::unique_ptr<PoseFinder>> finders_;
};

} // namespace

std::vector<Known>
knownObjects(const std::vector<SceneItem>& items, double leaf)
{
  std::vector<Known> known;
  for (const auto& item : items) {
    const SurfletSet surface = item.sample(kModelSurflets, kTrainingSeed);
    known.push_back({item, reduceToTwoSidedCells(surface, leaf).cells, centroidOf(surface),
                     PoseModel::train(item.label, surface)});
  }
  return known;
}

bool
isPoseFinder(const std::string& name)
{
  const auto& names = poseFinderNames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string>
peerNames()
{
  std::vector<std::string> names = {"ours", "ours_verified", "classic_vfh", "classic_esf",
                                    "exclusion_vfh"};
  names.insert(names.end(), poseFinderNames().begin(), poseFinderNames().end());
  return names;
}

std::unique_ptr<Peer>
peer(const std::string& name, const std::vector<SceneItem>& items, const std::vector<Known>& known,
     const RecogniserOptions& options, unsigned limit)
{
  if (isPoseFinder(name))
    return std::make_unique<PosePeer>(name, known, options.leaf, limit);
  return std::make_unique<RecogniserPeer>(name, items, known, options);
}

} // namespace apps
} // namespace pcl_surflet
