// Database files: what is loaded must be usable models, what is refused a DatabaseFileError.
#include "input_file.h"

#include "pcl_surflet/database_file.h"

#include <pcl/console/print.h>

#include <cstdlib>

using namespace pcl_surflet;

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  static const fuzz::InputFile file(".pcd");
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  try {
    const ModelDatabase database = loadDatabase(file.hold(data, size));
    if (database.empty())
      std::abort();
    for (std::size_t i = 0; i < database.size(); ++i)
      if (!database[i].problem().empty())
        std::abort();
    database.penalized();
  }
  catch (const DatabaseFileError&) {
  }
  return 0;
}
