#include "pcl_surflet/sensed_surface.h"

#include <pcl/features/integral_image_normal.h>
#include <pcl/features/normal_3d_omp.h>

#include <cmath>
#include <limits>

namespace pcl_surflet {
namespace {

using Points = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;

Points::ConstPtr
shared(const Points& cloud)
{
  return Points::ConstPtr(&cloud, [](const Points*) {});
}

pcl::Indices
allIndices(std::size_t n)
{
  pcl::Indices all(n);
  for (std::size_t i = 0; i < n; ++i)
    all[i] = static_cast<pcl::index_t>(i);
  return all;
}

/** \brief Squares of coordinates up to here are finite in single precision. */
constexpr float kFarthest = 1e18F;

/** \brief The usable points of a cloud. PCL's normal estimation looks at is_dense only, and its
 * search aborts the process on a point that is not finite in a cloud that claims to be dense, and
 * on coordinates whose sum is not finite. */
struct FinitePoints {
  Points points;
  pcl::Indices indices; ///< in the cloud
  std::size_t left_out = 0;

  template <class PointT>
  explicit FinitePoints(const pcl::PointCloud<PointT>& cloud)
  {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const auto usable = [](float c) { return std::abs(c) <= kFarthest; }; // not NaN either
      if (!usable(cloud[i].x) || !usable(cloud[i].y) || !usable(cloud[i].z)) {
        ++left_out;
        continue;
      }
      points.push_back({cloud[i].x, cloud[i].y, cloud[i].z});
      indices.push_back(static_cast<pcl::index_t>(i));
    }
  }

  /** \brief Surflets with these normals; indices are those of the cloud. */
  ConvertedSurflets
  convert(const Normals& normals) const
  {
    auto out = toSurflets(points, normals, allIndices(points.size()));
    for (auto& i : out.indices)
      i = indices[static_cast<std::size_t>(i)];
    out.rejected += left_out;
    return out;
  }
};

Normals
estimateNormals(const Points& cloud, const Eigen::Vector3f& sensor, int neighbours,
                unsigned threads)
{
  if (neighbours < 3)
    throw std::invalid_argument("pcl_surflet: a normal needs at least 3 neighbours");
  Normals normals;
  if (cloud.empty())
    return normals;
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(threads);
  estimation.setInputCloud(shared(cloud));
  estimation.setKSearch(neighbours);
  estimation.setViewPoint(sensor.x(), sensor.y(), sensor.z());
  estimation.compute(normals);
  return normals;
}

/** \brief Turns every normal against its viewing direction; no normal where there is no direction.
 */
void
orientAgainst(const pcl::PointCloud<pcl::PointNormal>& directions, const pcl::Indices& kept,
              Normals& normals)
{
  for (std::size_t k = 0; k < kept.size(); ++k) {
    auto n = normals[k].getNormalVector3fMap();
    const auto v = directions[static_cast<std::size_t>(kept[k])].getNormalVector3fMap();
    const float along = n.dot(v);
    if (!(v.squaredNorm() > 0) || !std::isfinite(along))
      n.setConstant(std::numeric_limits<float>::quiet_NaN());
    else if (along > 0)
      n = -n;
  }
}

} // namespace

ConvertedSurflets
surfletsFromDepth(const Points& cloud, const Eigen::Vector3f& sensor)
{
  if (!cloud.isOrganized() || cloud.width < 3 || cloud.height < 3)
    throw std::invalid_argument(
        "pcl_surflet: depth clouds must be organised, at least 3 x 3 pixels");
  pcl::IntegralImageNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setNormalEstimationMethod(estimation.AVERAGE_3D_GRADIENT);
  estimation.setInputCloud(shared(cloud));
  estimation.setViewPoint(sensor.x(), sensor.y(), sensor.z());
  Normals normals;
  estimation.compute(normals);
  return toSurflets(cloud, normals, allIndices(cloud.size()));
}

ConvertedSurflets
surfletsFromPoints(const Points& cloud, const Eigen::Vector3f& sensor, int neighbours,
                   unsigned threads)
{
  const FinitePoints finite(cloud);
  return finite.convert(estimateNormals(finite.points, sensor, neighbours, threads));
}

ConvertedSurflets
surfletsFromDirections(const pcl::PointCloud<pcl::PointNormal>& points_and_directions,
                       int neighbours, unsigned threads)
{
  const FinitePoints finite(points_and_directions);
  Normals normals = estimateNormals(finite.points, Eigen::Vector3f::Zero(), neighbours, threads);
  orientAgainst(points_and_directions, finite.indices, normals);
  return finite.convert(normals);
}

ConvertedSurflets
withEstimatedNormals(const SurfletSet& surflets, double radius, unsigned threads)
{
  if (!(radius > 0))
    throw std::invalid_argument("pcl_surflet: the radius of normals must be positive");
  Points points;
  for (std::size_t i = 0; i < surflets.size(); ++i)
    points.push_back({surflets.x[i], surflets.y[i], surflets.z[i]});
  const FinitePoints finite(points);
  Normals normals;
  if (!finite.points.empty()) {
    pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(threads);
    estimation.setInputCloud(shared(finite.points));
    estimation.setRadiusSearch(radius);
    estimation.compute(normals);
  }
  for (std::size_t k = 0; k < normals.size(); ++k) {
    const auto i = static_cast<std::size_t>(finite.indices[k]);
    auto n = normals[k].getNormalVector3fMap();
    if (n.dot(Eigen::Vector3f(surflets.nx[i], surflets.ny[i], surflets.nz[i])) < 0)
      n = -n;
  }
  return finite.convert(normals);
}

} // namespace pcl_surflet
