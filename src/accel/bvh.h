// The hierarchy itself, and how one is built over boxes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/build_monitor.h"
#include "accel/split.h"
#include "accel/wide_node.h"
#include "base/large_array.h"
#include "steradian/settings.h"

namespace steradian {

/// Levels of splits below the root, at most.
inline constexpr uint32_t kMaxBvhDepth = 64;
/// Levels of nodes, at most: one for every split, two to keep kinds apart, and what it takes to gather a leaf of any
/// size from runs of items.
inline constexpr uint32_t kMaxNodeLevels = kMaxBvhDepth + 12;

/// The root is nodes[0]; no nodes when there was nothing to build over.
struct Bvh {
    LargeArray<WideNode> nodes;
    /// Primitives in the order of the leaves: triangles as blocks of kBlock ids each, which end with kNoHit where a
    /// leaf does not fill them, and the others one by one.
    std::vector<uint32_t> blocks, entries;
    uint64_t leaves = 0;
    uint32_t depth = 0;  ///< splits above the deepest leaf, at most BvhOptions::max_depth

    Box bounds;
};

/// What a primitive's way through the stages takes, in tenths of the whole, roughly as measured.
inline constexpr uint64_t kReadWork = 1, kDivideWork = 6, kGatherWork = 2, kPackWork = 1;
inline constexpr uint64_t kBuildWork = kReadWork + kDivideWork + kGatherWork + kPackWork;

struct BvhOptions {
    BvhBuilder builder = BvhBuilder::sah;
    uint32_t max_depth = kMaxBvhDepth;
    ItemKind mostly = ItemKind::block;  ///< the kind whose costs decide where many primitives are divided
    uint64_t work = kDivideWork;        ///< to report for a primitive once it is in a leaf
    uint32_t max_leaf = 8;     ///< primitives of a leaf that was not forced; overlapping boxes do not stay alone
    bool kinds_first = false;  ///< ranges of several kinds are divided by kind before anything else
    bool split_boxes = false;  ///< BvhBuilder::high_quality may; not where rays are transformed, see SpatialSplit
    BvhLayout layout = BvhLayout::full;  ///< what is to be made of the hierarchy; it limits how much may be added
};

/// O(n log n) whatever the boxes are: where the surface-area heuristic finds nothing or would run out of levels, the
/// median split over (centroid, index) takes over, and a leaf at max_depth takes what is left. A leaf holds one kind.
/// Uses all workers of the caller's arena; the result does not depend on their number. Check `monitor.poll()`
/// afterwards: what a cancelled build returns is unfinished. Throws std::bad_alloc. At most max_items() boxes
/// (compact.h), all of them finite; takes them. With split boxes a primitive may be in several leaves, and there are
/// at most half as many again. Nodes and what the leaves will hold take no more than most_tree_bytes() of what is in
/// all leaves (tree_bytes.h).
Bvh build_bvh(LargeArray<BuildPrimitive>& primitives, const BvhOptions& options, BuildMonitor& monitor);

}  // namespace steradian
