/** \file
 * A virtual depth camera or structured-light head: what a sensor would measure of a scene of meshes
 * [Wahl 2007, Sec. 5.5.3]. */
#pragma once

#include "pcl_surflet/core/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace pcl_surflet {

/** \brief A surface of a scene and what it belongs to. Both sides of its triangles are seen. */
struct SensedBody {
  TriangleMesh mesh;          ///< in the scene
  std::uint32_t label = 0;    ///< 0 background, else the object's number
  std::uint32_t instance = 0; ///< 0 background, else which thing of the scene
};

/** \brief Where a sensor is and where it looks. */
struct SensorPose {
  std::array<double, 3> position{0, 0, 1}; ///< of the sensor, in the scene
  std::array<double, 3> target{0, 0, 0};   ///< a point in the middle of the picture
  /** \brief Upwards in the picture, as far as the view allows; if it looks along this direction,
   * another one is taken. */
  std::array<double, 3> up{0, 0, 1};
};

/** \brief Parameters of sense(); lengths in the unit of the scene (metres by default), angles in
 * degrees. Defaults are those of a noiseless camera. */
struct DepthSensor {
  std::size_t columns = 640; ///< pixels, >= 1
  std::size_t rows = 480;    ///< pixels, >= 1; rows * columns at most 2^26
  double opening = 57;       ///< across the columns, in (0, 170]; pixels are square
  double noise = 0;          ///< standard deviation of the depth (along forward) at depth 1, >= 0
  double noise_power = 0;    ///< by which power of the depth it grows, in [0, 4]; triangulation: 2
  double quantum = 0;        ///< depths are whole multiples of it; 0: any depth; >= 0
  /** \brief Share of the pixels at depth edges that measure something between both sides, in
   * [0, 1]. Such points belong to nothing: label and instance 0. */
  double flying = 0;
  double edge = 0.02;  ///< a depth edge: neighbouring pixels differ by more, > 0
  double grazing = 90; ///< no return from surfaces seen farther off their normal, in (0, 90]
  /** \brief Distance of a projector to the right of the camera (negative: left), looking the same
   * way with the same opening; what it does not light gives no return. 0: none. */
  double baseline = 0;
};

/** \brief Cartesian frame of a sensor: x to the right, y down, z forward. */
struct SensorFrame {
  std::array<double, 3> position{0, 0, 0}; ///< origin, in the scene
  std::array<double, 3> right{1, 0, 0};    ///< unit vector in the scene, x of the sensor
  std::array<double, 3> down{0, 1, 0};     ///< unit vector in the scene, y of the sensor
  std::array<double, 3> forward{0, 0, 1};  ///< unit vector in the scene, z of the sensor

  /** \brief At the origin, along +z. */
  SensorFrame() = default;
  /** \throws std::invalid_argument if the pose is not finite or looks nowhere */
  PCL_SURFLET_API explicit SensorFrame(const SensorPose& pose);

  /** \brief From the sensor's coordinates to the scene's. */
  PCL_SURFLET_API std::array<double, 3> toScene(const std::array<double, 3>& point) const;
  /** \brief From the scene's coordinates to the sensor's. */
  PCL_SURFLET_API std::array<double, 3> toSensor(const std::array<double, 3>& point) const;
  /** \brief (w, x, y, z) of the rotation from sensor to scene, w >= 0. */
  PCL_SURFLET_API std::array<double, 4> quaternion() const;
};

/** \brief An organised picture of points, row by row. */
struct DepthScan {
  SensorFrame frame;       ///< of the sensor in the scene
  std::size_t columns = 0; ///< pixels of a row
  std::size_t rows = 0;    ///< number of rows
  ///@{
  /** \brief Of each pixel, in the sensor's frame; NaN in all three: no return. */
  std::vector<float> x, y, z;
  ///@}
  std::vector<std::uint32_t> labels;    ///< SensedBody::label of each pixel; 0 without return
  std::vector<std::uint32_t> instances; ///< SensedBody::instance of each pixel; 0 without return
};

/** \brief What a sensor measures of \p bodies.
 *
 * A pixel measures the foremost surface at its middle. The result depends on the arguments alone.
 * \throws std::invalid_argument if a parameter is out of range or a mesh has a problem() */
PCL_SURFLET_API DepthScan sense(const std::vector<SensedBody>& bodies, const DepthSensor& sensor,
                                const SensorPose& pose, std::uint64_t seed);

/** \brief From where a scene is looked at. */
enum class ViewSet {
  One,
  Two,    ///< antipodal: from the other side, too
  Ring24, ///< every 30 degrees, two sensors at different heights [Wahl 2007, Sec. 5.5.3]
  All24,  ///< all round, also from below, evenly on a sphere
  Pass    ///< along the x axis and back on the other side: a sensor that moves past a large scene
};

/** \brief Places of the sensor; angles in degrees. */
struct ViewOptions {
  ViewSet views = ViewSet::Ring24;          ///< how many, and where
  std::array<double, 3> target{0, 0, 0.05}; ///< that every sensor looks at
  double distance = 1.4;                    ///< from there, > 0
  double elevation = 45;                    ///< above the horizon; the upper ring; in (-90, 90)
  double second_elevation = 25;             ///< the lower ring; in (-90, 90)
  /** \brief Of the first sensor, about the vertical; pass: from where it stands otherwise, -y. */
  double azimuth = 0;
  double path = 2;        ///< pass: length of the way along x, with the target in its middle, >= 0
  std::size_t stops = 24; ///< pass: views in all, the second half on the way back, in [2, 10000]
};

/** \brief The poses of a set of views. \throws std::invalid_argument if an option is out of range
 */
PCL_SURFLET_API std::vector<SensorPose> sensorPoses(const ViewOptions& options);

} // namespace pcl_surflet
