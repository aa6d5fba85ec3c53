#include "pcl_surflet/core/surflet_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_surflet {

void
SurfletSet::reserve(std::size_t n)
{
  for (auto* a : {&x, &y, &z, &nx, &ny, &nz})
    a->reserve(n);
}

void
SurfletSet::clear()
{
  for (auto* a : {&x, &y, &z, &nx, &ny, &nz})
    a->clear();
}

void
SurfletSet::push_back(const Surflet& s)
{
  x.push_back(s.x);
  y.push_back(s.y);
  z.push_back(s.z);
  nx.push_back(s.nx);
  ny.push_back(s.ny);
  nz.push_back(s.nz);
}

bool
SurfletSet::appendChecked(const Surflet& s)
{
  if (!std::isfinite(s.x) || !std::isfinite(s.y) || !std::isfinite(s.z))
    return false;
  // In double precision neither the largest nor the smallest float overflows when squared.
  const double length =
      std::sqrt(static_cast<double>(s.nx) * s.nx + static_cast<double>(s.ny) * s.ny +
                static_cast<double>(s.nz) * s.nz);
  if (!(length > 0) || !std::isfinite(length))
    return false;
  push_back({s.x, s.y, s.z, static_cast<float>(s.nx / length), static_cast<float>(s.ny / length),
             static_cast<float>(s.nz / length)});
  return true;
}

SurfletSet
SurfletSet::subset(const std::vector<std::uint32_t>& indices) const
{
  SurfletSet out;
  out.reserve(indices.size());
  for (const auto i : indices)
    out.push_back((*this)[i]);
  return out;
}

Extent
computeExtent(const SurfletSet& set)
{
  Extent e;
  const std::size_t n = set.size();
  if (n == 0)
    return e;
  for (std::size_t i = 0; i < n; ++i) {
    e.centroid[0] += set.x[i];
    e.centroid[1] += set.y[i];
    e.centroid[2] += set.z[i];
  }
  for (double& c : e.centroid)
    c /= static_cast<double>(n);
  double sum = 0;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    const double r = std::sqrt((set.x[i] - e.centroid[0]) * (set.x[i] - e.centroid[0]) +
                               (set.y[i] - e.centroid[1]) * (set.y[i] - e.centroid[1]) +
                               (set.z[i] - e.centroid[2]) * (set.z[i] - e.centroid[2]));
    sum += r;
    e.r_max = std::max(e.r_max, r);
    smallest = std::min(smallest, r);
  }
  e.r_mean = sum / static_cast<double>(n);
  e.r_min = smallest;
  return e;
}

UnitSurflets
toUnitScale(const SurfletSet& set)
{
  UnitSurflets unit;
  const Extent e = computeExtent(set);
  if (e.r_max > 0)
    unit.scale = std::ldexp(1.0, -std::ilogb(e.r_max) - 1);
  unit.set = set;
  for (std::size_t i = 0; i < set.size(); ++i) {
    unit.set.x[i] = static_cast<float>((set.x[i] - e.centroid[0]) * unit.scale);
    unit.set.y[i] = static_cast<float>((set.y[i] - e.centroid[1]) * unit.scale);
    unit.set.z[i] = static_cast<float>((set.z[i] - e.centroid[2]) * unit.scale);
  }
  return unit;
}

} // namespace pcl_surflet
