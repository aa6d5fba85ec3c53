/** \file
 * Training of model banks: one model, many conditions. */
#pragma once

#include "pcl_surflet/core/pair_histogram.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/recognition/model_bank.h"

#include <vector>

namespace pcl_surflet {

/** \brief Trains models whose members were seen under the conditions of a bank.
 *
 * \code
 * HistogramModelTrainer trainer;
 * ModelBankTrainer banks(trainer, ModelBank::standard());
 * HistogramModel bunny = banks.train("bunny", mesh);
 * \endcode
 * The first member is what \p trainer makes of the data: clean and complete. For every condition
 * samples are disturbed, normals estimated anew where a sensor would have to
 * (pcl::NormalEstimation), and their pairs counted; the histograms of a condition are grouped by
 * likeness, one member a group. Lengths of the model are those of the complete object.
 *
 * Clouds of more surflets than HistogramModelTrainer::getMeshSurflets() are thinned to that number
 * at random before they are disturbed. Takes a second or two an object with the default bank. The
 * same seed gives the same model for any number of threads. */
class PCL_SURFLET_API ModelBankTrainer {
public:
  /** \brief \param trainer resolution, role, seed, threads and the clean member
   * \param bank the conditions of the other members */
  ModelBankTrainer(HistogramModelTrainer trainer, ModelBank bank);

  /** \brief Disturbed samples per member, default 12. \throws std::invalid_argument if 0 */
  void setSamplesPerMember(unsigned samples);

  /** \brief As HistogramModelTrainer::train() \throws TrainingError, also if a condition leaves
   * nothing that has a feature */
  HistogramModel train(const std::string& label, const SurfletSet& surflets) const;
  /** \brief The same of a mesh. */
  HistogramModel train(const std::string& label, const TriangleMesh& mesh) const;

private:
  /** \brief What is disturbed. */
  struct Base {
    std::vector<SurfletSet> samplings;
    double spacing = 0; ///< square root of the area per surflet
  };

  /** \brief Histograms of disturbed samples: of many pairs, and of as many as a query has. */
  struct Counted {
    std::vector<PairHistogram> rich, like_queries;
    std::vector<double> left; ///< share of the sample that the condition leaves
  };

  void addMembers(HistogramModel& model, const Base& base) const;
  void addCondition(HistogramModel& model, const Base& base, std::size_t condition) const;
  void calibrateComplete(HistogramModel& model, const Base& base) const;
  Counted count(const BankCondition& condition, const Base& base, double delta_max,
                std::uint64_t seed) const;

  HistogramModelTrainer trainer_;
  ModelBank bank_;
  unsigned samples_ = 12;
};

} // namespace pcl_surflet
