/** \file
 * Shape search in large collections [Wahl 2007, Sec. 3.1.1, 3.6.9]. */
#pragma once

#include "pcl_surflet/core/similarity.h"
#include "pcl_surflet/core/surflet_set.h"
#include "pcl_surflet/recognition/model_database.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief A model that resembles the query. */
struct SearchHit {
  std::size_t model = 0; ///< number in the order of adding
  std::string label;     ///< its name
  double score = 0; ///< mean ln H of the query's features under the model's best member; larger is
                    ///< better
};

/** \brief Finds the models that resemble a query most, among thousands and regardless of size.
 *
 * Every member's histogram is kept as the square roots of its shares, whose Euclidean distance is
 * Hellinger's, in FLANN's randomised k-d trees. The trees give a shortlist; its members are ranked
 * by their likelihood, as HistogramClassifier does with sizes normalised. The shortlist is the only
 * approximation: searchAll() does without.
 *
 * Takes 14 bytes a bin and member (doc/memory.md). Const methods may be called from several
 * threads. Results depend on models, their order and parameters alone, provided that no other
 * thread draws from rand() while models are added (FLANN does). */
class PCL_SURFLET_API ModelSearch {
public:
  /** \brief \param resolution of all models
   * \param floor of empty bins, as PenaltyParameters::floor
   * \throws std::invalid_argument if the resolution is unusable or the floor not in (0, 1) */
  explicit ModelSearch(const Resolution& resolution, double floor = PenaltyParameters().floor);
  /** \brief All models of \p database, with the penalty of the database as it is. */
  explicit ModelSearch(const ModelDatabase& database);
  ~ModelSearch();
  ModelSearch(ModelSearch&&) noexcept;            ///< leaves the other only to be destroyed
  ModelSearch& operator=(ModelSearch&&) noexcept; ///< leaves the other only to be destroyed

  /** \brief Adds a model without building the index anew (FLANN does so each time the number of
   * members has doubled). \throws DatabaseError if the model is unusable or of another resolution
   */
  void add(const HistogramModel& model);

  std::size_t size() const; ///< number of models

  /** \brief Members compared by likelihood, default 100. \throws std::invalid_argument if 0 */
  void setShortlist(std::size_t members);
  std::size_t getShortlist() const; ///< members compared by likelihood
  /** \brief Leaves of the trees looked at, default 1000: more find the true neighbours more often.
   * \throws std::invalid_argument if 0 */
  void setChecks(int checks);
  int getChecks() const; ///< leaves looked at
  /** \brief Pairs drawn of a query, 0 (default): HistogramClassifier::defaultFeatures(). */
  void setNumberOfFeatures(std::uint64_t features);
  std::uint64_t getNumberOfFeatures() const; ///< as set, 0: the default
  void setSeed(std::uint64_t seed);          ///< of the pairs drawn of a query, default 1
  std::uint64_t getSeed() const;             ///< of the pairs drawn of a query

  /** \brief The \p k best models, best first; fewer if the shortlist holds no more. Empty for a
   * query without features. \param query surflets as HistogramClassifier::classify() takes them
   * \param k most hits, 0: none */
  std::vector<SearchHit> search(const SurfletSet& query, std::size_t k) const;
  /** \brief The same, of a query that is a histogram already (ModelMember::histogram). Empty if it
   * is all zero. \throws std::invalid_argument if its size is not that of the resolution */
  std::vector<SearchHit> search(const std::vector<float>& histogram, std::size_t k) const;
  /** \brief As search(), but compares the query with every model. */
  std::vector<SearchHit> searchAll(const SurfletSet& query, std::size_t k) const;
  /** \brief The same, of a histogram. \throws std::invalid_argument as search() */
  std::vector<SearchHit> searchAll(const std::vector<float>& histogram, std::size_t k) const;

private:
  struct Data;
  std::unique_ptr<Data> data_;
};

} // namespace pcl_surflet
