// Takes nodes of a binary tree from where a builder that looked from the top down has put them to where they are
// better.
#pragma once

#include "accel/binary_tree.h"

namespace steradian {

/// Of each node: itself, where it is from, its parent and height, and a move.
inline constexpr size_t kReinsertionBytes = 57;

/// Optimises the tree of `root`, which stays the root, and puts the primitives into the order of its leaves, each of
/// which keeps what it had; what belongs to none is left out. No leaf gets deeper than `max_depth`. The sum of the
/// surfaces of all nodes never grows. Holds kReinsertionBytes a node, and then a copy of the primitives. Uses all
/// workers; the result does not depend on their number. `work` is what to report, see BvhOptions.
void reinsert(BinaryNode& root, LargeArray<BuildPrimitive>& primitives, uint32_t max_depth, BuildMonitor& monitor,
              uint64_t work);

}  // namespace steradian
