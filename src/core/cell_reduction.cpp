#include "pcl_surflet/core/cell_reduction.h"

#include "cell_sums.h"
#include "number_text.h"
#include "pcl_surflet/core/morton_key.h"
#include "radix_sort.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace pcl_surflet {

namespace {

using detail::CellSums;

/** \brief The cells the set spans: the lowest cell and the bits a cell number needs per axis. */
struct CellGrid {
  double inverse_leaf = 0;
  double lowest[3] = {0, 0, 0}; ///< integer-valued
  int bits = 0;
};

bool
isFinite(const SurfletSet& s, std::size_t i)
{
  // A sum of finite floats is finite in double precision, and any other summand spoils it.
  return std::isfinite(static_cast<double>(s.x[i]) + s.y[i] + s.z[i] + s.nx[i] + s.ny[i] + s.nz[i]);
}

CellGrid
makeGrid(const SurfletSet& set, double leaf)
{
  CellGrid grid;
  grid.inverse_leaf = 1 / leaf;
  constexpr float inf = std::numeric_limits<float>::infinity();
  float low[3] = {inf, inf, inf}, high[3] = {-inf, -inf, -inf};
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (!isFinite(set, i))
      continue;
    const float p[3] = {set.x[i], set.y[i], set.z[i]};
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a]);
    }
  }
  double cells = 0;
  for (int a = 0; a < 3 && low[a] <= high[a]; ++a) {
    grid.lowest[a] = std::floor(low[a] * grid.inverse_leaf);
    cells = std::max(cells, std::floor(high[a] * grid.inverse_leaf) - grid.lowest[a]);
  }
  if (!(cells < 0x1p53))
    throw std::invalid_argument("pcl_surflet: cells of edge " + detail::numberText(leaf) +
                                " are too small for so wide a cloud; set a larger leaf");
  while (std::ldexp(1.0, grid.bits) <= cells)
    ++grid.bits;
  return grid;
}

/** \brief Coordinates of the cell of surflet \p i, counted from the lowest cell. */
std::array<std::uint64_t, 3>
cellCoordinates(const SurfletSet& set, const CellGrid& grid, std::size_t i)
{
  return {static_cast<std::uint64_t>(std::floor(set.x[i] * grid.inverse_leaf) - grid.lowest[0]),
          static_cast<std::uint64_t>(std::floor(set.y[i] * grid.inverse_leaf) - grid.lowest[1]),
          static_cast<std::uint64_t>(std::floor(set.z[i] * grid.inverse_leaf) - grid.lowest[2])};
}

/** \brief Numbers the cells in the order of \p items' keys; returns how many there are. */
template <class Items>
std::uint32_t
numberCells(const Items& items, std::vector<std::uint32_t>& cell_of)
{
  std::uint32_t cells = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    cells += i == 0 || items[i].key != items[i - 1].key;
    cell_of[items[i].index] = cells - 1;
  }
  return cells;
}

/** \brief Sorts the finite surflets by cell and numbers the cells: keys of one machine word. */
template <class Word>
std::uint32_t
assignCells(const SurfletSet& set, const CellGrid& grid, std::vector<std::uint32_t>& cell_of)
{
  std::vector<detail::KeyedIndex<Word>> items, scratch;
  items.reserve(set.size());
  for (std::size_t i = 0; i < set.size(); ++i)
    if (isFinite(set, i)) {
      const auto c = cellCoordinates(set, grid, i);
      const auto key =
          detail::spread3(c[0]) | detail::spread3(c[1]) << 1 | detail::spread3(c[2]) << 2;
      items.push_back({static_cast<Word>(key), static_cast<std::uint32_t>(i)});
    }
  detail::radixSort(items, scratch, 3 * grid.bits);
  return numberCells(items, cell_of);
}

/** \brief The same for grids too large for one word: rare, so a comparison sort will do. */
std::uint32_t
assignWideCells(const SurfletSet& set, const CellGrid& grid, std::vector<std::uint32_t>& cell_of)
{
  std::vector<detail::KeyedIndex<WideMortonKey>> items;
  for (std::size_t i = 0; i < set.size(); ++i)
    if (isFinite(set, i))
      items.push_back({WideMortonKey::fromCoordinates(cellCoordinates(set, grid, i), grid.bits),
                       static_cast<std::uint32_t>(i)});
  std::sort(items.begin(), items.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  return numberCells(items, cell_of);
}

std::vector<CellSums>
sumCells(const SurfletSet& set, const std::vector<std::uint32_t>& cell_of, std::uint32_t cells)
{
  // In input order: the set is streamed, and scans visit a cell's neighbours soon after it.
  std::vector<CellSums> sums(cells);
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (cell_of[i] == CellReduction::no_cell)
      continue;
    sums[cell_of[i]].add(set, i);
  }
  return sums;
}

/** \brief Turns sums into mean surflets; cells whose normals cancel get no place in the result. */
void
appendMeans(const std::vector<CellSums>& sums, double min_mean_normal, CellReduction& result,
            std::vector<std::uint32_t>& new_number)
{
  result.cells.reserve(sums.size());
  result.counts.reserve(sums.size());
  for (std::size_t c = 0; c < sums.size(); ++c) {
    const auto& [p, n, count] = sums[c];
    const double length = sums[c].normalLength();
    if (!(length > 0) || length < min_mean_normal * count) {
      new_number[c] = CellReduction::no_cell;
      ++result.cancelled_cells;
      result.cancelled_surflets += count;
      continue;
    }
    new_number[c] = static_cast<std::uint32_t>(result.cells.size());
    result.cells.push_back({static_cast<float>(p[0] / count), static_cast<float>(p[1] / count),
                            static_cast<float>(p[2] / count), static_cast<float>(n[0] / length),
                            static_cast<float>(n[1] / length), static_cast<float>(n[2] / length)});
    result.counts.push_back(count);
  }
}

void
checkOptions(const CellReductionOptions& options)
{
  if (!(options.leaf > 0) || !std::isfinite(options.leaf) || !std::isfinite(1 / options.leaf))
    throw std::invalid_argument(
        "pcl_surflet: the edge of cells must be positive and finite, it is " +
        detail::numberText(options.leaf));
  if (!(options.min_mean_normal >= 0 && options.min_mean_normal <= 1))
    throw std::invalid_argument("pcl_surflet: min_mean_normal must be in [0, 1], it is " +
                                detail::numberText(options.min_mean_normal));
  if (!(options.split_below >= 0 && options.split_below <= 1))
    throw std::invalid_argument("pcl_surflet: split_below must be in [0, 1], it is " +
                                detail::numberText(options.split_below));
}

} // namespace

CellReduction
reduceToCells(const SurfletSet& set, const CellReductionOptions& options)
{
  checkOptions(options);
  CellReduction result;
  result.cell_of.assign(set.size(), CellReduction::no_cell);
  const CellGrid grid = makeGrid(set, options.leaf);
  const std::uint32_t cells =
      grid.bits <= 10   ? assignCells<std::uint32_t>(set, grid, result.cell_of)
      : grid.bits <= 21 ? assignCells<std::uint64_t>(set, grid, result.cell_of)
                        : assignWideCells(set, grid, result.cell_of);
  auto sums = sumCells(set, result.cell_of, cells);
  if (options.split_below > 0)
    detail::splitSides(set, options.split_below, sums, result.cell_of);
  std::vector<std::uint32_t> new_number(sums.size());
  appendMeans(sums, options.min_mean_normal, result, new_number);
  for (auto& cell : result.cell_of) {
    result.rejected += cell == CellReduction::no_cell;
    if (result.cancelled_cells > 0 && cell != CellReduction::no_cell)
      cell = new_number[cell];
  }
  return result;
}

CellReduction
reduceToCells(const SurfletSet& set, double leaf)
{
  CellReductionOptions options;
  options.leaf = leaf;
  return reduceToCells(set, options);
}

CellReduction
reduceToTwoSidedCells(const SurfletSet& set, double leaf)
{
  CellReductionOptions options;
  options.leaf = leaf;
  options.split_below = kTwoSided;
  return reduceToCells(set, options);
}

} // namespace pcl_surflet
