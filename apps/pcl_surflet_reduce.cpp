// Reduces an oriented cloud to one mean surflet per cell.

#include "app_common.h"

#include "pcl_adapters/pcd_content.h"
#include "pcl_surflet/mean_surflet_grid.h"

#include <algorithm>
#include <iostream>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_reduce";

struct Options {
  std::string in, out;
  double leaf = 0, min_normal = 0.1;
  bool csv = false;
};

struct Counts {
  std::size_t input = 0, output = 0, cancelled_cells = 0, left_out = 0;
};

[[noreturn]] void
refuse(const std::string& path, const std::string& why)
{
  throw DataError("cannot reduce '" + path + "': " + why);
}

void
requireField(const std::string& path, const pcl::PCLPointCloud2& cloud, const std::string& name,
             const std::string& remedy)
{
  const auto fits = [&](const pcl::PCLPointField& f) {
    return f.name == name && f.datatype == pcl::PCLPointField::FLOAT32 && f.count == 1;
  };
  if (std::none_of(cloud.fields.begin(), cloud.fields.end(), fits))
    refuse(path,
           "it has no field " + name + " of type FLOAT32 (TYPE F, SIZE 4, COUNT 1); " + remedy);
}

SourcePoints
readOriented(const std::string& path)
{
  SourcePoints content;
  if (const auto problem = detail::readPcd(path, content); !problem.empty())
    refuse(path, problem + "; give a PCD file of oriented points");
  for (const char* name : {"x", "y", "z"})
    requireField(path, content.cloud, name, "give a PCD file of oriented points");
  for (const char* name : {"normal_x", "normal_y", "normal_z"})
    requireField(path, content.cloud, name,
                 "estimate normals first, for instance by pcl_normal_estimation");
  if (content.size() == 0)
    refuse(path, "it has no points; give a PCD file of oriented points");
  return content;
}

/** \brief Puts the mean surflets in place of the points of \p content; the sensor stays. */
Counts
reduce(const Options& o, SourcePoints& content)
{
  Counts counts;
  counts.input = content.size();
  MeanSurfletGrid<pcl::PCLPointCloud2> grid(true);
  grid.setInputCloud(pcl::make_shared<pcl::PCLPointCloud2>(std::move(content.cloud)));
  grid.setLeafSize(o.leaf);
  grid.setMinimumMeanNormal(o.min_normal);
  grid.filter(content.cloud);
  counts.output = content.size();
  counts.cancelled_cells = grid.getNumberOfCancelledCells();
  counts.left_out = grid.getRemovedIndices()->size();
  // The filter prints its errors, which runMain() silences; points that are neither left out nor
  // in a cell tell of the only one that can be left.
  if (counts.output == 0 && counts.left_out == 0)
    refuse(o.in, "cells of edge " + number(o.leaf) +
                     " are too small for the cloud's extent; give a larger -leaf");
  if (counts.output == 0)
    refuse(o.in, "no cell has a mean surflet: " + std::to_string(counts.input) +
                     " points are not finite or their normals cancel; check the normals, or "
                     "lower -leaf or -min_normal");
  return counts;
}

void
report(const Options& o, const Counts& c)
{
  if (o.csv)
    std::cout << "input,output,cancelled_cells,left_out\n"
              << c.input << "," << c.output << "," << c.cancelled_cells << "," << c.left_out
              << "\n";
  else
    note("wrote '" + o.out + "': " + std::to_string(c.input) + " points -> " +
         std::to_string(c.output) + " mean surflets; " + std::to_string(c.cancelled_cells) +
         " cells with cancelling normals, " + std::to_string(c.left_out) + " points left out");
}

int
run(int argc, char** argv)
{
  Options o;
  CommandLine line(kProgram, "IN.pcd OUT.pcd -leaf S",
                   "Reduces an oriented cloud to the mean surflet of each cubic cell: position and "
                   "normal\naveraged, the normal scaled to unit length. Other fields are those of "
                   "the cell's first\npoint. Cells whose normals cancel are left out and counted.");
  line.real("-leaf", "S", "edge of a cell in the cloud's unit (required)", o.leaf, 1e-30, 1e30);
  line.real("-min_normal", "L",
            "leave out cells whose mean normal is shorter, in [0, 1], default " +
                number(o.min_normal),
            o.min_normal, 0, 1);
  line.flag("-csv", "print input,output,cancelled_cells,left_out as a table", o.csv);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(2, 2);
  requirePcdName(line.files()[1]);
  line.require("-leaf");
  o.in = line.files()[0];
  o.out = line.files()[1];
  auto content = readOriented(o.in);
  const Counts counts = reduce(o, content);
  writeFile(o.out, detail::binaryPcd(content));
  report(o, counts);
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return run(argc, argv); });
}
