/** \file
 * Cells of a scene that grows, and which of them changed; internal, not installed. */
#pragma once

#include "core/cell_sums.h"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace pcl_surflet {
namespace online {

/** \brief Coordinates of a cell, or of a block of them. */
using CellKey = std::array<std::int64_t, 3>;

struct CellKeyHash {
  std::size_t operator()(const CellKey& key) const;
};

/** \brief Mean surflets of cells, two where both sides of a wall are seen: the side of a surflet is
 * the sign of its normal against the first one of the cell. */
class OnlineCells {
public:
  explicit OnlineCells(double leaf);

  /** \brief Adds surflet \p i of \p set, which is finite and of unit normal. \return false, adding
   * nothing, if it is too far away for a key */
  bool add(const SurfletSet& set, std::size_t i);

  /** \brief Brings \ref means up to date. \return cells that are new, or whose mean moved by more
   * than \p moved leaves or turned by more than \p turned rad since they were last returned */
  std::vector<std::uint32_t> takeChanged(double moved, double turned);

  const SurfletSet&
  means() const
  {
    return means_;
  }
  const CellKey&
  keyOf(std::uint32_t cell) const
  {
    return keys_[cell];
  }

private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Sides {
    std::array<float, 3> first{};
    std::array<std::uint32_t, 2> cell{kNone, kNone};
  };

  std::uint32_t& cellOf(const SurfletSet& set, std::size_t i, const CellKey& key);

  double leaf_;
  std::unordered_map<CellKey, Sides, CellKeyHash> sides_;
  std::vector<CellKey> keys_;
  std::vector<detail::CellSums> sums_;
  std::vector<std::uint32_t> touched_;
  std::vector<bool> is_touched_;
  SurfletSet means_, taken_; ///< taken_: as last returned, shorter by what is new
};

} // namespace online
} // namespace pcl_surflet
