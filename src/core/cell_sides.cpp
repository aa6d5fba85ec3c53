#include "cell_sums.h"

#include "pcl_surflet/core/cell_reduction.h"

#include <algorithm>
#include <array>

namespace pcl_surflet {
namespace detail {
namespace {

using Vector = std::array<double, 3>;

constexpr std::uint32_t kWhole = CellReduction::no_cell;
/** \brief Squarings of the scatter matrix: its first axis then outweighs another one half as strong
 * 2^64 times. */
constexpr int kSquarings = 6;

/** \brief Scatter of normals about 0, which does not tell n from -n. */
struct Scatter {
  double m[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

  void
  add(const Vector& n)
  {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        m[a][b] += n[a] * n[b];
  }
  /** \brief The axis along which it is largest; where it points is settled by its largest
   * component, which is positive. */
  Vector axis() const;
};

Vector
Scatter::axis() const
{
  Scatter power = *this;
  for (int k = 0; k < kSquarings; ++k) {
    const double trace = power.m[0][0] + power.m[1][1] + power.m[2][2];
    if (!(trace > 0))
      return {0, 0, 1};
    Scatter square;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        for (int c = 0; c < 3; ++c)
          square.m[a][b] += power.m[a][c] / trace * (power.m[c][b] / trace);
    power = square;
  }
  int longest = 0; // the column of the largest diagonal element is the longest
  for (int a = 1; a < 3; ++a)
    if (power.m[a][a] > power.m[longest][longest])
      longest = a;
  return {power.m[0][longest], power.m[1][longest], power.m[2][longest]};
}

/** \brief The number of each two-sided cell among these, or kWhole. */
std::vector<std::uint32_t>
twoSided(const std::vector<CellSums>& sums, double split_below, std::uint32_t& found)
{
  std::vector<std::uint32_t> number(sums.size(), kWhole);
  found = 0;
  for (std::size_t c = 0; c < sums.size(); ++c)
    if (sums[c].count > 1 && sums[c].normalLength() < split_below * sums[c].count)
      number[c] = found++;
  return number;
}

Vector
normalOf(const SurfletSet& set, std::size_t i)
{
  return {set.nx[i], set.ny[i], set.nz[i]};
}

std::vector<Vector>
axesOf(const SurfletSet& set, const std::vector<std::uint32_t>& number,
       const std::vector<std::uint32_t>& cell_of, std::size_t cells)
{
  std::vector<Scatter> scatter(cells);
  for (std::size_t i = 0; i < set.size(); ++i)
    if (cell_of[i] != CellReduction::no_cell && number[cell_of[i]] != kWhole)
      scatter[number[cell_of[i]]].add(normalOf(set, i));
  std::vector<Vector> axes;
  axes.reserve(cells);
  for (const auto& s : scatter)
    axes.push_back(s.axis());
  return axes;
}

} // namespace

void
splitSides(const SurfletSet& set, double split_below, std::vector<CellSums>& sums,
           std::vector<std::uint32_t>& cell_of)
{
  std::uint32_t cells = 0;
  const auto number = twoSided(sums, split_below, cells);
  if (cells == 0)
    return;
  const auto axes = axesOf(set, number, cell_of, cells);
  std::vector<std::uint32_t> place(sums.size());
  std::vector<CellSums> split;
  split.reserve(sums.size() + cells);
  for (std::size_t c = 0; c < sums.size(); ++c) {
    place[c] = static_cast<std::uint32_t>(split.size());
    split.push_back(number[c] == kWhole ? sums[c] : CellSums());
    if (number[c] != kWhole)
      split.emplace_back();
  }
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (cell_of[i] == CellReduction::no_cell)
      continue;
    const std::uint32_t side = number[cell_of[i]];
    cell_of[i] = place[cell_of[i]];
    if (side == kWhole)
      continue;
    const Vector n = normalOf(set, i), &a = axes[side];
    cell_of[i] += n[0] * a[0] + n[1] * a[1] + n[2] * a[2] < 0 ? 1 : 0;
    split[cell_of[i]].add(set, i);
  }
  sums = std::move(split);
}

} // namespace detail
} // namespace pcl_surflet
