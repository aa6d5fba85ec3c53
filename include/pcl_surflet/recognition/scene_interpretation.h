/** \file
 * Scene interpretation: segments and names the objects of a scene in one go. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"
#include "pcl_surflet/recognition/model_database.h"

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief What is done about what carries the objects [Wahl 2007, Sec. 5.4, step 1]. */
enum class BackgroundTreatment {
  Ignore,  ///< nothing: background models of the database take no part
  Exclude, ///< strategy A: the caller has removed it, see cellsAwayFrom(); otherwise as Ignore
  Model    ///< strategy B: the database's background models identify it, and it is ignored
};

/** \brief Cluster seeds that move before they are used [Wahl 2007, Sec. 6.1.1]. A seed's centre
 * begins on a surface, and the ball of r_max about it holds the whole object only if it lies in its
 * middle; so it climbs to where most selected surflets are between r_min and r_max of it. Seeds of
 * models whose r_min is 0 stay. */
struct FloatingSeeds {
  bool on = false;     ///< whether seeds move
  unsigned steps = 25; ///< step k is r_min / k long, in [1, 10000]
  /** \brief s of Eq. 6.3, 6.4, times r_max: how sharply the two radii bound, in (0, 1e6]. */
  double steepness = 60;
  bool keep_paths = false; ///< in ModelDiagnostics::seed_paths
};

/** \brief Repetitive clustering [Wahl 2007, Sec. 6.1.3], after step 7: new pairs are drawn within
 * r_max of each detection's centroid, those that suit its model are refined, and what is left joins
 * the detection. It regains the border of objects; names stay as they are. */
struct Repetition {
  bool on = false; ///< whether detections regain what is left
  /** \brief Pairs drawn for each surflet within r_max, > 0 and at most 1e6. */
  double pairs_per_surflet = 4;
};

/** \brief Constants of the seven steps. Those marked (*) the dissertation leaves open. */
struct DissertationParameters {
  BackgroundTreatment background = BackgroundTreatment::Ignore; ///< step 1

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

  FloatingSeeds floating; ///< step 2
  Repetition repetition;  ///< after step 7

  std::uint64_t seed = 1; ///< of all that is drawn; one seed, one result
  unsigned threads = 0;   ///< 0: all; the result does not depend on it

  /** \brief Told now and then which share is done, in [0, 1], never falling; returns false to
   * cancel. Called in the thread that interprets; what it throws ends the interpretation. */
  std::function<bool(double)> progress;
};

/** \brief What an interpretation did for one model. Each count is what was left or lost at that
 * point; what the other method counts is 0. */
struct ModelDiagnostics {
  std::string label; ///< of the model
  /** \name interpretByExplanation(), which tries again on what the first choice left over
   * explanations = died_fit + lost + detections */
  ///@{
  std::size_t places = 0;       ///< where the model was tried
  std::size_t promising = 0;    ///< rough segments that the scan left
  std::size_t explanations = 0; ///< that a closer look at these gave, in all rounds
  std::size_t died_fit = 0;     ///< of these: fit less than junk_fit
  ///@}
  /** \name interpretByDissertation() */
  ///@{
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
  std::size_t regained = 0;          ///< repetition: surflets that joined the detections
  /** \brief Step 2: where each seed's centre was before and after every step that it moved. */
  std::vector<std::vector<std::array<double, 3>>> seed_paths;
  ///@}
  /** \brief Step 7: lost a competition. Explanations: others explain their cells better. */
  std::size_t lost = 0;
  std::size_t detections = 0; ///< of this model in the result
};

/** \brief What an interpretation did: counts of what was left or lost at each step. */
struct InterpretationDiagnostics {
  bool cancelled = false;        ///< progress said so: there are no detections, the rest is partial
  std::uint64_t drawn = 0;       ///< step 1: pairs drawn
  std::uint64_t too_long = 0;    ///< step 1: of these, longer than any model
  std::uint64_t featureless = 0; ///< step 1: of those drawn, pairs without feature
  std::uint64_t background = 0;  ///< step 1: pairs that are most likely background
  std::size_t background_cells = 0;     ///< by explanation: cells voted background
  std::vector<ModelDiagnostics> models; ///< in the order of the database
};

/** \brief An object found in a scene. */
struct Detection {
  std::size_t model = 0;            ///< index in the database
  std::string label;                ///< of the model
  std::vector<std::uint32_t> cells; ///< indices of its surflets in the scene, ascending
  std::array<double, 3> centroid{}; ///< of these surflets
  /** \brief Where the centroid of the whole object is expected, of which the surflets may be one
   * side: by explanation with models from trainForSensors(), see ObjectCentre; else the same as
   * centroid. */
  std::array<double, 3> centre{};
  /** \brief Nats per feature by which the model's mean log-likelihood exceeds that of the best
   * other model, on the regrouped surflets; at least 0 if nothing was merged in step 7. */
  double score = 0;
  std::size_t seeds = 0; ///< merged cluster seeds, n_C; 0 by explanation
  double fit = 0; ///< by explanation: intersection with the model's histogram, in [0, 1]; else 0
  /** \brief By explanation: how much better it fits than the best other model fits the same cells,
   * in [-1, 1]; 0 if they are the same. NaN without any other model, and by the dissertation. */
  double margin = std::numeric_limits<double>::quiet_NaN();
  /** \brief By explanation: the member of the model that fits best. With members for views
   * (addView()) it tells from where the object was seen. */
  std::size_t member = 0;
  double votes = 1; ///< share of the runs that found it, in (0, 1]; see AccumulationParameters
};

/** \brief What was found in a scene, and how. */
struct SceneInterpretation {
  std::vector<Detection> detections;     ///< in the order of the models
  InterpretationDiagnostics diagnostics; ///< step by step
};

/** \brief Interprets a scene by the seven steps of the dissertation as they are written
 * [Wahl 2007, Sec. 5.4].
 *
 * \param cells the scene, reduced to mean surflets (reduceToCells())
 * \param database models and, for BackgroundTreatment::Model, background models. Of a
 * model with several members the first takes part, which is that of the complete surface.
 * \param parameters constants of the steps
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
  DissertationParameters steps; ///< of which background, min_cluster, seed, threads are used
  /** \brief Edge of the cells in the unit of the scene, if known: then the share of a model's
   * surface that was found counts. 0: unknown. */
  double leaf = 0;
  double reach = 1.1;               ///< a place extends to this many r_max from its centre, >= 1
  double place_spacing = 1.2;       ///< between places, in r_mean of the smallest object, > 0
  std::size_t scan_cells = 128;     ///< cells of a place by which a model is tried, in [3, 4096]
  std::size_t settling_cells = 256; ///< the same for what is promising, in [3, 4096]
  unsigned recentrings = 3;         ///< times that a place moves to what supports the model, >= 1
  unsigned probes = 16; ///< cells of an explanation by which the support of a cell is judged, >= 1
  std::uint64_t features = 50000; ///< pairs by which an explanation is judged, >= 1
  double min_fit = 0.72;          ///< least intersection with the model's histogram, in [0, 1]
  /** \brief Fit that is worth nothing, in [0, 1]: explanations are chosen to maximise the sum of
   * cells times (fit - junk_fit). */
  double junk_fit = 0.6;
  double strong_fit = 0.86; ///< from here on, no rival is looked for, in [0, 1]
  unsigned rounds = 4; ///< times that explanations are sought, then on what is left, in [1, 255]
  unsigned vote_pairs = 24; ///< BackgroundTreatment::Model: pairs by which a cell is judged, >= 1
  double vote_share = 0.3;  ///< a cell is background from this share of its pairs on, in (0, 1]
  double vote_radius = 0.3; ///< partners lie within this share of the background's delta_max, > 0
  /** \brief BackgroundTreatment::Ignore: the same for a background learned from the scene's long
   * pairs; the radius is a share of the largest object's delta_max. */
  double uniform_vote_share = 0.6;
  double uniform_vote_radius = 0.8; ///< see \ref uniform_vote_share, > 0
};

/** \brief Interprets a scene by what explains it best.
 *
 * All models are tried all over the scene. At a place, cells are drawn evenly from a ball of the
 * model's size and paired with each other. The *support* of a pair is the logarithm of the model's
 * probability of its feature over that of chance, and the support of a cell is the mean over its
 * pairs with all cells that have support themselves: a power iteration, where steps 2 and 3 of the
 * dissertation erase crosstalk pair by pair. What supports each other is one object, whether or
 * not others touch it. The place moves to its middle, then all cells of the ball are asked for
 * their support, and the intersection of their histogram with the model's is the explanation's fit.
 *
 * Explanations are chosen together, in place of steps 6 and 7: every cell goes to the chosen
 * explanation that it supports most, and one more is chosen if the sum over all of cells times
 * (fit - junk_fit) grows. Weak ones are tried against their rivals. What fits less than min_fit is
 * refused, so unknown objects stay unnamed. For BackgroundTreatment::Model cells are first judged
 * one by one: background are those whose pairs with their neighbours it explains better than every
 * object. BackgroundTreatment::Ignore does the same with what the scene's own long pairs tell,
 * those that no object can have.
 *
 * Cells should come from reduceToTwoSidedCells() and models from trainForScenes(), with seven
 * intervals in every dimension; with five too few bins are empty. Results and limits are in
 * doc/interpretation/results.md.
 *
 * Exceptions and \p cells as in interpretByDissertation(). */
PCL_SURFLET_API SceneInterpretation
interpretByExplanation(const SurfletSet& cells, const ModelDatabase& database,
                       const ExplanationParameters& parameters = {});

/** \brief Indices of the cells that are farther than \p distance from every surflet of
 * \p background that looks the same way within 45 degrees: strategy A, exclusion by a scene sensed
 * without objects [Wahl 2007, Sec. 5.4].
 *
 * Regardless of where they look, what stands on a table would lose its foot.
 *
 * \param cells of the scene
 * \param background surflets of the scene without objects, in the same frame
 * \param distance in their unit, usually one cell
 * \param threads 0: all; does not change the result
 * \throws std::invalid_argument if \p distance is not positive and finite */
PCL_SURFLET_API std::vector<std::uint32_t> cellsAwayFrom(const SurfletSet& cells,
                                                         const SurfletSet& background,
                                                         double distance, unsigned threads = 0);

} // namespace pcl_surflet
