// Lists what is in a database.

#include "app_common.h"

#include <algorithm>
#include <iostream>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_info";

double
emptyShare(const ModelMember& member)
{
  const auto empty = std::count(member.histogram.begin(), member.histogram.end(), 0.0f);
  return static_cast<double>(empty) / static_cast<double>(member.histogram.size());
}

const char*
roleName(const HistogramModel& model)
{
  return model.role == ModelRole::Background ? "background" : "object";
}

void
printCsv(const ModelDatabase& database)
{
  std::cout << "label,role,member,condition,resolution,delta_max,r_mean,r_max,r_min,surface_area,"
               "features,empty_bins,penalty,leaf\n";
  for (std::size_t i = 0; i < database.size(); ++i) {
    const HistogramModel& m = database[i];
    for (std::size_t k = 0; k < m.members.size(); ++k)
      std::cout << csvField(m.label) << "," << roleName(m) << "," << k << ","
                << csvField(m.members[k].condition) << "," << csvField(m.resolution.toString())
                << "," << number(m.delta_max) << "," << number(m.r_mean) << "," << number(m.r_max)
                << "," << number(m.r_min) << "," << number(m.surface_area) << ","
                << m.members[k].features << "," << number(emptyShare(m.members[k])) << ","
                << number(database.penaltyMinimum()) << "," << number(m.leaf) << "\n";
  }
}

void
printText(const std::string& path, const ModelDatabase& database)
{
  const PenaltyParameters& penalty = database.getPenalty();
  std::cout << path << ": " << database.size() << " models, resolution "
            << database.resolution().toString() << " (" << database.resolution().bins()
            << " bins), penalty " << number(database.penaltyMinimum()) << " (tau "
            << number(penalty.tau) << ", floor " << number(penalty.floor) << ")\n";
  for (std::size_t i = 0; i < database.size(); ++i) {
    const HistogramModel& m = database[i];
    std::cout << m.label << "  " << roleName(m) << "  delta_max " << number(m.delta_max)
              << "  r_mean " << number(m.r_mean) << "  r_max " << number(m.r_max) << "  r_min "
              << number(m.r_min) << "  area "
              << (m.surface_area > 0 ? number(m.surface_area) : std::string("unknown"))
              << (m.leaf > 0 ? "  cells " + number(m.leaf) : std::string()) << "\n";
    for (const auto& member : m.members)
      std::cout << "  " << (member.condition.empty() ? "member" : member.condition) << ": "
                << member.features << " features, " << number(100 * emptyShare(member))
                << " % of the bins empty\n";
  }
}

int
info(int argc, char** argv)
{
  bool csv = false;
  CommandLine line(kProgram, "DB.pcd",
                   "Lists the models of a database: label, role, lengths, features and share of "
                   "empty bins\nof every member, resolution and penalty.");
  line.flag("-csv", "print a table, one row per member", csv);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(1, 1);
  const ModelDatabase database = readDatabase(line.files()[0]);
  if (csv)
    printCsv(database);
  else
    printText(line.files()[0], database);
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return info(argc, argv); });
}
