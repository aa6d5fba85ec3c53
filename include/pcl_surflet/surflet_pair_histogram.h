/** \file
 * SurfletPairHistogramEstimation: one histogram per cloud, where VFHEstimation stands. */
#pragma once

#include "pcl_surflet/core/pair_histogram.h"
#include "pcl_surflet/core/surflet_set.h"
#include "pcl_surflet/impl/whole_cloud_feature.h"
#include "pcl_surflet/point_types.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {

namespace detail {

/** \brief What the estimation wants computed, free of point types. */
struct HistogramRequest {
  Resolution resolution;
  std::uint64_t pairs = 1000000;
  std::uint64_t seed = 1;
  double delta_max = 0;
  unsigned threads = 0;
};

/** \brief Empty, or why the request cannot be served with output points of \p bins bins. */
PCL_SURFLET_API std::string requestProblem(const HistogramRequest& request, int bins);

/** \brief The histogram, empty if no pair has a feature. */
PCL_SURFLET_API std::vector<float> computePairHistogram(const SurfletSet& surflets,
                                                        const HistogramRequest& request);

} // namespace detail

/** \brief Global descriptor of a cloud: the histogram of its surflet-pair features
 * [Wahl 2007, Sec. 2.3].
 *
 * Drops in where pcl::VFHEstimation stands, but needs no viewpoint:
 * \code
 * pcl_surflet::SurfletPairHistogramEstimation<pcl::PointXYZ, pcl::Normal> estimation;
 * estimation.setInputCloud (cloud);
 * estimation.setInputNormals (normals);
 * pcl::PointCloud<pcl_surflet::SurfletPairHistogram625> descriptor;
 * estimation.compute (descriptor); // one point
 * \endcode
 *
 * The output is one point whose \c histogram holds shares that sum to 1. It can be searched with
 * pcl::KdTreeFLANN and written as a PCD that pcl_viewer plots. PointOutT may be any type with a
 * float histogram[] and descriptorSize(), e.g. pcl::Histogram<2401> with setResolution({7,7,7,7});
 * define PCL_NO_PRECOMPILE before including this header then, as for point types of your own.
 *
 * Histograms are comparable only if they were made with the same delta_max: set that of the model
 * (or of the largest object) with setDeltaMax(); by default it is measured, which makes the
 * descriptor independent of scale.
 *
 * Invalid points and misuse are treated as by SurfletPairFeature. If no pair has a feature the
 * output is empty. */
template <typename PointInT, typename PointNT, typename PointOutT = SurfletPairHistogram625>
class SurfletPairHistogramEstimation
    : public detail::WholeCloudFeature<PointInT, PointNT, PointOutT> {
public:
  ///@{
  /** \brief As PCL's classes have it. */
  using Ptr = pcl::shared_ptr<SurfletPairHistogramEstimation<PointInT, PointNT, PointOutT>>;
  using ConstPtr =
      pcl::shared_ptr<const SurfletPairHistogramEstimation<PointInT, PointNT, PointOutT>>;
  using typename detail::WholeCloudFeature<PointInT, PointNT, PointOutT>::PointCloudOut;
  ///@}

  SurfletPairHistogramEstimation() { this->feature_name_ = "SurfletPairHistogramEstimation"; }

  /** \brief Bins per dimension, default 5,5,5,5. Their product must be PointOutT's size. */
  void
  setResolution(const Resolution& resolution)
  {
    request_.resolution = resolution;
  }
  /** \brief Bins per dimension. */
  const Resolution&
  getResolution() const
  {
    return request_.resolution;
  }
  /** \brief Upper end of delta in the cloud's unit; 0 (default): the largest distance in the cloud.
   */
  void
  setDeltaMax(double delta_max)
  {
    request_.delta_max = delta_max;
  }
  /** \brief Upper end of delta; 0: the largest distance in the cloud. */
  double
  getDeltaMax() const
  {
    return request_.delta_max;
  }
  /** \brief Pairs to draw, positive, default 1,000,000; a cloud that has no more pairs gives all of
   * them. */
  void
  setNumberOfPairs(std::uint64_t pairs)
  {
    request_.pairs = pairs;
  }
  /** \brief Pairs to draw. */
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
  /** \brief Seed of the drawn pairs. */
  std::uint64_t
  getSeed() const
  {
    return request_.seed;
  }
  /** \brief Threads, 0 (default): all. The result does not depend on it. */
  void
  setNumberOfThreads(unsigned threads = 0)
  {
    request_.threads = threads;
  }
  /** \brief Threads, 0: all. */
  unsigned
  getNumberOfThreads() const
  {
    return request_.threads;
  }

private:
  void computeFeature(PointCloudOut& output) override;

  detail::HistogramRequest request_;
};

} // namespace pcl_surflet

#ifdef PCL_NO_PRECOMPILE
#include "pcl_surflet/impl/surflet_pair_histogram.hpp"
#endif
