/** \file
 * Training of models for scenes that a sensor sees from one side or a few. */
#pragma once

#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/sensed_scene.h"

#include <cstdint>

namespace pcl_surflet {

/** \brief A noiseless sensor far from an object, with 2.5 pixels to a cell, that looks from the 24
 * places of a ring: for objects of any unit whose own sensor is not known.
 * \throws std::invalid_argument if the item has no extent, the leaf is not positive and finite, or
 * the picture would need more than 4096 pixels a side: the cells are too small for the object */
PCL_SURFLET_API SceneSensing sensingFor(const SceneItem& item, double leaf);

/** \brief trainForScenes() on what a virtual sensor sees of an object alone, from all places of
 * \p sensing together, with further members (addView()) for single views.
 *
 * Members are what every second place shows and, on a ring, what it shows together with the
 * opposite one; all once more without the foot of what stands upright (z up): flat surfaces near
 * the bottom are taken for what carries the object. With a ring of 24 that is 19 histograms, 37 for
 * objects with a foot, of 10 kB each at 7,7,7,7. Views that show too little are left out. Nothing
 * is learned of surfaces that no sensor sees: the bottom, the inside of a vase. But where the
 * middle of the whole surface is, seen from where the views are, becomes HistogramModel::centre.
 *
 * \param trainer resolution and role of the model
 * \param item the object as it stands, with a mesh
 * \param sensing the sensor and its places, like those of the scenes to come
 * \param leaf edge of the cells, as in the scenes to come
 * \param seed of noise and orientations
 * \param threads 0: all; does not change the result
 * \throws TrainingError, std::invalid_argument as trainForScenes() and senseAlone() */
PCL_SURFLET_API HistogramModel trainForSensors(const HistogramModelTrainer& trainer,
                                               const SceneItem& item, const SceneSensing& sensing,
                                               double leaf, std::uint64_t seed = 1,
                                               unsigned threads = 0);

} // namespace pcl_surflet
