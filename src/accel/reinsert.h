// Takes nodes of a binary tree from where a builder that looked from the top down has put them to where they are
// better.
#pragma once

#include "accel/binary_tree.h"

namespace steradian {

/// Of each node: its rank, parent and height, and a move.
inline constexpr size_t kReinsertionTreeBytes = 9, kReinsertionBytes = kReinsertionTreeBytes + 12;

/// Optimises the tree of `root`, which stays the root; each leaf keeps what it had. No leaf gets deeper than
/// `max_depth`. The sum of the surfaces of all nodes never grows. Holds kReinsertionBytes a node. Uses all workers; the
/// result does not depend on their number. `work` is what to report, see BvhOptions.
void reinsert(BinaryPool& nodes, uint32_t root, uint32_t max_depth, BuildMonitor& monitor, uint64_t work);

}  // namespace steradian
