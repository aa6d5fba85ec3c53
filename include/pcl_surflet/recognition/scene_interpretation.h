/** \file
 * Scene interpretation: segments and names the objects of a scene in one go. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"
#include "pcl_surflet/recognition/model_database.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief What is done about what carries the objects [Wahl 2007, Sec. 5.4, step 1]. */
enum class BackgroundTreatment {
  Ignore,  ///< nothing: background models of the database take no part
  Exclude, ///< strategy A: the caller has removed it, see cellsAwayFrom(); otherwise as Ignore
  Model    ///< strategy B: the database's background models identify it, and it is ignored
};

/** \brief Constants of the seven steps. Those marked (*) the dissertation leaves open. */
struct DissertationParameters {
  BackgroundTreatment background = BackgroundTreatment::Ignore;

  /** \brief Step 1: pairs s with a distance of at most the largest delta_max of the objects, n. The
   * dissertation draws 232,000, and 100,000 where the background is excluded. */
  std::uint64_t pairs = 232000;
  /** \brief Step 1 (*): gives up after this many draws per wanted pair. A draw is in vain if the
   * pair is too long; in a scene much larger than the models nearly all are. */
  std::uint64_t draws_per_pair = 100;
  double lambda_h = 1.3; ///< step 1: lambda_H of Eq. 5.3, > 0

  std::size_t seeds = 100; ///< step 2 (*): cluster seeds of each model, m

  /** \brief Step 3 (*): regroupings after which a seed that still shows crosstalk is given up. */
  unsigned max_regroupings = 200;

  double lambda_o = 0.3; ///< step 4: lambda_o of Eq. 5.17, in [0, 1)

  unsigned check_regroupings = 4; ///< step 5 (*): regroupings of a cluster, >= 1

  std::size_t min_cluster = 30; ///< step 6 (*): fewest surflets of a cluster
  /** \brief Step 6 (*): smallest size relative to the model's largest cluster, in [0, 1]. Of 0.3,
   * 0.5 and 0.8, 0.3 finds most objects and names clusters as well as the others. */
  double lambda_c = 0.3;

  std::uint64_t seed = 1;
  unsigned threads = 0; ///< 0: all; the result does not depend on it

  /** \brief Told now and then which share is done, in [0, 1], never falling; returns false to
   * cancel. Called in the thread that interprets; what it throws ends the interpretation. */
  std::function<bool(double)> progress;
};

/** \brief What the steps did for one model. Each count is what was left or lost at that point. */
struct ModelDiagnostics {
  std::string label;
  double threshold = 0;              ///< step 1: Hbar of Eq. 5.3
  std::uint64_t pairs = 0;           ///< step 1: pairs selected for the model
  std::size_t surflets = 0;          ///< step 1: surflets of those pairs, each counted once
  std::size_t seeds = 0;             ///< step 2
  std::size_t seed_surflets = 0;     ///< step 2: in all seeds together
  std::size_t seeds_cleared = 0;     ///< step 3: seeds that lost all surflets, or never settled
  std::size_t refined_surflets = 0;  ///< step 3: left in all seeds together
  std::size_t seeds_lone = 0;        ///< step 4: seeds that share too little with any other
  std::size_t clusters = 0;          ///< step 4
  std::size_t died_distribution = 0; ///< step 5: another model explains the cluster better
  std::size_t died_small = 0;        ///< step 6: below the minimum
  std::size_t died_relative = 0;     ///< step 6: too small beside the model's largest
  std::size_t merged = 0;            ///< step 7: joined with another cluster of the model
  std::size_t lost = 0;              ///< step 7: lost a competition
  std::size_t detections = 0;
};

struct InterpretationDiagnostics {
  bool cancelled = false;     ///< progress said so: there are no detections, the rest is partial
  std::uint64_t drawn = 0;    ///< step 1: pairs drawn
  std::uint64_t too_long = 0; ///< step 1: of these, longer than any model
  std::uint64_t featureless = 0;
  std::uint64_t background = 0;         ///< step 1: pairs that are most likely background
  std::vector<ModelDiagnostics> models; ///< in the order of the database
};

/** \brief An object found in a scene. */
struct Detection {
  std::size_t model = 0; ///< index in the database
  std::string label;
  std::vector<std::uint32_t> cells; ///< indices of its surflets in the scene, ascending
  std::array<double, 3> centroid{}; ///< of these surflets
  /** \brief Nats per feature by which the model's mean log-likelihood exceeds that of the best
   * other model, on the regrouped surflets; at least 0 if nothing was merged in step 7. */
  double score = 0;
  std::size_t seeds = 0; ///< merged cluster seeds, n_C; 0 by explanation
  double fit = 0; ///< by explanation: intersection with the model's histogram, in [0, 1]; else 0
};

struct SceneInterpretation {
  std::vector<Detection> detections; ///< in the order of the models
  InterpretationDiagnostics diagnostics;
};

/** \brief Interprets a scene by the seven steps of the dissertation as they are written
 * [Wahl 2007, Sec. 5.4].
 *
 * \param cells the scene, reduced to mean surflets (reduceToCells())
 * \param database models and, for BackgroundTreatment::Model, background models. A model of several
 * members takes part with their mean histogram.
 *
 * **Readings.** A pair longer than a model's delta_max has the histogram value 0 there (it cannot
 * lie on the object) and is crosstalk in step 3. Regrouping joins every surflet of a set with
 * exactly one other (Eq. 5.14). In step 4 the common surflets count relative to the lower seed; a
 * seed without partner does not make a cluster (Eq. 5.17). In step 7 clusters of one model are
 * merged first, then rivals meet, nearest centroids first; where neither wins two conditions the
 * higher score stays.
 *
 * Empty scenes and scenes much larger than the models give no detections; the diagnostics tell why.
 * The steps have no absolute measure of similarity: unknown objects, and scenes much smaller than
 * the models, are given the name that fits least badly. \throws DatabaseError if the database has
 * no object, or no background model to be modelled \throws std::invalid_argument if a parameter is
 * out of range */
PCL_SURFLET_API SceneInterpretation
interpretByDissertation(const SurfletSet& cells, const ModelDatabase& database,
                        const DissertationParameters& parameters = {});

/** \brief Constants of interpretByExplanation(). All are chosen by experiment on scenes with seeds
 * below 100. */
struct ExplanationParameters {
  DissertationParameters steps; ///< steps 1 to 4, which propose places; background; seed; threads
  double reach = 1.1;           ///< a place extends to this many r_max from its centre, >= 1
  unsigned rounds = 2; ///< times that places are proposed, each on what is still unexplained, >= 1
  std::size_t settling_cells = 1500; ///< cells of a place by which a model finds its centre, >= 2
  unsigned recentrings = 3;          ///< times the centre moves to the mean of what was kept, >= 1
  unsigned max_regroupings = 60;     ///< of one refinement
  unsigned probes = 24; ///< pairs of a cell with what was kept, by which it may come back, >= 1
  double max_crosstalk = 0.1; ///< share of crosstalk among these that is tolerated, in [0, 1]
  /** \brief Nats per feature by which the mean log-likelihood of an explanation's cells may fall
   * short of what the model expects of its own features. Until then the worst cells are peeled off.
   */
  double max_surprise = 0.1;
  double peeled_share = 0.1;      ///< share of the cells that is peeled off at a time, in (0, 1)
  unsigned peelings = 20;         ///< most times
  std::uint64_t features = 40000; ///< regrouped features by which an explanation is judged, >= 1
  double min_ratio = 0.1;         ///< least mean log density ratio to all models, nats per feature
  double min_fit = 0.72;          ///< least intersection with the model's histogram, in [0, 1]
  unsigned vote_pairs = 24; ///< BackgroundTreatment::Model: pairs by which a cell is judged, >= 1
  double vote_share = 0.3;  ///< a cell is background from this share of its pairs on, in (0, 1]
  double vote_radius = 0.3; ///< partners lie within this share of the background's delta_max, > 0
};

/** \brief Interprets a scene by what explains it best.
 *
 * Steps 1 to 4 of the dissertation propose places. At every place each model is tried on *all*
 * cells there: refined as in step 3 until what is left supports the model, the place moved to the
 * middle of that. An explanation is worth its number of cells times the mean logarithm of the
 * model's density over the mean density of all models (bin masses divided by the width of the
 * delta intervals, so that models of different size can be compared). The best explanation is
 * taken, its cells are explained, and the others have to do with what is left. An explanation is
 * refused whose histogram does not intersect the model's by min_fit, so parts of unknown objects
 * stay unnamed. For BackgroundTreatment::Model cells are first judged one by one: background are
 * those whose pairs with their neighbours it explains better than every object.
 *
 * What does not belong to the object is told from it by the likelihood of its pairs: the worst
 * cells are peeled off until the rest is nearly as likely as the model's own features. The database
 * should have seven intervals in every dimension; with five too few bins are empty. The diagnostics
 * are those of the first round.
 *
 * Limits, measured in doc/interpretation/results.md: of objects pushed together until they touch
 * little more than half are found, and the largest model takes cells of its neighbours.
 *
 * Exceptions and \p cells as in interpretByDissertation(). */
PCL_SURFLET_API SceneInterpretation
interpretByExplanation(const SurfletSet& cells, const ModelDatabase& database,
                       const ExplanationParameters& parameters = {});

/** \brief Indices of the cells that are farther than \p distance from every surflet of
 * \p background, a scene sensed without objects: strategy A, exclusion [Wahl 2007, Sec. 5.4].
 *
 * \throws std::invalid_argument if \p distance is not positive and finite */
PCL_SURFLET_API std::vector<std::uint32_t>
cellsAwayFrom(const SurfletSet& cells, const SurfletSet& background, double distance);

} // namespace pcl_surflet
