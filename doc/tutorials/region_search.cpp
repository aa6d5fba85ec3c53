// Tutorial: OctreeRegionSearch in place of pcl::search::KdTree.

#include "tutorial_data.h"

#include "pcl_surflet/octree_region_search.h"

#include <pcl/common/io.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/filter.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using SearchPtr = pcl::search::Search<pcl::PointXYZ>::Ptr;

// same: begin
/** \brief Normals of \p cloud, whichever search finds the neighbours. */
pcl::PointCloud<pcl::Normal>
normalsBy(const SearchPtr& search, const Cloud::ConstPtr& cloud)
{
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(search); // the only line that changes
  estimation.setRadiusSearch(0.01);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  return normals;
}
// same: end

/** \brief Largest angle between two normals of a place, degrees. */
double
largestAngle(const pcl::PointCloud<pcl::Normal>& a, const pcl::PointCloud<pcl::Normal>& b)
{
  double smallest = 1;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::isfinite(a[i].normal_x) && std::isfinite(b[i].normal_x))
      smallest = std::min(
          smallest, std::abs(double(a[i].getNormalVector3fMap().dot(b[i].getNormalVector3fMap()))));
  return std::acos(smallest) * 180 / M_PI;
}

} // namespace

int
main()
{
  // Two things seen by a camera, apart from each other.
  Cloud::Ptr cloud(new Cloud);
  pcl::Indices kept;
  for (const float x : {0.f, 0.5f}) {
    Cloud part;
    pcl::removeNaNFromPointCloud(
        *tutorial::seenAlone(*pcl_surflet::shapeByName(x > 0 ? "cup" : "bottle"), 0, 1), part,
        kept);
    for (auto& p : part)
      p.x += x;
    *cloud += part;
  }

  const SearchPtr tree(new pcl::search::KdTree<pcl::PointXYZ>);
  const auto search = std::make_shared<pcl_surflet::OctreeRegionSearch<pcl::PointXYZ>>();
  const double angle = largestAngle(normalsBy(tree, cloud), normalsBy(search, cloud));
  std::printf("normals of %s points agree within %.1f degrees\n",
              cloud->size() > 1000 ? "all" : "too few", angle);

  // clusters: begin
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setInputCloud(cloud);
  search->setInputCloud(cloud); // this class, as some others, does not do it itself
  extraction.setSearchMethod(search);
  extraction.setClusterTolerance(0.01);
  extraction.setMinClusterSize(100);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  std::printf("%zu clusters\n", clusters.size());
  // clusters: end

  // regions: begin
  pcl::Indices inside;
  const int found = search->radiusSearchIndices((*cloud)[0], 0.02, inside); // without distances
  // regions: end
  pcl::Indices same;
  std::vector<float> squared;
  const bool all_found = found == search->radiusSearch((*cloud)[0], 0.02, same, squared);

  // dynamic: begin
  using Search = pcl_surflet::OctreeRegionSearch<pcl::PointXYZ>;
  Search growing(Search::Octree); // points may come and go
  growing.setCellSize(0.01);
  growing.setInputCloud(cloud);
  const auto index = growing.addPoint({10, 0, 0}); // anywhere in space
  const int before = growing.radiusSearchIndices({10, 0, 0}, 0.1, inside);
  growing.removePoint(index);
  const int after = growing.radiusSearchIndices({10, 0, 0}, 0.1, inside);
  std::printf("%d point there, then %d\n", before, after);
  // dynamic: end

  return cloud->size() > 1000 && angle < 0.5 && clusters.size() == 2 && all_found && before == 1 &&
                 after == 0
             ? EXIT_SUCCESS
             : EXIT_FAILURE;
}
