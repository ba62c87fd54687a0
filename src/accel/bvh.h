// The hierarchy itself, and how one is built over boxes.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

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

inline constexpr uint32_t kBlock = 4;

/// Asks the caller's function from one thread at a time and remembers a yes. A thread that finds another one asking, or
/// that is asked again from within the function, goes on with what is known.
class Cancellation {
public:
    explicit Cancellation(const std::function<bool()>& asked) : asked_(asked) {}
    bool poll() {
        if (stop_.load(std::memory_order_relaxed)) return true;
        if (!asked_) return false;
        // Not a mutex: one thread may get here twice, when the function waits for tasks that poll.
        if (asking_.exchange(true, std::memory_order_acquire)) return stop_.load(std::memory_order_relaxed);
        if (asked_()) stop_.store(true, std::memory_order_relaxed);
        asking_.store(false, std::memory_order_release);
        return stop_.load(std::memory_order_relaxed);
    }

private:
    const std::function<bool()>& asked_;
    std::atomic<bool> asking_{false}, stop_{false};
};

struct BvhOptions {
    BvhBuilder builder = BvhBuilder::sah;
    uint32_t max_depth = kMaxBvhDepth;
    ItemKind mostly = ItemKind::block;  ///< the kind whose costs decide where many primitives are divided
};

/// O(n log n) whatever the boxes are: where the surface-area heuristic finds nothing or would run out of levels, the
/// median split over (centroid, index) takes over, and a leaf at max_depth takes what is left. A leaf holds one kind.
/// Uses all workers of the caller's arena; the result does not depend on their number. Check `cancelled.poll()`
/// afterwards: what a cancelled build returns is unfinished. Throws std::bad_alloc. Fewer than ChildRef::kMaxItems
/// boxes, all of them finite; reorders them.
Bvh build_bvh(std::span<BuildPrimitive> primitives, const BvhOptions& options, Cancellation& cancelled);

}  // namespace steradian
