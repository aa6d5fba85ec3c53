#include "labelled_scene.h"

#include "app_common.h"
#include "pcl_adapters/cloud_columns.h"
#include "pcl_adapters/pcd_content.h"

#include <pcl/common/point_tests.h>

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

/** \brief The values of three fields at a point; zeros without them. */
Eigen::Vector3f
vectorAt(const pcl::PCLPointCloud2& cloud, std::size_t point, const detail::Columns& fields)
{
  Eigen::Vector3f out = Eigen::Vector3f::Zero();
  for (Eigen::Index k = 0; k < 3; ++k)
    if (const auto* field = fields[static_cast<std::size_t>(k)])
      out[k] = detail::valueAt(cloud, point, *field);
  return out;
}

} // namespace

LabelledScene
readLabelledScene(const std::string& path)
{
  SourcePoints content;
  if (const auto problem = detail::readPcd(path, content); !problem.empty())
    throw DataError("cannot use '" + path + "': " + problem +
                    "; give a PCD file, such as pcl_surflet_interpret -out writes");
  const auto& cloud = content.cloud;
  const auto xyz = detail::columns(cloud, {"x", "y", "z"});
  const auto n = detail::columns(cloud, {"normal_x", "normal_y", "normal_z"});
  if (xyz[0] == nullptr)
    throw DataError("cannot use '" + path + "': it has no fields x, y, z of type F; give a cloud");
  const auto labels = numbersOf(cloud, content.size(), "label");
  const auto things = numbersOf(cloud, content.size(), "instance");
  LabelledScene scene;
  scene.width = cloud.height > 1 ? cloud.width : 0;
  for (std::size_t i = 0; i < content.size(); ++i) {
    pcl::PointXYZLNormal p;
    p.getVector3fMap() = vectorAt(cloud, i, xyz);
    p.getNormalVector3fMap() = vectorAt(cloud, i, n);
    p.label = labels.empty() ? 0 : labels[i];
    if (!pcl::isXYZFinite(p))
      continue;
    scene.points.push_back(p);
    scene.things.push_back(things.empty() ? p.label : things[i]);
    scene.places.push_back(static_cast<std::uint32_t>(i));
  }
  if (scene.points.empty())
    throw DataError("cannot use '" + path + "': it has no finite point; give a cloud");
  return scene;
}

} // namespace apps
} // namespace pcl_surflet
