#include "pcl_surflet/impl/mean_surflet_grid.hpp"

#include <pcl/console/print.h>

#include <array>
#include <cstring>
#include <exception>

namespace pcl_surflet {

namespace {

const char* const kFieldNames[6] = {"x", "y", "z", "normal_x", "normal_y", "normal_z"};

/** \brief Byte offsets of position and normal in a point; false, having said why, if one lacks. */
bool
findFields(const pcl::PCLPointCloud2& cloud, std::array<std::size_t, 6>& offsets)
{
  for (int k = 0; k < 6; ++k) {
    bool found = false;
    for (const auto& field : cloud.fields)
      if (field.name == kFieldNames[k] && field.count == 1 &&
          field.datatype == pcl::PCLPointField::FLOAT32) {
        offsets[static_cast<std::size_t>(k)] = field.offset;
        found = field.offset + sizeof(float) <= cloud.point_step;
      }
    if (!found) {
      PCL_ERROR("[pcl_surflet::MeanSurfletGrid::applyFilter] the cloud has no field %s of type "
                "FLOAT32: estimate normals first\n",
                kFieldNames[k]);
      return false;
    }
  }
  return true;
}

/** \brief Where point \p i begins: rows may be padded. */
std::size_t
pointOffset(const pcl::PCLPointCloud2& cloud, std::size_t i)
{
  return i / cloud.width * cloud.row_step + i % cloud.width * cloud.point_step;
}

Surflet
readSurflet(const std::uint8_t* point, const std::array<std::size_t, 6>& offsets)
{
  float v[6];
  for (std::size_t k = 0; k < 6; ++k)
    std::memcpy(&v[k], point + offsets[k], sizeof(float));
  return {v[0], v[1], v[2], v[3], v[4], v[5]};
}

void
writeSurflet(const Surflet& s, std::uint8_t* point, const std::array<std::size_t, 6>& offsets)
{
  const float v[6] = {s.x, s.y, s.z, s.nx, s.ny, s.nz};
  for (std::size_t k = 0; k < 6; ++k)
    std::memcpy(point + offsets[k], &v[k], sizeof(float));
}

/** \brief An output without points but with the fields of \p input. */
pcl::PCLPointCloud2
emptyLike(const pcl::PCLPointCloud2& input)
{
  pcl::PCLPointCloud2 output;
  output.header = input.header;
  output.fields = input.fields;
  output.is_bigendian = input.is_bigendian;
  output.point_step = input.point_step;
  output.height = 1;
  output.is_dense = 1;
  return output;
}

} // namespace

bool
MeanSurfletGridBase::reduce(const SurfletSet& set, const std::vector<std::int32_t>& indices,
                            std::size_t cloud_size, SurfletSet& cells,
                            std::vector<std::int32_t>& first_points)
{
  cell_of_.assign(cloud_size, CellReduction::no_cell);
  counts_.clear();
  cancelled_cells_ = 0;
  CellReduction reduction;
  try {
    reduction = reduceToCells(set, options_);
  }
  catch (const std::exception& e) {
    PCL_ERROR("[pcl_surflet::MeanSurfletGrid::applyFilter] %s\n", e.what());
    return false;
  }
  first_points.assign(reduction.cells.size(), -1);
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const std::uint32_t cell = reduction.cell_of[k];
    cell_of_[static_cast<std::size_t>(indices[k])] = cell;
    if (cell != CellReduction::no_cell && first_points[cell] < 0)
      first_points[cell] = indices[k];
  }
  cells = std::move(reduction.cells);
  counts_ = std::move(reduction.counts);
  cancelled_cells_ = reduction.cancelled_cells;
  return true;
}

MeanSurfletGrid<pcl::PCLPointCloud2>::MeanSurfletGrid(bool extract_removed_indices)
    : pcl::Filter<pcl::PCLPointCloud2>(extract_removed_indices)
{
  filter_name_ = "MeanSurfletGrid";
}

void
MeanSurfletGrid<pcl::PCLPointCloud2>::applyFilter(pcl::PCLPointCloud2& output)
{
  std::array<std::size_t, 6> offsets;
  removed_indices_->clear();
  pcl::PCLPointCloud2 result = emptyLike(*input_);
  SurfletSet set, cells;
  std::vector<std::int32_t> indices(indices_->begin(), indices_->end()), first_points;
  bool good = findFields(*input_, offsets);
  for (std::size_t k = 0; good && k < indices.size(); ++k) {
    const auto i = static_cast<std::size_t>(indices[k]);
    set.push_back(readSurflet(&input_->data[pointOffset(*input_, i)], offsets));
  }
  const std::size_t size = std::size_t{input_->width} * input_->height;
  good = good && reduce(set, indices, size, cells, first_points);
  result.width = static_cast<std::uint32_t>(cells.size());
  result.row_step = result.width * result.point_step;
  result.data.resize(result.row_step);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::uint8_t* const point = &result.data[c * result.point_step];
    const auto first = static_cast<std::size_t>(first_points[c]);
    std::memcpy(point, &input_->data[pointOffset(*input_, first)], result.point_step);
    writeSurflet(cells[c], point, offsets);
  }
  for (std::size_t k = 0; good && extract_removed_indices_ && k < indices.size(); ++k)
    if (cell_of_[static_cast<std::size_t>(indices[k])] == CellReduction::no_cell)
      removed_indices_->push_back((*indices_)[k]);
  output = std::move(result);
}

} // namespace pcl_surflet

PCL_SURFLET_INSTANTIATE_MeanSurfletGrid(pcl::PointNormal);
PCL_SURFLET_INSTANTIATE_MeanSurfletGrid(pcl::PointXYZINormal);
PCL_SURFLET_INSTANTIATE_MeanSurfletGrid(pcl::PointXYZRGBNormal);
