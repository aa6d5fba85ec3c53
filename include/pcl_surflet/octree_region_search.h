/** \file
 * OctreeRegionSearch: the space representation as a search method of PCL. */
#pragma once

#include "pcl_surflet/compat.h"
#include "pcl_surflet/core/space_search.h"

#include <pcl/search/search.h>

#include <type_traits>

namespace pcl_surflet {

/** \brief Region, nearest-neighbour and box search on the space representation of ch. 4
 * [Wahl 2007], for use wherever PCL takes a pcl::search::Search.
 *
 * \code
 * auto search = std::make_shared<pcl_surflet::OctreeRegionSearch<pcl::PointXYZ>> ();
 * pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
 * estimation.setInputCloud (cloud);
 * estimation.setSearchMethod (search); // the estimation hands its cloud to the search
 * estimation.setRadiusSearch (0.02);
 *
 * search->setInputCloud (cloud);
 * pcl::Indices inside;
 * search->radiusSearchIndices (point, 0.1, inside); // no distances: several times as fast
 * \endcode
 *
 * Backends:
 * - Linear (default): static and by far the fastest to build and to search; setInputCloud()
 *   rebuilds it. 18 bytes a point.
 * - Octree, AVL: dynamic; addPoint() and removePoint() at any time, anywhere in space, with mean
 *   surflets per cell. The octree searches faster, the AVL tree needs less memory.
 *
 * The radius is inclusive [Wahl 2007, Eq. 4.13], as in pcl::octree; the kd-trees of PCL take
 * d < r. Distances are squared, computed in single precision as (dx * dx + dy * dy) + dz * dz.
 * nearestKSearch() is always sorted, with ties by index; radiusSearch() is sorted where
 * setSortedResults() asks for it, and with max_nn returns the nearest max_nn.
 * Points with a non-finite coordinate are skipped; such queries find nothing (0). So do queries
 * with a negative radius or before setInputCloud().
 *
 * The search keeps its own copy of the coordinates: later changes of the cloud go unnoticed. Const
 * calls may run in several threads at once; changes need a lock.
 *
 * For point types of one's own define PCL_NO_PRECOMPILE before including this header; x, y and z
 * must be floats. */
template <typename PointT>
class OctreeRegionSearch : public pcl::search::Search<PointT> {
  using Base = pcl::search::Search<PointT>;

public:
  using Ptr = pcl::shared_ptr<OctreeRegionSearch<PointT>>;            ///< as PCL's classes
  using ConstPtr = pcl::shared_ptr<const OctreeRegionSearch<PointT>>; ///< as PCL's classes
  using Base::nearestKSearch;
  using Base::radiusSearch;
  using typename Base::IndicesConstPtr;
  using typename Base::PointCloud;
  using typename Base::PointCloudConstPtr;
  /** \brief void up to PCL 1.13, then bool. */
  using SetInputCloudResult = compat::SetInputCloudResult<Base>;

  /** \brief Representations; which to take: doc/space.md. */
  using Backend = SpaceBackend;
  static constexpr Backend Octree = Backend::Octree; ///< dynamic, octrees of cells
  static constexpr Backend AVL = Backend::AVL; ///< dynamic, balanced trees: less memory, slower
  static constexpr Backend Linear = Backend::Linear; ///< static, the fastest

  /** \brief Empty. \param backend as setBackend() \param sorted as setSortedResults() */
  explicit OctreeRegionSearch(Backend backend = Linear, bool sorted = false);

  /** \brief Chooses the representation; points already there are taken over from the input cloud,
   * those added by addPoint() are lost. Input that cannot be taken over leaves the search empty, as
   * setInputCloud() does. */
  void setBackend(Backend backend);
  Backend getBackend() const; ///< the representation in use

  /** \brief Edge of the atomic cells of the dynamic backends, in the cloud's unit; 0 (default):
   * chosen at setInputCloud() for about 32 points a cell (0.01 without a cloud). Takes effect
   * at the next setInputCloud() or setBackend().
   * \throws pcl::PCLException unless 0 <= cell < inf */
  void setCellSize(double cell);
  double getCellSize() const; ///< the edge in use; 0 with the Linear backend if none was set

  /** \brief Depth d_max of a cube of the dynamic backends, 8 by default; takes effect like
   * setCellSize(). \throws pcl::PCLException outside [0, 63] */
  void setDepth(int depth);
  int getDepth() const; ///< as set

  /** \brief Threads of batch queries and of searches across cubes, 1 by default, 0 = all of the
   * machine. Results do not depend on it. */
  void setNumberOfThreads(unsigned threads);
  unsigned getNumberOfThreads() const; ///< 0: all

  /** \brief Builds the representation of \p cloud, or of its points \p indices. */
  SetInputCloudResult setInputCloud(const PointCloudConstPtr& cloud,
                                    const IndicesConstPtr& indices = IndicesConstPtr()) override;

  /** \brief The \p k points nearest to \p point, or all if there are fewer; indices of the cloud.
   * \return number of points found */
  int nearestKSearch(const PointT& point, int k, pcl::Indices& k_indices,
                     std::vector<float>& k_sqr_distances) const override;

  /** \brief All points within \p radius; with \p max_nn > 0 at most so many, the nearest.
   * \return number of points found */
  int radiusSearch(const PointT& point, double radius, pcl::Indices& k_indices,
                   std::vector<float>& k_sqr_distances, unsigned int max_nn = 0) const override;

  /** \brief Batch: the neighbours of the points \p indices of \p cloud (of all, if empty), shared
   * among the threads. */
  void nearestKSearch(const PointCloud& cloud, const pcl::Indices& indices, int k,
                      std::vector<pcl::Indices>& k_indices,
                      std::vector<std::vector<float>>& k_sqr_distances) const override;
  /** \brief Batch of radiusSearch(), as above. */
  void radiusSearch(const PointCloud& cloud, const pcl::Indices& indices, double radius,
                    std::vector<pcl::Indices>& k_indices,
                    std::vector<std::vector<float>>& k_sqr_distances,
                    unsigned int max_nn = 0) const override;

  /** \brief Region search without distances. \return number of points found */
  int radiusSearchIndices(const PointT& point, double radius, pcl::Indices& k_indices) const;

  /** \brief Batch of radiusSearchIndices(). */
  void radiusSearchIndices(const PointCloud& cloud, const pcl::Indices& indices, double radius,
                           std::vector<pcl::Indices>& k_indices) const;

  /** \brief Region search without copying, Linear backend only: ranges of places in the order of
   * linearOctree(), which tells index and position of each place. \return number of points found
   * \throws pcl::PCLException with a dynamic backend */
  int radiusSearchRanges(const PointT& point, double radius, std::vector<PlaceRange>& ranges) const;

  /** \brief All points with min <= p <= max in every coordinate. \return number of points found */
  int boxSearch(const PointT& min_point, const PointT& max_point, pcl::Indices& k_indices) const;

  /** \brief Adds a point to a dynamic backend; its normal counts if PointT has one.
   * \return the point's index from now on (indices continue those of the input cloud and are not
   * used twice), or -1 if it is not finite
   * \throws pcl::PCLException with the Linear backend */
  pcl::index_t addPoint(const PointT& point);

  /** \brief Adds the points of \p cloud in order. \return the index of the first; non-finite ones
   * take an index but cannot be found. \throws pcl::PCLException with the Linear backend */
  pcl::index_t addPoints(const PointCloud& cloud);

  /** \brief Removes a point from a dynamic backend; false if there is none with this index.
   * \throws pcl::PCLException with the Linear backend */
  bool removePoint(pcl::index_t index);

  /** \brief The occupied cells with their mean surflets.
   * \throws pcl::PCLException with the Linear backend: use MeanSurfletGrid or reduceToCells() */
  void getCells(std::vector<Cell>& cells) const;

  /** \brief The cells whose mean position lies within \p radius of \p point.
   * \throws pcl::PCLException with the Linear backend */
  void getCellsInRadius(const PointT& point, double radius, std::vector<Cell>& cells) const;

  std::size_t size() const;                 ///< number of points that can be found
  std::size_t memoryUsage() const;          ///< bytes beside the cloud
  const LinearOctree* linearOctree() const; ///< null with a dynamic backend

protected:
  using Base::indices_;
  using Base::input_;
  using Base::name_;
  using Base::sorted_results_;

private:
  void rebuild();
  UnrestrictedSpace& dynamicSpace(const char* method);
  const UnrestrictedSpace& dynamicSpace(const char* method) const;

  SpaceSearch::Options options_;
  SpaceSearch search_;
  pcl::index_t next_index_ = 0;
};

} // namespace pcl_surflet

#ifdef PCL_NO_PRECOMPILE
#include "pcl_surflet/impl/octree_region_search.hpp"
#endif
