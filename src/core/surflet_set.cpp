#include "pcl_surflet/core/surflet_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_surflet {
namespace {

/** \brief Squared lengths this close to 1 are those of a unit vector in single precision. */
constexpr double kUnitTolerance = 4e-7;

/** \brief Of a set that is not empty. */
void
setToMeanPosition(const SurfletSet& set, double (&mean)[3])
{
  double x = 0, y = 0, z = 0; // three independent chains of additions
  for (std::size_t i = 0; i < set.size(); ++i) {
    x += set.x[i];
    y += set.y[i];
    z += set.z[i];
  }
  const auto n = static_cast<double>(set.size());
  mean[0] = x / n;
  mean[1] = y / n;
  mean[2] = z / n;
}

} // namespace

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
  const double squared = static_cast<double>(s.nx) * s.nx + static_cast<double>(s.ny) * s.ny +
                         static_cast<double>(s.nz) * s.nz;
  if (!(squared > 0) || !std::isfinite(squared))
    return false;
  if (std::abs(squared - 1) < kUnitTolerance) { // most normals; a root and divisions less
    push_back(s);
    return true;
  }
  const double length = std::sqrt(squared);
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
  setToMeanPosition(set, e.centroid);
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
  const std::size_t n = set.size();
  if (n == 0)
    return unit;
  double centre[3];
  setToMeanPosition(set, centre);
  double reach[3] = {0, 0, 0};
  for (std::size_t i = 0; i < n; ++i) {
    reach[0] = std::max(reach[0], std::abs(set.x[i] - centre[0]));
    reach[1] = std::max(reach[1], std::abs(set.y[i] - centre[1]));
    reach[2] = std::max(reach[2], std::abs(set.z[i] - centre[2]));
  }
  const double farthest = std::max({reach[0], reach[1], reach[2]});
  if (farthest > 0 && std::isfinite(farthest))
    unit.scale = std::ldexp(1.0, -std::ilogb(farthest) - 1);
  unit.set = set;
  const auto convert = [&](std::vector<float>& column, double c) {
    for (float& v : column)
      v = static_cast<float>((v - c) * unit.scale);
  };
  convert(unit.set.x, centre[0]);
  convert(unit.set.y, centre[1]);
  convert(unit.set.z, centre[2]);
  return unit;
}

} // namespace pcl_surflet
