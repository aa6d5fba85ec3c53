// Ours and other ways to names and poses side by side on the same sensed scenes.

#include "app_common.h"
#include "evaluation/peers.h"
#include "scene_items.h"
#include "sensor_options.h"

#include "pcl_surflet/core/cell_reduction.h"

#include <algorithm>
#include <cstdio>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_evaluate_peers";
constexpr std::uint64_t kFirstTuned = 1; // thresholds are chosen on other scenes than any reported

struct Options {
  RecogniserOptions recogniser;
  SceneSensing sensing;
  std::vector<std::string> peers{"ours", "classic_vfh"};
  double presence = 0.5;
  SceneContents contents; ///< of which the clutter is what no peer knows
  std::uint64_t scenes = 20, tune = 5, seed = 1001, least = 50, limit = 120;
};

class Study {
public:
  Study(const std::vector<SceneItem>& items, const std::vector<SceneItem>& clutter,
        const Options& o)
      : items_(items), clutter_(clutter), options_(o),
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
    const auto contestant =
        peer(name, items_, known_, options_.recogniser, static_cast<unsigned>(options_.limit));
    PeerCounts chosen;
    if (options_.tune > 0 && isPoseFinder(name))
      chosen = counts(*contestant, kFirstTuned, options_.tune);
    const double threshold = bestThreshold(chosen);
    print(name, threshold, counts(*contestant, options_.seed, options_.scenes));
  }

private:
  Given
  given(std::uint64_t seed) const
  {
    SceneOptions scene = options_.recogniser.scene;
    scene.seed = seed;
    scene.present = presentOf(items_.size(), options_.presence, seed);
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
  const std::vector<SceneItem>& clutter_;
  Options options_;
  std::vector<Known> known_;
  std::vector<JudgedObject> judged_;
  SurfletSet empty_;
};

void
addOptions(CommandLine& line, Options& o)
{
  addNames(line, "-peer", "default ours,classic_vfh", peerNames(), o.peers);
  line.count("-scenes", "N", "number of scenes, default 20", o.scenes, 1, 1000000);
  line.count("-tune", "N",
             "scenes from seed 1 on that thresholds are chosen on, default 5; 0: none", o.tune, 0,
             99);
  line.real("-presence", "P", "each item is present with this probability, default 0.5", o.presence,
            0, 1);
  addClutter(line, o.contents);
  addArrangement(line, o.recogniser.scene);
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
  refuseNoiseOfViews(line);
  o.recogniser.dissertation.background = BackgroundTreatment::Exclude;
  o.recogniser.dissertation.threads = 1;
  o.sensing.threads = 1;
  if (line.given("-views"))
    o.recogniser.sensing = o.sensing;
  const auto items = itemsOf(line.files());
  const auto clutter = clutterOf(line, o.contents);
  settleContents(line, o.contents, items.size(), clutter.size(), o.recogniser.scene);
  const Study study(items, clutter, o);
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
