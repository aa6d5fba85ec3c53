#include "region_search/clouds.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/counter_random.h"

#include <pcl/io/pcd_io.h>

#include <cmath>
#include <cstdlib>
#include <functional>

namespace pcl_surflet {
namespace region_search {

namespace {

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

} // namespace

Cloud::Ptr
cubeCloud(std::size_t n)
{
  CounterRandom random(n);
  auto cloud = std::make_shared<Cloud>();
  for (std::size_t i = 0; i < n; ++i)
    cloud->push_back({float(random.uniform()), float(random.uniform()), float(random.uniform())});
  return cloud;
}

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

Cloud::Ptr
namedCloud(const std::string& name)
{
  if (name == "cube84k")
    return cubeCloud(84000);
  if (name == "cube1700k")
    return cubeCloud(1700000);
  if (name == "scan200k")
    return fileOr("PCL_SURFLET_SCAN", [] { return scanCloud(200000); });
  return reduced(*fileOr("PCL_SURFLET_SCENE", [] { return tableCloud(770000); }), 0.0042);
}

} // namespace region_search
} // namespace pcl_surflet
