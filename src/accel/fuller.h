// Trees of which too many leaves are nearly empty.
#pragma once

#include "accel/binary_tree.h"

namespace steradian {

/// Divides subtrees anew, by the median and into full blocks, where there is no other way for the whole to take no more
/// than most_tree_bytes() once it is gathered with nothing else in mind (tree_bytes.h). May sort the primitives, which
/// takes them twice for a while. Unfinished when cancelled.
void make_fuller(BinaryPool& pool, uint32_t root, LeafPrimitives& primitives, const BvhOptions& options,
                 BuildMonitor& monitor);

}  // namespace steradian
