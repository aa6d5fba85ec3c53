/** \file
 * Recognition rates of the twenty objects under ideal and disturbed conditions
 * [Wahl 2007, Sec. 3.6.4-3.6.6]. */
#pragma once

#include "experiment/objects.h"
#include "experiment/output.h"
#include "pcl_surflet/recognition/histogram_classifier.h"

#include <cstdint>
#include <utility>

namespace pcl_surflet {
namespace apps {

/** \brief What is done to a query before it is classified. */
struct Condition {
  std::string name;
  double noise = 0;   ///< amplitude along the normal, as a share of the diameter
  double visible = 1; ///< share of the surface left by a random plane
};

struct ClassificationPlan {
  std::vector<Condition> conditions;
  std::uint64_t tests = 100; ///< per object and condition
  std::uint64_t seed = 1;    ///< queries are sampled with other seeds than models
  unsigned threads = 0;
};

/** \brief Outcome of one condition. */
struct ConditionResult {
  Condition condition;
  std::vector<std::vector<std::uint64_t>> confusion; ///< [object][model answered]
  double seconds_per_query = 0;                      ///< of HistogramClassifier::classify() alone
  std::uint64_t tests = 0;                           ///< in all
  std::uint64_t right = 0;

  /** \brief Share of right answers. */
  double
  rate() const
  {
    return tests > 0 ? static_cast<double>(right) / static_cast<double>(tests) : 0;
  }
};

/** \brief Bounds of the 95 % confidence interval of a rate (Wilson). */
std::pair<double, double> confidenceInterval(std::uint64_t right, std::uint64_t tests);

/** \brief Trains one model an object by training A (meshes). */
ModelDatabase trainObjects(const std::vector<ExperimentObject>& objects,
                           const Resolution& resolution, std::uint64_t seed, unsigned threads,
                           const ProgressFunction& progress);

/** \brief A query: a fresh even sample, turned at random, then disturbed. Under noise the normals
 * are estimated anew from the disturbed positions (pcl::NormalEstimation within 3 spacings). */
SurfletSet makeQuery(const ExperimentObject& object, const Condition& condition,
                     std::uint64_t seed);

/** \brief Classifies tests x objects queries under every condition. Labels of the database must be
 * those of the objects, in order. */
std::vector<ConditionResult> runClassification(const std::vector<ExperimentObject>& objects,
                                               const HistogramClassifier& classifier,
                                               const ClassificationPlan& plan,
                                               const ProgressFunction& progress);

} // namespace apps
} // namespace pcl_surflet
