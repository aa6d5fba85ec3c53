/** \file
 * Several interpretations of one scene, merged and voted into one [Wahl 2007, Sec. 6.2]. */
#pragma once

#include "pcl_surflet/recognition/scene_interpretation.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace pcl_surflet {

/** \brief How often a scene is interpreted, and what of the results stays. */
struct AccumulationParameters {
  std::size_t runs = 1;  ///< most interpretations, each with a seed of its own, >= 1
  std::size_t cells = 0; ///< enough once the detections hold so many cells together; 0: never

  /** \brief Detections of one object are one hypothesis if they share more than this part of the
   * smaller one's cells, and hypotheses of different objects that do are rivals; in [0, 1). */
  double min_overlap = 0.3;
  double min_votes = 0.5; ///< share of the runs that must find a hypothesis, in [0, 1]
  /** \brief A cell belongs to a hypothesis if it does so in this share of the runs that found it;
   * 0: in any of them; in [0, 1]. */
  double min_cell_share = 0;
};

/** \brief Makes one interpretation of several of the same cells.
 *
 * Detections of different runs that overlap and bear one name are one hypothesis; its votes are the
 * runs that found it. Hypotheses of too few votes go, and of rivals those of fewer votes; of as
 * many votes those of less fit, then score. A cell claimed twice goes to whom more runs gave it.
 * Detection::votes is the share of runs; score and fit are means over detections, seeds are
 * summed. The diagnostics are those of the first run but for what was cancelled.
 *
 * \p runs may be empty: then nothing is found. A single run is returned as it is.
 * \throws std::invalid_argument if a parameter is out of range, or a detection's cell is none of
 * \p cells */
PCL_SURFLET_API SceneInterpretation
mergeInterpretations(const SurfletSet& cells, const std::vector<SceneInterpretation>& runs,
                     const AccumulationParameters& parameters);

/** \brief Seed of run number \p run: the first has \p seed itself, so it is the interpretation that
 * one gets without accumulation. */
PCL_SURFLET_API std::uint64_t seedOfRun(std::uint64_t seed, std::size_t run);

/** \brief Interprets again and again and merges the results.
 *
 * \param cells the reduced scene
 * \param interpret makes one interpretation of \p cells with a seed. Cancelled ones end the whole,
 * which then has no detections.
 * \param seed of the first run; those of the others follow from it (seedOfRun())
 * \param parameters how many runs, and how they vote
 * \param may_go_on asked after every run but the last, told how many there were: a time budget. The
 * result depends on it only by the number of runs. None: parameters alone decide.
 * \param runs_made receives how many there were, unless null
 * \throws as mergeInterpretations(), and what \p interpret throws */
PCL_SURFLET_API SceneInterpretation accumulateInterpretations(
    const SurfletSet& cells,
    const std::function<SceneInterpretation(std::uint64_t seed)>& interpret, std::uint64_t seed,
    const AccumulationParameters& parameters,
    const std::function<bool(std::size_t runs)>& may_go_on = {}, std::size_t* runs_made = nullptr);

} // namespace pcl_surflet
