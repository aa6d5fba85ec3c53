/** \file
 * Point types of pcl_surflet, registered with PCL. */
#pragma once

#include "pcl_surflet/compat.h"

#include <pcl/point_representation.h>
#include <pcl/register_point_struct.h>

#include <cstdint>
#include <ostream>

namespace pcl_surflet {

/** \brief The feature of one pair of points: (alpha, beta, gamma, delta) [Wahl 2007, Eq. 2.10] and
 * the indices of the two points in the input cloud. alpha is in radian, delta in the cloud's unit.
 */
struct SurfletPairSignature {
  float alpha = 0;           ///< radian, in [-pi, pi)
  float beta = 0;            ///< in [-1, 1]
  float gamma = 0;           ///< in [-1, 1]
  float delta = 0;           ///< distance, > 0
  std::uint32_t index_1 = 0; ///< of one point
  std::uint32_t index_2 = 0; ///< of the other

  /** \brief Number of floats, as PCL asks for it. */
  static constexpr int
  descriptorSize()
  {
    return 4;
  }
};

/** \brief Writes feature and indices. */
inline std::ostream&
operator<<(std::ostream& os, const SurfletPairSignature& p)
{
  return os << "(" << p.alpha << "," << p.beta << "," << p.gamma << "," << p.delta << " of "
            << p.index_1 << "," << p.index_2 << ")";
}

/** \brief Surflet-pair histogram of a whole cloud at the default resolution 5,5,5,5: shares that
 * sum to 1, alpha fastest, then beta, gamma, delta [Wahl 2007, Fig. 2.2, Eq. 2.23]. */
struct SurfletPairHistogram625 {
  float histogram[625] = {}; ///< shares

  /** \brief Number of floats, as PCL asks for it. */
  static constexpr int
  descriptorSize()
  {
    return 625;
  }
};

/** \brief Writes all bins. */
inline std::ostream&
operator<<(std::ostream& os, const SurfletPairHistogram625& p)
{
  for (int i = 0; i < SurfletPairHistogram625::descriptorSize(); ++i)
    os << (i == 0 ? "(" : ", ") << p.histogram[i];
  return os << ")";
}

} // namespace pcl_surflet

// clang-format off
POINT_CLOUD_REGISTER_POINT_STRUCT (pcl_surflet::SurfletPairSignature,
  (float, alpha, alpha)
  (float, beta, beta)
  (float, gamma, gamma)
  (float, delta, delta)
  (std::uint32_t, index_1, index_1)
  (std::uint32_t, index_2, index_2)
)
POINT_CLOUD_REGISTER_POINT_STRUCT (pcl_surflet::SurfletPairHistogram625,
  (float[625], histogram, surflet_pairs)
)
// clang-format on

namespace pcl {

/** Without this, KdTreeFLANN would compare the first three bins only. */
template <>
class DefaultPointRepresentation<pcl_surflet::SurfletPairHistogram625>
    : public DefaultFeatureRepresentation<pcl_surflet::SurfletPairHistogram625> {
};

/** Compares (alpha, beta, gamma, delta), not the indices. */
template <>
class DefaultPointRepresentation<pcl_surflet::SurfletPairSignature>
    : public PointRepresentation<pcl_surflet::SurfletPairSignature> {
public:
  DefaultPointRepresentation() { nr_dimensions_ = 4; }

  /** \brief Writes the four floats of \p p to \p out. */
  void
  copyToFloatArray(const pcl_surflet::SurfletPairSignature& p, float* out) const override
  {
    out[0] = p.alpha;
    out[1] = p.beta;
    out[2] = p.gamma;
    out[3] = p.delta;
  }
};

} // namespace pcl
