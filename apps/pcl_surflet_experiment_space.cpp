/** \file
 * pcl_surflet_experiment_space: experiment 4.6 [Wahl 2007], region search in a uniform cube. */
#include "pcl_surflet/core/cell_tree.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/linear_octree.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <forward_list>
#include <limits>
#include <string>
#include <vector>

#include <unistd.h>

namespace {

using namespace pcl_surflet;

constexpr int kWrongOptions = 1, kBadData = 2;
constexpr int kDepth = 8; // d_max of the experiment

constexpr const char* kHelp =
    "Usage: pcl_surflet_experiment_space OUT_PREFIX [options]\n"
    "\n"
    "Experiment 4.6 [Wahl 2007]: uniform points in the unit cube, d_max = 8, saturations\n"
    "s = N / 8^8 from 0.001 to 0.1, radii from 0.01 to 0.5; a linked list, the octree, the AVL\n"
    "tree and the linear octree. Writes OUT_PREFIX.csv (times, relative times (4.32), memory),\n"
    "OUT_PREFIX.gnuplot, which draws OUT_PREFIX.svg like Fig. 4.8, and prints a summary.\n"
    "\n"
    "  -saturations N   steps of s (10)\n"
    "  -radii N         steps of r (20)\n"
    "  -queries N       searches per pair of s and r (500)\n"
    "  -seed N          (1)\n"
    "  -h               this help\n";

/** \brief The naive approach of ch. 4.6: a linked list, every point tested. */
class PointList {
public:
  void
  add(PointIndex id, const Position& p)
  {
    points_.push_front({p, id});
  }
  void
  regionSearch(const Position& q, double radius, std::vector<PointIndex>& indices,
               std::vector<float>& squares) const
  {
    indices.clear();
    squares.clear();
    const float limit = squaredRadius(radius);
    for (const auto& entry : points_) {
      const float dx = entry.p[0] - q[0], dy = entry.p[1] - q[1], dz = entry.p[2] - q[2];
      const float square = dx * dx + dy * dy + dz * dz;
      if (square <= limit) {
        indices.push_back(entry.id);
        squares.push_back(square);
      }
    }
  }

private:
  struct Entry {
    Position p;
    PointIndex id;
  };
  std::forward_list<Entry> points_;
};

struct Options {
  std::string prefix;
  long saturations = 10, radii = 20, queries = 500, seed = 1;
  bool help = false;
};

enum Method { List, Octree, Avl, Linear, kMethods };
constexpr const char* kNames[kMethods] = {"list", "octree", "avl", "linear"};

struct Row {
  double saturation, radius, hits;
  std::array<double, kMethods> seconds;   ///< per search
  std::array<double, kMethods> per_point; ///< bytes
};

/** \brief Relative time in percent [Wahl 2007, Eq. 4.32]: 0 is the fastest of list, octree, AVL. */
double
relativeTime(const Row& row, int method)
{
  const double fastest = std::min({row.seconds[List], row.seconds[Octree], row.seconds[Avl]});
  return 100 * (row.seconds[static_cast<std::size_t>(method)] / fastest - 1);
}

/** \brief All four representations of one cloud. */
class Subject {
public:
  Subject(std::size_t n, CounterRandom& random)
  {
    const CubeFrame frame{{0, 0, 0}, 1, kDepth};
    octree_ = makeCellTree(TreeKind::Octree, frame);
    avl_ = makeCellTree(TreeKind::Avl, frame);
    for (std::size_t i = 0; i < n; ++i) {
      const Position p = {float(random.uniform()), float(random.uniform()),
                          float(random.uniform())};
      const auto id = static_cast<PointIndex>(i);
      points_.push_back(p);
      list_.add(id, p);
      octree_->add(id, {p[0], p[1], p[2], 0, 0, 1});
      avl_->add(id, {p[0], p[1], p[2], 0, 0, 1});
    }
    linear_.build({points_[0].data(), points_[0].data() + 1, points_[0].data() + 2, 3, n});
  }

  std::size_t
  search(int method, const Position& q, double radius)
  {
    if (method == List)
      list_.regionSearch(q, radius, indices_, squares_);
    else
      index(method).regionSearch(q, radius, indices_, &squares_);
    return indices_.size();
  }

  double
  bytesPerPoint(int method) const
  {
    const double n = static_cast<double>(points_.size());
    return method == List ? 32 : static_cast<double>(index(method).memoryUsage()) / n;
  }

  const Position&
  point(CounterRandom& random) const
  {
    return points_[random.below(static_cast<std::uint32_t>(points_.size()))];
  }

private:
  const RegionIndex&
  index(int method) const
  {
    if (method == Linear)
      return linear_;
    return method == Octree ? *octree_ : *avl_;
  }

  std::vector<Position> points_;
  PointList list_;
  std::unique_ptr<CellTree> octree_, avl_;
  LinearOctree linear_;
  std::vector<PointIndex> indices_;
  std::vector<float> squares_;
};

/** \brief Times every method on the same \p queries, in turns, so that a busy machine slows all. */
Row
measure(Subject& subject, double saturation, double radius, long queries, CounterRandom& random)
{
  Row row{saturation, radius, 0, {}, {}};
  for (long i = 0; i < queries; ++i) {
    const Position q = subject.point(random);
    for (int m = 0; m < kMethods; ++m) {
      const auto start = std::chrono::steady_clock::now();
      const std::size_t hits = subject.search(m, q, radius);
      row.seconds[static_cast<std::size_t>(m)] +=
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      row.hits += m == Linear ? static_cast<double>(hits) / static_cast<double>(queries) : 0;
    }
  }
  for (std::size_t m = 0; m < kMethods; ++m) {
    row.seconds[m] /= static_cast<double>(queries);
    row.per_point[m] = subject.bytesPerPoint(static_cast<int>(m));
  }
  return row;
}

std::vector<Row>
runExperiment(const Options& options)
{
  std::vector<Row> rows;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  for (long s = 0; s < options.saturations; ++s) {
    const double share = options.saturations > 1 ? double(s) / double(options.saturations - 1) : 0;
    const double saturation = 0.001 + share * 0.099;
    CounterRandom random(static_cast<std::uint64_t>(options.seed), static_cast<std::uint64_t>(s));
    Subject subject(static_cast<std::size_t>(std::lround(saturation * std::ldexp(1, 24))), random);
    for (long r = 0; r < options.radii; ++r) {
      const double part = options.radii > 1 ? double(r) / double(options.radii - 1) : 0;
      rows.push_back(measure(subject, saturation, 0.01 + part * 0.49, options.queries, random));
      if (terminal)
        std::fprintf(stderr, "\r%3ld %%",
                     100 * (s * options.radii + r + 1) / (options.saturations * options.radii));
    }
  }
  if (terminal)
    std::fprintf(stderr, "\n");
  return rows;
}

bool
writeCsv(const std::string& file, const std::vector<Row>& rows)
{
  std::FILE* out = std::fopen(file.c_str(), "w");
  if (!out)
    return false;
  std::fprintf(out, "saturation,radius,hits");
  for (const char* name : kNames)
    std::fprintf(out, ",%s_us,%s_relative_percent,%s_bytes_per_point", name, name, name);
  for (const Row& row : rows) {
    std::fprintf(out, "\n%.4g,%.4g,%.6g", row.saturation, row.radius, row.hits);
    for (std::size_t m = 0; m < kMethods; ++m)
      std::fprintf(out, ",%.5g,%.4g,%.4g", 1e6 * row.seconds[m],
                   relativeTime(row, static_cast<int>(m)), row.per_point[m]);
  }
  std::fprintf(out, "\n");
  const bool good = !std::ferror(out);
  return std::fclose(out) == 0 && good;
}

bool
writePlot(const std::string& prefix)
{
  std::FILE* out = std::fopen((prefix + ".gnuplot").c_str(), "w");
  if (!out)
    return false;
  const std::string base = prefix.substr(prefix.find_last_of('/') + 1);
  std::fprintf(out,
               "# Run in this folder: gnuplot %s.gnuplot\n"
               "set terminal svg size 900,1100 background rgb 'white'\nset output '%s.svg'\n"
               "set datafile separator ','\nset multiplot layout 4,2\nset logscale z\n"
               "set xlabel 'r'\nset ylabel 's'\nset view 60,40\nset key off\n",
               base.c_str(), base.c_str());
  for (int m = 0; m < kMethods; ++m) {
    const int column = 4 + 3 * m;
    std::fprintf(out,
                 "set title '%s: time per search [us]'\n"
                 "splot '%s.csv' skip 1 using 2:1:%d with points pt 7 ps 0.4 palette\n"
                 "set title '%s: 100 (time/best - 1) + 1'\n"
                 "splot '%s.csv' skip 1 using 2:1:($%d > -99 ? $%d + 1 : 1) with points pt 7 ps "
                 "0.4 palette\n",
                 kNames[m], base.c_str(), column, kNames[m], base.c_str(), column + 1, column + 1);
  }
  std::fprintf(out, "unset multiplot\n");
  const bool good = !std::ferror(out);
  return std::fclose(out) == 0 && good;
}

/** \brief Prints per radius the mean over saturations and says where the trees win. */
void
summarise(const std::vector<Row>& rows)
{
  std::printf("%7s %10s %10s %10s %10s %10s %14s\n", "r", "list us", "octree us", "avl us",
              "linear us", "avl/octree", "linear/octree");
  std::vector<double> radii;
  for (const Row& row : rows)
    if (std::find(radii.begin(), radii.end(), row.radius) == radii.end())
      radii.push_back(row.radius);
  double octree_wins = 0, avl_wins = 0;
  for (const double radius : radii) {
    double sum[kMethods] = {};
    std::size_t n = 0;
    for (const Row& row : rows)
      if (row.radius == radius) {
        for (std::size_t m = 0; m < kMethods; ++m)
          sum[m] += 1e6 * row.seconds[m];
        ++n;
      }
    for (double& v : sum)
      v /= static_cast<double>(n);
    octree_wins = sum[Octree] < sum[List] ? radius : octree_wins;
    avl_wins = sum[Avl] < sum[List] ? radius : avl_wins;
    std::printf("%7.3f %10.1f %10.1f %10.1f %10.1f %10.2f %14.3f\n", radius, sum[List], sum[Octree],
                sum[Avl], sum[Linear], sum[Avl] / sum[Octree], sum[Linear] / sum[Octree]);
  }
  std::printf(
      "\nmean over saturations: octree beats the list up to r = %.3f, AVL tree up to %.3f\n",
      octree_wins, avl_wins);
  std::printf("bytes per point at the lowest / highest saturation:");
  for (std::size_t m = 0; m < kMethods; ++m)
    std::printf(" %s %.0f / %.0f%s", kNames[m], rows.front().per_point[m], rows.back().per_point[m],
                m + 1 < kMethods ? "," : "\n");
}

bool
parse(int argc, char** argv, Options& options)
{
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    long* value = word == "-saturations" ? &options.saturations
                  : word == "-radii"     ? &options.radii
                  : word == "-queries"   ? &options.queries
                  : word == "-seed"      ? &options.seed
                                         : nullptr;
    if (word == "-h" || word == "--help")
      options.help = true;
    else if (value) {
      char* end = nullptr;
      *value = ++i < argc ? std::strtol(argv[i], &end, 10) : 0;
      if (i >= argc || end == argv[i] || *end != '\0' || *value < 1) {
        std::fprintf(stderr, "%s needs a positive whole number\n", word.c_str());
        return false;
      }
    }
    else if (word.size() > 1 && word[0] == '-') {
      std::fprintf(stderr, "unknown option %s (see -h)\n", word.c_str());
      return false;
    }
    else
      options.prefix = word;
  }
  if (!options.help && options.prefix.empty())
    std::fprintf(stderr, "OUT_PREFIX is missing (see -h)\n");
  return options.help || !options.prefix.empty();
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
  if (!writePlot(options.prefix)) { // before the long run
    std::fprintf(stderr, "cannot write %s.gnuplot\n", options.prefix.c_str());
    return kBadData;
  }
  const std::vector<Row> rows = runExperiment(options);
  if (!writeCsv(options.prefix + ".csv", rows)) {
    std::fprintf(stderr, "cannot write %s.csv\n", options.prefix.c_str());
    return kBadData;
  }
  summarise(rows);
  return 0;
}
