/** \file
 * The searches of this library and those that PCL users have, side by side. */
#pragma once

#include "pcl_surflet/octree_region_search.h"
#include "region_search/clouds.h"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/octree/octree_search.h>
#include <pcl/search/kdtree.h>

#include <nanoflann.hpp>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pcl_surflet {
namespace region_search {

/** \brief nanoflann's view of a PCL cloud. */
struct NanoCloud {
  const Cloud& cloud;
  std::size_t
  kdtree_get_point_count() const
  {
    return cloud.size();
  }
  float
  kdtree_get_pt(std::size_t i, std::size_t d) const
  {
    return cloud[i].data[d];
  }
  template <class Box>
  bool
  kdtree_get_bbox(Box&) const
  {
    return false;
  }
};
using Nano = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, NanoCloud>,
                                                 NanoCloud, 3, std::uint32_t>;
using PclOctree = pcl::octree::OctreePointCloudSearch<Point>;

/** \brief One cloud in every search structure, and what to ask. */
struct Subject {
  Cloud::Ptr cloud;
  double extent = 0, cell = 0;
  Cloud queries;
  OctreeRegionSearch<Point> linear, octree{OctreeRegionSearch<Point>::Octree},
      avl{OctreeRegionSearch<Point>::AVL};
  std::unique_ptr<PclOctree> pcl_octree, pcl_octree_fine;
  pcl::search::KdTree<Point> kdtree{false};
  pcl::KdTreeFLANN<Point> flann{false};
  std::unique_ptr<NanoCloud> nano_cloud;
  std::unique_ptr<Nano> nano;

  explicit Subject(const Cloud::Ptr& points);
};

/** \brief Searches around a point within a radius and returns how many points were found. */
using Query = std::function<std::size_t(Subject&, const Point&, double)>;

/** \brief The ways to ask; those of peers begin with "peer". */
std::vector<std::pair<std::string, Query>> queryKinds();

} // namespace region_search
} // namespace pcl_surflet
