// From a built hierarchy to its compact layout (AccelOptions::layout).
#pragma once

#include <functional>

#include "accel/bvh.h"
#include "accel/compact_block.h"
#include "accel/compact_node.h"

namespace steradian {

struct CompactLevel {
    LargeArray<CompactNode> nodes;
    LargeArray<uint64_t> blocks;  ///< with kPaddingUnits at the end; empty where there are no triangles
};

/// The leaves of a level may hold this many triangles at most, so that every block is within reach of a reference.
inline constexpr uint32_t kMaxCompactItems = (CompactRef::kMaxUnits - kPaddingUnits) / kMaxUnitsPerTriangle;

/// What the leaves of a level may hold, items that are in several of them counted several times.
constexpr uint32_t max_items(BvhLayout layout) {
    return layout == BvhLayout::compact ? kMaxCompactItems : ChildRef::kMaxItems - 1;
}

/// The corners of an id.
using TriangleOf = std::function<PackedTriangle(uint32_t id)>;

/// Lets go of the nodes and blocks of `bvh`. `work` is what to report in all.
/// Unfinished when cancelled.
CompactLevel make_compact(Bvh& bvh, const TriangleOf& triangle, BuildMonitor& monitor, uint64_t work);
/// The same nodes over blocks of the same triangles with the vertices that they have now; boxes are those of before.
CompactLevel repack(const CompactLevel& level, const TriangleOf& triangle);

}  // namespace steradian
