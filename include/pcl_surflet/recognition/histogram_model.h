/** \file
 * The model of one object: one or several surflet-pair histograms and a few lengths. */
#pragma once

#include "pcl_surflet/core/pair_histogram.h"
#include "pcl_surflet/recognition/object_centre.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief Is a model something to find, or background to be told from it [Wahl 2007, Sec. 5.4]? */
enum class ModelRole { Object, Background };

/** \brief One histogram of a model and the condition it was trained under. */
struct ModelMember {
  std::string condition;        ///< e.g. "complete", "noise 1 %"; at most 63 bytes
  std::vector<float> histogram; ///< H(b) [Wahl 2007, Eq. 2.23]: >= 0, sum 1
  std::uint64_t features = 0;   ///< number of features counted
  /** \brief Mean misfit (ModelMatch::misfit) of samples that were left out of the histogram, each
   * of HistogramClassifier::defaultFeatures(); 0 if it was not measured. */
  double misfit = 0;
  /** \brief Largest multiple of it among 97.5 % of those samples; 0 if not measured. */
  double misfit_limit = 0;
  /** \brief Area of the part of the surface that it shows, by the definition of
   * HistogramModel::surface_area; 0 if unknown. */
  double area = 0;
};

/** \brief Model M = (H, delta_max, r_mean, r_max) [Wahl 2007, Eq. 2.24] with r_min (Eq. 6.1).
 *
 * Lengths are in the unit of the training data. A model may hold several histograms, trained under
 * different conditions; its response to a query is that of its best member. */
struct PCL_SURFLET_API HistogramModel {
  static constexpr std::size_t kMaxLabelBytes = 63; ///< so that a database file can hold it
  /** \brief No model's label: what classifiers say of things that no model fits. */
  static constexpr const char* kReservedLabel = "unknown";

  std::string label; ///< 1 to 63 bytes without control characters; unique in a database
  ModelRole role = ModelRole::Object; ///< to be found, or to be ignored
  Resolution resolution;              ///< of every member
  double delta_max = 0;               ///< largest distance between two surflets, exact
  double r_mean = 0;                  ///< mean distance of a surflet to the centroid
  double r_max = 0;                   ///< largest distance of a surflet to the centroid
  double r_min = 0;                   ///< smallest distance of a surflet to the centroid
  double surface_area = 0;            ///< 0 if unknown (trained from points)
  double leaf = 0; ///< edge of the cells that it was trained for, see trainForScenes(); 0: none
  /** \brief From cells of a part of the object to its middle, see ObjectCentre. */
  CentreWeights centre{};
  std::vector<ModelMember> members; ///< at least one; the first is the complete object's

  /** \brief Empty if the model is usable, else what is wrong: checks label (not "unknown"),
   * resolution, lengths (finite, 0 <= r_min <= r_mean <= r_max <= delta_max, delta_max > 0),
   * weights (finite) and of every member size, values and sum. */
  std::string problem() const;

  /** \brief Area of what member number \p member shows: its own; if that is unknown, that
   * of the whole surface for the first member, which is complete, and 0 (unknown) for others. */
  double areaOf(std::size_t member) const;
};

} // namespace pcl_surflet
