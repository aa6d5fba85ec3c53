#include "experiment/peers/descriptors.h"

#include "pcl_surflet/core/geometry.h"

namespace pcl_surflet {
namespace apps {

PeerCloud
toPeerCloud(const SurfletSet& s)
{
  PeerCloud cloud;
  cloud.points.reset(new pcl::PointCloud<pcl::PointXYZ>);
  cloud.normals.reset(new pcl::PointCloud<pcl::Normal>);
  const Extent e = computeExtent(s);
  for (std::size_t i = 0; i < s.size(); ++i) {
    cloud.points->push_back({static_cast<float>(s.x[i] - e.centroid[0]),
                             static_cast<float>(s.y[i] - e.centroid[1]),
                             static_cast<float>(s.z[i] - e.centroid[2])});
    cloud.normals->push_back({s.nx[i], s.ny[i], s.nz[i]});
  }
  // The eighth neighbour is about 1.6 spacings away.
  cloud.reach = 1.9 * surfaceDensity(s).spacing;
  return cloud;
}

const std::vector<PeerDescriptor>&
peerDescriptors()
{
  static const std::vector<PeerDescriptor> all = {
      {"vfh", vfh, false},         {"cvfh", cvfh, false},
      {"our-cvfh", ourCvfh, true}, {"esf", esf, false},
      {"gasd", gasd, false},       {"grsd", grsd, false},
      {"pfh", pfh, false},         {"pfh4", pfhWithDistance, false},
      {"ppf", ppf, false}};
  return all;
}

} // namespace apps
} // namespace pcl_surflet
