/** \file
 * OnlineSceneInterpreter: takes in scans of a scene one by one and tells what is in it so far. */
#pragma once

#include "pcl_surflet/compat.h"
#include "pcl_surflet/recognition/online_interpretation.h"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>

namespace pcl_surflet {

/** \brief OnlineInterpretation for clouds of PCL. */
class PCL_SURFLET_API OnlineSceneInterpreter : public OnlineInterpretation {
public:
  using OnlineInterpretation::addScan;
  using OnlineInterpretation::OnlineInterpretation;

  /** \brief Takes in a scan in the frame of the scene. Points that are not finite, or whose normal
   * has no direction, are left out; cells that the scan has seen through vanish.
   * \param cloud positions
   * \param normals one per point; those that look away from the sensor are turned
   * \param sensor_origin where the sensor was, in the frame of the scene
   * \throws std::invalid_argument if the normals are not as many as the points or the origin is not
   * finite */
  OnlineScan addScan(const pcl::PointCloud<pcl::PointXYZ>& cloud,
                     const pcl::PointCloud<pcl::Normal>& normals,
                     const Eigen::Vector3f& sensor_origin);
  /** \brief The same of points that carry their normals. */
  OnlineScan addScan(const pcl::PointCloud<pcl::PointNormal>& cloud,
                     const Eigen::Vector3f& sensor_origin);

  /** \brief Takes in a scan in the frame of its sensor, whose pose in the scene is the cloud's
   * sensor_origin_ and sensor_orientation_. \throws std::invalid_argument if that is no pose */
  OnlineScan addScanInSensorFrame(const pcl::PointCloud<pcl::PointNormal>& cloud);
};

} // namespace pcl_surflet
