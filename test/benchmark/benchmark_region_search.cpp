/** \file
 * Region search against the searches PCL users have: ratios of medians from one run with
 * interleaved repetitions. PCL_SURFLET_SCAN and PCL_SURFLET_SCENE may name PCD files to be used in
 * place of the generated scan and table scene. */
#include "pcl_surflet/mean_surflet_grid.h"
#include "region_search/peers.h"

#include <pcl/filters/voxel_grid.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace {

using namespace pcl_surflet;
using namespace pcl_surflet::region_search;

/** \brief Clouds are built when the first benchmark that survives --benchmark_filter needs them. */
Subject&
subject(const std::string& name)
{
  static std::map<std::string, std::unique_ptr<Subject>> all;
  auto& s = all[name];
  if (!s)
    s = std::make_unique<Subject>(namedCloud(name));
  return *s;
}

void
search(benchmark::State& state, const std::string& name, double share, const Query& query)
{
  Subject& s = subject(name);
  const double radius = share * s.extent;
  std::size_t i = 0, hits = 0, queries = 0;
  for (auto _ : state) {
    hits += query(s, s.queries[i++ % s.queries.size()], radius);
    ++queries;
  }
  state.counters["hits"] = double(hits) / double(queries);
}

void
registerSearches()
{
  for (const char* name : {"cube84k", "scan200k", "table", "cube1700k"})
    for (const double share : {0.01, 0.03, 0.05, 0.1, 0.25, 0.5})
      for (const auto& [kind, query] : queryKinds()) {
        char title[100];
        std::snprintf(title, sizeof title, "%s:r%.2f/%s", name, share, kind.c_str());
        benchmark::RegisterBenchmark(title, [=, n = std::string(name)](benchmark::State& state) {
          search(state, n, share, query);
        });
      }
}

template <class Build>
void
registerBuild(const std::string& title, std::size_t n, const Build& build)
{
  benchmark::RegisterBenchmark(title.c_str(), [=](benchmark::State& state) {
    static std::map<std::size_t, Cloud::Ptr> clouds;
    auto& cloud = clouds[n];
    if (!cloud)
      cloud = cubeCloud(n);
    for (auto _ : state)
      build(cloud);
    state.counters["hits"] = double(n);
  });
}

void
registerBuilds()
{
  // Coarse cells hold some 20 to 30 points, fine ones mostly none or one.
  for (const auto& [n, cells] :
       {std::pair<std::size_t, int>{84000, 16}, {1000000, 32}, {1000000, 128}}) {
    const std::string group =
        "build" + std::to_string(n / 1000) + "k_cells" + std::to_string(cells) + "/";
    const double cell = 1.0 / cells;
    registerBuild(group + "linear", n, [](const Cloud::Ptr& c) {
      OctreeRegionSearch<Point> s;
      s.setInputCloud(c);
    });
    registerBuild(group + "octree", n, [=](const Cloud::Ptr& c) {
      OctreeRegionSearch<Point> s(OctreeRegionSearch<Point>::Octree);
      s.setCellSize(cell);
      s.setInputCloud(c);
    });
    registerBuild(group + "avl", n, [=](const Cloud::Ptr& c) {
      OctreeRegionSearch<Point> s(OctreeRegionSearch<Point>::AVL);
      s.setCellSize(cell);
      s.setInputCloud(c);
    });
    registerBuild(group + "peer_pcl_octree", n, [=](const Cloud::Ptr& c) {
      PclOctree s(cell);
      s.setInputCloud(c);
      s.addPointsFromInputCloud();
    });
    registerBuild(group + "peer_kdtree_flann", n, [](const Cloud::Ptr& c) {
      pcl::KdTreeFLANN<Point> s;
      s.setInputCloud(c);
    });
    registerBuild(group + "peer_nanoflann", n, [](const Cloud::Ptr& c) {
      NanoCloud view{*c};
      Nano s(3, view, nanoflann::KDTreeSingleIndexAdaptorParams(10));
      s.buildIndex();
    });
  }
}

/** \brief The reduction filter beside pcl::VoxelGrid: 770 k points of a table scene. */
void
registerReduction()
{
  const auto cloud = std::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  const Cloud::Ptr table = tableCloud(770000);
  for (const auto& p : *table)
    cloud->push_back(pcl::PointNormal(p.x, p.y, p.z, 0, 0, 1));
  const auto add = [](const std::string& title, const auto& run) {
    benchmark::RegisterBenchmark(title.c_str(), [=](benchmark::State& state) {
      for (auto _ : state)
        state.counters["hits"] = double(run());
    });
  };
  add("reduce770k/mean_surflet_grid", [=] {
    MeanSurfletGrid<pcl::PointNormal> grid;
    pcl::PointCloud<pcl::PointNormal> out;
    grid.setInputCloud(cloud);
    grid.setLeafSize(0.0058);
    grid.filter(out);
    return out.size();
  });
  add("reduce770k/peer_voxel_grid", [=] {
    pcl::VoxelGrid<pcl::PointNormal> grid;
    pcl::PointCloud<pcl::PointNormal> out;
    grid.setInputCloud(cloud);
    grid.setLeafSize(0.0058f, 0.0058f, 0.0058f);
    grid.filter(out);
    return out.size();
  });
}

/** \brief Medians per group in one line: CSV for the documentation's tables and plots. */
class TableReporter : public benchmark::ConsoleReporter {
public:
  bool
  ReportContext(const Context& context) override
  {
    return benchmark::ConsoleReporter::ReportContext(context);
  }
  void
  ReportRuns(const std::vector<Run>& runs) override
  {
    for (const auto& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred)
        continue;
      const std::string& name = run.run_name.function_name;
      const std::string group = name.substr(0, name.find('/'));
      if (times_.find(group) == times_.end())
        groups_.push_back(group);
      times_[group][name.substr(group.size() + 1)].push_back(1e9 * run.cpu_accumulated_time /
                                                             double(run.iterations));
      hits_[group] = run.counters.at("hits").value;
    }
  }
  void
  Finalize() override
  {
    std::printf("group,hits,kind,ns,best_peer/this,pcl_octree/this,nanoflann/this\n");
    for (const auto& group : groups_)
      for (const auto& kind : times_[group]) {
        const double ns = median(group, kind.first);
        std::printf("%s,%.4g,%s,%.5g,%.2f,%.2f,%.2f\n", group.c_str(), hits_[group],
                    kind.first.c_str(), ns, bestPeer(group) / ns,
                    median(group, "peer_pcl_octree") / ns, median(group, "peer_nanoflann") / ns);
      }
  }

private:
  double
  median(const std::string& group, const std::string& kind)
  {
    const auto& kinds = times_[group];
    const auto found = kinds.find(kind); // operator[] would add a row to the table
    if (found == kinds.end())
      return NAN;
    auto t = found->second;
    std::sort(t.begin(), t.end());
    return t[t.size() / 2];
  }
  double
  bestPeer(const std::string& group)
  {
    double best = INFINITY;
    for (const auto& kind : times_[group])
      if (kind.first.compare(0, 4, "peer") == 0)
        best = std::min(best, median(group, kind.first));
    return best;
  }

  std::vector<std::string> groups_;
  std::map<std::string, std::map<std::string, std::vector<double>>> times_;
  std::map<std::string, double> hits_;
};

} // namespace

int
main(int argc, char** argv)
{
  std::vector<char*> arguments(argv, argv + argc);
  char repetitions[] = "--benchmark_repetitions=5";
  char interleaving[] = "--benchmark_enable_random_interleaving=true";
  char min_time[] = "--benchmark_min_time=0.02";
  arguments.insert(arguments.begin() + 1, {repetitions, interleaving, min_time});
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data()))
    return 1;
  registerSearches();
  registerBuilds();
  registerReduction();
  TableReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return 0;
}
