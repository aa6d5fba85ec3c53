// The descent shared by all instruction sets. Included inside an anonymous namespace after the
// including file has defined testChildren(), filterLeaf<Mode>(), copyRange() and childDistances():
// internal linkage keeps the linker from mixing code of different instruction sets.

template <int mode>
void
descend(const RegionTree& tree, const RegionNode& node, const RegionQuery& query, RegionSink& sink)
{
  unsigned inside;
  unsigned reached = testChildren(node, query, inside);
  for (; reached; reached &= reached - 1) {
    const unsigned c = static_cast<unsigned>(__builtin_ctz(reached));
    if (inside >> c & 1) {
      if (mode == kDistances)
        copyRange(tree, query, node.begin[c], node.count[c], sink);
      else
        sink.range(sink, node.begin[c], node.count[c]);
    }
    else if (node.child[c] == kLeafChild)
      filterLeaf<mode>(tree, query, node.begin[c], node.count[c], sink);
    else
      descend<mode>(tree, tree.nodes[node.child[c]], query, sink);
  }
}

template <int mode>
void
search(const RegionTree& tree, const RegionQuery& query, RegionSink& sink)
{
  descend<mode>(tree, tree.nodes[0], query, sink);
}

const RegionKernels kKernels = {PCL_SURFLET_KERNEL_NAME, search<kIndices>,       search<kDistances>,
                                search<kPositions>,      filterLeaf<kDistances>, childDistances};
