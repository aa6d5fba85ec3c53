#include "free_space.h"

#include "core/vector3.h"
#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_surflet {
namespace online {
namespace {

constexpr std::size_t kBlock = 256; ///< cells asked at a time by one thread

/** \brief Length of \p v, which becomes a unit vector. */
double
normalise(Place& v)
{
  const double length = std::hypot(v[0], v[1], v[2]);
  for (double& a : v)
    a /= length;
  return length;
}

} // namespace

FreeSpace::FreeSpace(const SurfletSet& ends, const Place& sensor, double radius, double behind,
                     std::size_t rays)
    : sensor_(sensor), radius_(radius), behind_(behind), rays_(rays)
{
  std::array<std::vector<float>, 3> d;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    Place ray = detail::subtract({ends.x[i], ends.y[i], ends.z[i]}, sensor);
    const double length = normalise(ray);
    if (!(length > 0) || !std::isfinite(length))
      continue;
    for (std::size_t a = 0; a < 3; ++a)
      d[a].push_back(static_cast<float>(ray[a]));
    lengths_.push_back(length);
  }
  directions_.build({d[0].data(), d[1].data(), d[2].data(), 1, lengths_.size()});
}

/** \brief Finds the rays whose lines pass within \p radius of a place in front of the sensor.
 * \return its distance from the sensor; 0 if the sensor is within the radius */
double
FreeSpace::passing(const Place& place, double radius, std::vector<PlaceRange>& ranges) const
{
  Place direction = detail::subtract(place, sensor_);
  const double distance = normalise(direction);
  ranges.clear();
  if (!(distance > radius))
    return 0;
  // The chord of the angle asin (radius / distance), less than 4 % short up to 0.5.
  directions_.regionRanges({static_cast<float>(direction[0]), static_cast<float>(direction[1]),
                            static_cast<float>(direction[2])},
                           radius / distance, ranges);
  return distance;
}

bool
FreeSpace::looksAt(const Place& place, double radius) const
{
  std::vector<PlaceRange> ranges;
  return passing(place, 1.1 * radius, ranges) == 0 || !ranges.empty();
}

bool
FreeSpace::isSeenThrough(const Place& place) const
{
  std::vector<PlaceRange> ranges;
  const double distance = passing(place, radius_, ranges);
  std::size_t rays = 0;
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& r : ranges) {
    rays += r.end - r.begin;
    for (std::uint32_t at = r.begin; at < r.end; ++at)
      shortest = std::min(shortest, lengths_[static_cast<std::size_t>(directions_.indexAt(at))]);
  }
  return rays >= std::max<std::size_t>(rays_, 1) && shortest > distance + behind_;
}

Indices
FreeSpace::seenThrough(const OnlineCells& cells, const Indices& candidates, unsigned threads) const
{
  std::vector<char> is_gone(candidates.size());
  parallelFor((candidates.size() + kBlock - 1) / kBlock, threads, [&](std::size_t b, unsigned) {
    const std::size_t end = std::min(candidates.size(), (b + 1) * kBlock);
    for (std::size_t k = b * kBlock; k < end; ++k)
      is_gone[k] = isSeenThrough(cells.placeOf(candidates[k])) ? 1 : 0;
  });
  Indices gone;
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (is_gone[k] != 0)
      gone.push_back(candidates[k]);
  return gone;
}

} // namespace online
} // namespace pcl_surflet
