#include "pcl_adapters/pcd_content.h"

#include "pcl_adapters/pcd_guard.h"

#include <pcl/io/pcd_io.h>

#include <new>
#include <stdexcept>

namespace pcl_surflet {
namespace detail {

std::string
readPcd(const std::string& path, PcdContent& content)
{
  if (auto problem = pcdProblem(path); !problem.empty())
    return problem;
  bool read = false;
  int version = 0;
  try {
    read = pcl::PCDReader().read(path, content.cloud, content.origin, content.orientation,
                                 version) >= 0;
  }
  catch (const std::bad_alloc&) {
    return "it does not fit into memory";
  }
  catch (const std::exception&) { // PCL reports some damage by exceptions of several kinds
  }
  const auto& cloud = content.cloud;
  if (!read || cloud.point_step == 0 || cloud.data.size() / cloud.point_step < content.size())
    return "its data is damaged";
  return {};
}

std::string
binaryPcd(const PcdContent& content)
{
  const auto& cloud = content.cloud;
  std::string file =
      pcl::PCDWriter().generateHeaderBinary(cloud, content.origin, content.orientation);
  if (file.empty())
    throw std::invalid_argument("the fields of the cloud take more room than its points have");
  file += "DATA binary\n";
  return file.append(reinterpret_cast<const char*>(cloud.data.data()), cloud.data.size());
}

} // namespace detail
} // namespace pcl_surflet
