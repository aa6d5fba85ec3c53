/** \file
 * The experiments of chapter 3, as data for reportRates(). */
#pragma once

#include "experiment/rates_report.h"

namespace pcl_surflet {
namespace apps {

/** \brief What an experiment may vary. */
struct ChapterOptions {
  RatesOptions rates;
  double normal_radius = 3;           ///< of normals estimated under noise, in spacings
  std::uint64_t intervals = 30;       ///< steps of a distortion
  std::vector<std::string> peer_list; ///< peers that take part
  std::vector<std::string> strangers; ///< meshes that are not in the database
};

/** \brief Meshes of libcgal-demo that are not among experimentLabels(). */
std::string strangerNames();

/** \brief All meshes of libcgal-demo that the experiments know: experimentLabels() and
 * strangerNames(). */
std::vector<std::string> allLabels();

/** \brief Factors of one axis, drawn from each of so many \p intervals of [0.4, 2], for each axis
 * [Wahl 2007, Sec. 3.6.8]. */
std::vector<Setting> elongationSettings(std::uint64_t intervals);

/** \brief One, two or three random axes distorted by factors from [0.2, 2.3] whose measure
 * (distortionMeasure()) lies in each of so many \p intervals of what three axes can reach; without
 * the intervals that fewer axes cannot reach. */
std::vector<Setting> distortionSettings(std::uint64_t intervals);

/** \name One function a table or figure
 * \return the exit code. \throws as reportRates() */
///@{
/** \brief Ideal, noise and visibility by the likelihood; database and gallery of the objects. */
int runClassification(const ChapterOptions& options);
/** \brief Table 3.1 and Fig. 3.4. */
int runCriteria(const ChapterOptions& options);
/** \brief Fig. 3.5. */
int runNoise(const ChapterOptions& options);
/** \brief Fig. 3.6. */
int runVisibility(const ChapterOptions& options);
/** \brief Fig. 3.7. */
int runResolution(const ChapterOptions& options);
/** \brief Fig. 3.9. */
int runElongation(const ChapterOptions& options);
/** \brief Fig. 3.8 and 3.10-3.14. */
int runDistortion(const ChapterOptions& options);
/** \brief Ours beside PCL's global descriptors. */
int runPeers(const ChapterOptions& options);
/** \brief How many strangers pass for known where most known objects do: the bank's limit of the
 * misfit, by calibration and by what accepts 95 % of the known; rejection.csv. */
int runRejection(const ChapterOptions& options);
/** \brief Collections of classes of more and more variety: nearest neighbour, first and second
 * tier, precision over recall. The number of tests is that of models a class. retrieval.csv,
 * retrieval.svg. \throws UsageError for fewer than two classes or models */
int runRetrieval(const ChapterOptions& options);
///@}

} // namespace apps
} // namespace pcl_surflet
