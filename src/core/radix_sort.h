/** \file
 * Stable radix sort of keys that carry an index. */
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_surflet {
namespace detail {

template <class Key>
struct KeyedIndex {
  Key key;
  std::uint32_t index;
};

/** \brief Sorts \p items by the low \p bits of their keys, keeping the order of equal keys.
 *
 * Least significant digit first, at most 11 bits a pass: a histogram of 2048 counters stays in the
 * first-level cache. All histograms come from one pass over the keys; a digit that all keys share
 * costs no pass. \p scratch is resized as needed. */
template <class Key>
void
radixSort(std::vector<KeyedIndex<Key>>& items, std::vector<KeyedIndex<Key>>& scratch, int bits)
{
  constexpr int kMaxBits = 11;
  const int passes = (bits + kMaxBits - 1) / kMaxBits;
  if (passes == 0 || items.size() < 2)
    return;
  const int width = (bits + passes - 1) / passes;
  const std::size_t buckets = std::size_t{1} << width;
  const Key mask = static_cast<Key>(buckets - 1);
  std::vector<std::uint32_t> counts(passes * buckets, 0);
  for (const auto& item : items)
    for (int p = 0; p < passes; ++p)
      ++counts[p * buckets + (item.key >> (p * width) & mask)];
  scratch.resize(items.size());
  for (int p = 0; p < passes; ++p) {
    std::uint32_t* const count = counts.data() + p * buckets;
    if (count[items[0].key >> (p * width) & mask] == items.size())
      continue;
    std::uint32_t offset = 0;
    for (std::size_t b = 0; b < buckets; ++b) {
      const std::uint32_t n = count[b];
      count[b] = offset;
      offset += n;
    }
    for (const auto& item : items)
      scratch[count[item.key >> (p * width) & mask]++] = item;
    items.swap(scratch);
  }
}

} // namespace detail
} // namespace pcl_surflet
