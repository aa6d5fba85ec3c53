#include "evaluation/online_scenes.h"

#include "evaluation/training.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/linear_octree.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr std::uint64_t kEmptyStream = 0x656d7074ULL, kAgainStream = 0x616761696eULL;
constexpr double kFine = 0.5; ///< edge of the empty scene's cells, in those of the scene

SceneOptions
optionsOf(const LongTable& table, double length, std::uint64_t seed)
{
  SceneOptions o;
  o.size = length;
  o.width = table.width;
  o.density = 20000; // only placement looks at surflets
  o.seed = seed;
  return o;
}

SceneSensing
passing(const LongTable& table, double length)
{
  SceneSensing s = table.sensing;
  s.views.views = ViewSet::Pass;
  s.views.path = length;
  s.views.stops = 2 * (1 + static_cast<std::size_t>(std::llround(length / table.stride)));
  return s;
}

/** \brief Instance of most cells of a detection. */
std::uint32_t
instanceOf(const CellScene& cells, const Detection& d)
{
  std::map<std::uint32_t, std::size_t> count;
  for (const auto c : d.cells)
    ++count[cells.instance[c]];
  std::uint32_t best = 0;
  for (const auto& [instance, n] : count)
    if (n > count[best])
      best = instance;
  return best;
}

} // namespace

std::size_t
itemsOn(const LongTable& table, double length)
{
  return static_cast<std::size_t>(
      std::max<long long>(1, std::llround(length * table.items_per_length)));
}

ModelDatabase
tableDatabase(const std::vector<SceneItem>& items, const LongTable& table, int bins)
{
  TrainingOptions o;
  o.sensing = table.sensing;
  o.bins = bins;
  o.leaf = table.leaf;
  o.for_scenes = true;
  o.threads = table.sensing.threads;
  return trainedDatabase(items, o);
}

SensedTable
sensedTable(const std::vector<SceneItem>& items, const LongTable& table, double length,
            std::uint64_t seed)
{
  std::vector<SceneItem> standing;
  for (std::size_t k = 0; k < itemsOn(table, length); ++k)
    standing.push_back(items[k % items.size()]);
  const SceneOptions options = optionsOf(table, length, seed);
  const Scene complete = generateScene(standing, {}, options);
  SensedTable out;
  out.seed = seed;
  out.bodies = bodiesOf(complete, standing, {}, options);
  out.sensing = passing(table, length);
  out.scans = senseViews(out.bodies, out.sensing, seed);
  out.scene = sensedScene(complete, out.scans);
  const auto empty = senseViews(backgroundBodies(options), out.sensing, mix64(seed ^ kEmptyStream));
  out.empty = reduceToCells(sensedSurflets(empty), kFine * table.leaf).cells;
  return out;
}

pcl::PointCloud<pcl::PointNormal>
cloudOf(const OrientedScan& s)
{
  pcl::PointCloud<pcl::PointNormal> cloud;
  cloud.reserve(s.nx.size());
  for (std::size_t i = 0; i < s.nx.size(); ++i) {
    pcl::PointNormal p;
    p.getVector3fMap() << s.scan.x[i], s.scan.y[i], s.scan.z[i];
    p.getNormalVector3fMap() << s.nx[i], s.ny[i], s.nz[i];
    cloud.push_back(p);
  }
  const auto& at = s.scan.frame.position;
  const auto q = s.scan.frame.quaternion();
  cloud.sensor_origin_ = Eigen::Vector4d(at[0], at[1], at[2], 0).cast<float>();
  cloud.sensor_orientation_ = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).cast<float>();
  return cloud;
}

void
append(SurfletSet& to, const SurfletSet& from)
{
  for (std::size_t i = 0; i < from.size(); ++i)
    to.push_back(from[i]);
}

CellScene
withNearestTruth(const SurfletSet& cells, const Scene& scene)
{
  CellScene out;
  out.cells = cells;
  out.items = scene.items;
  out.instance.resize(cells.size());
  const SurfletSet& s = scene.surflets;
  LinearOctree octree;
  octree.build({s.x.data(), s.y.data(), s.z.data(), 1, s.size()});
  std::vector<PointIndex> nearest;
  std::vector<float> distances;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!std::isfinite(cells.x[c]) || s.empty())
      continue;
    octree.nearestSearch({cells.x[c], cells.y[c], cells.z[c]}, 1, nearest, distances);
    out.instance[c] = scene.instances[static_cast<std::size_t>(nearest.at(0))];
  }
  return out;
}

std::vector<Detection>
thereOf(const OnlineInterpretation& online)
{
  std::vector<Detection> there;
  for (const auto& d : online.detections())
    if (d.state != OnlineState::Vanished)
      there.push_back(d);
  return there;
}

void
takeAway(const SensedTable& table, std::size_t most, const CellScene& cells,
         OnlineSceneInterpreter& online, Taking& taking)
{
  std::set<std::uint32_t> gone;
  std::vector<std::uint64_t> ending, staying;
  for (const auto& d : online.detections()) {
    const auto instance = instanceOf(cells, d);
    if (d.state == OnlineState::Vanished || instance == 0)
      continue;
    if (gone.size() < most || gone.count(instance) > 0) {
      gone.insert(instance);
      ending.push_back(d.id);
    }
    else
      staying.push_back(d.id);
  }
  std::vector<SensedBody> rest;
  for (const auto& body : table.bodies)
    if (gone.count(body.instance) == 0)
      rest.push_back(body);
  for (const auto& scan : senseViews(rest, table.sensing, mix64(table.seed ^ kAgainStream)))
    online.addScanInSensorFrame(cloudOf(scan));
  std::set<std::uint64_t> there;
  for (const auto& d : online.detections())
    if (d.state != OnlineState::Vanished)
      there.insert(d.id);
  taking.taken += ending.size();
  taking.others += staying.size();
  for (const auto id : ending)
    taking.ended += there.count(id) == 0 ? 1 : 0;
  for (const auto id : staying)
    taking.stayed += there.count(id);
}

} // namespace apps
} // namespace pcl_surflet
