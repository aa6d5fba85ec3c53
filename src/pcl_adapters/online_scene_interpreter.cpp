#include "pcl_surflet/online_scene_interpreter.h"

#include <pcl/common/transforms.h>

#include <stdexcept>
#include <string>

namespace pcl_surflet {
namespace {

/** \brief A point's surflet with the normal turned to the sensor: what is seen is seen from
 * outside. Without usable normal it still is the end of a ray. */
Surflet
seenFrom(const Eigen::Vector3f& sensor, const Eigen::Vector3f& point, Eigen::Vector3f normal)
{
  if ((sensor - point).dot(normal) < 0)
    normal = -normal;
  return {point.x(), point.y(), point.z(), normal.x(), normal.y(), normal.z()};
}

std::array<double, 3>
placeOf(const Eigen::Vector3f& sensor)
{
  return {sensor.x(), sensor.y(), sensor.z()};
}

} // namespace

OnlineScan
OnlineSceneInterpreter::addScan(const pcl::PointCloud<pcl::PointXYZ>& cloud,
                                const pcl::PointCloud<pcl::Normal>& normals,
                                const Eigen::Vector3f& sensor_origin)
{
  if (normals.size() != cloud.size())
    throw std::invalid_argument("pcl_surflet: there must be one normal for each point, there are " +
                                std::to_string(normals.size()) + " for " +
                                std::to_string(cloud.size()));
  SurfletSet surflets;
  surflets.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    surflets.push_back(
        seenFrom(sensor_origin, cloud[i].getVector3fMap(), normals[i].getNormalVector3fMap()));
  return addScan(surflets, placeOf(sensor_origin));
}

OnlineScan
OnlineSceneInterpreter::addScan(const pcl::PointCloud<pcl::PointNormal>& cloud,
                                const Eigen::Vector3f& sensor_origin)
{
  SurfletSet surflets;
  surflets.reserve(cloud.size());
  for (const auto& p : cloud)
    surflets.push_back(seenFrom(sensor_origin, p.getVector3fMap(), p.getNormalVector3fMap()));
  return addScan(surflets, placeOf(sensor_origin));
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
