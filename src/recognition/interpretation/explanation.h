/** \file
 * The parts of interpretation by explanation; internal, not installed. */
#pragma once

#include "progress.h"
#include "support.h"

namespace pcl_surflet {
namespace interpretation {

/** \brief A model at a place, and the cells that support it there. */
struct Explanation {
  std::size_t model = 0;
  Centre centre{};
  double reach = 0; ///< largest distance of a supporting cell to the centre, or more
  std::vector<CellSupport> supported; ///< all cells that support it, whoever owns them
  Indices cells;                      ///< those of them that are its own, ascending
  double fit = 0;                     ///< overlap of the cells' histogram with the model's
  std::size_t member = 0;             ///< of the model, which overlaps most
};

/** \brief What the parts of one interpretation share. */
struct Explaining {
  const SceneData& scene;
  const ExplanationParameters& parameters;
  ProgressReport& progress;
  InterpretationDiagnostics& diagnostics;
  std::vector<char> background;      ///< one entry a cell, or none
  LinearOctree open;                 ///< the cells that nothing explains yet
  std::vector<SupportMemory> memory; ///< one a thread

  Explaining(const SceneData& scene, const ExplanationParameters& parameters,
             ProgressReport& progress, InterpretationDiagnostics& diagnostics);

  /** \brief Leaves those cells open that are neither taken nor background. */
  void openExcept(const std::vector<char>& taken);
  double
  radiusOf(std::size_t model) const
  {
    return parameters.reach * scene.models.all[model].model->r_max;
  }
  ModelDiagnostics&
  diagnosticsOf(std::size_t model)
  {
    return diagnostics.models[scene.models.all[model].index];
  }
};

/** \brief Tries every model all over the open cells: rough segments, the most worthy first. */
std::vector<Segment> scan(Explaining& work);

/** \brief Looks closely at a segment on the open cells; no cells if it does not hold. */
Explanation lookClosely(Explaining& work, const Segment& rough, SupportMemory& memory);

/** \brief Looks closely at all, and leaves one of those that came to the same; best fit first. */
std::vector<Explanation> lookClosely(Explaining& work, const std::vector<Segment>& rough);

/** \brief Chooses explanations that together explain the scene best, and divides the cells. */
std::vector<Explanation> choose(Explaining& work, const std::vector<Segment>& candidates);

/** \brief Which cells are background: those whose pairs with random neighbours a background model
 * explains better than every object. One entry a cell. */
std::vector<char> voteForBackground(const SceneData& scene, const LinearOctree& octree,
                                    const ExplanationParameters& parameters);

/** \brief The same without a model of it: the background is learned from pairs that are too long
 * for every object. No cell is, where there are hardly any such pairs. */
std::vector<char> voteForUniformBackground(const SceneData& scene, const LinearOctree& octree,
                                           const ExplanationParameters& parameters);

} // namespace interpretation
} // namespace pcl_surflet
