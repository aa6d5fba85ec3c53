// Ours and other ways to names and poses side by side on the same sensed scenes.

#include "app_common.h"
#include "evaluation/peer_scoring.h"
#include "evaluation/pose_peers.h"
#include "evaluation/recognisers.h"
#include "experiment/peers/isolation.h"
#include "scene_items.h"
#include "sensor_options.h"
#include "thread_time.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/pose_estimator.h"
#include "pcl_surflet/pose_verification.h"

#include <algorithm>
#include <cstdio>
#include <optional>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_evaluate_peers";
constexpr std::size_t kModelSurflets = 40000;
constexpr std::uint64_t kFirstTuned = 1; // thresholds are chosen on other scenes than any reported

struct Options {
  RecogniserOptions recogniser;
  SceneSensing sensing;
  std::vector<std::string> peers{"ours", "classic_vfh"};
  double presence = 0.5;
  std::vector<std::string> clutter; ///< things that no peer knows
  std::uint64_t unknown = 0;        ///< of them present in every scene
  std::uint64_t scenes = 20, tune = 5, seed = 1001, least = 50, limit = 120;
};

/** \brief An object, as all peers know it. */
struct Known {
  SceneItem item;
  SurfletSet cells; ///< of the complete surface, in the item's coordinates
  std::array<double, 3> centre{};
  PoseModel pose;
};

/** \brief A scene as all peers get it. */
struct Given {
  CellScene all;                      ///< as sensed, thin walls kept
  std::vector<std::uint32_t> visible; ///< cells away from those of the empty scene
  std::uint64_t seed = 0;
};

struct Answer {
  std::vector<FoundObject> found;
  double seconds = 0;
  std::size_t failures = 0;
};

class Peer {
public:
  virtual ~Peer() = default;
  virtual Answer answer(const Given& given) const = 0;
};

std::array<double, 3>
centroidOf(const SurfletSet& set)
{
  const Extent extent = computeExtent(set);
  return {extent.centroid[0], extent.centroid[1], extent.centroid[2]};
}

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

/** \brief A method of pcl_surflet_evaluate; ours has poses, too, which may be the judge of names.
 */
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
    const PoseEstimate e = estimatePose(cluster, known.pose, parameters_,
                                        pointsBeside(cells, taken, cluster, known.pose.diameter()));
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

class Study {
public:
  Study(const std::vector<SceneItem>& items, const Options& o)
      : items_(items), clutter_(itemsOf(o.clutter)), options_(o),
        known_(knownObjects(items, o.recogniser.leaf)),
        empty_(reduceToCells(seenBackground(o.recogniser.scene, o.recogniser.sensing),
                             o.recogniser.leaf)
                   .cells)
  {
    for (const auto& k : known_)
      judged_.push_back({PoseError(k.item.sample(kModelSurflets, kTrainingSeed)), k.pose.diameter(),
                         k.pose.symmetry().kind != SymmetryKind::None});
  }

  void
  run(const std::string& name) const
  {
    const auto peer = peerOf(name);
    const bool tuned = options_.tune > 0 && isFinder(name);
    PeerCounts chosen;
    if (tuned)
      chosen = counts(*peer, kFirstTuned, options_.tune);
    const double threshold = bestThreshold(chosen);
    print(name, threshold, counts(*peer, options_.seed, options_.scenes));
  }

private:
  static bool
  isFinder(const std::string& name)
  {
    const auto& names = poseFinderNames();
    return std::find(names.begin(), names.end(), name) != names.end();
  }

  std::unique_ptr<Peer>
  peerOf(const std::string& name) const
  {
    const auto& o = options_.recogniser;
    if (isFinder(name))
      return std::make_unique<PosePeer>(name, known_, o.leaf,
                                        static_cast<unsigned>(options_.limit));
    return std::make_unique<RecogniserPeer>(name, items_, known_, o);
  }

  Given
  given(std::uint64_t seed) const
  {
    SceneOptions scene = options_.recogniser.scene;
    scene.seed = seed;
    scene.present = presentOf(items_.size(), options_.presence, seed);
    scene.clutter = std::min<std::size_t>(options_.unknown, clutter_.size());
    const Scene seen = seenScene(items_, clutter_, scene, options_.recogniser.sensing);
    Given g;
    const double leaf = options_.recogniser.leaf;
    g.all = withTruth(reduceToTwoSidedCells(seen.surflets, leaf), seen);
    g.visible = cellsAwayFrom(g.all.cells, empty_, leaf);
    g.seed = seed;
    return g;
  }

  PeerCounts
  counts(const Peer& peer, std::uint64_t first, std::uint64_t scenes) const
  {
    PeerCounts c;
    Progress progress(scenes);
    for (std::uint64_t k = 0; k < scenes; ++k) {
      progress.show(k, "scenes");
      const Given scene = given(first + k);
      const Answer a = peer.answer(scene);
      judge(scene.all, a.found, judged_, options_.least, c);
      c.seconds.push_back(a.seconds);
      c.failures += a.failures;
    }
    progress.clear();
    return c;
  }

  static void
  printRate(std::size_t hits, std::size_t trials)
  {
    const Rate r = rateOf(hits, trials);
    std::printf("  %3zu/%-3zu %5.1f [%5.1f, %5.1f]", hits, trials, r.percent, r.low, r.high);
  }

  static void
  print(const std::string& name, double threshold, const PeerCounts& c)
  {
    const AcceptedCounts a = accepted(c, threshold);
    std::printf("%-16s %6zu %9.3f", name.c_str(), c.scenes, threshold);
    printRate(a.names, c.present);
    printRate(a.names, a.detections);
    printRate(a.centres, c.present);
    printRate(a.poses, c.present);
    double sum = 0;
    for (const double s : c.seconds)
      sum += s;
    std::printf("  %8.3f %4zu\n", sum / static_cast<double>(std::max<std::size_t>(1, c.scenes)),
                c.failures);
    std::fflush(stdout);
  }

  const std::vector<SceneItem>& items_;
  std::vector<SceneItem> clutter_;
  Options options_;
  std::vector<Known> known_;
  std::vector<JudgedObject> judged_;
  SurfletSet empty_;
};

void
addOptions(CommandLine& line, Options& o)
{
  std::string names = "ours, ours_verified, classic_vfh, classic_esf, exclusion_vfh";
  for (const auto& name : poseFinderNames())
    names += ", " + name;
  line.option("-peer", "NAME,...", "default ours,classic_vfh: " + names,
              [&o, names](const std::string& text) {
                o.peers = parts(text, ',');
                for (const auto& name : o.peers)
                  if ((", " + names + ",").find(", " + name + ",") == std::string::npos)
                    throw UsageError("option -peer: there is no '" + name + "'; the names are " +
                                     names);
              });
  line.count("-scenes", "N", "number of scenes, default 20", o.scenes, 1, 1000000);
  line.count("-tune", "N",
             "scenes from seed 1 on that thresholds are chosen on, default 5; 0: none", o.tune, 0,
             99);
  line.real("-presence", "P", "each item is present with this probability, default 0.5", o.presence,
            0, 1);
  line.option("-clutter", "ITEM,...", "things that no method knows",
              [&o](const std::string& text) { o.clutter = parts(text, ','); });
  line.count("-unknown", "N", "things of the clutter in every scene, default all", o.unknown, 0,
             1000000);
  addArrangement(line, o.recogniser.scene);
  line.real("-density", "D", "points per squared unit, default 470000", o.recogniser.scene.density,
            1e-9, 1e12);
  addSensor(line, o.sensing);
  line.real("-leaf", "S", "edge of the cells, default 0.0058", o.recogniser.leaf, 1e-9, 1e9);
  line.count("-limit", "S", "CPU seconds for one model before a search is ended, default 120",
             o.limit, 1, 100000);
  line.count("-least", "N", "present are objects of so many points, default 50", o.least, 1,
             1000000);
  line.count("-seed", "S", "seed of the first scene, at least 100, default 1001", o.seed, 100,
             1ULL << 62);
}

int
run(int argc, char** argv)
{
  Options o;
  CommandLine line(kProgram, "ITEM...",
                   "Generates scenes of the ITEMs (see pcl_surflet_generate) and lets several "
                   "methods name and place what is\nthere, each in one thread. Scores name, "
                   "detections, centre and pose apart.");
  addOptions(line, o);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(1, 1000);
  if (!line.given("-unknown"))
    o.unknown = o.clutter.size();
  o.recogniser.dissertation.background = BackgroundTreatment::Exclude;
  o.recogniser.dissertation.threads = 1;
  o.sensing.threads = 1;
  if (line.given("-views"))
    o.recogniser.sensing = o.sensing;
  const auto items = itemsOf(line.files());
  o.recogniser.scene.present = items.size();
  const Study study(items, o);
  std::printf("%llu scenes, seeds %llu to %llu; thresholds from %llu scenes, seeds %llu on\n"
              "%-16s %6s %9s  %-29s  %-29s  %-29s  %-29s  %8s %s\n",
              static_cast<unsigned long long>(o.scenes), static_cast<unsigned long long>(o.seed),
              static_cast<unsigned long long>(o.seed + o.scenes - 1),
              static_cast<unsigned long long>(o.tune), static_cast<unsigned long long>(kFirstTuned),
              "peer", "scenes", "threshold", "named right %", "detections right %",
              "centre right %", "pose right %", "s/scene", "fail");
  for (const auto& name : o.peers)
    study.run(name);
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return run(argc, argv); });
}
