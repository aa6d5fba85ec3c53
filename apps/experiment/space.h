/** \file
 * Region search in a uniform cube by four representations of space [Wahl 2007, Exp. 4.6]. */
#pragma once

#include "experiment/output.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

struct SpaceOptions {
  std::string out; ///< directory of the results, made if missing
  std::uint64_t saturations = 10, radii = 20, queries = 500, seed = 1;
};

/** \brief A linked list (the naive approach), the dissertation's two trees, and this library's. */
enum SpaceMethod : std::size_t { List, Octree, AVL, Linear, kSpaceMethods };

/** \brief Their names in tables. */
const char* const* spaceMethodNames();

/** \brief Outcome for one saturation and radius. */
struct SpaceRow {
  double saturation, radius;
  double hits;                                 ///< points found, mean over the queries
  std::array<double, kSpaceMethods> seconds;   ///< per search, the median
  std::array<double, kSpaceMethods> per_point; ///< bytes
};

/** \brief Relative time in percent [Wahl 2007, Eq. 4.32]: 0 is the fastest of list, octree, AVL. */
double relativeTime(const SpaceRow& row, std::size_t method);

/** \brief Saturation s = N / 8^8 of step \p i, from 0.001 to 0.1 [Wahl 2007, Eq. 4.31]. */
double saturationOf(const SpaceOptions& options, std::uint64_t i);

/** \brief Uniform points in the unit cube, d_max = 8, radii from 0.01 to 0.5, one thread: a row per
 * saturation and radius, in this order. Points and queries depend on the seed alone. */
std::vector<SpaceRow> runSpace(const SpaceOptions& options, const ProgressFunction& progress);

} // namespace apps
} // namespace pcl_surflet
