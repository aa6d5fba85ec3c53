// The dynamic octree [Wahl 2007, Sec. 4.3.2]: leaves at depth d_max, inner nodes for the way there.
#include "cell_tree_detail.h"

#include <algorithm>

namespace pcl_surflet {
namespace detail {

namespace {

template <class Key>
class CellOctree : public CellTreeBase {
public:
  explicit CellOctree(const CubeFrame& frame) : CellTreeBase(frame) { takeNode(); }

  void
  add(PointIndex id, const Surflet& s) override
  {
    const auto cell = cellOf(s);
    if (cell == last_cell_ && last_bucket_ != kNone) // neighbours in space often come in a row
      return addToBucket(last_bucket_, cell, id, s);
    const Key key = Key::fromCoordinates(cell, frame_.depth);
    std::uint32_t node = 0;
    for (int level = 0; level < frame_.depth; ++level) {
      const int digit = key.digit(level);
      if (nodes_[node].child[digit] == kNone) {
        const std::uint32_t child = level + 1 < frame_.depth ? takeNode() : buckets_.take();
        nodes_[node].child[digit] = child;
      }
      node = nodes_[node].child[digit];
    }
    if (frame_.depth == 0 && buckets_.count() == 0)
      node = buckets_.take(); // the cube is one cell, bucket 0
    addToBucket(node, cell, id, s);
    last_cell_ = cell;
    last_bucket_ = node;
  }

  bool
  remove(PointIndex id, const Surflet& s) override
  {
    const auto cell = cellOf(s);
    const Key key = Key::fromCoordinates(cell, frame_.depth);
    std::uint32_t path[65] = {0};
    for (int level = 0; level < frame_.depth; ++level) {
      path[level + 1] = nodes_[path[level]].child[key.digit(level)];
      if (path[level + 1] == kNone)
        return false;
    }
    const std::uint32_t bucket = path[frame_.depth];
    if (size_ == 0 || !removeFromBucket(bucket, cell, id, s))
      return false;
    if (buckets_[bucket].points.empty())
      prune(path, key);
    return true;
  }

  std::size_t
  memoryUsage() const override
  {
    return sizeof(*this) + nodes_.capacity() * sizeof(Node) +
           free_.capacity() * sizeof(std::uint32_t) + buckets_.memoryUsage();
  }

  void
  forEachCell(const std::function<void(const Cell&)>& visit) const override
  {
    descend(root(), 0, {0, 0, 0}, nullptr, [&](std::uint32_t b, const auto& cell, bool) {
      visit(toCell(buckets_[b], frame_, cell));
    });
  }

  void
  boxSearch(const Position& low, const Position& high,
            std::vector<PointIndex>& indices) const override
  {
    indices.clear();
    const CellRange range = {frame_.coordinates({low[0], low[1], low[2]}),
                             frame_.coordinates({high[0], high[1], high[2]})};
    collectBox(root(), 0, {0, 0, 0}, range, low, high, indices);
  }

protected:
  void
  collectPoints(const StartCells& starts, const RegionBounds& bounds,
                RegionResult& result) const override
  {
    collect(starts, bounds, [&](std::uint32_t bucket, const auto&, bool whole) {
      whole ? result.take(buckets_[bucket]) : result.test(buckets_[bucket]);
    });
  }

  void
  collectCells(const StartCells& starts, const RegionBounds& bounds,
               std::vector<Cell>& cells) const override
  {
    collect(starts, bounds, [&](std::uint32_t bucket, const auto& cell, bool) {
      cells.push_back(toCell(buckets_[bucket], frame_, cell));
    });
  }

private:
  using Coordinates = CubeFrame::Coordinates;

  struct Node {
    std::uint32_t child[8] = {kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone};
  };
  struct CellRange {
    Coordinates low, high;
  };

  /** \brief The root: node 0, or with depth 0 the only bucket. */
  std::uint32_t
  root() const
  {
    return size_ == 0 ? kNone : 0;
  }

  std::uint32_t
  takeNode()
  {
    if (free_.empty()) {
      nodes_.emplace_back();
      return static_cast<std::uint32_t>(nodes_.size() - 1);
    }
    const std::uint32_t node = free_.back();
    free_.pop_back();
    return node;
  }

  /** \brief Takes the emptied bucket at the end of \p path away, and every node this empties. */
  void
  prune(const std::uint32_t* path, const Key& key)
  {
    buckets_.release(path[frame_.depth]);
    last_bucket_ = kNone;
    for (int level = frame_.depth - 1; level >= 0; --level) {
      Node& node = nodes_[path[level]];
      node.child[key.digit(level)] = kNone;
      const bool empty =
          std::all_of(node.child, node.child + 8, [](std::uint32_t c) { return c == kNone; });
      if (!empty || level == 0)
        return;
      free_.push_back(path[level]);
    }
  }

  template <class Visit>
  void
  collect(const StartCells& starts, const RegionBounds& bounds, const Visit& visit) const
  {
    for (const Coordinates& start : starts.cells) {
      const std::uint32_t node = find(start, starts.depth); // step 2: descend by prefix
      descend(node, starts.depth, start, &bounds, visit);   // step 3: the leaves below
    }
  }

  std::uint32_t
  find(const Coordinates& cell, int depth) const
  {
    const Key prefix = Key::fromCoordinates(cell, depth);
    std::uint32_t node = root();
    for (int level = 0; level < depth && node != kNone; ++level)
      node = nodes_[node].child[prefix.digit(level)];
    return node;
  }

  /** \brief Visits the buckets below \p node, the cell at \p cell on \p level.
   *
   * The dissertation tests every leaf below the start; skipping the cells the sphere does not reach
   * and taking those inside it whole needs the same tree. Without \p bounds all are taken. */
  template <class Visit>
  void
  descend(std::uint32_t node, int level, const Coordinates& cell, const RegionBounds* bounds,
          const Visit& visit) const
  {
    if (node == kNone)
      return;
    if (bounds) {
      const double edge = edges_[level];
      const double low[3] = {frame_.corner[0] + static_cast<double>(cell[0]) * edge,
                             frame_.corner[1] + static_cast<double>(cell[1]) * edge,
                             frame_.corner[2] + static_cast<double>(cell[2]) * edge};
      if (!bounds->reaches(low, edge))
        return;
      if (bounds->contains(low, edge))
        bounds = nullptr;
    }
    if (level == frame_.depth)
      return visit(node, cell, bounds == nullptr);
    const Node& children = nodes_[node];
    for (unsigned digit = 0; digit < 8; ++digit)
      if (children.child[digit] != kNone)
        descend(children.child[digit], level + 1,
                {cell[0] << 1 | (digit & 1), cell[1] << 1 | (digit >> 1 & 1),
                 cell[2] << 1 | (digit >> 2 & 1)},
                bounds, visit);
  }

  void
  collectBox(std::uint32_t node, int level, const Coordinates& cell, const CellRange& range,
             const Position& low, const Position& high, std::vector<PointIndex>& indices) const
  {
    const int up = frame_.depth - level;
    for (int a = 0; a < 3; ++a)
      if (node == kNone || cell[a] < range.low[a] >> up || cell[a] > range.high[a] >> up)
        return;
    if (level == frame_.depth)
      return appendInBox(buckets_[node], low, high, indices);
    for (unsigned digit = 0; digit < 8; ++digit)
      collectBox(nodes_[node].child[digit], level + 1,
                 {cell[0] << 1 | (digit & 1), cell[1] << 1 | (digit >> 1 & 1),
                  cell[2] << 1 | (digit >> 2 & 1)},
                 range, low, high, indices);
  }

  std::vector<Node> nodes_; ///< the root is node 0; children on level d_max are buckets
  std::vector<std::uint32_t> free_;
  Coordinates last_cell_{}; ///< where the last point was added
  std::uint32_t last_bucket_ = kNone;
  const std::vector<double> edges_ = [this] {
    std::vector<double> edges;
    for (int level = 0; level <= frame_.depth; ++level)
      edges.push_back(frame_.edgeAt(level));
    return edges;
  }();
};

} // namespace

std::unique_ptr<CellTree>
makeOctree(const CubeFrame& frame)
{
  if (frame.depth <= MortonKey::max_depth)
    return std::make_unique<CellOctree<MortonKey>>(frame);
  return std::make_unique<CellOctree<WideMortonKey>>(frame);
}

} // namespace detail
} // namespace pcl_surflet
