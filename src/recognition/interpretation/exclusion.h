/** \file
 * Strategy A: what is left beside an empty scene; internal, not installed. */
#pragma once

#include "pcl_surflet/core/linear_octree.h"
#include "pcl_surflet/core/surflet_set.h"

#include <cstdint>
#include <vector>

namespace pcl_surflet {
namespace interpretation {

/** \brief An empty scene, ready to be asked again and again [Wahl 2007, Sec. 5.4]. */
class EmptyScene {
public:
  /** \throws std::invalid_argument if \p distance is not positive and finite */
  EmptyScene(SurfletSet surface, double distance);

  /** \brief Is the surface within the distance of surflet \p i, and looks the same way? */
  bool holds(const SurfletSet& set, std::size_t i, std::vector<PlaceRange>& memory) const;

  /** \brief Those of \p indices that it does not hold, in their order. */
  std::vector<std::uint32_t> away(const SurfletSet& set, const std::vector<std::uint32_t>& indices,
                                  unsigned threads) const;

private:
  SurfletSet surface_;
  double distance_;
  LinearOctree octree_;
};

} // namespace interpretation
} // namespace pcl_surflet
