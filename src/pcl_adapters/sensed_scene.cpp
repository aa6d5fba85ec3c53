#include "pcl_surflet/sensed_scene.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/octree_region_search.h"

#include <pcl/features/normal_3d.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace pcl_surflet {
namespace {

using Points = pcl::PointCloud<pcl::PointXYZ>;

bool
hasPoint(const DepthScan& scan, std::size_t i)
{
  return std::isfinite(scan.x[i]) && std::isfinite(scan.y[i]) && std::isfinite(scan.z[i]);
}

/** \brief Pixel \p i in the frame of the scene; not finite where there is no point or no normal. */
Surflet
inScene(const OrientedScan& s, std::size_t i)
{
  const SensorFrame& f = s.scan.frame;
  const auto p = f.toScene({s.scan.x[i], s.scan.y[i], s.scan.z[i]});
  std::array<float, 3> n{};
  for (std::size_t k = 0; k < 3; ++k)
    n[k] = static_cast<float>(f.right[k] * s.nx[i] + f.down[k] * s.ny[i] + f.forward[k] * s.nz[i]);
  return {static_cast<float>(p[0]),
          static_cast<float>(p[1]),
          static_cast<float>(p[2]),
          n[0],
          n[1],
          n[2]};
}

/** \brief The points of a scan. \p pixels gets where they come from. */
Points::Ptr
pointsOf(const DepthScan& scan, std::vector<std::size_t>& pixels)
{
  Points::Ptr points(new Points);
  for (std::size_t i = 0; i < scan.z.size(); ++i)
    if (hasPoint(scan, i)) {
      points->push_back({scan.x[i], scan.y[i], scan.z[i]});
      pixels.push_back(i);
    }
  return points;
}

/** \brief The normal of the plane through neighbours, towards the sensor at the origin, as
 * pcl::NormalEstimation has it; NaN if they are fewer than three or lie on a line. Seen from its
 * edge a surface shows lines of pixels that are far apart, and of one line PCL 1.15 gives any of
 * its normals, where PCL 1.13 gave none. */
pcl::Normal
normalOf(const Points& points, const pcl::PointXYZ& at, const pcl::Indices& neighbours)
{
  constexpr float kOnALine = 1e-6F; // of the variances across and along it
  Eigen::Matrix3f covariance = Eigen::Matrix3f::Zero();
  Eigen::Vector4f centroid, plane;
  Eigen::Vector3f variances;
  pcl::Normal out(NAN, NAN, NAN);
  if (neighbours.size() < 3)
    return out;
  pcl::computeMeanAndCovarianceMatrix(points, neighbours, covariance, centroid);
  pcl::eigen33(covariance, variances);
  if (!(variances[1] > kOnALine * variances[2]))
    return out;
  pcl::solvePlaneParameters(covariance, centroid, plane, out.curvature);
  pcl::flipNormalTowardsViewpoint(at, 0, 0, 0, plane);
  out.getNormalVector3fMap() = plane.head<3>();
  return out;
}

/** \brief Is it certain which side of the surface is seen? Of a surface seen from its edge a small
 * error of the normal would turn it around. */
bool
facesSurely(const pcl::PointXYZ& p, const pcl::Normal& n)
{
  constexpr float kLeastCosine = 0.087f; // 85 degrees
  const auto sight = p.getVector3fMap();
  return std::abs(n.getNormalVector3fMap().dot(sight)) >= kLeastCosine * sight.norm();
}

} // namespace

OrientedScan
withNormals(DepthScan scan, double radius)
{
  if (!(radius > 0) || !std::isfinite(radius))
    throw std::invalid_argument("pcl_surflet: the radius of normals must be positive and finite");
  OrientedScan out{std::move(scan), {}, {}, {}};
  for (auto* v : {&out.nx, &out.ny, &out.nz})
    v->assign(out.scan.z.size(), std::numeric_limits<float>::quiet_NaN());
  std::vector<std::size_t> pixels;
  const auto points = pointsOf(out.scan, pixels);
  if (points->empty())
    return out;
  OctreeRegionSearch<pcl::PointXYZ> search;
  search.setInputCloud(points);
  pcl::Indices neighbours;
  std::vector<float> squared;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const pcl::PointXYZ& p = (*points)[k];
    search.radiusSearch(p, radius, neighbours, squared);
    const pcl::Normal n = normalOf(*points, p, neighbours);
    if (!facesSurely(p, n))
      continue;
    out.nx[pixels[k]] = n.normal_x;
    out.ny[pixels[k]] = n.normal_y;
    out.nz[pixels[k]] = n.normal_z;
  }
  return out;
}

std::vector<OrientedScan>
senseViews(const std::vector<SensedBody>& bodies, const SceneSensing& sensing, std::uint64_t seed)
{
  const auto poses = sensorPoses(sensing.views);
  std::vector<OrientedScan> scans(poses.size());
  parallelFor(poses.size(), sensing.threads, [&](std::size_t k, unsigned) {
    scans[k] = withNormals(sense(bodies, sensing.sensor, poses[k], mix64(seed) + k),
                           sensing.normal_radius);
  });
  return scans;
}

Scene
sensedScene(const Scene& scene, const std::vector<OrientedScan>& scans)
{
  std::vector<SurfletSet> sets(scene.items.size() + 1); // of each instance
  for (const auto& s : scans)
    for (std::size_t i = 0; i < s.scan.z.size(); ++i) {
      if (s.scan.instances[i] >= sets.size())
        throw std::invalid_argument("sensedScene: a scan shows instance " +
                                    std::to_string(s.scan.instances[i]) + ", the scene has " +
                                    std::to_string(scene.items.size()));
      sets[s.scan.instances[i]].appendChecked(inScene(s, i));
    }
  Scene out;
  out.items = scene.items;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    for (std::size_t i = 0; i < sets[k].size(); ++i)
      out.surflets.push_back(sets[k][i]);
    out.labels.resize(out.surflets.size(), k == 0 ? 0 : out.items[k - 1].number);
    out.instances.resize(out.surflets.size(), static_cast<std::uint32_t>(k));
    if (k > 0)
      out.items[k - 1].surflets = sets[k].size();
  }
  return out;
}

SurfletSet
sensedSurflets(const std::vector<OrientedScan>& scans)
{
  SurfletSet out;
  for (const auto& s : scans)
    for (std::size_t i = 0; i < s.scan.z.size(); ++i)
      out.appendChecked(inScene(s, i));
  return out;
}

std::vector<OrientedScan>
scansAlone(const SceneItem& item, const SceneSensing& sensing, std::uint64_t seed)
{
  const std::vector<SensedBody> bodies = {{item.mesh(), 1, 1}};
  std::array<float, 3> low, high;
  low = high = bodies[0].mesh.vertices.at(0);
  for (const auto& v : bodies[0].mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], v[k]);
      high[k] = std::max(high[k], v[k]);
    }
  SceneSensing alone = sensing;
  for (std::size_t k = 0; k < 3; ++k)
    alone.views.target[k] = 0.5 * (static_cast<double>(low[k]) + high[k]);
  return senseViews(bodies, alone, seed);
}

SurfletSet
senseAlone(const SceneItem& item, const SceneSensing& sensing, std::uint64_t seed)
{
  return sensedSurflets(scansAlone(item, sensing, seed));
}

} // namespace pcl_surflet
