/** \file
 * What is compared: methods that find and name the objects of a scene, trained on the same things.
 */
#pragma once

#include "evaluation/training.h"

#include "pcl_surflet/recognition/scene_accumulation.h"

#include <memory>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

struct RecogniserOptions {
  SceneOptions scene; ///< what scenes will be like; its seed is of no account
  Sensing sensing;    ///< how they will be seen
  ExplanationParameters explanation;
  DissertationParameters dissertation; ///< background, threads: of all methods
  double leaf = 0.0058;
  double min_confidence = 0; ///< explanation: leaves out what is less sure, in [0, 1]
  int bins = 0;              ///< in each of the four dimensions; 0: what suits the method
  bool on_surfaces = false;  ///< trains models for explanations on plain surfaces too
};

/** \brief Finds the objects it was trained on. */
class Recogniser {
public:
  virtual ~Recogniser() = default;

  /** \brief What is in the scene. Detections name objects in the order of training; their cells
   * are indices of \p cells. All treatment of the background is part of it. */
  virtual SceneInterpretation find(const SurfletSet& cells, std::uint64_t seed) const = 0;

  /** \brief How the method wants scenes to be reduced, see CellReductionOptions. */
  virtual double
  splitBelow() const
  {
    return 0;
  }
};

/** \brief Names that recogniser() understands. */
const std::vector<std::string>& recogniserNames();

/** \brief A method by name, trained on \p objects.
 *
 * - dissertation, explanation: the interpretations of the library. Excluded background: cells near
 *   those of an empty scene, sensed another time, are left out first.
 * - floating, repeated, floating_repeated: dissertation with floating seeds, with repetitive
 *   clustering, with both.
 * - classic_vfh, classic_esf: TabletopClassic, whatever the treatment. It removes as many planes as
 *   the background has and is trained on each object standing alone on that background.
 * - exclusion_vfh: the same, but what is near the empty scene is left out in place of planes.
 *
 * Where a sensor looks, all of it is what this sensor sees: objects alone from 24 places for
 * models, the empty scene from those of the scenes, examples on a background likewise. */
std::unique_ptr<Recogniser> recogniser(const std::string& name,
                                       const std::vector<SceneItem>& objects,
                                       const RecogniserOptions& options);

} // namespace apps
} // namespace pcl_surflet
