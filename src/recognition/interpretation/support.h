/** \file
 * Which cells of a place support a model: those whose pairs with one another the model explains
 * better than chance; internal, not installed. */
#pragma once

#include "pcl_surflet/core/linear_octree.h"
#include "steps.h"

#include <cmath>

namespace pcl_surflet {
namespace interpretation {

using Centre = std::array<double, 3>;

inline double
distance(const Centre& a, const Centre& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/** \brief A segment of fewer of a model's cells, if their number is known, is nothing. */
constexpr double kLeastCoverage = 0.3;

/** \brief Cells drawn evenly from those within a ball, and the features of all their pairs. */
struct Sample {
  Indices cells;              ///< in the order of the octree
  std::size_t population = 0; ///< cells in the ball
  /** \brief Of the pairs (1,0), (2,0), (2,1), (3,0) ...: angular bins, or the number of angular
   * bins for a pair without feature, and distances in the scene's unit scale. */
  std::vector<std::uint32_t> column;
  std::vector<float> delta;
};

/** \brief Memory of a thread, used again and again. */
struct SupportMemory {
  Sample sample;
  std::vector<PlaceRange> ranges;
  PairRows rows;
  std::vector<std::uint32_t> index;
  std::vector<std::uint32_t> column;
  std::vector<float> delta, ratio, weight, support, histogram;
  std::vector<std::uint32_t> counts;
  PairFeatures features;
  Indices partners;
};

/** \brief The part of a sample that supports a model. */
struct Segment {
  std::size_t model = 0;
  Centre centre{};    ///< of the supporting cells
  double cells = 0;   ///< estimated number of supporting cells in the ball
  double support = 0; ///< their mean support, nats per pair
  /** \brief Intersection of their few pairs with the model's histogram; 0 for hopeless segments:
   * without support, or with too small a part of the model's cells. */
  double rough_fit = 0;
  Indices core; ///< the supporting cells of the sample

  /** \brief Nats won by explaining these cells. */
  double
  worth() const
  {
    return cells * support;
  }
};

/** \brief All cells of \p octree within \p radius of \p centre. */
Indices cellsWithin(const LinearOctree& octree, const Centre& centre, double radius,
                    std::vector<PlaceRange>& ranges);

std::size_t cellsIn(const std::vector<PlaceRange>& ranges);

/** \brief Appends \p n cells, spread evenly over the ranges, which must not be empty. The octree
 * keeps neighbours together, so that is an even choice of the surface. */
void spreadOver(const LinearOctree& octree, const std::vector<PlaceRange>& ranges, std::size_t n,
                Indices& out);

/** \brief Draws at most \p most cells within the ball and computes the features of their pairs. */
void drawSample(const SceneData& scene, const LinearOctree& octree, const Centre& centre,
                double radius, std::size_t most, SupportMemory& memory);

/** \brief Which cells of the memory's sample, within \p radius of \p centre, support the model?
 *
 * All begin with weight one. The support of a cell is the mean, over the others by their weight, of
 * the logarithm of the model's probability of the pair over that of chance. A cell with support
 * keeps its weight and one without loses it, first compared with the mean of all, until the
 * weights have settled: a power iteration with a threshold. */
Segment segment(const SceneData& scene, std::size_t model, const Centre& centre, double radius,
                SupportMemory& memory);

/** \brief A cell and its support by other cells, nats per pair. */
struct CellSupport {
  std::uint32_t cell = 0;
  float support = 0;
};

/** \brief Those of \p cells that have support, each judged by \p probes of \p core, spread
 * evenly over it. */
void supportOf(const SceneData& scene, const SceneModel& model, const Indices& cells,
               const Indices& core, unsigned probes, SupportMemory& memory,
               std::vector<CellSupport>& out);

/** \brief Overlap of the histogram of \p cells, from \p features random pairs, with the model. */
Overlap fitOf(const SceneData& scene, const SceneModel& model, const Indices& cells,
              std::uint64_t features, std::uint64_t seed);

} // namespace interpretation
} // namespace pcl_surflet
