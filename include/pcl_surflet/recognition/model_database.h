/** \file
 * A set of models (Omega) and background models (Omega') of one resolution. */
#pragma once

#include "pcl_surflet/core/similarity.h"
#include "pcl_surflet/recognition/histogram_model.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief How empty bins are penalised [Wahl 2007, Sec. 3.5]. */
struct PenaltyParameters {
  /** \brief H_min = tau * smallest positive bin of the database (Eq. 3.20), tau in (0, 1]. */
  double tau = 1.0;
  /** \brief If positive, H_min is this instead, the same for every database. 1e-5 to 1e-4 stands
   * noise better than Eq. 3.20, whose H_min is the chance count of the rarest bin. */
  double floor = 1e-5;
};

/** \brief A misused database; what() says how. */
class PCL_SURFLET_API DatabaseError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
  ~DatabaseError() override;
};

/** \brief One histogram of a model, ready to be compared. */
struct PenalizedHistogram {
  std::size_t model = 0;       ///< index of the model
  std::size_t member = 0;      ///< index of its member
  Histogram h;                 ///< penalised, free of zeros [Wahl 2007, Eq. 3.21, 3.22]
  Histogram log_h;             ///< ln h, taken once [Wahl 2007, Eq. 3.16]
  std::vector<bool> empty_bin; ///< which bins were truly zero before the penalty
  double log_sum = 0;          ///< sum of ln h over the bins [Wahl 2007, Eq. 3.18]
  double expected_log = 0;     ///< sum of h ln h: mean log-likelihood of the model's own features
};

/** \brief The models one wants to tell apart.
 *
 * All models have the same resolution: their bins compete, so a model of another resolution is
 * refused (train it again, or keep two databases). Labels are unique. */
class PCL_SURFLET_API ModelDatabase {
public:
  /** \brief Adds \p model. \throws DatabaseError if it is unusable (HistogramModel::problem()), its
   * resolution differs from the others', or its label is taken */
  void add(HistogramModel model);
  /** \brief Adds \p model in place of the one of the same label, if any.
   * \return true if there was one. \throws DatabaseError as add() */
  bool replace(HistogramModel model);
  /** \brief Removes the model \p label. \return false if there is none */
  bool remove(const std::string& label);

  /** \brief Number of models, background models included. */
  std::size_t
  size() const
  {
    return models_.size();
  }
  /** \brief Whether there is no model. */
  bool
  empty() const
  {
    return models_.empty();
  }
  /** \brief Models in the order of adding; \p i < size(). */
  const HistogramModel&
  operator[](std::size_t i) const
  {
    return models_[i];
  }
  /** \brief The model \p label, or null. */
  const HistogramModel* find(const std::string& label) const;
  /** \brief Resolution of all models; the default one while empty. */
  Resolution resolution() const;
  /** \brief Largest delta_max, 0 while empty. */
  double largestDelta() const;

  /** \brief How empty bins are penalised from now on. \throws DatabaseError unless tau is in (0, 1]
   * and floor in [0, 1) */
  void setPenalty(const PenaltyParameters& penalty);
  /** \brief The penalty in use. */
  const PenaltyParameters&
  getPenalty() const
  {
    return penalty_;
  }
  /** \brief H_min of the database as it stands [Wahl 2007, Eq. 3.20], at most 1 / (2 bins). */
  double penaltyMinimum() const;
  /** \brief All members of all models with the penalty applied, in order. */
  std::vector<PenalizedHistogram> penalized() const;

private:
  void check(const HistogramModel& model, bool only) const;

  std::vector<HistogramModel> models_;
  PenaltyParameters penalty_;
};

} // namespace pcl_surflet
