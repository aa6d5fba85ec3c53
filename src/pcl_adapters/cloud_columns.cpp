#include "pcl_adapters/cloud_columns.h"

#include <cstring>

namespace pcl_surflet {
namespace detail {

Columns
columns(const pcl::PCLPointCloud2& cloud, const std::array<const char*, 3>& names)
{
  Columns found{};
  for (std::size_t k = 0; k < names.size(); ++k)
    for (const auto& field : cloud.fields) {
      const bool is_float = field.datatype == pcl::PCLPointField::FLOAT32;
      const bool is_double = field.datatype == pcl::PCLPointField::FLOAT64;
      const std::size_t size = is_float ? sizeof(float) : sizeof(double);
      if (field.name == names[k] && (is_float || is_double) && field.count == 1 &&
          field.offset + size <= cloud.point_step)
        found[k] = &field;
    }
  const bool complete = found[0] != nullptr && found[1] != nullptr && found[2] != nullptr;
  return complete ? found : Columns{};
}

float
valueAt(const pcl::PCLPointCloud2& cloud, std::size_t point, const pcl::PCLPointField& field)
{
  const auto* from = cloud.data.data() + point * cloud.point_step + field.offset;
  if (field.datatype == pcl::PCLPointField::FLOAT32) {
    float value;
    std::memcpy(&value, from, sizeof value);
    return value;
  }
  double value;
  std::memcpy(&value, from, sizeof value);
  return static_cast<float>(value);
}

} // namespace detail
} // namespace pcl_surflet
