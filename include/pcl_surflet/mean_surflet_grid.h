/** \file
 * MeanSurfletGrid: one mean surflet per cell, a filter beside pcl::VoxelGrid. */
#pragma once

#include "pcl_surflet/compat.h"
#include "pcl_surflet/core/cell_reduction.h"

#include <pcl/PCLPointCloud2.h>
#include <pcl/filters/filter.h>

namespace pcl_surflet {

/** \brief Parameters and by-products that the filter has for every kind of cloud. */
class PCL_SURFLET_API MeanSurfletGridBase {
public:
  /** \brief Edge of the cubic cells in the cloud's unit; must be set. Positive and finite. */
  void
  setLeafSize(double leaf)
  {
    options_.leaf = leaf;
  }
  /** \brief 0 if it was not set. */
  double
  getLeafSize() const
  {
    return options_.leaf;
  }

  /** \brief Cells whose mean normal is shorter than this are left out: their normals cancel, as on
   * a thin wall seen from both sides. In [0, 1], 0.1 by default. */
  void
  setMinimumMeanNormal(double length)
  {
    options_.min_mean_normal = length;
  }
  /** \brief See setMinimumMeanNormal(). */
  double
  getMinimumMeanNormal() const
  {
    return options_.min_mean_normal;
  }

  /** \brief After filter(): for every point of the input cloud the output point that stands for it,
   * or CellReduction::no_cell: the point is not finite, not among the indices, or its cell's
   * normals cancel. */
  const std::vector<std::uint32_t>&
  getCellOfPoint() const
  {
    return cell_of_;
  }

  /** \brief After filter(): how many points each output point stands for. */
  const std::vector<std::uint32_t>&
  getPointCounts() const
  {
    return counts_;
  }

  /** \brief After filter(): cells left out because their normals cancel. */
  std::size_t
  getNumberOfCancelledCells() const
  {
    return cancelled_cells_;
  }

protected:
  MeanSurfletGridBase() = default;

  /** \brief Reduces \p set, whose surflet i is point \p indices[i] of \p cloud_size; false, having
   * printed what is wrong, if the parameters are. */
  bool reduce(const SurfletSet& set, const std::vector<std::int32_t>& indices,
              std::size_t cloud_size, SurfletSet& cells, std::vector<std::int32_t>& first_points);

  CellReductionOptions options_;       ///< what the setters set
  std::vector<std::uint32_t> cell_of_; ///< getCellOfPoint()
  std::vector<std::uint32_t> counts_;  ///< getPointCounts()
  std::size_t cancelled_cells_ = 0;    ///< getNumberOfCancelledCells()
};

/** \brief Reduces an oriented cloud to one mean surflet per cell [Wahl 2007, Sec. 4.3.1].
 *
 * \code
 * pcl_surflet::MeanSurfletGrid<pcl::PointNormal> grid;
 * grid.setInputCloud (cloud);
 * grid.setLeafSize (0.005);
 * grid.filter (cells);
 * \endcode
 *
 * Unlike pcl::VoxelGrid the normal is scaled to unit length again, cells whose normals cancel are
 * left out and counted, and points can be traced to their cell. Cells lie at multiples of the leaf
 * size; output points come in the order of the cells' Morton keys, so that neighbours lie together.
 * Fields other than position and normal are those of the cell's first point. Points with a
 * non-finite coordinate or normal are left out; getRemovedIndices() (ask the constructor for it)
 * lists them and those of cancelled cells. The result does not depend on anything but the input.
 *
 * Errors (no leaf size, a leaf too small for the cloud) are printed and give an empty output.
 *
 * \tparam PointT any point type with x, y, z, normal_x, normal_y, normal_z, or pcl::PCLPointCloud2
 */
template <typename PointT>
class MeanSurfletGrid : public pcl::Filter<PointT>, public MeanSurfletGridBase {
public:
  ///@{
  /** \brief As PCL's classes have it. */
  using PointCloud = typename pcl::Filter<PointT>::PointCloud;
  using Ptr = pcl::shared_ptr<MeanSurfletGrid<PointT>>;
  using ConstPtr = pcl::shared_ptr<const MeanSurfletGrid<PointT>>;
  ///@}

  /** \brief \param extract_removed_indices whether getRemovedIndices() will be asked for */
  explicit MeanSurfletGrid(bool extract_removed_indices = false);

protected:
  using pcl::Filter<PointT>::input_;
  using pcl::Filter<PointT>::indices_;
  using pcl::Filter<PointT>::removed_indices_;
  using pcl::Filter<PointT>::extract_removed_indices_;
  using pcl::Filter<PointT>::filter_name_;

  /** \brief What filter() calls. */
  void applyFilter(PointCloud& output) override;
};

/** \brief The same for clouds whose fields are known at run time only.
 *
 * Needs x, y, z, normal_x, normal_y, normal_z as single FLOAT32 fields in the machine's byte order;
 * the output has the fields of the input. */
template <>
class PCL_SURFLET_API MeanSurfletGrid<pcl::PCLPointCloud2>
    : public pcl::Filter<pcl::PCLPointCloud2>, public MeanSurfletGridBase {
public:
  ///@{
  /** \brief As PCL's classes have it. */
  using Ptr = pcl::shared_ptr<MeanSurfletGrid<pcl::PCLPointCloud2>>;
  using ConstPtr = pcl::shared_ptr<const MeanSurfletGrid<pcl::PCLPointCloud2>>;
  ///@}

  /** \brief \param extract_removed_indices whether getRemovedIndices() will be asked for */
  explicit MeanSurfletGrid(bool extract_removed_indices = false);

protected:
  /** \brief What filter() calls. */
  void applyFilter(pcl::PCLPointCloud2& output) override;
};

} // namespace pcl_surflet

#ifdef PCL_NO_PRECOMPILE
#include "pcl_surflet/impl/mean_surflet_grid.hpp"
#endif
