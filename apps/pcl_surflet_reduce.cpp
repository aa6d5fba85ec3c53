/** \file
 * pcl_surflet_reduce: one mean surflet per cell. */
#include "pcl_surflet/mean_surflet_grid.h"

#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace {

constexpr int kWrongOptions = 1, kBadData = 2;

constexpr const char* kHelp =
    "Usage: pcl_surflet_reduce IN.pcd OUT.pcd -leaf S [options]\n"
    "\n"
    "Reduces an oriented cloud to the mean surflet of each cubic cell: position and normal\n"
    "averaged, the normal scaled to unit length. Other fields are those of the cell's first\n"
    "point. Cells whose normals cancel are left out and counted.\n"
    "\n"
    "  -leaf S          edge of a cell in the cloud's unit (required)\n"
    "  -min_normal L    leave out cells whose mean normal is shorter, in [0, 1] (0.1)\n"
    "  -csv             print input,output,cancelled_cells,left_out as CSV to stdout\n"
    "  -h               this help\n"
    "\n"
    "Exit status: 0 done, 1 wrong options, 2 bad data or files.\n";

struct Options {
  std::vector<std::string> files;
  double leaf = 0, min_normal = 0.1;
  bool csv = false, help = false;
};

bool
parseNumber(const char* text, double& value)
{
  char* end = nullptr;
  value = std::strtod(text, &end);
  return end != text && *end == '\0';
}

/** \brief Reads the command line; false, having named the fault, if it is wrong. */
bool
parse(int argc, char** argv, Options& options)
{
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "-h" || word == "--help")
      options.help = true;
    else if (word == "-csv")
      options.csv = true;
    else if (word == "-leaf" || word == "-min_normal") {
      double& value = word == "-leaf" ? options.leaf : options.min_normal;
      if (++i == argc || !parseNumber(argv[i], value)) {
        pcl::console::print_error("%s needs a number%s%s\n", word.c_str(), i < argc ? ", not " : "",
                                  i < argc ? argv[i] : "");
        return false;
      }
    }
    else if (word.size() > 1 && word[0] == '-') {
      pcl::console::print_error("unknown option %s (see -h)\n", word.c_str());
      return false;
    }
    else
      options.files.push_back(word);
  }
  if (options.help)
    return true;
  if (options.files.size() != 2)
    pcl::console::print_error("two files are needed: IN.pcd OUT.pcd (see -h)\n");
  else if (!(options.leaf > 0 && options.leaf < HUGE_VAL))
    pcl::console::print_error("-leaf must be given, positive and finite\n");
  else if (!(options.min_normal >= 0 && options.min_normal <= 1))
    pcl::console::print_error("-min_normal must lie in [0, 1]\n");
  else
    return true;
  return false;
}

/** \brief Writes beside the target and renames, so that no half-written file is left. */
bool
save(const std::string& file, const pcl::PCLPointCloud2& cloud)
{
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored)) {
    pcl::console::print_error("%s is not a regular file\n", file.c_str());
    return false; // renaming would replace a device or a link's target
  }
  const std::string temporary = file + ".part";
  try {
    if (pcl::PCDWriter().writeBinary(temporary, cloud) == 0 &&
        std::rename(temporary.c_str(), file.c_str()) == 0)
      return true;
  }
  catch (const std::exception& e) {
    pcl::console::print_error("%s\n", e.what());
  }
  std::remove(temporary.c_str());
  pcl::console::print_error("cannot write %s\n", file.c_str());
  return false;
}

} // namespace

int
main(int argc, char** argv)
{
  Options options;
  if (!parse(argc, argv, options))
    return kWrongOptions;
  if (options.help) {
    std::fputs(kHelp, stdout);
    return 0;
  }
  auto cloud = std::make_shared<pcl::PCLPointCloud2>();
  if (pcl::io::loadPCDFile(options.files[0], *cloud) < 0) {
    pcl::console::print_error("cannot read %s\n", options.files[0].c_str());
    return kBadData;
  }
  pcl_surflet::MeanSurfletGrid<pcl::PCLPointCloud2> grid(true);
  grid.setInputCloud(cloud);
  grid.setLeafSize(options.leaf);
  grid.setMinimumMeanNormal(options.min_normal);
  pcl::PCLPointCloud2 cells;
  grid.filter(cells);
  const std::size_t input = std::size_t{cloud->width} * cloud->height, output = cells.width;
  if (output == 0) {
    pcl::console::print_error("%s: no cell has a mean surflet\n", options.files[0].c_str());
    return kBadData;
  }
  if (!save(options.files[1], cells))
    return kBadData;
  const std::size_t left_out = grid.getRemovedIndices()->size();
  if (options.csv)
    std::printf("input,output,cancelled_cells,left_out\n%zu,%zu,%zu,%zu\n", input, output,
                grid.getNumberOfCancelledCells(), left_out);
  else
    pcl::console::print_highlight("%zu points -> %zu mean surflets; %zu cells with cancelling "
                                  "normals, %zu points left out\n",
                                  input, output, grid.getNumberOfCancelledCells(), left_out);
  return 0;
}
