#pragma once

#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/octree_region_search.h"

#include <pcl/console/print.h>
#include <pcl/exceptions.h>
#include <pcl/point_types.h>

#include <cmath>
#include <exception>
#include <string>

namespace pcl_surflet {

namespace detail {

template <typename PointT>
Position
positionOf(const PointT& p)
{
  return {p.x, p.y, p.z};
}

/** \brief Where the coordinates of \p cloud lie. */
template <typename PointT>
PointArray
coordinatesOf(const pcl::PointCloud<PointT>& cloud)
{
  static_assert(sizeof(PointT) % sizeof(float) == 0, "points must consist of whole floats");
  if (cloud.empty())
    return {};
  return {&cloud[0].x, &cloud[0].y, &cloud[0].z, sizeof(PointT) / sizeof(float), cloud.size()};
}

/** \brief Where its normals lie; nothing for point types without normals. */
template <typename PointT>
PointArray
normalsOf(const pcl::PointCloud<PointT>& cloud)
{
  if constexpr (pcl::traits::has_normal<PointT>::value)
    if (!cloud.empty())
      return {&cloud[0].normal_x, &cloud[0].normal_y, &cloud[0].normal_z,
              sizeof(PointT) / sizeof(float), cloud.size()};
  return {};
}

template <typename PointT>
Surflet
surfletOf(const PointT& p)
{
  Surflet s{p.x, p.y, p.z, 0, 0, 0};
  if constexpr (pcl::traits::has_normal<PointT>::value) {
    s.nx = p.normal_x;
    s.ny = p.normal_y;
    s.nz = p.normal_z;
  }
  return s;
}

/** \brief Calls \p search with the caller's indices, or with a copy where PCL was built with
 * another index type. */
template <typename Search>
void
withIndices(pcl::Indices& indices, const Search& search)
{
  if constexpr (std::is_same<pcl::index_t, PointIndex>::value)
    search(indices);
  else {
    std::vector<PointIndex> found;
    search(found);
    indices.assign(found.begin(), found.end());
  }
}

/** \brief The points of \p cloud that \p indices names, or all if it names none. */
template <typename PointT, typename Work>
void
forEachQuery(const pcl::PointCloud<PointT>& cloud, const pcl::Indices& indices, unsigned threads,
             const Work& work)
{
  constexpr std::size_t kBlock = 64;
  const std::size_t n = indices.empty() ? cloud.size() : indices.size();
  parallelFor((n + kBlock - 1) / kBlock, threads, [&](std::size_t block, unsigned) {
    for (std::size_t i = block * kBlock; i < std::min(n, (block + 1) * kBlock); ++i)
      work(i, cloud[indices.empty() ? i : static_cast<std::size_t>(indices[i])]);
  });
}

} // namespace detail

template <typename PointT>
OctreeRegionSearch<PointT>::OctreeRegionSearch(Backend backend, bool sorted)
    : Base("OctreeRegionSearch", sorted)
{
  setBackend(backend);
}

template <typename PointT>
void
OctreeRegionSearch<PointT>::setBackend(Backend backend)
{
  options_.backend = backend;
  if (input_)
    setInputCloud(input_, indices_);
  else
    rebuild();
}

template <typename PointT>
typename OctreeRegionSearch<PointT>::Backend
OctreeRegionSearch<PointT>::getBackend() const
{
  return options_.backend;
}

template <typename PointT>
void
OctreeRegionSearch<PointT>::setCellSize(double cell)
{
  if (!(cell >= 0) || !std::isfinite(cell))
    throw pcl::PCLException("[pcl_surflet::OctreeRegionSearch::setCellSize] the cell size must be "
                            "finite and not negative, it is " +
                            std::to_string(cell));
  options_.cell = cell;
}

template <typename PointT>
double
OctreeRegionSearch<PointT>::getCellSize() const
{
  return search_.space() ? search_.space()->options().cell : options_.cell;
}

template <typename PointT>
void
OctreeRegionSearch<PointT>::setDepth(int depth)
{
  if (depth < 0 || depth > 63)
    throw pcl::PCLException("[pcl_surflet::OctreeRegionSearch::setDepth] the depth must be in "
                            "[0, 63], it is " +
                            std::to_string(depth));
  options_.depth = depth;
}

template <typename PointT>
void
OctreeRegionSearch<PointT>::setNumberOfThreads(unsigned threads)
{
  options_.threads = threads;
  search_.setNumberOfThreads(threads);
}

template <typename PointT>
int
OctreeRegionSearch<PointT>::getDepth() const
{
  return options_.depth;
}

template <typename PointT>
unsigned
OctreeRegionSearch<PointT>::getNumberOfThreads() const
{
  return options_.threads;
}

template <typename PointT>
typename OctreeRegionSearch<PointT>::SetInputCloudResult
OctreeRegionSearch<PointT>::setInputCloud(const PointCloudConstPtr& cloud,
                                          const IndicesConstPtr& indices)
{
  input_ = cloud;
  indices_ = indices;
  bool good = cloud != nullptr;
  if (!good)
    PCL_ERROR("[pcl_surflet::OctreeRegionSearch::setInputCloud] no cloud given\n");
  try {
    rebuild();
  }
  catch (const std::exception& e) {
    PCL_ERROR("[pcl_surflet::OctreeRegionSearch::setInputCloud] %s\n", e.what());
    search_ = SpaceSearch();
    good = false;
  }
  return static_cast<SetInputCloudResult>(good);
}

template <typename PointT>
void
OctreeRegionSearch<PointT>::rebuild()
{
  next_index_ = input_ ? static_cast<pcl::index_t>(input_->size()) : 0;
  if (!input_) {
    search_.build(options_, {}, {}, nullptr);
    return;
  }
  const std::vector<PointIndex>* subset = nullptr;
  std::vector<PointIndex> copy;
  if (indices_) {
    copy.assign(indices_->begin(), indices_->end());
    subset = &copy;
  }
  search_.build(options_, detail::coordinatesOf(*input_), detail::normalsOf(*input_), subset);
}

template <typename PointT>
int
OctreeRegionSearch<PointT>::nearestKSearch(const PointT& point, int k, pcl::Indices& k_indices,
                                           std::vector<float>& k_sqr_distances) const
{
  detail::withIndices(k_indices, [&](std::vector<PointIndex>& found) {
    search_.index().nearestSearch(detail::positionOf(point),
                                  k > 0 ? static_cast<std::size_t>(k) : 0, found, k_sqr_distances);
  });
  return static_cast<int>(k_indices.size());
}

template <typename PointT>
int
OctreeRegionSearch<PointT>::radiusSearch(const PointT& point, double radius,
                                         pcl::Indices& k_indices,
                                         std::vector<float>& k_sqr_distances,
                                         unsigned int max_nn) const
{
  detail::withIndices(k_indices, [&](std::vector<PointIndex>& found) {
    search_.radiusSearch(detail::positionOf(point), radius, sorted_results_, max_nn, found,
                         k_sqr_distances);
  });
  return static_cast<int>(k_indices.size());
}

template <typename PointT>
void
OctreeRegionSearch<PointT>::nearestKSearch(const PointCloud& cloud, const pcl::Indices& indices,
                                           int k, std::vector<pcl::Indices>& k_indices,
                                           std::vector<std::vector<float>>& k_sqr_distances) const
{
  const std::size_t n = indices.empty() ? cloud.size() : indices.size();
  k_indices.resize(n);
  k_sqr_distances.resize(n);
  detail::forEachQuery(cloud, indices, options_.threads, [&](std::size_t i, const PointT& p) {
    nearestKSearch(p, k, k_indices[i], k_sqr_distances[i]);
  });
}

template <typename PointT>
void
OctreeRegionSearch<PointT>::radiusSearch(const PointCloud& cloud, const pcl::Indices& indices,
                                         double radius, std::vector<pcl::Indices>& k_indices,
                                         std::vector<std::vector<float>>& k_sqr_distances,
                                         unsigned int max_nn) const
{
  const std::size_t n = indices.empty() ? cloud.size() : indices.size();
  k_indices.resize(n);
  k_sqr_distances.resize(n);
  detail::forEachQuery(cloud, indices, options_.threads, [&](std::size_t i, const PointT& p) {
    radiusSearch(p, radius, k_indices[i], k_sqr_distances[i], max_nn);
  });
}

template <typename PointT>
int
OctreeRegionSearch<PointT>::radiusSearchIndices(const PointT& point, double radius,
                                                pcl::Indices& k_indices) const
{
  detail::withIndices(k_indices, [&](std::vector<PointIndex>& found) {
    search_.index().regionSearch(detail::positionOf(point), radius, found, nullptr);
  });
  return static_cast<int>(k_indices.size());
}

template <typename PointT>
void
OctreeRegionSearch<PointT>::radiusSearchIndices(const PointCloud& cloud,
                                                const pcl::Indices& indices, double radius,
                                                std::vector<pcl::Indices>& k_indices) const
{
  k_indices.resize(indices.empty() ? cloud.size() : indices.size());
  detail::forEachQuery(cloud, indices, options_.threads, [&](std::size_t i, const PointT& p) {
    radiusSearchIndices(p, radius, k_indices[i]);
  });
}

template <typename PointT>
int
OctreeRegionSearch<PointT>::radiusSearchRanges(const PointT& point, double radius,
                                               std::vector<PlaceRange>& ranges) const
{
  if (!search_.linear())
    throw pcl::PCLException("[pcl_surflet::OctreeRegionSearch::radiusSearchRanges] only the Linear "
                            "backend has ranges");
  search_.linear()->regionRanges(detail::positionOf(point), radius, ranges);
  std::size_t count = 0;
  for (const PlaceRange& range : ranges)
    count += range.end - range.begin;
  return static_cast<int>(count);
}

template <typename PointT>
int
OctreeRegionSearch<PointT>::boxSearch(const PointT& min_point, const PointT& max_point,
                                      pcl::Indices& k_indices) const
{
  detail::withIndices(k_indices, [&](std::vector<PointIndex>& found) {
    search_.index().boxSearch(detail::positionOf(min_point), detail::positionOf(max_point), found);
  });
  return static_cast<int>(k_indices.size());
}

template <typename PointT>
pcl::index_t
OctreeRegionSearch<PointT>::addPoint(const PointT& point)
{
  UnrestrictedSpace& space = dynamicSpace("addPoint");
  if (!space.add(static_cast<PointIndex>(next_index_), detail::surfletOf(point)))
    return -1;
  return next_index_++;
}

template <typename PointT>
pcl::index_t
OctreeRegionSearch<PointT>::addPoints(const PointCloud& cloud)
{
  dynamicSpace("addPoints");
  const pcl::index_t first = next_index_;
  search_.addPoints(static_cast<PointIndex>(first), detail::coordinatesOf(cloud),
                    detail::normalsOf(cloud));
  next_index_ += static_cast<pcl::index_t>(cloud.size());
  return first;
}

template <typename PointT>
bool
OctreeRegionSearch<PointT>::removePoint(pcl::index_t index)
{
  return dynamicSpace("removePoint").remove(static_cast<PointIndex>(index));
}

template <typename PointT>
void
OctreeRegionSearch<PointT>::getCells(std::vector<Cell>& cells) const
{
  cells.clear();
  dynamicSpace("getCells").forEachCell([&](const Cell& cell) { cells.push_back(cell); });
}

template <typename PointT>
void
OctreeRegionSearch<PointT>::getCellsInRadius(const PointT& point, double radius,
                                             std::vector<Cell>& cells) const
{
  dynamicSpace("getCellsInRadius").regionCells(detail::positionOf(point), radius, cells);
}

template <typename PointT>
std::size_t
OctreeRegionSearch<PointT>::size() const
{
  return search_.index().size();
}

template <typename PointT>
std::size_t
OctreeRegionSearch<PointT>::memoryUsage() const
{
  return search_.index().memoryUsage();
}

template <typename PointT>
const LinearOctree*
OctreeRegionSearch<PointT>::linearOctree() const
{
  return search_.linear();
}

template <typename PointT>
const UnrestrictedSpace&
OctreeRegionSearch<PointT>::dynamicSpace(const char* method) const
{
  if (!search_.space())
    throw pcl::PCLException(std::string("[pcl_surflet::OctreeRegionSearch::") + method +
                            "] the Linear backend is static: choose Octree or AVL by setBackend()");
  return *search_.space();
}

template <typename PointT>
UnrestrictedSpace&
OctreeRegionSearch<PointT>::dynamicSpace(const char* method)
{
  return const_cast<UnrestrictedSpace&>(
      static_cast<const OctreeRegionSearch<PointT>&>(*this).dynamicSpace(method));
}

} // namespace pcl_surflet

#define PCL_SURFLET_INSTANTIATE_OctreeRegionSearch(T)                                              \
  template class PCL_SURFLET_API pcl_surflet::OctreeRegionSearch<T>
