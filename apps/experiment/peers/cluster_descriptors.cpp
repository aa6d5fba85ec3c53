#include "experiment/peers/descriptors.h"

#include <pcl/features/cvfh.h>
#include <pcl/features/our_cvfh.h>
#include <pcl/features/vfh.h>
#include <pcl/search/kdtree.h>

namespace pcl_surflet {
namespace apps {
namespace {

using Signature = pcl::VFHSignature308;

/** \brief Bins of VFH before those of the viewing direction. */
constexpr std::size_t kShapeBins = 180;

Signatures
signaturesOf(const pcl::PointCloud<Signature>& cloud, std::size_t bins)
{
  Signatures all;
  for (const auto& s : cloud)
    all.emplace_back(s.histogram, s.histogram + bins);
  return all;
}

/** \brief Parameters as in PCL's tutorials, lengths by the spacing. */
template <class Estimation>
pcl::PointCloud<Signature>
clusterSignatures(Estimation& estimation, const PeerCloud& cloud)
{
  estimation.setInputCloud(cloud.points);
  estimation.setInputNormals(cloud.normals);
  estimation.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  estimation.setRadiusNormals(static_cast<float>(cloud.reach));
  estimation.setClusterTolerance(static_cast<float>(cloud.reach));
  estimation.setEPSAngleThreshold(static_cast<float>(5.0 / 180.0 * M_PI));
  estimation.setCurvatureThreshold(1.0F);
  estimation.setNormalizeBins(false);
  pcl::PointCloud<Signature> out;
  estimation.compute(out);
  return out;
}

} // namespace

Signatures
vfh(const PeerCloud& cloud)
{
  pcl::VFHEstimation<pcl::PointXYZ, pcl::Normal, Signature> estimation;
  estimation.setInputCloud(cloud.points);
  estimation.setInputNormals(cloud.normals);
  estimation.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  pcl::PointCloud<Signature> out;
  estimation.compute(out);
  return signaturesOf(out, kShapeBins);
}

Signatures
cvfh(const PeerCloud& cloud)
{
  pcl::CVFHEstimation<pcl::PointXYZ, pcl::Normal, Signature> estimation;
  return signaturesOf(clusterSignatures(estimation, cloud), Signature::descriptorSize());
}

Signatures
ourCvfh(const PeerCloud& cloud)
{
  pcl::OURCVFHEstimation<pcl::PointXYZ, pcl::Normal, Signature> estimation;
  estimation.setAxisRatio(0.8F);
  return signaturesOf(clusterSignatures(estimation, cloud), Signature::descriptorSize());
}

} // namespace apps
} // namespace pcl_surflet
