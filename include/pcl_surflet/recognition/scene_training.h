/** \file
 * Training of models for scene interpretation. */
#pragma once

#include "pcl_surflet/recognition/histogram_model_trainer.h"

#include <array>

namespace pcl_surflet {

/** \brief What the parts of an object that are seen teach about its middle. */
struct CentreLesson {
  std::array<double, 3> centre; ///< centroid of the whole object, in the frame of the surflets
  ObjectCentre* guess;          ///< learns; its weights are for the caller to use
};

/** \brief Trains a model of what an object looks like in a scene that is reduced to cells.
 *
 * A scene's mean surflets are not those of the surface: edges are cut, and walls thinner than a
 * cell suffer. So the object is reduced too (reduceToTwoSidedCells()), in four random orientations.
 * And as interpretation finds an object by the cells that support its model
 * (interpretByExplanation()), the histogram is that of the cells that support each other; a wine
 * glass loses its stem. HistogramModel::surface_area becomes the area of these cells, by which the
 * share found of an object is judged.
 *
 * \param label 1 to 63 bytes, unique in a database
 * \param trainer resolution and role of the model; seven intervals in every dimension are best
 * \param surflets of the complete surface, several to a cell
 * \param leaf edge of the cells, as in the scenes to come; positive and finite
 * \param seed of the orientations
 * \param threads 0: all; does not change the result
 * \throws TrainingError if fewer than 30 cells support the model: take smaller cells
 * \throws std::invalid_argument for an unusable leaf */
PCL_SURFLET_API HistogramModel trainForScenes(const HistogramModelTrainer& trainer,
                                              const std::string& label, const SurfletSet& surflets,
                                              double leaf, std::uint64_t seed = 1,
                                              unsigned threads = 0);

/** \brief Adds to a model from trainForScenes() what a sensor sees of the object from one place, or
 * from several together, as a further member. An explanation fits as well as its best member.
 *
 * A sensor on one side of a scene shows half of an object, which the histogram of the whole does
 * not fit. What is seen is reduced and cleared of cells that do not support the complete model,
 * like the object itself.
 *
 * \param model receives the member; its first one is that of the complete object
 * \param condition names the view, e.g. "seen from 30 degrees"; at most 63 bytes
 * \param seen surflets of what is seen, several to a cell
 * \param leaf edge of the cells, the one that the model was trained with
 * \param seed of the orientations
 * \param threads 0: all; does not change the result
 * \param lesson if not null: told the cells that support the view, for the guess of the centre
 * \throws TrainingError if fewer than 30 cells support the model; then nothing is added
 * \throws std::invalid_argument for an unusable leaf, or a model without members */
PCL_SURFLET_API void addView(HistogramModel& model, const std::string& condition,
                             const SurfletSet& seen, double leaf, std::uint64_t seed = 1,
                             unsigned threads = 0, const CentreLesson* lesson = nullptr);

} // namespace pcl_surflet
