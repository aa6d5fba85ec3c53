/** \file
 * Region search against the searches PCL users have: ratios of medians from one run with
 * interleaved repetitions. PCL_SURFLET_SCAN and PCL_SURFLET_SCENE may name PCD files to be used in
 * place of the generated scan and table scene. */
#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/mean_surflet_grid.h"
#include "pcl_surflet/octree_region_search.h"

#include <pcl/filters/voxel_grid.h>
#include <pcl/io/pcd_io.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/octree/octree_search.h>
#include <pcl/search/kdtree.h>

#include <benchmark/benchmark.h>
#include <nanoflann.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>

namespace {

using namespace pcl_surflet;
using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

/** \brief nanoflann's view of a PCL cloud. */
struct NanoCloud {
  const Cloud& cloud;
  std::size_t
  kdtree_get_point_count() const
  {
    return cloud.size();
  }
  float
  kdtree_get_pt(std::size_t i, std::size_t d) const
  {
    return cloud[i].data[d];
  }
  template <class Box>
  bool
  kdtree_get_bbox(Box&) const
  {
    return false;
  }
};
using Nano = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, NanoCloud>,
                                                 NanoCloud, 3, std::uint32_t>;
using PclOctree = pcl::octree::OctreePointCloudSearch<Point>;

Cloud::Ptr
cubeCloud(std::size_t n)
{
  CounterRandom random(n);
  auto cloud = std::make_shared<Cloud>();
  for (std::size_t i = 0; i < n; ++i)
    cloud->push_back({float(random.uniform()), float(random.uniform()), float(random.uniform())});
  return cloud;
}

/** \brief A bumpy closed surface, sampled in random order. */
Cloud::Ptr
scanCloud(std::size_t n)
{
  CounterRandom random(n);
  auto cloud = std::make_shared<Cloud>();
  while (cloud->size() < n) {
    const double z = random.uniform(-1, 1), t = random.uniform(0, 2 * M_PI);
    const double w = std::sqrt(1 - z * z), x = w * std::cos(t), y = w * std::sin(t);
    const double r = 0.4 + 0.08 * std::sin(7 * x + 2) * std::sin(9 * y) + 0.05 * std::sin(11 * z);
    cloud->push_back({float(r * x), float(0.7 * r * y), float(r * z)});
  }
  return cloud;
}

/** \brief A table of 1 m with seven round bodies on it. */
Cloud::Ptr
tableCloud(std::size_t n)
{
  CounterRandom random(n);
  auto cloud = std::make_shared<Cloud>();
  while (cloud->size() < n) {
    if (random.below(2) == 0) {
      cloud->push_back({float(random.uniform()), float(random.uniform()), 0});
      continue;
    }
    const double body = random.below(7), z = random.uniform(-1, 1), t = random.uniform(0, 7);
    const double w = 0.1 * std::sqrt(1 - z * z);
    cloud->push_back({float(0.5 + 0.35 * std::cos(body) + w * std::cos(t)),
                      float(0.5 + 0.35 * std::sin(body) + w * std::sin(t)), float(0.1 + 0.1 * z)});
  }
  return cloud;
}

/** \brief The cloud in the PCD file that \p variable names, or \p made. */
Cloud::Ptr
fileOr(const char* variable, const std::function<Cloud::Ptr()>& made)
{
  const char* file = std::getenv(variable);
  auto cloud = std::make_shared<Cloud>();
  if (file == nullptr)
    return made();
  if (pcl::io::loadPCDFile(file, *cloud) < 0)
    std::exit(2);
  return cloud;
}

Cloud::Ptr
reduced(const Cloud& cloud, double leaf)
{
  SurfletSet set;
  for (const auto& p : cloud)
    set.push_back({p.x, p.y, p.z, 0, 0, 1});
  auto cells = std::make_shared<Cloud>();
  const auto reduction = reduceToCells(set, leaf);
  for (std::size_t i = 0; i < reduction.cells.size(); ++i)
    cells->push_back({reduction.cells.x[i], reduction.cells.y[i], reduction.cells.z[i]});
  return cells;
}

/** \brief One cloud in every search structure, and what to ask. */
struct Subject {
  Cloud::Ptr cloud;
  double extent = 0, cell = 0;
  Cloud queries;
  OctreeRegionSearch<Point> linear, octree{OctreeRegionSearch<Point>::Octree},
      avl{OctreeRegionSearch<Point>::AVL};
  std::unique_ptr<PclOctree> pcl_octree, pcl_octree_fine;
  pcl::search::KdTree<Point> kdtree{false};
  pcl::KdTreeFLANN<Point> flann{false};
  std::unique_ptr<NanoCloud> nano_cloud;
  std::unique_ptr<Nano> nano;

  explicit Subject(const Cloud::Ptr& points) : cloud(points)
  {
    Point low = points->front(), high = low;
    for (const auto& p : *points)
      for (int a = 0; a < 3; ++a) {
        low.data[a] = std::min(low.data[a], p.data[a]);
        high.data[a] = std::max(high.data[a], p.data[a]);
      }
    for (int a = 0; a < 3; ++a)
      extent = std::max(extent, double(high.data[a]) - low.data[a]);
    CounterRandom random(1);
    for (int i = 0; i < 1024; ++i)
      queries.push_back((*points)[random.below(static_cast<std::uint32_t>(points->size()))]);
    octree.setInputCloud(cloud);
    // PCL's octree gets the cells that suit it best here, and finer ones as users often choose.
    cell = suggestCellSize(
        {&cloud->front().x, &cloud->front().y, &cloud->front().z, 4, cloud->size()}, 8);
    avl.setInputCloud(cloud);
    linear.setInputCloud(cloud);
    pcl_octree = std::make_unique<PclOctree>(cell);
    pcl_octree->setInputCloud(cloud);
    pcl_octree->addPointsFromInputCloud();
    pcl_octree_fine = std::make_unique<PclOctree>(cell / 4);
    pcl_octree_fine->setInputCloud(cloud);
    pcl_octree_fine->addPointsFromInputCloud();
    kdtree.setInputCloud(cloud);
    flann.setInputCloud(cloud);
    nano_cloud = std::make_unique<NanoCloud>(NanoCloud{*cloud});
    nano = std::make_unique<Nano>(3, *nano_cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
    nano->buildIndex();
  }
};

using Query = std::function<std::size_t(Subject&, const Point&, double)>;

struct Results {
  pcl::Indices indices;
  std::vector<float> squares;
  std::vector<PlaceRange> ranges;
  std::vector<std::pair<std::uint32_t, float>> matches;
};

/** \brief The ways to ask; those of peers begin with "peer". */
std::vector<std::pair<std::string, Query>>
queryKinds()
{
  const auto out = std::make_shared<Results>();
  return {
      {"linear",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.linear.radiusSearch(q, r, out->indices, out->squares));
       }},
      {"linear_indices",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.linear.radiusSearchIndices(q, r, out->indices));
       }},
      {"linear_ranges",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.linear.radiusSearchRanges(q, r, out->ranges));
       }},
      {"octree",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.octree.radiusSearch(q, r, out->indices, out->squares));
       }},
      {"avl",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.avl.radiusSearch(q, r, out->indices, out->squares));
       }},
      {"peer_pcl_octree",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.pcl_octree->radiusSearch(q, r, out->indices, out->squares));
       }},
      {"peer_pcl_octree_fine",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.pcl_octree_fine->radiusSearch(q, r, out->indices, out->squares));
       }},
      {"peer_search_kdtree",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.kdtree.radiusSearch(q, r, out->indices, out->squares));
       }},
      {"peer_kdtree_flann",
       [out](Subject& s, const Point& q, double r) {
         return std::size_t(s.flann.radiusSearch(q, r, out->indices, out->squares));
       }},
      {"peer_nanoflann",
       [out](Subject& s, const Point& q, double r) {
         nanoflann::SearchParams unsorted;
         unsorted.sorted = false;
         return s.nano->radiusSearch(q.data, float(r * r), out->matches, unsorted);
       }},
  };
}

std::map<std::string, std::unique_ptr<Subject>>&
subjects()
{
  static std::map<std::string, std::unique_ptr<Subject>> all;
  return all;
}

/** \brief Clouds are built when the first benchmark that survives --benchmark_filter needs them. */
Subject&
subject(const std::string& name)
{
  auto& s = subjects()[name];
  if (s)
    return *s;
  Cloud::Ptr cloud;
  if (name == "cube84k")
    cloud = cubeCloud(84000);
  else if (name == "cube1700k")
    cloud = cubeCloud(1700000);
  else if (name == "scan200k")
    cloud = fileOr("PCL_SURFLET_SCAN", [] { return scanCloud(200000); });
  else
    cloud = reduced(*fileOr("PCL_SURFLET_SCENE", [] { return tableCloud(770000); }), 0.0042);
  s = std::make_unique<Subject>(cloud);
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
        std::snprintf(title, sizeof title, "%s,r%.2f/%s", name, share, kind.c_str());
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
    auto t = times_[group][kind];
    if (t.empty())
      return NAN;
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
