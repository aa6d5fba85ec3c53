// How well are the poses of objects found? Sec. 6.4 on generated and sensed scenes.

#include "app_common.h"
#include "evaluation/pose_scoring.h"
#include "evaluation/scenes.h"
#include "evaluation/scoring.h"
#include "scene_items.h"
#include "sensor_options.h"
#include "surfaces.h"
#include "thread_time.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/recognition/scene_training.h"
#include "pcl_surflet/scene_interpreter.h"
#include "pcl_surflet/view_training.h"

#include <cmath>
#include <cstdio>
#include <map>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_evaluate_pose";
constexpr std::size_t kModelSurflets = 40000;

struct Options {
  SceneOptions scene;
  SceneSensing sensing;
  PoseParameters pose;
  double leaf = 0.0058, foreign = 0, limit = 0.1;
  std::uint64_t scenes = 10, seed = 1001, threads = 0, least = 50;
  bool sensed = false, interpreted = false, blind = false, verbose = false;
};

/** \brief A cluster of a scene and which of its items it is of. */
struct TrueCluster {
  std::size_t item = 0;
  SurfletSet points;
  SurfletSet beside; ///< points near it that are in no cluster
};

/** \brief What an object is recognised by, and how a pose is judged. */
struct KnownObject {
  PoseModel model;
  PoseError error;
  bool symmetric = false;
};

std::vector<std::array<double, 3>>
viewpointsOf(const Options& o)
{
  std::vector<std::array<double, 3>> out;
  if (o.sensed && !o.blind)
    for (const auto& pose : sensorPoses(o.sensing.views))
      out.push_back(pose.position);
  return out;
}

/** \brief What is sensed of a scene, or all of it. */
Scene
sceneOf(const std::vector<SceneItem>& objects, const Options& o, std::uint64_t k)
{
  SceneOptions options = o.scene;
  options.seed = o.seed + k;
  Scene complete = generateScene(objects, {}, options);
  if (!o.sensed)
    return complete;
  return sensedScene(complete,
                     senseViews(bodiesOf(complete, objects, {}, options), o.sensing, options.seed));
}

/** \brief True clusters, with a share of points of the rest of the scene near them. */
std::vector<TrueCluster>
trueClusters(const Scene& scene, const Options& o)
{
  std::vector<TrueCluster> all(scene.items.size());
  for (std::size_t k = 0; k < all.size(); ++k)
    all[k].item = k;
  for (std::size_t i = 0; i < scene.surflets.size(); ++i)
    if (scene.instances[i] > 0)
      all[scene.instances[i] - 1].points.push_back(scene.surflets[i]);
  for (auto& cluster : all) {
    const std::size_t own = cluster.points.size();
    if (own == 0 || o.foreign <= 0)
      continue;
    const Extent extent = computeExtent(cluster.points);
    const auto more = static_cast<std::size_t>(o.foreign / (1 - o.foreign) * own);
    CounterRandom random(o.seed, cluster.item);
    for (std::size_t tries = 0; tries < 200 * more && cluster.points.size() < own + more; ++tries) {
      const auto i = random.below(static_cast<std::uint32_t>(scene.surflets.size()));
      const Surflet s = scene.surflets[i];
      const double far =
          std::hypot(s.x - extent.centroid[0], s.y - extent.centroid[1], s.z - extent.centroid[2]);
      if (scene.instances[i] != cluster.item + 1 && far < 1.2 * extent.r_max)
        cluster.points.push_back(s);
    }
  }
  return all;
}

/** \brief Finds clusters as a user would: by the interpreter, the empty scene excluded. */
class Interpreting {
public:
  Interpreting(const std::vector<SceneItem>& objects, const Options& o)
  {
    HistogramModelTrainer trainer;
    trainer.setResolution({7, 7, 7, 7});
    SceneSensing around = o.sensing;
    around.views.views = ViewSet::Ring24;
    ModelDatabase database;
    for (const auto& item : objects)
      database.add(o.sensed
                       ? trainForSensors(trainer, item, around, o.leaf, kTrainingSeed)
                       : trainForScenes(
                             trainer, item.label,
                             item.sample(static_cast<std::size_t>(item.area * o.scene.density) + 1,
                                         kTrainingSeed),
                             o.leaf, kTrainingSeed));
    SceneOptions empty = o.scene;
    empty.seed = kTrainingSeed;
    interpreter_.setDatabase(database);
    interpreter_.setLeafSize(o.leaf);
    interpreter_.setNumberOfThreads(static_cast<unsigned>(o.threads));
    interpreter_.setBackgroundCloud(cloudOf(
        o.sensed ? sensedSurflets(senseViews(backgroundBodies(empty), o.sensing, kTrainingSeed))
                 : emptyBackground(empty)));
  }

  /** \brief What is near a cluster and in none. */
  static void
  addBeside(const Scene& scene, const std::vector<char>& taken, TrueCluster& cluster)
  {
    const Extent extent = computeExtent(cluster.points);
    const double far = 2 * extent.r_max;
    for (std::size_t i = 0; i < taken.size(); ++i) {
      const Surflet s = scene.surflets[i];
      if (taken[i] == 0 && std::abs(s.x - extent.centroid[0]) < far &&
          std::abs(s.y - extent.centroid[1]) < far)
        cluster.beside.push_back(s);
    }
  }

  /** \brief Detections whose name is that of the item most of their points are of. */
  std::vector<TrueCluster>
  clusters(const Scene& scene)
  {
    interpreter_.setInputCloud(cloudOf(scene.surflets));
    std::vector<TrueCluster> all;
    std::vector<char> taken(scene.surflets.size(), 0);
    for (const auto& d : interpreter_.interpret()) {
      std::map<std::uint32_t, std::size_t> votes;
      TrueCluster cluster;
      for (const auto i : d.indices) {
        ++votes[scene.instances[static_cast<std::size_t>(i)]];
        taken[static_cast<std::size_t>(i)] = 1;
        cluster.points.push_back(scene.surflets[static_cast<std::size_t>(i)]);
      }
      const auto most =
          std::max_element(votes.begin(), votes.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      if (most == votes.end() || most->first == 0)
        continue;
      cluster.item = most->first - 1;
      if (scene.items[cluster.item].label == d.label)
        all.push_back(std::move(cluster));
    }
    for (auto& cluster : all)
      addBeside(scene, taken, cluster);
    return all;
  }

private:
  SceneInterpreter<pcl::PointNormal> interpreter_;
};

std::vector<KnownObject>
learned(const std::vector<SceneItem>& objects)
{
  std::vector<KnownObject> known;
  for (const auto& item : objects) {
    const SurfletSet surface = item.sample(kModelSurflets, kTrainingSeed);
    const double start = threadSeconds();
    PoseModel model = PoseModel::train(item.label, surface);
    const double time = threadSeconds() - start;
    const Symmetry& s = model.symmetry();
    const bool symmetric = s.kind != SymmetryKind::None;
    constexpr const char* kinds[] = {"none", "discrete", "continuous", "spherical"};
    std::fprintf(stderr,
                 "%-18s diameter %.4f, symmetry %s of order %u, axis %.3f %.3f %.3f, %.2f s\n",
                 item.label.c_str(), model.diameter(), kinds[static_cast<int>(s.kind)], s.order,
                 s.axis[0], s.axis[1], s.axis[2], time);
    known.push_back({std::move(model), PoseError(surface), symmetric});
  }
  return known;
}

void
judge(const KnownObject& object, const TrueCluster& cluster, const PlacedItem& item,
      const Options& o, PoseCounts& counts)
{
  ++counts.segmented;
  const double start = threadSeconds();
  const PoseEstimate e = estimatePose(cluster.points, object.model, o.pose, cluster.beside);
  counts.seconds.push_back(threadSeconds() - start);
  const RigidMotion truth = motionOf(item);
  const double error = (object.symmetric ? object.error.nearest(e.motion, truth)
                                         : object.error.distance(e.motion, truth)) /
                       object.model.diameter();
  const bool found = e.status == PoseStatus::Found, right = found && error < o.limit;
  counts.posed += found;
  counts.right += right;
  if (right)
    counts.errors.push_back(error);
  if (o.verbose)
    std::fprintf(stderr,
                 "%-18s %s error %.3f score %.3f inliers %.3f margin %.3f cells %zu points %zu "
                 "residual %.4f dev %.5f %.4f %s\n",
                 item.label.c_str(), right ? "right" : "WRONG", error, e.score, e.inlier_share,
                 e.margin, e.cells, cluster.points.size(), e.residual, e.position_deviation,
                 e.rotation_deviation, e.reason.c_str());
}

/** \brief Percent and its interval; a dash if there were no \p trials. */
std::string
textOf(const Rate& rate, std::size_t trials)
{
  char text[64];
  if (trials == 0)
    return std::string(20, ' ') + "-";
  std::snprintf(text, sizeof text, "%5.1f [%5.1f, %5.1f]", rate.percent, rate.low, rate.high);
  return text;
}

void
printRow(const std::string& name, const PoseCounts& c)
{
  const Rate present = rateOf(c.right, c.present), posed = rateOf(c.right, c.posed);
  double sum = 0;
  for (const double s : c.seconds)
    sum += s;
  std::printf("%-18s %7zu %9zu %6zu %6zu   %s   %s   ", name.c_str(), c.present, c.segmented,
              c.posed, c.right, textOf(present, c.present).c_str(), textOf(posed, c.posed).c_str());
  if (c.errors.empty() || c.seconds.empty())
    std::printf("%6s %7s %7s\n", "-", "-", "-");
  else
    std::printf("%6.4f %7.2f %7.2f\n", medianOf(c.errors),
                1e3 * sum / static_cast<double>(c.seconds.size()), 1e3 * medianOf(c.seconds));
}

void
evaluate(const std::vector<SceneItem>& objects, Options o)
{
  o.pose.viewpoints = viewpointsOf(o);
  const auto known = learned(objects);
  std::unique_ptr<Interpreting> interpreting;
  if (o.interpreted)
    interpreting = std::make_unique<Interpreting>(objects, o);
  std::vector<PoseCounts> counts(objects.size());
  Progress progress(o.scenes);
  for (std::uint64_t k = 0; k < o.scenes; ++k) {
    progress.show(k, "scenes");
    const Scene scene = sceneOf(objects, o, k);
    for (const auto& item : scene.items)
      counts[item.number - 1].present += item.surflets >= o.least;
    const auto clusters = interpreting ? interpreting->clusters(scene) : trueClusters(scene, o);
    std::vector<bool> done(scene.items.size(), false);
    for (const auto& cluster : clusters) {
      const auto& item = scene.items[cluster.item];
      if (item.surflets < o.least || done[cluster.item])
        continue;
      done[cluster.item] = true;
      judge(known[item.number - 1], cluster, item, o, counts[item.number - 1]);
    }
  }
  progress.clear();
  std::printf("%llu scenes, seeds %llu to %llu\n"
              "object             present segmented  posed  right   %% of present            "
              "%% of poses              error ms mean  median\n",
              static_cast<unsigned long long>(o.scenes), static_cast<unsigned long long>(o.seed),
              static_cast<unsigned long long>(o.seed + o.scenes - 1));
  PoseCounts all;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    printRow(objects[i].label, counts[i]);
    all += counts[i];
  }
  printRow("all", all);
}

void
addOptions(CommandLine& line, Options& o)
{
  line.count("-scenes", "N", "number of scenes, default 10", o.scenes, 1, 1000000);
  addArrangement(line, o.scene);
  addSensor(line, o.sensing);
  line.flag("-interpret", "clusters are those that SceneInterpreter finds, default the true ones",
            o.interpreted);
  line.real("-leaf", "S", "of the interpreter's cells, default 0.0058", o.leaf, 1e-9, 1e9);
  line.real("-foreign", "P", "share of points of other things added to true clusters, default 0",
            o.foreign, 0, 0.9);
  line.flag("-blind", "does not tell where the sensors are", o.blind);
  line.real("-limit", "E", "a pose is right below this error over the diameter, default 0.1",
            o.limit, 0, 10);
  line.count("-least", "N", "present are objects of so many points, default 50", o.least, 1,
             1000000);
  line.count("-references", "N", "cells whose pairs vote, default 24", o.pose.references, 1,
             100000);
  line.count("-partners", "N", "cells each is paired with, default 400", o.pose.partners, 1,
             100000);
  line.count("-peaks", "N", "poses that each reference proposes, default 3", o.pose.peaks, 1, 1000);
  line.count("-cells", "N", "most cells of a cluster looked at, default 800", o.pose.final_cells,
             50, 100000);
  line.count("-refined", "N", "proposals refined, default 6", o.pose.refined, 1, 1000);
  line.real("-unseen_weight", "W", "of surface that sensors should see, default 0.3",
            o.pose.unseen_weight, 0, 1);
  line.flag("-verbose", "prints every pose to stderr", o.verbose);
  line.count("-seed", "S", "seed of the first scene, the next one counts on, default 1001", o.seed,
             0, 1ULL << 62);
  addThreads(line, o.threads);
}

int
run(int argc, char** argv)
{
  Options o;
  CommandLine line(
      kProgram, "ITEM...",
      "Generates scenes of the ITEMs (see pcl_surflet_generate), estimates the pose of "
      "every object from its cluster and\ncounts the poses whose mean error of points "
      "(ADD; of symmetric objects that to nearest points, ADD-S) is below a\ntenth of "
      "the diameter.");
  addOptions(line, o);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(1, 1000);
  refuseNoiseOfViews(line);
  o.sensed = line.given("-views");
  o.sensing.threads = static_cast<unsigned>(o.threads);
  const auto objects = itemsOf(line.files());
  o.scene.present = objects.size();
  evaluate(objects, o);
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return run(argc, argv); });
}
