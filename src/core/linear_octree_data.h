/** \file
 * Inside of the linear octree: arrays and their construction. */
#pragma once

#include "pcl_surflet/core/linear_octree.h"

#include "kernels/region_kernel.h"
#include "radix_sort.h"

#include <vector>

namespace pcl_surflet {

/** \brief The sorted points and the nodes over them. */
struct LinearOctree::Data {
  Options options;
  const kernels::RegionKernels* kernels = nullptr;
  std::size_t size = 0;
  std::vector<float> x, y, z; // padded by a block
  std::vector<PointIndex> index;
  std::vector<kernels::RegionNode> nodes;
  kernels::RegionTree tree{}; ///< refers to the arrays above
};

namespace detail {

/** \brief A tight box; empty at first. */
struct Box {
  float low[3];
  float high[3];
  Box();
};

/** \brief Sorts points along the Morton curve and lays the nodes over them. */
class LinearOctreeBuilder {
public:
  LinearOctreeBuilder(LinearOctree::Data& data, const PointArray& points);

  /** \brief Takes the finite points (of \p subset, if given), sorts them and makes the nodes. */
  void build(const std::vector<PointIndex>* subset);

private:
  using Item = KeyedIndex<std::uint32_t>;
  static constexpr int kDepth = 10; ///< levels of one key

  void takePoints(const std::vector<PointIndex>* subset);
  Box boxOf(std::size_t begin, std::size_t end) const;
  void sortRange(std::size_t begin, std::size_t end);
  void gather(std::size_t begin, std::size_t end);
  void fillNode(std::size_t node, std::uint32_t begin, std::uint32_t end);
  bool hasOneKey(std::uint32_t begin, std::uint32_t end) const;
  std::uint32_t middle(std::uint32_t begin, std::uint32_t end) const;
  int cutRange(std::uint32_t begin, std::uint32_t end, std::uint32_t enough,
               std::uint32_t* cuts) const;
  void setBox(std::size_t node, int slot, const Box& box);
  Box boxOfNode(std::size_t node) const;

  LinearOctree::Data& data_;
  const PointArray& points_;
  std::vector<Item> items_, scratch_;
};

} // namespace detail
} // namespace pcl_surflet
