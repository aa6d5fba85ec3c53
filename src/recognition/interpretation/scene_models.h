/** \file
 * The models as the steps of interpretation need them; internal, not installed. */
#pragma once

#include "pcl_surflet/core/pair_counting.h"
#include "pcl_surflet/recognition/model_database.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace pcl_surflet {
namespace interpretation {

/** \brief Mark of a feature that a model cannot have: a pair longer than its delta_max. */
constexpr std::uint32_t kBeyond = std::numeric_limits<std::uint32_t>::max();

/** \brief Cells of edge s that a surface has per s^2, averaged over orientations (measured on
 * bottle, bunny, dragon and horse: 1.22 to 1.32). Less where walls are thinner than cells. */
constexpr double kCellsOfArea = 1.27;

/** \brief Area of the surface that occupies so many cells of edge \p leaf. */
inline double
areaOfCells(double cells, double leaf)
{
  return cells * leaf * leaf / kCellsOfArea;
}

constexpr float kMostSupport = 3; ///< limit of a pair's support, nats

/** \brief One model with tables over its bins. */
struct SceneModel {
  std::size_t index = 0; ///< in the database
  const HistogramModel* model = nullptr;
  std::vector<float> h; ///< H(b) without penalty, of the first member: the complete object
  /** \brief H(b) of all members, padded with zeros to whole blocks for bestOverlap(). */
  std::vector<std::vector<float>> members;
  std::vector<float> log_h; ///< ln of the penalised H(b) [Wahl 2007, Eq. 3.21, 3.22]
  /** \brief Penalised H(b) per width of the delta intervals in the scene's unit scale: what is
   * comparable among models of different size. */
  std::vector<float> density;
  float least_density = 0; ///< of what the model cannot have
  double expected_log = 0; ///< mean log-likelihood of the model's own features
  /** \brief ln of the penalised H(b) over the probability of the bin for surflets that have nothing
   * to do with each other: normals by chance, distances as on a sphere of diameter delta_max.
   * Limited to 3 nats either way, so that no single pair decides.
   *
   * One row of angular_bins + 1 entries an interval of delta; the last entry is 0, for pairs
   * without feature, and the last row is for pairs beyond delta_max. */
  std::vector<float> support;
  float intervals_per_length = 0; ///< of delta in the scene's unit scale
  float last_row = 0;             ///< number of intervals of delta
  double expected_support = 0;    ///< mean of support over the model's own features
  double expected_cells = 0;      ///< cells of the whole object; 0 if unknown
  std::vector<float> border;      ///< squared borders of delta in the scene's unit scale
  float longest = 0;              ///< delta_max squared in the scene's unit scale
  std::uint32_t angular_bins = 0;

  bool
  isObject() const
  {
    return model->role == ModelRole::Object;
  }
  /** \brief h_i(f): the bin of a feature [Wahl 2007, Eq. 3.4], or kBeyond. */
  std::uint32_t
  bin(std::uint32_t angular_bin, float delta_squared) const
  {
    if (delta_squared > longest)
      return kBeyond;
    for (const float b : border)
      angular_bin += delta_squared >= b ? angular_bins : 0;
    return angular_bin;
  }
  /** \brief Density of a feature; least_density beyond delta_max. */
  float
  densityOf(std::uint32_t angular_bin, float delta_squared) const
  {
    const std::uint32_t b = bin(angular_bin, delta_squared);
    return b == kBeyond ? least_density : density[b];
  }
  /** \brief Where \ref support has a pair: without branches, so that loops over pairs become
   * vectors. \param column angular bin, or angular_bins for a pair without feature
   * \param delta distance in the scene's unit scale */
  std::uint32_t
  supportIndex(std::uint32_t column, float delta) const
  {
    const float interval = std::min(delta * intervals_per_length, last_row);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(interval)) * (angular_bins + 1) +
           column;
  }
  /** \brief H_i(h_i(f)); 0 beyond delta_max. */
  float
  value(std::uint32_t angular_bin, float delta_squared) const
  {
    const std::uint32_t b = bin(angular_bin, delta_squared);
    return b == kBeyond ? 0.f : h[b];
  }
};

/** \brief The models that take part, objects first. */
struct SceneModels {
  std::vector<SceneModel> all;
  std::size_t objects = 0; ///< the first of all are objects, the others background
  Resolution resolution;
  double largest_delta = 0; ///< delta_max of the largest object
  float log_h_min = 0;      ///< ln of the penalty, the likelihood of what a model cannot have
};

/** \brief Bins that bestOverlap() takes at a time. */
constexpr std::size_t kOverlapBlock = 16;

/** \brief How much a histogram overlaps with that of the most similar member. */
struct Overlap {
  double share = 0; ///< intersection [Wahl 2007, Eq. 3.7], in [0, 1]
  std::size_t member = 0;
};

/** \param histogram of sum 1, padded like SceneModel::members */
Overlap bestOverlap(const SceneModel& model, const std::vector<float>& histogram);

/** \brief Distribution of the angles of two surflets at random places with random normals; counted
 * once for each resolution and kept. */
const std::vector<float>& chanceAngles(const Resolution& resolution);

/** \brief Tables of one model. \param h_min least probability of a bin
 * \param scale of the scene's PairSource \param chance chanceAngles() */
SceneModel sceneModel(const HistogramModel& model, double h_min, double scale,
                      const std::vector<float>& chance);

/** \param scale of the scene's PairSource \param threads 0: all; does not change the result */
SceneModels sceneModels(const ModelDatabase& database, bool with_background, double scale,
                        unsigned threads = 1);

} // namespace interpretation
} // namespace pcl_surflet
