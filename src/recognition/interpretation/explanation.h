/** \file
 * The parts of interpretation by explanation; internal, not installed. */
#pragma once

#include "pcl_surflet/core/linear_octree.h"
#include "steps.h"

namespace pcl_surflet {
namespace interpretation {

/** \brief A model at a place, and the cells that support it there. */
struct Explanation {
  std::size_t model = 0;
  std::array<double, 3> place{}; ///< centre
  Indices cells;
  double ratio = 0; ///< mean log of the model's density over the mean density of all models
  double fit = 0;   ///< intersection of the cells' histogram with the model's

  /** \brief Nats won by this explanation. */
  double
  worth() const
  {
    return static_cast<double>(cells.size()) * ratio;
  }
};

/** \brief Cells that no explanation has taken yet, and how to find them. */
struct OpenCells {
  LinearOctree octree;
  std::vector<char> taken;
};

/** \brief Moves from \p place to where cells support \p model, and judges them roughly; no cells if
 * they do not. Deterministic in \p stream. */
Explanation settle(const SceneData& scene, const OpenCells& open, std::size_t model,
                   const std::array<double, 3>& place, std::uint64_t stream,
                   const ExplanationParameters& parameters);

/** \brief Completes the cells of a settled explanation and judges them. */
void confirm(const SceneData& scene, const OpenCells& open, std::uint64_t stream,
             const ExplanationParameters& parameters, Explanation& explanation);

/** \brief Which cells are background: those whose pairs with random neighbours a background model
 * explains better than every object. One entry a cell. */
std::vector<char> voteForBackground(const SceneData& scene, const LinearOctree& octree,
                                    const ExplanationParameters& parameters);

} // namespace interpretation
} // namespace pcl_surflet
