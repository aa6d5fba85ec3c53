#include "pcl_surflet/core/scene_generator.h"

#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/counter_random.h"
#include "require.h"
#include "scene_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace pcl_surflet {
namespace detail {

Vector3
Pose::turned(const Vector3& v) const
{
  return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
}

Pose
Pose::after(const Pose& first) const
{
  Pose out;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      out.rows[i][j] = rows[i][0] * first.rows[0][j] + rows[i][1] * first.rows[1][j] +
                       rows[i][2] * first.rows[2][j];
  out.shift = add(turned(first.shift), shift);
  return out;
}

std::array<double, 16>
Pose::matrix() const
{
  return {rows[0][0], rows[0][1], rows[0][2], shift[0],   rows[1][0], rows[1][1],
          rows[1][2], shift[1],   rows[2][0], rows[2][1], rows[2][2], shift[2],
          0,          0,          0,          1};
}

Pose
turnAboutZ(double angle)
{
  const double c = std::cos(angle), s = std::sin(angle);
  Pose pose;
  pose.rows = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
  return pose;
}

Pose
tiltAboutX(double angle)
{
  const double c = std::cos(angle), s = std::sin(angle);
  Pose pose;
  pose.rows = {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
  return pose;
}

SurfletSet
moved(const SurfletSet& set, const Pose& pose)
{
  SurfletSet out;
  out.reserve(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    const auto p = toFloat3(add(pose.turned({set.x[i], set.y[i], set.z[i]}), pose.shift));
    const auto n = toFloat3(pose.turned({set.nx[i], set.ny[i], set.nz[i]}));
    out.push_back({p[0], p[1], p[2], n[0], n[1], n[2]});
  }
  return out;
}

PlacementItem
placementItem(const SurfletSet& upright, const Pose& posture)
{
  PlacementItem item;
  item.surflets = moved(upright, posture);
  item.pose = posture;
  const Extent extent = computeExtent(item.surflets);
  std::copy(extent.centroid, extent.centroid + 3, item.centroid.begin());
  item.radius = extent.r_max;
  item.r_mean = extent.r_mean;
  for (std::size_t i = 0; i < item.surflets.size(); ++i)
    item.radius_xy = std::max(item.radius_xy, std::hypot(item.surflets.x[i] - item.centroid[0],
                                                         item.surflets.y[i] - item.centroid[1]));
  return item;
}

void
translate(PlacementItem& item, const Vector3& by)
{
  Pose shift;
  shift.shift = by;
  item.pose = shift.after(item.pose);
  item.centroid = add(item.centroid, by);
  for (std::size_t i = 0; i < item.surflets.size(); ++i) {
    item.surflets.x[i] += static_cast<float>(by[0]);
    item.surflets.y[i] += static_cast<float>(by[1]);
    item.surflets.z[i] += static_cast<float>(by[2]);
  }
}

} // namespace detail

namespace {

constexpr double kMaxSurflets = 1 << 28;
constexpr const char* kGenerator = "generateScene: ";
constexpr double kLeastLean = M_PI / 12, kMostLean = M_PI / 4;

// Independent random numbers for what is drawn from one seed.
constexpr std::uint64_t kChoiceStream = 0x63686f696365ULL, kPostureStream = 0x706f7374ULL;
constexpr std::uint64_t kSampleStream = 0x73616d70ULL, kEmptyStream = 0x656d707479ULL;

void
check(const SceneOptions& o)
{
  requirePositive(o.size, "size", kGenerator);
  requirePositive(o.width, "width", kGenerator, true);
  requirePositive(o.wall_height, "wall_height", kGenerator);
  requirePositive(o.density, "density", kGenerator);
  requirePositive(o.distance_factor, "distance_factor", kGenerator, true);
  requirePositive(o.gap, "gap", kGenerator, true);
  requirePositive(o.noise, "noise", kGenerator, true);
}

std::size_t
surfletsFor(double area, const SceneOptions& o)
{
  const double n = std::round(area * o.density);
  if (!(n <= kMaxSurflets))
    throw std::invalid_argument("generateScene: more than 2^28 surflets; lower the density (it "
                                "counts surflets per squared unit of the items)");
  return static_cast<std::size_t>(n);
}

/** \brief \p count of 0 ... n - 1 in ascending order, chosen at random. */
std::vector<std::size_t>
chosen(std::size_t n, std::size_t count, CounterRandom& random)
{
  std::vector<std::size_t> all(n);
  std::iota(all.begin(), all.end(), std::size_t{0});
  for (std::size_t i = n; i > 1; --i)
    std::swap(all[i - 1], all[random.below(static_cast<std::uint32_t>(i))]);
  all.resize(std::min(n, count));
  std::sort(all.begin(), all.end());
  return all;
}

detail::Pose
postureOf(Posture posture, CounterRandom& random)
{
  const double first = random.uniform(0, 2 * M_PI), last = random.uniform(0, 2 * M_PI);
  const double lean = random.uniform(kLeastLean, kMostLean);
  if (posture == Posture::Mixed) {
    constexpr Posture all[] = {Posture::Upright, Posture::Lying, Posture::Leaning};
    posture = all[random.below(3)];
  }
  double tilt = 0;
  if (posture == Posture::Lying)
    tilt = M_PI / 2;
  else if (posture == Posture::Leaning)
    tilt = lean;
  return detail::turnAboutZ(last).after(detail::tiltAboutX(tilt).after(detail::turnAboutZ(first)));
}

detail::PlacementItem
standing(const SceneItem& item, std::size_t i, const SceneOptions& o)
{
  if (!(item.area > 0) || !item.sample)
    throw std::invalid_argument("generateScene: '" + item.label + "' has no surface");
  const std::size_t n = surfletsFor(item.area, o);
  if (n == 0)
    throw std::invalid_argument("generateScene: not one surflet falls on '" + item.label +
                                "'; raise the density (it counts surflets per squared unit)");
  CounterRandom random(o.seed, kPostureStream + i);
  return detail::placementItem(item.sample(n, mix64(o.seed ^ (kSampleStream + i))),
                               postureOf(o.posture, random));
}

SurfletSet
noisy(const SurfletSet& set, double noise, std::uint64_t seed)
{
  return noise > 0 ? displacedAlongNormals(set, noise, mix64(~seed)) : set;
}

void
append(Scene& scene, const SurfletSet& set, std::uint32_t label, std::uint32_t instance)
{
  for (std::size_t i = 0; i < set.size(); ++i)
    scene.surflets.push_back(set[i]);
  scene.labels.resize(scene.surflets.size(), label);
  scene.instances.resize(scene.surflets.size(), instance);
}

} // namespace

TriangleMesh
meshOf(const Shape& shape, double vertices)
{
  // n vertices carry 2n triangles, of sqrt(3)/4 e^2 each if they are equilateral.
  return meshOfShape(shape, std::sqrt(areaOfShape(shape) * 2 / (std::sqrt(3.0) * vertices)));
}

SceneItem
sceneItem(const std::string& label, const Shape& shape)
{
  constexpr double kVertices = 20000; // fine enough for handles and rims
  return {label, areaOfShape(shape),
          [shape](std::size_t n, std::uint64_t seed) { return sampleShape(shape, n, seed); },
          [shape] { return meshOf(shape, kVertices); }};
}

SceneItem
sceneItem(const std::string& label, const TriangleMesh& mesh)
{
  if (const auto problem = mesh.problem(); !problem.empty())
    throw std::invalid_argument("'" + label + "': " + problem);
  return {label, surfaceArea(mesh),
          [mesh](std::size_t n, std::uint64_t seed) { return sampleSurface(mesh, n, seed); },
          [mesh] { return mesh; }};
}

Scene
generateScene(const std::vector<SceneItem>& objects, const std::vector<SceneItem>& clutter,
              const SceneOptions& o)
{
  check(o);
  Scene scene;
  CounterRandom random(o.seed, kChoiceStream);
  std::vector<detail::PlacementItem> placed;
  const auto take = [&](const std::vector<SceneItem>& list, std::size_t count, bool is_clutter) {
    for (const auto i : chosen(list.size(), count, random)) {
      const std::size_t number = i + (is_clutter ? objects.size() : 0);
      placed.push_back(standing(list[i], number, o));
      PlacedItem item;
      item.label = list[i].label;
      item.number = static_cast<std::uint32_t>(number + 1);
      item.clutter = is_clutter;
      scene.items.push_back(std::move(item));
    }
  };
  take(objects, o.present, false);
  take(clutter, o.clutter, true);
  detail::placeItems(placed, o);

  const auto seed = mix64(o.seed ^ kSampleStream);
  const std::size_t n = surfletsFor(detail::backgroundArea(o), o);
  append(scene, noisy(detail::sampleBackground(o, n, seed), o.noise, seed), 0, 0);
  for (std::size_t k = 0; k < placed.size(); ++k) {
    auto& item = scene.items[k];
    item.pose = placed[k].pose.matrix();
    item.centroid = placed[k].centroid;
    item.r_mean = placed[k].r_mean;
    item.surflets = placed[k].surflets.size();
    append(scene, noisy(placed[k].surflets, o.noise, seed + k + 1), item.number,
           static_cast<std::uint32_t>(k + 1));
  }
  return scene;
}

SurfletSet
emptyBackground(const SceneOptions& o)
{
  check(o);
  const auto seed = mix64(o.seed ^ kEmptyStream);
  const std::size_t n = surfletsFor(detail::backgroundArea(o), o);
  return noisy(detail::sampleBackground(o, n, seed), o.noise, seed);
}

std::vector<SensedBody>
backgroundBodies(const SceneOptions& o)
{
  check(o);
  if (o.background == Background::None)
    return {};
  return {{detail::backgroundMesh(o), 0, 0}};
}

std::vector<SensedBody>
bodiesOf(const Scene& scene, const std::vector<SceneItem>& objects,
         const std::vector<SceneItem>& clutter, const SceneOptions& o)
{
  auto bodies = backgroundBodies(o);
  for (std::size_t k = 0; k < scene.items.size(); ++k) {
    const auto& item = scene.items[k];
    const std::size_t number = item.number - 1;
    const auto& source =
        number < objects.size() ? objects.at(number) : clutter.at(number - objects.size());
    if (!source.mesh)
      throw std::invalid_argument("bodiesOf: '" + source.label + "' has no mesh to be sensed");
    SensedBody body{source.mesh(), item.number, static_cast<std::uint32_t>(k + 1)};
    const auto& m = item.pose;
    for (auto& v : body.mesh.vertices) {
      const detail::Vector3 p = detail::toVector3(v);
      v = detail::toFloat3({m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3],
                            m[4] * p[0] + m[5] * p[1] + m[6] * p[2] + m[7],
                            m[8] * p[0] + m[9] * p[1] + m[10] * p[2] + m[11]});
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

} // namespace pcl_surflet
