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
  std::string label;      ///< of the model
  std::string condition;  ///< what the best member was trained under ("noise 4 %"): of the winner,
                          ///< an estimate of the query's noise and visibility
  double score = 0;       ///< value of the criterion; which end is better: smallerIsBetter()
  double surprise = 0;    ///< nats per feature by which the log-likelihood falls short of what the
                          ///< model expects of its own features; near 0 for a perfect match
  double posterior = 0;   ///< probability of the model among those of the database, in [0, 1]
  /** \brief Kullback-Leibler divergence of the query from the best member, sum Q ln (Q / H), in
   * nats per feature, >= 0: what the features tell against the model. Fewer features make it
   * larger. */
  double misfit = 0;
  /** \brief The misfit as a multiple of what the member's own training samples have; near 1 for
   * the right model. 0 if that was not measured in training (models of a bank are). */
  double relative_misfit = 0;
};

/** \brief The answer to one query. */
struct Classification {
  std::vector<ModelMatch> ranking; ///< all models, best first; empty if the query had no feature
  bool unknown = true;             ///< no model is similar enough (setUnknownThreshold())
  double margin = 0;               ///< score difference of the two best models, >= 0
  /** \brief The winner's relative misfit times the square root of its misfit's share of the
   * runner-up's (at most 1; 1 without runner-up): a stranger lies between the models, what is known
   * lies near one. 0 if the winner's misfit was not measured in training. */
  double strangeness = 0;
  std::uint64_t features = 0; ///< features used
  std::uint64_t rejected = 0; ///< pairs drawn without feature

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
 * A model of several members (ModelBankTrainer) responds with its best member. Where models differ
 * in size, the likelihood is that of a density: bin masses are divided by the width of the model's
 * delta intervals (score minus ln (delta_max / largest delta_max of the database)); with equal
 * delta_max the criterion is exactly that of the dissertation.
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
  /** \brief The criterion in use. */
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
  /** \brief Pairs drawn per query, the default resolved. */
  std::uint64_t getNumberOfFeatures() const;
  /** \brief 2000, or twice the number of bins if that is more. */
  static std::uint64_t defaultFeatures(const Resolution& resolution);
  /** \brief Seed of the drawn pairs, default 1. */
  void
  setSeed(std::uint64_t seed)
  {
    seed_ = seed;
  }
  /** \brief Seed of the drawn pairs. */
  std::uint64_t
  getSeed() const
  {
    return seed_;
  }
  /** \brief Threads of classifyBatch(), 0 (default): all. The result does not depend on it. */
  void
  setNumberOfThreads(unsigned threads)
  {
    threads_ = threads;
  }
  /** \brief Threads of classifyBatch(), 0: all. */
  unsigned
  getNumberOfThreads() const
  {
    return threads_;
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
  /** \brief Worst value of what is known, if there is one. */
  std::optional<double>
  getUnknownThreshold() const
  {
    return threshold_;
  }
  /** \brief Takes a query for unknown if its strangeness exceeds \p limit. Stands noise and missing
   * parts far better than a threshold of the surprise, but needs models trained in a bank and the
   * default number of features. No limit by default; a winner that was trained without bank passes.
   */
  void
  setMisfitLimit(std::optional<double> limit)
  {
    misfit_limit_ = limit;
  }
  /** \brief Largest strangeness of what is known, if there is one. */
  std::optional<double>
  getMisfitLimit() const
  {
    return misfit_limit_;
  }
  /** \brief A limit from the training data alone: the mean over the members of what the strangeness
   * of 97.5 % of the samples stays below that were left out of a member's histogram; nothing if no
   * member was trained in a bank.
   *
   * The runner-up is the nearest member of another model: by the Kullback-Leibler divergence of the
   * histograms, as if all models had one size. Of more than 256 members, 256 are looked at. */
  std::optional<double> calibratedMisfitLimit() const;
  /** \brief Compares shapes regardless of size: query and models are scaled to one diameter
   * [Wahl 2007, Sec. 3.6.9]. Default off. */
  void
  setScaleNormalized(bool on)
  {
    scale_normalized_ = on;
  }
  /** \brief Are shapes compared regardless of size? */
  bool
  isScaleNormalized() const
  {
    return scale_normalized_;
  }

  /** \brief Classifies one cloud.
   * A query of fewer than two surflets, or without any feature, is unknown with an empty ranking.
   * \param query finite surflets in the unit of the models, with outward normals of unit length:
   * toSurflets() and SurfletSet::appendChecked() leave out all others */
  Classification classify(const SurfletSet& query) const;

  /** \brief Classifies many clouds, in parallel; the same as classify() of each. */
  std::vector<Classification> classifyBatch(const std::vector<SurfletSet>& queries) const;

private:
  struct ModelInfo {
    std::string label;
    double delta_max;
    std::size_t first_member; ///< in members_
    std::size_t members;
  };
  struct MemberInfo {
    std::string condition;
    double misfit, misfit_limit; ///< of ModelMember
  };

  /** \brief Logarithms of one model's members, those of a bin next to each other: a query of few
   * different bins is compared with all members in one pass. */
  struct LogTable {
    std::size_t members = 0;
    std::vector<float> rows; ///< bin by bin
  };
  class Query;
  struct Candidate;

  void meanLogs(const Query& query, std::size_t model, std::vector<float>& mean) const;
  Candidate bestMember(const Query& query, std::size_t model, std::vector<float>& means) const;
  double score(const PenalizedHistogram& p, const Histogram& q, double mean_log) const;
  bool better(double a, double b) const;
  bool accepted(const Classification& answer) const;
  double nearestRival(std::size_t member) const;

  std::vector<ModelInfo> models_;
  std::vector<MemberInfo> infos_; ///< parallel to members_
  std::vector<PenalizedHistogram> members_;
  std::vector<LogTable> logs_; ///< parallel to models_
  Resolution resolution_;
  double h_min_;
  double largest_delta_;
  Criterion criterion_ = Criterion::Likelihood;
  std::uint64_t features_ = 0;
  std::uint64_t seed_ = 1;
  unsigned threads_ = 0;
  std::optional<double> threshold_, misfit_limit_;
  bool scale_normalized_ = false;
};

} // namespace pcl_surflet
