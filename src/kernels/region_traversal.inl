// The descent shared by all instruction sets. Included inside an anonymous namespace after the
// including file has defined testChildren(), childDistances(), filterBlock<mode>(), copyBlock() and
// copyIndexBlock(), which may write a whole block past the sink's size: internal linkage keeps the
// linker from mixing code of different instruction sets.

/** \brief Makes room for \p count more results, at most the capacity. */
inline void
makeRoom(RegionSink& sink, std::uint32_t count)
{
  if (sink.size + count > sink.capacity)
    sink.flush(sink);
}

/** \brief Takes the points [begin, end) without tests. */
template <int mode>
inline void
takeRange(const RegionTree& tree, const RegionQuery& query, std::uint32_t begin, std::uint32_t end,
          RegionSink& sink)
{
  if (mode == kPositions || (mode == kIndices && end - begin > kShortRange))
    return sink.range(sink, begin, end - begin);
  while (begin < end) {
    const std::uint32_t part = end - begin < kShortRange ? end - begin : kShortRange;
    makeRoom(sink, part);
    for (std::uint32_t i = 0; i < part; i += kBlock)
      if (mode == kDistances)
        copyBlock(tree, query, begin + i, sink.size + i, sink);
      else
        copyIndexBlock(tree, begin + i, sink.size + i, sink);
    sink.size += part;
    begin += part;
  }
}

/** \brief Filters the run [begin, end) behind the \p size results; returns how many there are now.
 */
template <int mode>
inline std::uint32_t
filterRun(const RegionTree& tree, const RegionQuery& query, std::uint32_t begin, std::uint32_t end,
          std::uint32_t size, RegionSink& sink)
{
  do {
    size = filterBlock<mode>(tree, query, begin, end - begin, size, sink);
    begin += kBlock;
  } while (begin < end);
  return size;
}

/** \brief A bottom node. Single runs inside the region are filtered like those on its border:
 * telling them apart costs more in mispredicted branches. */
template <int mode>
inline void
searchRuns(const RegionTree& tree, const RegionNode& node, const RegionQuery& query,
           unsigned reached, RegionSink& sink)
{
  makeRoom(sink, kBottomSize);
  std::uint32_t size = sink.size; // in a register: the sink might alias what is stored
  for (; reached; reached &= reached - 1) {
    const unsigned c = static_cast<unsigned>(__builtin_ctz(reached));
    const std::uint32_t begin = node.begin + (c == 0 ? 0u : node.cut[c - 1]);
    size = filterRun<mode>(tree, query, begin, node.begin + node.cut[c], size, sink);
  }
  sink.size = size;
}

/** \brief Searches a node that holds the points up to \p end. */
template <int mode>
void
descend(const RegionTree& tree, const RegionNode& node, std::uint32_t end, const RegionQuery& query,
        RegionSink& sink)
{
  unsigned inside;
  unsigned reached = testChildren(node, query, inside);
  if (node.child == 0) {
    if (inside == (1u << kFanOut) - 1)
      return takeRange<mode>(tree, query, node.begin, end, sink);
    return searchRuns<mode>(tree, node, query, reached, sink);
  }
  const RegionNode* const children = tree.nodes + node.child;
  for (; reached; reached &= reached - 1) {
    const unsigned c = static_cast<unsigned>(__builtin_ctz(reached));
    const std::uint32_t child_end = c + 1u < node.cut[0] ? children[c + 1].begin : end;
    if (inside >> c & 1)
      takeRange<mode>(tree, query, children[c].begin, child_end, sink);
    else
      descend<mode>(tree, children[c], child_end, query, sink);
  }
}

template <int mode>
void
search(const RegionTree& tree, const RegionQuery& query, RegionSink& sink)
{
  descend<mode>(tree, tree.nodes[0], tree.size, query, sink);
}

void
filterOneRun(const RegionTree& tree, const RegionQuery& query, std::uint32_t begin,
             std::uint32_t end, RegionSink& sink)
{
  makeRoom(sink, end - begin);
  sink.size = filterRun<kDistances>(tree, query, begin, end, sink.size, sink);
}

const RegionKernels kKernels = {search<kIndices>, search<kDistances>, search<kPositions>,
                                filterOneRun, childDistances};
