#include "region_search/peers.h"

#include "pcl_surflet/core/counter_random.h"

#include <algorithm>

namespace pcl_surflet {
namespace region_search {

namespace {

struct Results {
  pcl::Indices indices;
  std::vector<float> squares;
  std::vector<PlaceRange> ranges;
  std::vector<std::pair<std::uint32_t, float>> matches;
};

} // namespace

Subject::Subject(const Cloud::Ptr& points) : cloud(points)
{
  Point low = points->front(), high = low;
  for (const auto& p : *points)
    for (int a = 0; a < 3; ++a) {
      low.data[a] = std::min(low.data[a], p.data[a]);
      high.data[a] = std::max(high.data[a], p.data[a]);
    }
  for (int a = 0; a < 3; ++a)
    extent = std::max(extent, double(high.data[a]) - low.data[a]);
  CounterRandom random(1);
  for (int i = 0; i < 1024; ++i)
    queries.push_back((*points)[random.below(static_cast<std::uint32_t>(points->size()))]);
  octree.setInputCloud(cloud);
  // PCL's octree gets the cells that suit it best here, and finer ones as users often choose.
  cell = suggestCellSize(
      {&cloud->front().x, &cloud->front().y, &cloud->front().z, 4, cloud->size()}, 8);
  avl.setInputCloud(cloud);
  linear.setInputCloud(cloud);
  pcl_octree = std::make_unique<PclOctree>(cell);
  pcl_octree->setInputCloud(cloud);
  pcl_octree->addPointsFromInputCloud();
  pcl_octree_fine = std::make_unique<PclOctree>(cell / 4);
  pcl_octree_fine->setInputCloud(cloud);
  pcl_octree_fine->addPointsFromInputCloud();
  kdtree.setInputCloud(cloud);
  flann.setInputCloud(cloud);
  nano_cloud = std::make_unique<NanoCloud>(NanoCloud{*cloud});
  nano = std::make_unique<Nano>(3, *nano_cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  nano->buildIndex();
}

std::vector<std::pair<std::string, Query>>
queryKinds()
{
  const auto out = std::make_shared<Results>();
  return {
      {"linear",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.linear.radiusSearch(q, r, out->indices, out->squares));
       }},
      {"linear_indices",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.linear.radiusSearchIndices(q, r, out->indices));
       }},
      {"linear_ranges",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.linear.radiusSearchRanges(q, r, out->ranges));
       }},
      {"octree",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.octree.radiusSearch(q, r, out->indices, out->squares));
       }},
      {"avl",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.avl.radiusSearch(q, r, out->indices, out->squares));
       }},
      {"peer_pcl_octree",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.pcl_octree->radiusSearch(q, r, out->indices, out->squares));
       }},
      {"peer_pcl_octree_fine",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.pcl_octree_fine->radiusSearch(q, r, out->indices, out->squares));
       }},
      {"peer_search_kdtree",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.kdtree.radiusSearch(q, r, out->indices, out->squares));
       }},
      {"peer_kdtree_flann",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.flann.radiusSearch(q, r, out->indices, out->squares));
       }},
      {"peer_nanoflann",
       [out](Subject& s, const Point& q, double r) {
         nanoflann::SearchParams unsorted;
         unsorted.sorted = false;
         return s.nano->radiusSearch(q.data, float(r * r), out->matches, unsorted);
       }},
  };
}

} // namespace region_search
} // namespace pcl_surflet
