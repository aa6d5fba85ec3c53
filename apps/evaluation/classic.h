/** \file
 * The tabletop classic as a peer: planes away (RANSAC), Euclidean clusters, one descriptor a
 * cluster, nearest neighbour. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief What describes a cluster. */
enum class Descriptor { Vfh, Esf };

/** \brief Parameters of TabletopClassic; lengths in cell edges. Defaults are chosen on scenes with
 * seeds below 100. */
struct ClassicParameters {
  Descriptor descriptor = Descriptor::Vfh;
  double leaf = 0;             ///< edge of the cells, in the unit of the coordinates, > 0
  unsigned planes = 1;         ///< planes removed at most
  double min_plane = 0.05;     ///< a plane holds at least this share of the cells, in [0, 1]
  double plane_distance = 0.5; ///< farthest cell that belongs to a plane
  double tolerance = 1.3;      ///< farthest neighbour of the same cluster
  /** \brief Smallest cluster, as a share of the smallest one trained, in [0, 1]. */
  double min_cluster = 0.3;
  /** \brief Unknown is what is farther from its neighbour than the farthest example of the object
   * from the others, times this. */
  double slack = 2;
};

/** \brief A cluster of the scene and its name. */
struct NamedCluster {
  std::size_t object = 0;           ///< as given to learn()
  std::vector<std::uint32_t> cells; ///< ascending
  double distance = 0;              ///< to the nearest example
};

/** \brief Plane removal, clusters and nearest neighbour by PCL and FLANN. One thread. */
class TabletopClassic {
public:
  explicit TabletopClassic(const ClassicParameters& parameters);
  ~TabletopClassic();

  /** \brief Takes the largest cluster of \p cells, a scene of one object, as example of \p object.
   * \return false if there is no cluster: nothing is learned from things so thin or small */
  bool learn(std::size_t object, const SurfletSet& cells);

  /** \brief To be called after the last learn(): builds the index and calibrates the distances.
   * An object needs two examples; one without any is never found.
   * \throws std::invalid_argument if nothing was learned */
  void finish();

  std::vector<NamedCluster> find(const SurfletSet& cells) const;

private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace apps
} // namespace pcl_surflet
