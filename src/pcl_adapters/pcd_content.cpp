#include "pcl_adapters/pcd_content.h"

#include "pcl_adapters/pcd_guard.h"

#include <pcl/io/pcd_io.h>

#include <new>
#include <stdexcept>

namespace pcl_surflet {
namespace detail {

namespace {

/** \brief Does PCL understand the header as it is written? A line of blanks ends it for PCL, which
 * then reads points of no fields and crashes. */
bool
understands(pcl::PCDReader& reader, const std::string& path, const PcdClaim& claim)
{
  PcdContent content;
  int version = 0, kind = 0;
  unsigned end = 0;
  if (reader.readHeader(path, content.cloud, content.origin, content.orientation, version, kind,
                        end) < 0)
    return false;
  const auto& cloud = content.cloud;
  return cloud.fields.size() == claim.fields && cloud.point_step == claim.step &&
         content.size() == claim.points && end == claim.end;
}

} // namespace

std::string
readPcd(const std::string& path, PcdContent& content)
{
  PcdClaim claim;
  if (auto problem = pcdProblem(path, claim); !problem.empty())
    return problem;
  bool read = false;
  int version = 0;
  try {
    pcl::PCDReader reader;
    if (!understands(reader, path, claim))
      return "its header is not understood: it may have a line of blanks, or a field twice";
    read = reader.read(path, content.cloud, content.origin, content.orientation, version) >= 0;
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
