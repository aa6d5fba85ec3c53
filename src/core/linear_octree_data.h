/** \file
 * Inside of the linear octree: arrays and their construction. */
#pragma once

#include "pcl_surflet/core/linear_octree.h"

#include "kernels/region_kernel.h"
#include "radix_sort.h"

#include <vector>

namespace pcl_surflet {

struct LinearOctree::Data {
  Options options;
  const kernels::RegionKernels* kernels = nullptr;
  std::size_t size = 0;
  std::vector<float> x, y, z; // padded by kRegionSlack
  std::vector<PointIndex> index;
  std::vector<kernels::RegionNode> nodes;

  kernels::RegionTree
  view() const
  {
    return {x.data(), y.data(), z.data(), index.data(), nodes.data()};
  }
};

namespace detail {

/** \brief A tight box; empty at first. */
struct Box {
  float low[3];
  float high[3];
  Box();
  void add(const Box& other);
};

/** \brief Sorts points along the Morton curve and lays the nodes over them. */
class LinearOctreeBuilder {
public:
  LinearOctreeBuilder(const PointArray& points, std::uint32_t leaf_size);

  /** \brief Takes the finite points (of \p subset, if given) and sorts them. */
  void sortPoints(const std::vector<PointIndex>* subset);

  std::size_t
  size() const
  {
    return x.empty() ? 0 : x.size() - kernels::kRegionSlack;
  }

  std::vector<float> x, y, z;
  std::vector<PointIndex> index;
  std::vector<kernels::RegionNode> nodes;

private:
  using Item = KeyedIndex<std::uint32_t>;
  static constexpr int kDepth = 10; ///< levels of one key

  Box boxOf(std::size_t begin, std::size_t end) const;
  void sortRange(std::size_t begin, std::size_t end, const Box& box);
  void gather(std::size_t begin, std::size_t end);
  void makeNodes();
  std::uint32_t makeChild(std::uint32_t begin, std::uint32_t end, int level, Box& box);
  std::uint32_t makeNode(std::uint32_t begin, std::uint32_t end, int level, Box& box);
  int firstDifferentLevel(std::uint32_t begin, std::uint32_t end, int level) const;
  std::uint32_t addEmptyNode();
  void setChild(std::uint32_t node, int slot, std::uint32_t child, std::uint32_t begin,
                std::uint32_t end, const Box& box);

  const PointArray& points_;
  std::uint32_t leaf_size_;
  std::vector<Item> items_, scratch_;
};

} // namespace detail
} // namespace pcl_surflet
