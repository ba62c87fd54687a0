// Where triangles coincide, leaves are merged as soon as the tree is there.
#pragma once

#include "accel/binary_tree.h"

namespace steradian {

/// Blocks of triangles that are points or have the same vertices take the fewest bytes in the compact layout, and what
/// is held before they are packed takes no fewer than ever. Where that would be more than twice the result beside it,
/// and only there, leaves of such triangles are merged, as gather() does later and no further, and the nodes are moved
/// together. `for_each_node` are bytes that the next step holds beside the tree for every node, and
/// `for_each_primitive` for every primitive. Not while sources take nodes. Returns the root.
uint32_t merge_alike_leaves(BinaryPool& pool, uint32_t root, const LeafPrimitives& primitives, uint64_t for_each_node,
                            uint64_t for_each_primitive);

}  // namespace steradian
