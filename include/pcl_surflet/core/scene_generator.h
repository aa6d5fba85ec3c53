/** \file
 * Labelled scenes of objects on a background, for experiments and tests. */
#pragma once

#include "pcl_surflet/core/depth_sensor.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/core/surflet_set.h"
#include "pcl_surflet/core/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief A thing that can be put into a scene; upright means z up. */
struct SceneItem {
  std::string label; ///< its name in a database
  double area = 0;   ///< squared unit
  /** \brief Draws n surflets uniformly by area with a seed. */
  std::function<SurfletSet(std::size_t n, std::uint64_t seed)> sample;
  /** \brief The item as a mesh, for sensors; a shape's has some 20,000 vertices. */
  std::function<TriangleMesh()> mesh = {};
};

/** \brief A mesh of the shape with roughly as many \p vertices. \throws std::invalid_argument as
 * meshOfShape() if they are not positive, or too many */
PCL_SURFLET_API TriangleMesh meshOf(const Shape& shape, double vertices);

/** \brief A shape as an item: samples are exact, the mesh is approximate. */
PCL_SURFLET_API SceneItem sceneItem(const std::string& label, const Shape& shape);
/** \brief A mesh as an item. \throws std::invalid_argument with mesh.problem() */
PCL_SURFLET_API SceneItem sceneItem(const std::string& label, const TriangleMesh& mesh);

/** \brief How an object stands. All are turned about the vertical at random first. */
enum class Posture {
  Upright,
  Lying,   ///< tilted by 90 degrees
  Leaning, ///< tilted by 15 to 45 degrees
  Mixed    ///< each object one of the above, at random
};

/** \brief How far objects are from each other. */
enum class Spacing {
  /** \brief Centroids at least distance_factor * min (r_i, r_j) apart in the horizontal plane, r
   * the largest distance of a surflet to the centroid [Wahl 2007, Eq. 5.22].
   *
   * Reading: the printed bound alone lets objects intersect, which it is there to avoid; so their
   * vertical bounding cylinders must not overlap either. */
  Apart,
  /** \brief Pushed together in the middle: each object slides horizontally towards one of those
   * already there until it is SceneOptions::gap from meeting one. A gap of 0 makes them touch. */
  Pile,
  /** \brief Every centroid exactly distance_factor * min (r_i, r_0) beside that of the first item,
   * in a random direction; items may intersect. For two items: the critical distance [Wahl 2007,
   * Fig. 5.5]. */
  Pair
};

/** \brief What the objects stand on. */
enum class Background {
  None,   ///< nothing; objects stand on z = 0 all the same
  Plane,  ///< square table, normals up
  Corner, ///< two planes: a table and an upright wall along its +y edge
  Box,    ///< a floor and four walls, seen from inside
  Bowl    ///< spherical bowl, seen from inside; z = 0 at its lowest point
};

/** \brief Parameters of generateScene(); lengths in the unit of the items (metres by default). */
struct SceneOptions {
  Posture posture = Posture::Upright;        ///< of the objects and the clutter
  Spacing spacing = Spacing::Apart;          ///< between them
  double distance_factor = 1.0;              ///< of Eq. 5.22, >= 0
  double gap = 0;                            ///< along the sliding direction of a pile, >= 0
  Background background = Background::Plane; ///< what they stand on
  double size = 1.0;        ///< edge of table, corner and box; diameter of the bowl's opening; > 0
  double width = 0;         ///< edge along y of table, corner and box, >= 0; 0: as size
  double wall_height = 0.3; ///< of corner and box, > 0
  /** \brief Surflets per squared unit, > 0. The default gives 770,000 surflets for the seven
   * objects of the dissertation (0.63 square metres) on the table. */
  double density = 470000;
  /** \brief Largest displacement along the normal, uniform, >= 0 [Wahl 2007, Sec. 3.6.5]. */
  double noise = 0;
  std::size_t present = ~std::size_t{0}; ///< objects present, chosen at random; more than all: all
  std::size_t clutter = 0;               ///< unknown things present, chosen from the clutter list
  std::uint64_t seed = 1;                ///< of places, turns, samples and noise
};

/** \brief One thing in a scene. */
struct PlacedItem {
  std::string label;                ///< SceneItem::label
  std::uint32_t number = 0;         ///< its label in Scene::labels
  bool clutter = false;             ///< unknown to the database
  std::array<double, 16> pose{};    ///< item to scene, 4 x 4, row by row
  std::array<double, 3> centroid{}; ///< of its surflets, in the scene
  double r_mean = 0;        ///< mean distance of its surflets to the centroid [Wahl 2007, Eq. 2.24]
  std::size_t surflets = 0; ///< number of its surflets
};

/** \brief A scene and the truth about it. */
struct Scene {
  SurfletSet surflets; ///< background first, then the items in the order of Scene::items
  /** \brief 0 background, i + 1 object i of the list, objects + j + 1 thing j of the clutter. */
  std::vector<std::uint32_t> labels;
  std::vector<std::uint32_t> instances; ///< 0 background, k + 1 for items[k]
  std::vector<PlacedItem> items;        ///< in the order of placing
};

/** \brief Puts \p objects (name an item twice for two instances) and things from \p clutter on a
 * background.
 *
 * Surfaces are complete: also what an object stands on and its underside are there, as in
 * [Wahl 2007, Sec. 5.5.2]. Items rest with their lowest point on the background, without regard to
 * balance. The result depends on the arguments alone.
 * \throws std::invalid_argument if a parameter is out of its range, an item has no area, the scene
 * would exceed 2^28 surflets, or the items do not fit on the background */
PCL_SURFLET_API Scene generateScene(const std::vector<SceneItem>& objects,
                                    const std::vector<SceneItem>& clutter,
                                    const SceneOptions& options);

/** \brief The same background without objects, sensed another time: other surflets of the same
 * surface. \throws std::invalid_argument if a parameter is out of range */
PCL_SURFLET_API SurfletSet emptyBackground(const SceneOptions& options);

/** \brief The background as a body for sensors, or nothing if there is none.
 * \throws std::invalid_argument if a parameter is out of range */
PCL_SURFLET_API std::vector<SensedBody> backgroundBodies(const SceneOptions& options);

/** \brief What a sensor meets in \p scene, which generateScene() made of the other arguments: the
 * background, then the items in their places.
 * \throws std::invalid_argument if a parameter is out of range or an item has no mesh */
PCL_SURFLET_API std::vector<SensedBody> bodiesOf(const Scene& scene,
                                                 const std::vector<SceneItem>& objects,
                                                 const std::vector<SceneItem>& clutter,
                                                 const SceneOptions& options);

} // namespace pcl_surflet
