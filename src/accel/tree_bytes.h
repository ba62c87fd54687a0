// What a hierarchy takes in the full layout, nodes and what the leaves hold together, and the most that builds let it
// take: gather() and make_fuller() see to it, and build_memory() tells.
#pragma once

#include <algorithm>
#include <cstdint>

#include "accel/triangle_block.h"
#include "accel/wide_node.h"
#include "accel/world.h"

namespace steradian {

/// For every triangle, or part of one where boxes are split; for every shape, instance or part of one; and for a root
/// and a block that are not full.
inline constexpr uint64_t kMostTriangleBytes = 60, kMostOtherBytes = 96, kMostRootBytes = 512;
constexpr uint64_t most_tree_bytes(uint64_t triangles, uint64_t others) {
    return kMostTriangleBytes * triangles + kMostOtherBytes * others + kMostRootBytes;
}

/// Blocks of triangles, shapes or instances.
constexpr uint32_t items_for(ItemKind kind, uint32_t primitives) {
    return kind == ItemKind::block ? (primitives + kBlock - 1) / kBlock : primitives;
}
constexpr uint64_t item_bytes(ItemKind kind) {
    return kind == ItemKind::block ? sizeof(TriangleBlock) : sizeof(LeafEntry);
}
/// Items of each child of a node over the runs of a leaf: the least power of kWidth runs that makes do with kWidth
/// children.
constexpr uint32_t share_of(uint32_t items) {
    uint32_t share = ChildRef::kMaxRun;
    while (uint64_t(share) * kWidth < items) share *= kWidth;
    return share;
}
/// Nodes that it takes to gather a leaf's items, kMaxRun to a run and kWidth runs or nodes to a node.
constexpr uint32_t nodes_for(uint32_t items) {
    if (items <= ChildRef::kMaxRun) return 0;
    const uint32_t share = share_of(items);
    uint32_t nodes = 1;
    for (uint32_t first = 0; first < items; first += share) nodes += nodes_for(std::min(share, items - first));
    return nodes;
}
/// Of a leaf, without the reference to it.
constexpr uint64_t leaf_bytes(ItemKind kind, uint32_t primitives) {
    const uint32_t items = items_for(kind, primitives);
    return items * item_bytes(kind) + nodes_for(items) * sizeof(WideNode);
}

}  // namespace steradian
