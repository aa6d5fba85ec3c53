// PCD files: what the guard lets pass, PCL's reader and the conversion to surflets must stand, and
// so must labelling it; what is refused must be a SurfaceFileError with a remedy.
#include "input_file.h"
#include "labelled_pcd.h"

#include "pcl_surflet/surface_file.h"

#include <pcl/console/print.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

using namespace pcl_surflet;

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  static const fuzz::InputFile file(".pcd");
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  try {
    SurfaceFileOptions options;
    options.keep_points = true;
    const SurfaceFile surface = loadSurface(file.hold(data, size), options);
    for (std::size_t i = 0; i < surface.surflets.size(); ++i) {
      const Surflet s = surface.surflets[i];
      if (!std::isfinite(s.x) || !std::isfinite(s.y) || !std::isfinite(s.z) ||
          std::abs(std::hypot(s.nx, s.ny, s.nz) - 1) > 1e-3)
        std::abort(); // no usable surflet
    }
    const std::vector<std::uint32_t> ones(surface.surflets.size(), 1);
    const std::string labelled = apps::asPcd(surface, {ones, ones});
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(labelled.data());
    if (loadSurface(file.hold(bytes, labelled.size())).surflets.size() != surface.surflets.size())
      std::abort(); // the labelled cloud is another
  }
  catch (const SurfaceFileError& error) {
    if (std::strchr(error.what(), ';') == nullptr)
      std::abort(); // no remedy
  }
  return 0;
}
