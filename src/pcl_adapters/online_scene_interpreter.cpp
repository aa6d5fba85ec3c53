#include "pcl_surflet/online_scene_interpreter.h"

#include "pcl_surflet/conversions.h"

#include <pcl/common/transforms.h>

#include <numeric>
#include <stdexcept>

namespace pcl_surflet {
namespace {

/** \brief Turns normals that look away from the sensor: what is seen is seen from outside. */
void
orient(SurfletSet& set, const Eigen::Vector3f& sensor)
{
  if (!sensor.allFinite())
    throw std::invalid_argument("pcl_surflet: the sensor's origin must be finite");
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Eigen::Vector3f to_sensor = sensor - Eigen::Vector3f(set.x[i], set.y[i], set.z[i]);
    if (to_sensor.dot(Eigen::Vector3f(set.nx[i], set.ny[i], set.nz[i])) >= 0)
      continue;
    set.nx[i] = -set.nx[i];
    set.ny[i] = -set.ny[i];
    set.nz[i] = -set.nz[i];
  }
}

} // namespace

OnlineScan
OnlineSceneInterpreter::addScan(const pcl::PointCloud<pcl::PointXYZ>& cloud,
                                const pcl::PointCloud<pcl::Normal>& normals,
                                const Eigen::Vector3f& sensor_origin)
{
  pcl::Indices all(cloud.size());
  std::iota(all.begin(), all.end(), 0);
  SurfletSet surflets = toSurflets(cloud, normals, all).surflets;
  orient(surflets, sensor_origin);
  OnlineScan scan = addScan(surflets);
  scan.rejected += cloud.size() - surflets.size();
  return scan;
}

OnlineScan
OnlineSceneInterpreter::addScan(const pcl::PointCloud<pcl::PointNormal>& cloud,
                                const Eigen::Vector3f& sensor_origin)
{
  SurfletSet surflets = toSurflets(cloud).surflets;
  orient(surflets, sensor_origin);
  OnlineScan scan = addScan(surflets);
  scan.rejected += cloud.size() - surflets.size();
  return scan;
}

OnlineScan
OnlineSceneInterpreter::addScanInSensorFrame(const pcl::PointCloud<pcl::PointNormal>& cloud)
{
  const Eigen::Vector3f origin = cloud.sensor_origin_.head<3>();
  const float norm = cloud.sensor_orientation_.norm();
  if (!origin.allFinite() || !(norm > 0.99F && norm < 1.01F))
    throw std::invalid_argument("pcl_surflet: the cloud's sensor_origin_ and sensor_orientation_ "
                                "(VIEWPOINT of a PCD file) are no pose");
  Eigen::Affine3f pose = Eigen::Affine3f::Identity();
  pose.translate(origin).rotate(cloud.sensor_orientation_.normalized());
  pcl::PointCloud<pcl::PointNormal> scene;
  pcl::transformPointCloudWithNormals(cloud, scene, pose);
  return addScan(scene, origin);
}

} // namespace pcl_surflet
