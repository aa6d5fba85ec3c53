#include "steps.h"

#include <algorithm>
#include <iterator>

namespace pcl_surflet {
namespace interpretation {

Indices
common(const Indices& a, const Indices& b)
{
  Indices out;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
  return out;
}

Indices
united(const Indices& a, const Indices& b)
{
  Indices out;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
  return out;
}

ClustersOfModel
mergeSeeds(ClustersOfModel seeds, double lambda_o, std::size_t& lone)
{
  ClustersOfModel clusters;
  lone = 0;
  std::stable_sort(seeds.begin(), seeds.end(), [](const Cluster& a, const Cluster& b) {
    return a.likelihood > b.likelihood; // the best first, Eq. 5.16
  });
  while (!seeds.empty()) {
    const Cluster best = std::move(seeds.front());
    Cluster cluster;
    ClustersOfModel left;
    for (std::size_t j = 1; j < seeds.size(); ++j) {
      const Indices shared = common(best.surflets, seeds[j].surflets);
      const double size = static_cast<double>(seeds[j].surflets.size());
      if (static_cast<double>(shared.size()) > lambda_o * size) { // Eq. 5.17
        cluster.surflets = united(cluster.surflets, shared);
        ++cluster.seeds;
      }
      else
        left.push_back(std::move(seeds[j]));
    }
    if (cluster.seeds > 1)
      clusters.push_back(std::move(cluster));
    else
      ++lone;
    seeds = std::move(left);
  }
  return clusters;
}

} // namespace interpretation
} // namespace pcl_surflet
