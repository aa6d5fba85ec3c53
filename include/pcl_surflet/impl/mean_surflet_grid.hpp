#pragma once

#include "pcl_surflet/mean_surflet_grid.h"

#include <pcl/point_types.h>

namespace pcl_surflet {

template <typename PointT>
MeanSurfletGrid<PointT>::MeanSurfletGrid(bool extract_removed_indices)
    : pcl::Filter<PointT>(extract_removed_indices)
{
  filter_name_ = "MeanSurfletGrid";
}

template <typename PointT>
void
MeanSurfletGrid<PointT>::applyFilter(PointCloud& output)
{
  SurfletSet set, cells;
  set.reserve(indices_->size());
  for (const auto i : *indices_) {
    const PointT& p = (*input_)[static_cast<std::size_t>(i)];
    set.push_back({p.x, p.y, p.z, p.normal_x, p.normal_y, p.normal_z});
  }
  const std::vector<std::int32_t> indices(indices_->begin(), indices_->end());
  std::vector<std::int32_t> first_points;
  removed_indices_->clear();
  output.clear();
  output.is_dense = true;
  if (!reduce(set, indices, input_->size(), cells, first_points))
    return;
  output.resize(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    PointT p = (*input_)[static_cast<std::size_t>(first_points[c])];
    p.x = cells.x[c];
    p.y = cells.y[c];
    p.z = cells.z[c];
    p.normal_x = cells.nx[c];
    p.normal_y = cells.ny[c];
    p.normal_z = cells.nz[c];
    output[c] = p;
  }
  for (std::size_t k = 0; extract_removed_indices_ && k < indices_->size(); ++k)
    if (cell_of_[static_cast<std::size_t>((*indices_)[k])] == CellReduction::no_cell)
      removed_indices_->push_back((*indices_)[k]);
}

} // namespace pcl_surflet

#define PCL_SURFLET_INSTANTIATE_MeanSurfletGrid(T)                                                 \
  template class PCL_SURFLET_API pcl_surflet::MeanSurfletGrid<T>
