#include "experiment/space_report.h"

#include "app_common.h"

#include <cstdio>
#include <map>
#include <set>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr const char* kBase = "experiment_46";
constexpr const char* kPicture = "experiment_46.svg";

std::string
csvOf(const std::vector<SpaceRow>& rows)
{
  std::string out = "saturation,radius,hits";
  for (std::size_t m = 0; m < kSpaceMethods; ++m) {
    const std::string name = spaceMethodNames()[m];
    out += "," + name + "_us," + name + "_relative_percent," + name + "_bytes_per_point";
  }
  out += "\n";
  for (const SpaceRow& row : rows) {
    out += formatted("%.4g,%.4g,%.6g", row.saturation, row.radius, row.hits);
    for (std::size_t m = 0; m < kSpaceMethods; ++m)
      out += formatted(",%.5g,%.4g,%.4g", 1e6 * row.seconds[m], relativeTime(row, m),
                       row.per_point[m]);
    out += "\n";
  }
  return out;
}

/** \brief Two plots against the radius: the cuts through Fig. 4.8 at one saturation. */
std::string
cutsAt(double saturation)
{
  return formatted("set title 's = %.3g: time per search [us]'\n"
                   "plot for [m=0:3] '%s.csv' skip 1 using (abs($1-%.4g)<1e-6 ? $2 : NaN):"
                   "(column(4+3*m)) with linespoints pt 7 ps 0.4 title word(names, m+1)\n",
                   saturation, kBase, saturation) +
         formatted("set title 's = %.3g: relative time (4.32) [%%] + 1'\n"
                   "plot for [m=0:2] '%s.csv' skip 1 using (abs($1-%.4g)<1e-6 ? $2 : NaN):"
                   "(column(5+3*m)+1) with linespoints pt 7 ps 0.4 title word(names, m+1)\n",
                   saturation, kBase, saturation);
}

/** \brief Cuts through Fig. 4.8 at the lowest, a middle and the highest saturation: lines can be
 * compared where surfaces hide each other. */
std::string
plotOf(const SpaceOptions& options)
{
  const std::set<std::uint64_t> steps = {0, options.saturations / 2, options.saturations - 1};
  std::string out =
      formatted("# Run in this folder: gnuplot %s.gnuplot\n"
                "set terminal svg size 900,%zu background rgb 'white'\n",
                kBase, 300 * steps.size()) +
      outputStatements(kPicture) +
      formatted("set datafile separator ','\nset multiplot layout %zu,2\nset logscale y\n"
                "set xlabel 'r'\nset key bottom right\nnames = 'list octree avl linear'\n",
                steps.size());
  for (const auto step : steps)
    out += cutsAt(saturationOf(options, step));
  return out + "unset multiplot\n";
}

using Times = std::array<double, kSpaceMethods>;

/** \brief Microseconds by radius, means over the saturations. */
std::map<double, Times>
meanTimes(const std::vector<SpaceRow>& rows)
{
  std::map<double, Times> sums;
  std::map<double, double> counts;
  for (const SpaceRow& row : rows) {
    Times& sum = sums[row.radius]; // zeros at first
    for (std::size_t m = 0; m < kSpaceMethods; ++m)
      sum[m] += 1e6 * row.seconds[m];
    ++counts[row.radius];
  }
  for (auto& [radius, sum] : sums)
    for (double& v : sum)
      v /= counts[radius];
  return sums;
}

/** \brief Prints the mean times and says where the trees win. */
void
printSummary(const std::vector<SpaceRow>& rows)
{
  std::printf("%7s %10s %10s %10s %10s %10s %14s\n", "r", "list us", "octree us", "avl us",
              "linear us", "avl/octree", "linear/octree");
  double octree_wins = 0, avl_wins = 0;
  for (const auto& [radius, us] : meanTimes(rows)) {
    octree_wins = us[Octree] < us[List] ? radius : octree_wins;
    avl_wins = us[AVL] < us[List] ? radius : avl_wins;
    std::printf("%7.3f %10.1f %10.1f %10.1f %10.1f %10.2f %14.3f\n", radius, us[List], us[Octree],
                us[AVL], us[Linear], us[AVL] / us[Octree], us[Linear] / us[Octree]);
  }
  std::printf(
      "\nmean over saturations: octree beats the list up to r = %.3f, AVL tree up to %.3f\n",
      octree_wins, avl_wins);
  std::printf("bytes per point at the lowest / highest saturation:");
  for (std::size_t m = 0; m < kSpaceMethods; ++m)
    std::printf(" %s %.0f / %.0f%s", spaceMethodNames()[m], rows.front().per_point[m],
                rows.back().per_point[m], m + 1 < kSpaceMethods ? "," : "\n");
}

} // namespace

int
reportSpace(const SpaceOptions& options)
{
  makeDirectory(options.out);
  const std::string base = options.out + "/" + kBase;
  writeFile(base + ".gnuplot", plotOf(options)); // fails before the long run, not after it
  const auto rows = withProgress<std::vector<SpaceRow>>(
      options.saturations * options.radii,
      [&](const auto& show) { return runSpace(options, show); });
  writeFile(base + ".csv", csvOf(rows));
  printSummary(rows);
  const auto no_picture = drawByGnuplot(options.out, std::string(kBase) + ".gnuplot", kPicture);
  std::printf("\nwrote %s.csv and .gnuplot%s\n", base.c_str(),
              no_picture.empty() ? " and .svg" : "");
  if (!no_picture.empty())
    complain("no picture: " + no_picture);
  return kOk;
}

} // namespace apps
} // namespace pcl_surflet
