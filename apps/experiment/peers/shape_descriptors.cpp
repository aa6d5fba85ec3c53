#include "experiment/peers/descriptors.h"

#include <pcl/features/esf.h>
#include <pcl/features/gasd.h>
#include <pcl/features/grsd.h>
#include <pcl/search/kdtree.h>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief Diameter in metres to which clouds are scaled for GRSD. */
constexpr float kGrsdDiameter = 0.5F;

template <class Signature>
Signatures
signaturesOf(const pcl::PointCloud<Signature>& cloud)
{
  Signatures all;
  for (const auto& s : cloud)
    all.emplace_back(std::begin(s.histogram), std::end(s.histogram));
  return all;
}

/** \brief What an estimation makes of points without normals and parameters. */
template <class Signature, class Estimation>
Signatures
estimated(Estimation&& estimation, const PeerCloud& cloud)
{
  estimation.setInputCloud(cloud.points);
  pcl::PointCloud<Signature> out;
  estimation.compute(out);
  return signaturesOf(out);
}

} // namespace

Signatures
esf(const PeerCloud& cloud)
{
  return estimated<pcl::ESFSignature640>(pcl::ESFEstimation<pcl::PointXYZ, pcl::ESFSignature640>(),
                                         cloud);
}

Signatures
gasd(const PeerCloud& cloud)
{
  return estimated<pcl::GASDSignature512>(
      pcl::GASDEstimation<pcl::PointXYZ, pcl::GASDSignature512>(), cloud);
}

Signatures
grsd(const PeerCloud& cloud)
{
  auto scaled = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(*cloud.points);
  for (auto& p : *scaled)
    p.getVector3fMap() *= kGrsdDiameter;
  pcl::GRSDEstimation<pcl::PointXYZ, pcl::Normal, pcl::GRSDSignature21> estimation;
  estimation.setInputCloud(scaled);
  estimation.setInputNormals(cloud.normals);
  estimation.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  estimation.setRadiusSearch(kGrsdDiameter * cloud.reach);
  pcl::PointCloud<pcl::GRSDSignature21> out;
  estimation.compute(out);
  return signaturesOf(out);
}

} // namespace apps
} // namespace pcl_surflet
