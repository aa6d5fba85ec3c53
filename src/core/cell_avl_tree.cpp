// The balanced binary tree [Wahl 2007, Sec. 4.3.3]: an AVL tree ordered by key, whose nodes are the
// occupied cells and nothing else.
#include "cell_tree_detail.h"

#include <algorithm>
#include <array>

namespace pcl_surflet {
namespace detail {

namespace {

template <int Words>
class CellAvlTree : public CellTreeBase {
public:
  using Key = BasicMortonKey<3, Words>;
  using KeyWords = std::array<std::uint64_t, Words>;

  explicit CellAvlTree(const CubeFrame& frame) : CellTreeBase(frame) {}

  void
  add(PointIndex id, const Surflet& s) override
  {
    const auto cell = cellOf(s);
    std::uint32_t bucket = kNone;
    root_ = insert(root_, Key::fromCoordinates(cell, frame_.depth).words(), bucket);
    addToBucket(bucket, cell, id, s);
  }

  bool
  remove(PointIndex id, const Surflet& s) override
  {
    const auto cell = cellOf(s);
    const KeyWords key = Key::fromCoordinates(cell, frame_.depth).words();
    const std::uint32_t node = find(key);
    if (node == kNone || !removeFromBucket(node, cell, id, s))
      return false;
    if (buckets_[node].points.empty()) {
      root_ = erase(root_, key);
      buckets_.release(node);
    }
    return true;
  }

  std::size_t
  memoryUsage() const override
  {
    return sizeof(*this) + nodes_.capacity() * sizeof(Node) + buckets_.memoryUsage();
  }

  void
  forEachCell(const std::function<void(const Cell&)>& visit) const override
  {
    inOrder(root_, {}, allOnes(), [&](std::uint32_t n) { visit(cellAt(n)); });
  }

  void
  boxSearch(const Position& low, const Position& high,
            std::vector<PointIndex>& indices) const override
  {
    indices.clear();
    // Along the curve every cell of a box lies between the box's two extreme corners.
    const auto from = frame_.coordinates({low[0], low[1], low[2]});
    const auto to = frame_.coordinates({high[0], high[1], high[2]});
    inOrder(root_, Key::fromCoordinates(from, frame_.depth).words(),
            Key::fromCoordinates(to, frame_.depth).words(),
            [&](std::uint32_t n) { appendInBox(buckets_[n], low, high, indices); });
  }

protected:
  void
  collectPoints(const StartCells& starts, const RegionBounds& bounds,
                RegionResult& result) const override
  {
    collect(starts, bounds, [&](std::uint32_t n, bool whole) {
      whole ? result.take(buckets_[n]) : result.test(buckets_[n]);
    });
  }

  void
  collectCells(const StartCells& starts, const RegionBounds& bounds,
               std::vector<Cell>& cells) const override
  {
    collect(starts, bounds, [&](std::uint32_t n, bool) { cells.push_back(cellAt(n)); });
  }

private:
  /** \brief Node n holds the key of bucket n. */
  struct Node {
    KeyWords key;
    std::uint32_t left, right;
    std::int32_t height;
  };

  static KeyWords
  allOnes()
  {
    KeyWords words;
    words.fill(~std::uint64_t{0});
    return words;
  }

  Cell
  cellAt(std::uint32_t n) const
  {
    return toCell(buckets_[n], frame_, Key::fromWords(nodes_[n].key, frame_.depth).coordinates());
  }

  std::int32_t
  height(std::uint32_t n) const
  {
    return n == kNone ? 0 : nodes_[n].height;
  }

  void
  updateHeight(std::uint32_t n)
  {
    nodes_[n].height = 1 + std::max(height(nodes_[n].left), height(nodes_[n].right));
  }

  std::uint32_t
  rotateRight(std::uint32_t n)
  {
    const std::uint32_t top = nodes_[n].left;
    nodes_[n].left = nodes_[top].right;
    nodes_[top].right = n;
    updateHeight(n);
    updateHeight(top);
    return top;
  }

  std::uint32_t
  rotateLeft(std::uint32_t n)
  {
    const std::uint32_t top = nodes_[n].right;
    nodes_[n].right = nodes_[top].left;
    nodes_[top].left = n;
    updateHeight(n);
    updateHeight(top);
    return top;
  }

  /** \brief Restores the AVL condition at \p n, whose subtrees differ by two levels at most. */
  std::uint32_t
  balance(std::uint32_t n)
  {
    const std::uint32_t left = nodes_[n].left, right = nodes_[n].right;
    if (height(left) > height(right) + 1) {
      if (height(nodes_[left].left) < height(nodes_[left].right))
        nodes_[n].left = rotateLeft(left);
      return rotateRight(n);
    }
    if (height(right) > height(left) + 1) {
      if (height(nodes_[right].right) < height(nodes_[right].left))
        nodes_[n].right = rotateRight(right);
      return rotateLeft(n);
    }
    updateHeight(n);
    return n;
  }

  std::uint32_t
  insert(std::uint32_t n, const KeyWords& key, std::uint32_t& bucket)
  {
    if (n == kNone) {
      bucket = buckets_.take();
      if (bucket >= nodes_.size())
        nodes_.resize(bucket + 1);
      nodes_[bucket] = {key, kNone, kNone, 1};
      return bucket;
    }
    if (key == nodes_[n].key) {
      bucket = n;
      return n;
    }
    if (key < nodes_[n].key) {
      const std::uint32_t child = insert(nodes_[n].left, key, bucket);
      nodes_[n].left = child;
    }
    else {
      const std::uint32_t child = insert(nodes_[n].right, key, bucket);
      nodes_[n].right = child;
    }
    return balance(n);
  }

  std::uint32_t
  find(const KeyWords& key) const
  {
    std::uint32_t n = root_;
    while (n != kNone && key != nodes_[n].key)
      n = key < nodes_[n].key ? nodes_[n].left : nodes_[n].right;
    return n;
  }

  std::uint32_t
  erase(std::uint32_t n, const KeyWords& key)
  {
    if (key < nodes_[n].key)
      nodes_[n].left = erase(nodes_[n].left, key);
    else if (nodes_[n].key < key)
      nodes_[n].right = erase(nodes_[n].right, key);
    else {
      const std::uint32_t left = nodes_[n].left, right = nodes_[n].right;
      if (left == kNone || right == kNone)
        return left == kNone ? right : left;
      // The next key takes the place; nodes are relinked, not copied, since n numbers a bucket.
      std::uint32_t next = kNone;
      const std::uint32_t rest = takeFirst(right, next);
      nodes_[next].left = left;
      nodes_[next].right = rest;
      n = next;
    }
    return balance(n);
  }

  /** \brief Unlinks the first node of the subtree; returns what is left of it. */
  std::uint32_t
  takeFirst(std::uint32_t n, std::uint32_t& first)
  {
    if (nodes_[n].left == kNone) {
      first = n;
      return nodes_[n].right;
    }
    nodes_[n].left = takeFirst(nodes_[n].left, first);
    return balance(n);
  }

  /** \brief What one region search carries along. */
  struct Exploration {
    KeyWords mask; ///< the bits of the d_F leading digits
    const RegionBounds* bounds;
  };
  /** \brief Start prefixes that may still occur, in ascending order. */
  struct Prefixes {
    const KeyWords* first;
    const KeyWords* last;
  };

  template <class Visit>
  void
  collect(const StartCells& starts, const RegionBounds& bounds, const Visit& visit) const
  {
    std::vector<KeyWords> prefixes;
    for (const auto& start : starts.cells)
      prefixes.push_back(Key::fromCoordinates(start, starts.depth).words());
    std::sort(prefixes.begin(), prefixes.end());
    const std::uint64_t ones = ~std::uint64_t{0};
    const Exploration exploration = {Key::fromCoordinates({ones, ones, ones}, starts.depth).words(),
                                     &bounds};
    KeyWords highest = Key::fromCoordinates({ones, ones, ones}, frame_.depth).words();
    explore(root_, exploration, {prefixes.data(), prefixes.data() + prefixes.size()}, KeyWords{},
            highest, visit);
  }

  /** \brief Box of the smallest cell that holds the keys from \p low to \p high. */
  double
  commonCell(const KeyWords& low, const KeyWords& high, double* corner) const
  {
    int digits = 0;
    for (int w = 0; w < Words; ++w) {
      const std::uint64_t different = low[w] ^ high[w];
      digits += different == 0 ? Key::digits_per_word : (__builtin_clzll(different) - 1) / 3;
      if (different != 0)
        break;
    }
    const int depth = std::min(digits, frame_.depth);
    const auto cell = Key::fromWords(low, depth).coordinates();
    const double edge = frame_.edgeAt(depth);
    for (std::size_t a = 0; a < 3; ++a)
      corner[a] = frame_.corner[a] + static_cast<double>(cell[a]) * edge;
    return edge;
  }

  /** \brief Step 3 with the explore operator [Wahl 2007, Eq. 4.24] for all start prefixes at once.
   *
   * I1 = prefix of node \p n; a start prefix I2 < I1 can only be found left of n, I2 > I1 only
   * right of it, I2 = I1 (n is collected then) on both sides. \p open are the prefixes that may
   * still occur below n, so no node is visited twice: the dissertation's list of explored prefixes
   * turned inside out. That list, read literally, ends the search at a node with an explored
   * prefix; points are lost then, since keys with the present prefix may lie below.
   *
   * All keys below n lie in [low, high]; large subtrees whose common cell the sphere does not
   * reach are left out, and those in a cell inside it are taken without tests. */
  template <class Visit>
  void
  explore(std::uint32_t n, Exploration exploration, Prefixes open, KeyWords low,
          const KeyWords& high, const Visit& visit) const
  {
    constexpr std::int32_t kLargeHeight = 3; // below, the box costs more than it saves
    while (n != kNone && open.first != open.last) {
      const Node& node = nodes_[n];
      if (exploration.bounds && node.height >= kLargeHeight) {
        double corner[3];
        const double edge = commonCell(low, high, corner);
        if (!exploration.bounds->reaches(corner, edge))
          return;
        if (exploration.bounds->contains(corner, edge))
          exploration.bounds = nullptr;
      }
      KeyWords prefix = node.key;
      for (int w = 0; w < Words; ++w)
        prefix[w] &= exploration.mask[w];
      const KeyWords* not_left = open.first; // prefixes from here on are not below I1
      while (not_left != open.last && *not_left < prefix)
        ++not_left;
      const bool equal = not_left != open.last && *not_left == prefix;
      explore(node.left, exploration, {open.first, not_left + equal}, low, node.key, visit);
      if (equal)
        visit(n, exploration.bounds == nullptr);
      open.first = not_left;
      low = node.key;
      n = node.right;
    }
  }

  template <class Visit>
  void
  inOrder(std::uint32_t n, const KeyWords& from, const KeyWords& to, const Visit& visit) const
  {
    if (n == kNone)
      return;
    const Node& node = nodes_[n];
    if (from < node.key)
      inOrder(node.left, from, to, visit);
    if (!(node.key < from) && !(to < node.key))
      visit(n);
    if (node.key < to)
      inOrder(node.right, from, to, visit);
  }

  std::vector<Node> nodes_;
  std::uint32_t root_ = kNone;
};

} // namespace

std::unique_ptr<CellTree>
makeAvlTree(const CubeFrame& frame)
{
  if (frame.depth <= MortonKey::max_depth)
    return std::make_unique<CellAvlTree<1>>(frame);
  return std::make_unique<CellAvlTree<3>>(frame);
}

} // namespace detail
} // namespace pcl_surflet
