/** \file
 * PCL's global descriptors, each behind one function: the rest of the program does not see PCL's
 * templates, which compile slowly. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Signatures of one cloud, all of one length: most descriptors give one, those of clusters
 * several. Empty if there is none. */
using Signatures = std::vector<std::vector<float>>;

/** \brief A cloud as PCL's descriptors want it, its centroid at the origin. */
struct PeerCloud {
  pcl::PointCloud<pcl::PointXYZ>::Ptr points;
  pcl::PointCloud<pcl::Normal>::Ptr normals;
  double reach = 0; ///< about three spacings, for those who look at neighbours
};

PeerCloud toPeerCloud(const SurfletSet& surflets);

/** \name Descriptors of clouds whose diameter is about 1
 * Parameters are PCL's defaults or, for lengths, multiples of the spacing. */
///@{
/** \brief Viewpoint Feature Histogram without the 128 bins of viewing directions: complete clouds
 * have no viewpoint, and with one anywhere VFH would answer worse. */
Signatures vfh(const PeerCloud& cloud);
Signatures cvfh(const PeerCloud& cloud);
Signatures ourCvfh(const PeerCloud& cloud);
Signatures esf(const PeerCloud& cloud);
Signatures gasd(const PeerCloud& cloud);
/** \brief Its thresholds between surface types are metres of household objects: the cloud is scaled
 * to their size. */
Signatures grsd(const PeerCloud& cloud);
/** \brief Point Feature Histogram of the pairs of 500 points, three angles, 5^3 bins. */
Signatures pfh(const PeerCloud& cloud);
/** \brief The same features and the distance, 5^4 bins, of 50,000 drawn pairs. */
Signatures pfhWithDistance(const PeerCloud& cloud);
/** \brief Point Pair Features, 5^4 bins, of 50,000 drawn pairs. */
Signatures ppf(const PeerCloud& cloud);
///@}

struct PeerDescriptor {
  std::string name; ///< as in the option -peers
  Signatures (*compute)(const PeerCloud&);
  bool isolated; ///< crashes on some clouds: to be computed in a process of its own
};

const std::vector<PeerDescriptor>& peerDescriptors();

} // namespace apps
} // namespace pcl_surflet
