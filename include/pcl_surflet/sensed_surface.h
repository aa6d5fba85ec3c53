/** \file
 * Surflets from sensor data that has no normals yet: depth images and points with viewing
 * directions [Wahl 2007, Sec. 1.5.3]. Normals are PCL's, oriented to the sensor; threads 0: all,
 * and no result depends on their number. Clouds may be empty. */
#pragma once

#include "pcl_surflet/compat.h"
#include "pcl_surflet/conversions.h"

#include <pcl/point_types.h>

namespace pcl_surflet {

/** \brief Surflets of an organised depth cloud, normals by pcl::IntegralImageNormalEstimation
 * (average 3-D gradient, borders and depth jumps left out), oriented to \p sensor.
 *
 * NaN pixels and pixels without normal are left out and counted. Indices are those of the cloud,
 * \p sensor is a place in its frame and unit.
 * \throws std::invalid_argument if the cloud is not organised or smaller than 3 x 3 pixels */
PCL_SURFLET_API ConvertedSurflets surfletsFromDepth(const pcl::PointCloud<pcl::PointXYZ>& cloud,
                                                    const Eigen::Vector3f& sensor);

/** \brief Surflets of an unorganised cloud seen from one place, normals by pcl::NormalEstimationOMP
 * over \p neighbours nearest points, oriented to \p sensor, a place in the frame of the cloud.
 *
 * Points with a coordinate that is not finite or beyond 1e18, whose squares single precision cannot
 * hold, are left out and counted, as are points without normal. Indices are those of the cloud.
 * \throws std::invalid_argument if neighbours is below 3 */
PCL_SURFLET_API ConvertedSurflets surfletsFromPoints(const pcl::PointCloud<pcl::PointXYZ>& cloud,
                                                     const Eigen::Vector3f& sensor,
                                                     int neighbours = 20, unsigned threads = 0);

/** \brief Surflets of points of which each has the direction in which the sensor saw it (from the
 * sensor to the point, in the normal fields; any length but zero). Normals by
 * pcl::NormalEstimationOMP over \p neighbours nearest points, oriented against the directions.
 *
 * Points with a direction that is zero or not finite are left out and counted, as are those that
 * surfletsFromPoints() leaves out.
 * \throws std::invalid_argument if neighbours is below 3 */
PCL_SURFLET_API ConvertedSurflets
surfletsFromDirections(const pcl::PointCloud<pcl::PointNormal>& points_and_directions,
                       int neighbours = 20, unsigned threads = 0);

/** \brief The surflets with normals estimated anew from the positions (pcl::NormalEstimationOMP
 * over \p radius, in the unit of the set), each turned to the side of the normal it replaces.
 * Surflets with fewer than three neighbours, or that surfletsFromPoints() would leave out, are left
 * out and counted. \throws std::invalid_argument if radius is not positive */
PCL_SURFLET_API ConvertedSurflets withEstimatedNormals(const SurfletSet& surflets, double radius,
                                                       unsigned threads = 0);

} // namespace pcl_surflet
