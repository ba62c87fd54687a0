// A builder for previews: the surface-area heuristic where it is cheap or matters most, a space-filling curve in
// between.
#pragma once

#include <optional>

#include "accel/binary_tree.h"

namespace steradian {

/// Sorts primitives along a Morton curve, cuts that into treelets of up to kTreelet primitives, which are subtrees of
/// the radix tree over the codes (Karras 2012, "Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d
/// Trees"), and divides by the surface-area heuristic the treelets among themselves, as boxes (after Garanzha,
/// Pantaleoni & McAllister 2011, "Simpler and Faster HLBVH with Work Queues"), and each of them. Nothing is moved along
/// all the levels in between. Same promises as build_bvh; options.builder is not looked at. The root; without one when
/// options.max_depth is too small for that, or there were more than most_treelets(), or when cancelled.
std::optional<uint32_t> build_fast(LargeArray<BuildPrimitive>& primitives, const BvhOptions& options, BinaryPool& pool,
                                   BuildMonitor& monitor);

/// With more of them they would take too much memory for nothing: they are hardly larger than leaves then.
constexpr size_t most_treelets(size_t primitives) { return primitives / 8 + 16; }

}  // namespace steradian
