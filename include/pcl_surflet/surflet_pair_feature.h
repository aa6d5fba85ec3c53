/** \file
 * SurfletPairFeature: the features of the pairs of an oriented cloud. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"
#include "pcl_surflet/impl/whole_cloud_feature.h"
#include "pcl_surflet/point_types.h"

#include <cstdint>
#include <vector>

namespace pcl_surflet {

namespace detail {

/** \brief What SurfletPairFeature wants computed, free of point types. */
struct PairFeatureRequest {
  std::uint64_t pairs = 0;     ///< pairs to draw; 0: all
  std::uint64_t seed = 1;      ///< of the drawn pairs
  double maximum_distance = 0; ///< longest pair; 0: no limit
  unsigned threads = 0;        ///< 0: all
};

/** \brief Number of all pairs, 0 if too many to be output. */
PCL_SURFLET_API std::uint64_t countablePairs(std::size_t surflets);

/** \brief Features of the pairs asked for; indices are those of \p surflets. \p rejected counts
 * pairs without feature. */
PCL_SURFLET_API std::vector<SurfletPairSignature>
computePairSignatures(const SurfletSet& surflets, const PairFeatureRequest& request,
                      std::uint64_t& rejected);

} // namespace detail

/** \brief Computes the four-dimensional feature (alpha, beta, gamma, delta) of pairs of oriented
 * points [Wahl 2007, Eq. 2.2-2.10], one output point per pair.
 *
 * \code
 * pcl_surflet::SurfletPairFeature<pcl::PointXYZ, pcl::Normal> feature;
 * feature.setInputCloud (cloud);
 * feature.setInputNormals (normals);
 * feature.setNumberOfPairs (10000);
 * pcl::PointCloud<pcl_surflet::SurfletPairSignature> pairs;
 * feature.compute (pairs);
 * \endcode
 *
 * Without setNumberOfPairs() all m(m-1)/2 pairs of the indexed points are computed, each unordered
 * pair once. Output points carry the two indices into the input cloud. Points that are not finite
 * or have no usable normal take part in no pair; normals are scaled to unit length. Pairs without a
 * feature (coincident points, both normals along the connecting line) are left out and counted.
 *
 * The output is unorganised (height 1) and dense. On misuse (no input, normals missing or of
 * another size, a search surface that is not the input) PCL_ERROR says what is wrong and the output
 * is empty.
 *
 * For clouds of a type with normals (pcl::PointNormal) the input serves as normals unless others
 * are set. The result does not depend on the number of threads. */
template <typename PointInT, typename PointNT, typename PointOutT = SurfletPairSignature>
class SurfletPairFeature : public detail::WholeCloudFeature<PointInT, PointNT, PointOutT> {
public:
  ///@{
  /** \brief As PCL's classes have it. */
  using Ptr = pcl::shared_ptr<SurfletPairFeature<PointInT, PointNT, PointOutT>>;
  using ConstPtr = pcl::shared_ptr<const SurfletPairFeature<PointInT, PointNT, PointOutT>>;
  using typename detail::WholeCloudFeature<PointInT, PointNT, PointOutT>::PointCloudOut;
  ///@}

  SurfletPairFeature() { this->feature_name_ = "SurfletPairFeature"; }

  /** \brief Pairs to draw at random, with replacement; 0 (default): all pairs. No more than 2^31 -
   * 1 are output, PCL's clouds hold no more. */
  void
  setNumberOfPairs(std::uint64_t pairs)
  {
    request_.pairs = pairs;
  }
  /** \brief See setNumberOfPairs(). */
  std::uint64_t
  getNumberOfPairs() const
  {
    return request_.pairs;
  }
  /** \brief Seed of the drawn pairs, default 1. */
  void
  setSeed(std::uint64_t seed)
  {
    request_.seed = seed;
  }
  /** \brief Leaves out pairs farther apart than this, in the cloud's unit; 0 (default): no limit.
   *
   * Drawing goes on until the number of pairs is reached, but for no more than 100 times as many
   * draws: fewer pairs are output where short pairs are rare. */
  void
  setMaximumDistance(double distance)
  {
    request_.maximum_distance = distance;
  }
  /** \brief See setMaximumDistance(). */
  double
  getMaximumDistance() const
  {
    return request_.maximum_distance;
  }
  /** \brief Threads, 0 (default): all. */
  void
  setNumberOfThreads(unsigned threads = 0)
  {
    request_.threads = threads;
  }
  /** \brief Pairs without feature met by the last compute(). */
  std::uint64_t
  getNumberOfRejectedPairs() const
  {
    return rejected_;
  }

  /** \brief See detail::WholeCloudFeature::compute(). */
  void
  compute(PointCloudOut& output)
  {
    rejected_ = 0;
    detail::WholeCloudFeature<PointInT, PointNT, PointOutT>::compute(output);
  }

private:
  void computeFeature(PointCloudOut& output) override;

  detail::PairFeatureRequest request_;
  std::uint64_t rejected_ = 0;
};

} // namespace pcl_surflet

#ifdef PCL_NO_PRECOMPILE
#include "pcl_surflet/impl/surflet_pair_feature.hpp"
#endif
