#include "labelled_scene.h"

#include "app_common.h"
#include "pcl_adapters/pcd_content.h"

#include <pcl/common/point_tests.h>
#include <pcl/conversions.h>

#include <algorithm>
#include <cstring>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief The whole numbers of the field \p name; empty if there is no such field. */
std::vector<std::uint32_t>
numbersOf(const pcl::PCLPointCloud2& cloud, std::size_t points, const std::string& name)
{
  std::vector<std::uint32_t> out;
  for (const auto& field : cloud.fields) {
    const bool fits = field.datatype == pcl::PCLPointField::UINT32 && field.count <= 1 &&
                      field.offset + sizeof(std::uint32_t) <= cloud.point_step;
    if (field.name != name || !fits)
      continue;
    out.resize(points);
    for (std::size_t i = 0; i < points; ++i)
      std::memcpy(&out[i], cloud.data.data() + i * cloud.point_step + field.offset,
                  sizeof(std::uint32_t));
  }
  return out;
}

bool
hasField(const pcl::PCLPointCloud2& cloud, const char* name)
{
  return std::any_of(cloud.fields.begin(), cloud.fields.end(), [&](const auto& field) {
    return field.name == name && field.datatype == pcl::PCLPointField::FLOAT32;
  });
}

} // namespace

LabelledScene
readLabelledScene(const std::string& path)
{
  detail::PcdContent content;
  if (const auto problem = detail::readPcd(path, content); !problem.empty())
    throw DataError("cannot use '" + path + "': " + problem +
                    "; give a PCD file, such as pcl_surflet_interpret -out writes");
  for (const char* axis : {"x", "y", "z"})
    if (!hasField(content.cloud, axis))
      throw DataError("cannot use '" + path +
                      "': it has no fields x, y, z of type F; give a cloud");
  pcl::PointCloud<pcl::PointXYZLNormal> all;
  pcl::fromPCLPointCloud2(content.cloud, all);
  auto things = numbersOf(content.cloud, all.size(), "instance");
  LabelledScene scene;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!pcl::isXYZFinite(all[i]))
      continue;
    scene.points.push_back(all[i]);
    scene.things.push_back(things.empty() ? all[i].label : things[i]);
  }
  if (scene.points.empty())
    throw DataError("cannot use '" + path + "': it has no finite point; give a cloud");
  return scene;
}

} // namespace apps
} // namespace pcl_surflet
