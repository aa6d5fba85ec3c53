/** \file
 * Cells of a scene that grows, and which of them changed; internal, not installed. */
#pragma once

#include "core/cell_sums.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace pcl_surflet {
namespace online {

using Indices = std::vector<std::uint32_t>;
using Place = std::array<double, 3>;

/** \brief Coordinates of a cell, or of a block of them. */
using CellKey = std::array<std::int64_t, 3>;

struct CellKeyHash {
  std::size_t operator()(const CellKey& key) const;
};

/** \brief Mean surflets of cells, two where both sides of a wall are seen: the side of a surflet is
 * the sign of its normal against the first one of the cell.
 *
 * All changes since begin() can be taken back, at the cost of what changed. */
class OnlineCells {
public:
  /** \param block edge of the blocks by which near() finds cells */
  OnlineCells(double leaf, double block);

  /** \brief What was done so far stays. */
  void begin() noexcept;
  /** \brief Everything is as it was at begin(). */
  void rollBack() noexcept;

  /** \brief Adds surflet \p i of \p set, which is finite and of unit normal. \return false, adding
   * nothing, if it is too far away for a key */
  bool add(const SurfletSet& set, std::size_t i);
  /** \brief The cell is no more; its number is not given again. */
  void remove(std::uint32_t cell);
  /** \brief Only for cells that takeChanged() has just returned. */
  void setBackground(std::uint32_t cell, bool is_background);

  /** \brief Brings \ref means up to date. \return cells that are new, or whose mean moved by more
   * than \p moved leaves or turned by more than \p turned rad since they were last returned;
   * ascending */
  Indices takeChanged(double moved, double turned);

  /** \brief Those that take part, ascending: within \p reach of one of \p places, or a little
   * farther, by whole blocks. */
  Indices near(const std::vector<Place>& places, double reach) const;
  /** \brief Those that take part and that nothing was added to since begin(), ascending, in blocks
   * that \p is_wanted (middle, half diagonal). */
  template <class IsWanted>
  Indices untouched(const IsWanted& is_wanted) const;

  /** \brief Cells that are no more hold NaN. */
  const SurfletSet&
  means() const
  {
    return means_;
  }
  Place
  placeOf(std::uint32_t cell) const
  {
    return {means_.x[cell], means_.y[cell], means_.z[cell]};
  }
  const CellKey&
  keyOf(std::uint32_t cell) const
  {
    return cells_[cell].key;
  }
  /** \brief Is it there, and no background? */
  bool
  takesPart(std::uint32_t cell) const
  {
    return cells_[cell].is_there && !cells_[cell].is_background;
  }
  /** \brief Appends those of the cell \p key that take part. */
  void append(const CellKey& key, Indices& cells) const;

private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Sides {
    std::array<float, 3> first{};
    std::array<std::uint32_t, 2> cell{kNone, kNone};
  };
  struct Cell {
    CellKey key{};
    detail::CellSums sums;
    Surflet taken;               ///< as last returned
    std::uint64_t saved_for = 0; ///< number of the begin() since which it changed
    bool is_taken = false, is_there = true, is_background = false;
  };

  CellKey blockOf(const CellKey& cell) const;
  Place middleOf(const CellKey& block) const;
  void save(std::uint32_t cell);
  Sides& sidesFor(const CellKey& key, const SurfletSet& set, std::size_t i);
  std::uint32_t appended(const CellKey& key);

  double leaf_;
  std::int64_t cells_per_block_;
  std::unordered_map<CellKey, Sides, CellKeyHash> sides_;
  std::unordered_map<CellKey, Indices, CellKeyHash> blocks_;
  std::vector<Cell> cells_;
  SurfletSet means_;

  // What was done since begin(), and what was there before.
  struct SavedCell {
    std::uint32_t cell;
    Cell before;
    Surflet mean;
  };
  struct SavedSides {
    CellKey key;
    bool was_there;
    Sides before;
  };
  std::uint64_t begun_ = 1;
  std::size_t cells_before_ = 0;
  Indices touched_, removed_;
  std::vector<SavedCell> saved_cells_;
  std::vector<SavedSides> saved_sides_;
};

template <class IsWanted>
Indices
OnlineCells::untouched(const IsWanted& is_wanted) const
{
  const double half_diagonal =
      0.87 * leaf_ * static_cast<double>(cells_per_block_); // sqrt (3) / 2, rounded up
  Indices found;
  for (const auto& [block, cells] : blocks_)
    if (!cells.empty() && is_wanted(middleOf(block), half_diagonal))
      for (const auto c : cells)
        if (takesPart(c) && cells_[c].saved_for != begun_)
          found.push_back(c);
  std::sort(found.begin(), found.end());
  return found;
}

} // namespace online
} // namespace pcl_surflet
