/** \file
 * What the tutorials work on in place of your data: clouds as a depth camera would give them. */
#pragma once

#include "pcl_surflet/core/scene_generator.h"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <limits>

namespace tutorial {

/** \brief An organised cloud as drivers of depth cameras give it: x right, y down, z forward, NaN
 * where nothing returned. The camera's pose is kept as PCL does. */
inline pcl::PointCloud<pcl::PointXYZ>::Ptr
organised(const pcl_surflet::DepthScan& scan)
{
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  for (std::size_t i = 0; i < scan.x.size(); ++i)
    cloud->push_back({scan.x[i], scan.y[i], scan.z[i]});
  cloud->width = static_cast<std::uint32_t>(scan.columns);
  cloud->height = static_cast<std::uint32_t>(scan.rows);
  cloud->is_dense = false;
  const auto& p = scan.frame.position;
  const auto q = scan.frame.quaternion();
  cloud->sensor_origin_ = Eigen::Vector4f(float(p[0]), float(p[1]), float(p[2]), 0);
  cloud->sensor_orientation_ =
      Eigen::Quaternionf(float(q[0]), float(q[1]), float(q[2]), float(q[3]));
  return cloud;
}

/** \brief A depth camera of 320 x 240 pixels with 0.5 mm of noise. */
inline pcl_surflet::DepthSensor
camera()
{
  pcl_surflet::DepthSensor sensor;
  sensor.columns = 320;
  sensor.rows = 240;
  sensor.noise = 0.0005;
  return sensor;
}

/** \brief One shape alone, seen by a camera 0.6 m away at \p azimuth degrees and 35 above. */
inline pcl::PointCloud<pcl::PointXYZ>::Ptr
seenAlone(const pcl_surflet::Shape& shape, double azimuth, std::uint64_t seed)
{
  pcl_surflet::ViewOptions view;
  view.views = pcl_surflet::ViewSet::One;
  view.distance = 0.6;
  view.elevation = 35;
  view.azimuth = azimuth;
  return organised(pcl_surflet::sense({{pcl_surflet::meshOf(shape, 20000), 1, 1}}, camera(),
                                      pcl_surflet::sensorPoses(view).front(), seed));
}

} // namespace tutorial
