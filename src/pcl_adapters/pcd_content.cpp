#include "pcl_adapters/pcd_content.h"

#include "pcl_adapters/pcd_guard.h"

#include <pcl/io/pcd_io.h>

#include <new>
#include <stdexcept>

#include <locale.h>

namespace pcl_surflet {
namespace detail {

namespace {

/** \brief Numbers are read as 1.5 by this thread while it lives: PCL 1.13 reads those of ASCII
 * files as the program's locale writes them, which makes 1 of 1.5 in a program with German menus.
 */
class ClassicNumbers {
public:
  ClassicNumbers() : classic_(::newlocale(LC_ALL_MASK, "C", nullptr))
  {
    if (!classic_)
      throw std::bad_alloc();
    before_ = ::uselocale(classic_);
  }
  ~ClassicNumbers()
  {
    ::uselocale(before_);
    ::freelocale(classic_);
  }
  ClassicNumbers(const ClassicNumbers&) = delete;
  ClassicNumbers& operator=(const ClassicNumbers&) = delete;

private:
  locale_t classic_, before_{};
};

/** \brief Does PCL understand the header as it is written? A line of blanks ends it for PCL, which
 * then reads points of no fields and crashes. */
bool
understands(pcl::PCDReader& reader, const std::string& path, const PcdClaim& claim)
{
  SourcePoints content;
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
readPcd(const std::string& path, SourcePoints& content)
{
  PcdClaim claim;
  if (auto problem = pcdProblem(path, claim); !problem.empty())
    return problem;
  bool read = false;
  int version = 0;
  try {
    const ClassicNumbers classic;
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
binaryPcd(const SourcePoints& content)
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
