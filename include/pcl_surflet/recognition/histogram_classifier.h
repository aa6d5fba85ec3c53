/** \file
 * Which model of a database does an unknown cloud belong to? */
#pragma once

#include "pcl_surflet/core/pair_counting.h"
#include "pcl_surflet/recognition/model_database.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief How well one model explains a query. */
struct ModelMatch {
  std::size_t model = 0;  ///< index in the database
  std::size_t member = 0; ///< the model's best member
  std::string label;
  double score = 0;     ///< value of the criterion; which end is better: smallerIsBetter()
  double surprise = 0;  ///< nats per feature by which the log-likelihood falls short of what the
                        ///< model expects of its own features; near 0 for a perfect match
  double posterior = 0; ///< probability of the model among those of the database, in [0, 1]
};

/** \brief The answer to one query. */
struct Classification {
  std::vector<ModelMatch> ranking; ///< all models, best first; empty if the query had no feature
  bool unknown = true;             ///< no model is similar enough (setUnknownThreshold())
  double margin = 0;               ///< score difference of the two best models, >= 0
  std::uint64_t features = 0;      ///< features used
  std::uint64_t rejected = 0;      ///< pairs drawn without feature

  /** \brief The best model, or null if unknown. */
  const ModelMatch*
  best() const
  {
    return unknown || ranking.empty() ? nullptr : &ranking.front();
  }
};

/** \brief Classifies clouds by comparing drawn features with the models of a database
 * [Wahl 2007, Sec. 3.2-3.5].
 *
 * \code
 * HistogramClassifier classifier(database);
 * const Classification answer = classifier.classify(surflets);
 * if (const ModelMatch* best = answer.best())
 *   std::cout << best->label << " " << best->posterior << "\n";
 * \endcode
 *
 * A model of several members responds with its best member. Where models differ in size, the
 * likelihood is that of a density: bin masses are divided by the width of the model's delta
 * intervals (score minus ln (delta_max / largest delta_max of the database)); with equal delta_max
 * the criterion is exactly that of the dissertation.
 *
 * Background models compete like objects; their label is then the answer.
 * Const methods may be called from several threads. One seed gives one result. */
class PCL_SURFLET_API HistogramClassifier {
public:
  /** \brief Copies what it needs of \p database (later changes to it do not matter).
   * \throws DatabaseError if it is empty */
  explicit HistogramClassifier(const ModelDatabase& database);

  /** \brief Default Likelihood. */
  void
  setCriterion(Criterion criterion)
  {
    criterion_ = criterion;
  }
  Criterion
  getCriterion() const
  {
    return criterion_;
  }
  /** \brief Pairs drawn per query; 0 (default): 2000, or twice the number of bins if that is more.
   */
  void
  setNumberOfFeatures(std::uint64_t features)
  {
    features_ = features;
  }
  std::uint64_t getNumberOfFeatures() const;
  void
  setSeed(std::uint64_t seed)
  {
    seed_ = seed;
  }
  /** \brief Threads of classifyBatch(), 0 (default): all. The result does not depend on it. */
  void
  setNumberOfThreads(unsigned threads)
  {
    threads_ = threads;
  }
  /** \brief Worst value that is still accepted as known. For Likelihood the largest magnitude of
   * surprise (nats per feature): a shape whose features all fall into the model's fullest bins is
   * foreign too, though its likelihood exceeds the model's own. For every other criterion the worst
   * score. No threshold (default): all is known. */
  void
  setUnknownThreshold(std::optional<double> threshold)
  {
    threshold_ = threshold;
  }
  /** \brief Compares shapes regardless of size: query and models are scaled to one diameter
   * [Wahl 2007, Sec. 3.6.9]. Default off. */
  void
  setScaleNormalized(bool on)
  {
    scale_normalized_ = on;
  }

  /** \brief Classifies one cloud.
   * A query of fewer than two surflets, or without any feature, is unknown with an empty ranking.
   */
  Classification classify(const SurfletSet& query) const;

  /** \brief Classifies many clouds, in parallel; the same as classify() of each. */
  std::vector<Classification> classifyBatch(const std::vector<SurfletSet>& queries) const;

private:
  struct ModelInfo {
    std::string label;
    double delta_max;
  };

  struct Candidate;

  std::vector<Candidate> candidates(const FeatureSample& sample, double query_delta_max) const;
  double score(const PenalizedHistogram& p, const Histogram& q, double mean_log) const;
  bool better(double a, double b) const;
  bool accepted(const ModelMatch& match) const;

  std::vector<ModelInfo> models_;
  std::vector<PenalizedHistogram> members_;
  Resolution resolution_;
  double h_min_;
  double largest_delta_;
  Criterion criterion_ = Criterion::Likelihood;
  std::uint64_t features_ = 0;
  std::uint64_t seed_ = 1;
  unsigned threads_ = 0;
  std::optional<double> threshold_;
  bool scale_normalized_ = false;
};

} // namespace pcl_surflet
