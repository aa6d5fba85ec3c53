// BackgroundTreatment::Exclude: what of a cloud is background.

#include "core/require.h"
#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/scene_interpreter.h"

#include <pcl/ModelCoefficients.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <cmath>
#include <limits>

namespace pcl_surflet {
namespace {

void
check(const ExclusionOptions& options)
{
  require(options.distance > 0 && std::isfinite(options.distance),
          "the distance from the background must be positive and finite");
  require(options.max_angle > 0 && options.max_angle <= M_PI + 1e-6,
          "the angle to the background's normals must be in (0, pi]");
}

void
check(const BackgroundPlane& plane)
{
  for (const double v : plane.normal)
    require(std::isfinite(v), "the normal of a background plane must be finite");
  require(plane.max_tilt > 0 && plane.max_tilt <= M_PI / 2 + 1e-6,
          "max_tilt of a background plane must be in (0, pi / 2]");
  require(plane.min_share > 0 && plane.min_share <= 1,
          "min_share of a background plane must be in (0, 1]");
  require(plane.max_iterations > 0 && plane.max_iterations <= std::numeric_limits<int>::max(),
          "max_iterations of a background plane must be positive, below 2^31");
}

/** \brief The plane a x + b y + c z + d = 0, (a, b, c) of unit length. */
struct Plane {
  double a = 0, b = 0, c = 0, d = 0;

  double
  distance(const Surflet& s) const
  {
    return a * s.x + b * s.y + c * s.z + d;
  }
  double
  agreement(const Surflet& s) const
  {
    return a * s.nx + b * s.ny + c * s.nz;
  }
};

pcl::PointCloud<pcl::PointXYZ>::Ptr
positionsOf(const SurfletSet& set)
{
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  cloud->reserve(set.size());
  for (std::size_t i = 0; i < set.size(); ++i)
    cloud->push_back({set.x[i], set.y[i], set.z[i]});
  return cloud;
}

/** \brief The plane's side is the one to which most of its cells turn. */
Plane
turnedLike(Plane plane, const SurfletSet& cells, const pcl::Indices& inliers)
{
  double sum = 0;
  for (const auto i : inliers)
    sum += plane.agreement(cells[static_cast<std::size_t>(i)]);
  return sum >= 0 ? plane : Plane{-plane.a, -plane.b, -plane.c, -plane.d};
}

/** \brief RANSAC by PCL, whose draws are the same every time. \return false if there is none */
bool
findPlane(const SurfletSet& cells, const BackgroundPlane& wanted, double distance, Plane& found)
{
  if (cells.size() < 3)
    return false;
  pcl::SACSegmentation<pcl::PointXYZ> segmentation;
  const Eigen::Vector3f axis = Eigen::Vector3d(wanted.normal.data()).cast<float>();
  segmentation.setModelType(axis.isZero(0) ? pcl::SACMODEL_PLANE
                                           : pcl::SACMODEL_PERPENDICULAR_PLANE);
  segmentation.setAxis(axis);
  segmentation.setEpsAngle(wanted.max_tilt);
  segmentation.setMethodType(pcl::SAC_RANSAC);
  segmentation.setMaxIterations(static_cast<int>(wanted.max_iterations));
  segmentation.setDistanceThreshold(distance);
  segmentation.setOptimizeCoefficients(true);
  segmentation.setInputCloud(positionsOf(cells));
  pcl::PointIndices inliers;
  pcl::ModelCoefficients model;
  segmentation.segment(inliers, model);
  if (model.values.size() != 4 || static_cast<double>(inliers.indices.size()) <
                                      wanted.min_share * static_cast<double>(cells.size()))
    return false;
  const auto& v = model.values;
  found = turnedLike({v[0], v[1], v[2], v[3]}, cells, inliers.indices);
  return true;
}

} // namespace

void
detail::removePoints(const std::function<bool(const Surflet&)>& is_background,
                     ConvertedSurflets& points)
{
  ConvertedSurflets rest;
  rest.rejected = points.rejected;
  for (std::size_t i = 0; i < points.surflets.size(); ++i) {
    const Surflet s = points.surflets[i];
    if (is_background(s))
      continue;
    rest.surflets.push_back(s);
    rest.indices.push_back(points.indices[i]);
  }
  points = std::move(rest);
}

SurfletSet
detail::backgroundCells(const SurfletSet& background, const ExclusionOptions& options)
{
  check(options);
  return reduceToCells(background, options.distance / 2).cells;
}

std::size_t
detail::removePlanes(const std::vector<BackgroundPlane>& planes, const ExclusionOptions& options,
                     ConvertedSurflets& points)
{
  std::size_t found = 0;
  for (const auto& wanted : planes) {
    check(wanted);
    check(options);
    // Cells: RANSAC would otherwise count what was sensed densely, and take long.
    const SurfletSet cells = reduceToCells(points.surflets, options.distance).cells;
    Plane plane;
    if (!findPlane(cells, wanted, options.distance, plane))
      continue;
    ++found;
    const double least = std::cos(options.max_angle);
    removePoints(
        [&](const Surflet& s) {
          return std::abs(plane.distance(s)) <= options.distance && plane.agreement(s) >= least;
        },
        points);
  }
  return found;
}

} // namespace pcl_surflet
