// Tutorial: the surflet-pair histogram beside VFH.

#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/core/similarity.h"
#include "pcl_surflet/surflet_pair_histogram.h"

#include <pcl/features/vfh.h>
#include <pcl/point_types.h>

#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;

// describe: begin
/** \brief Both descriptors of one cloud, scaled to a sum of 1. */
struct Descriptors {
  pcl_surflet::Histogram vfh, pairs;
};

Descriptors
describe(const Cloud::ConstPtr& cloud)
{
  Descriptors d;
  pcl::VFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::VFHSignature308> vfh;
  vfh.setInputCloud(cloud);
  vfh.setInputNormals(cloud);
  vfh.setViewPoint(0, 0, 10); // 128 of its 308 bins tell from where the object is seen
  pcl::PointCloud<pcl::VFHSignature308> a;
  vfh.compute(a);

  pcl_surflet::SurfletPairHistogramEstimation<pcl::PointNormal, pcl::PointNormal> pairs;
  pairs.setInputCloud(cloud);
  pairs.setInputNormals(cloud);
  pairs.setNumberOfPairs(100000);
  pairs.setDeltaMax(0.35); // the largest object: sizes count; without it only the shape does
  pcl::PointCloud<pcl_surflet::SurfletPairHistogram625> b;
  pairs.compute(b);

  d.vfh.assign(a[0].histogram, a[0].histogram + 308);
  double sum = 0;
  for (const double v : d.vfh)
    sum += v;
  for (double& v : d.vfh)
    v /= sum;
  d.pairs.assign(b[0].histogram, b[0].histogram + 625); // shares that sum to 1
  return d;
}
// describe: end

/** \brief Points of an object with noise of \p noise metres along the normals, turned anyhow. */
Cloud::Ptr
sample(const std::string& name, double noise, std::uint64_t seed)
{
  const auto surflets = pcl_surflet::displacedAlongNormals(
      pcl_surflet::randomlyRotated(
          pcl_surflet::sampleShape(*pcl_surflet::shapeByName(name), 2000, seed), seed),
      noise, seed);
  Cloud::Ptr cloud(new Cloud);
  for (std::size_t i = 0; i < surflets.size(); ++i) {
    const auto s = surflets[i];
    cloud->push_back({s.x, s.y, s.z, s.nx, s.ny, s.nz});
  }
  return cloud;
}

// nearest: begin
using Examples = std::vector<Descriptors>; // of one object

/** \brief Index of the object with the example most like \p query, by chi-squared distance. */
std::size_t
nearest(const std::vector<Examples>& objects, const Descriptors& query,
        pcl_surflet::Histogram Descriptors::*part)
{
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < objects.size(); ++i)
    for (const auto& example : objects[i])
      if (const double d = pcl_surflet::chiSquared2(example.*part, query.*part); d < least) {
        least = d;
        best = i;
      }
  return best;
}
// nearest: end

} // namespace

int
main()
{
  const std::vector<std::string> names{"bottle", "carafe", "wine_glass", "cup",
                                       "box",    "torus",  "cylinder",   "cone"};
  // train: begin
  std::vector<Examples> once, often; // VFH sees from where: it wants examples from all sides
  for (const auto& name : names) {
    once.push_back({describe(sample(name, 0, 1))});
    often.push_back(once.back());
    for (std::uint64_t k = 2; k <= 24; ++k)
      often.back().push_back(describe(sample(name, 0, k)));
  }
  // train: end
  constexpr std::size_t kTests = 5;
  std::size_t vfh = 0, vfh_often = 0, pairs = 0;
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t k = 0; k < kTests; ++k) {
      const auto query = describe(sample(names[i], 0.001, 1000 + 10 * i + k));
      vfh += nearest(once, query, &Descriptors::vfh) == i ? 1 : 0;
      vfh_often += nearest(often, query, &Descriptors::vfh) == i ? 1 : 0;
      pairs += nearest(once, query, &Descriptors::pairs) == i ? 1 : 0;
    }
  const std::size_t all = names.size() * kTests;
  std::printf("VFH, one example of each object: %zu of %zu right\n", vfh, all);
  std::printf("VFH, 24 examples: %zu of %zu right\n", vfh_often, all);
  std::printf("surflet pairs, one example: %zu of %zu right\n", pairs, all);
  return pairs == all ? EXIT_SUCCESS : EXIT_FAILURE;
}
