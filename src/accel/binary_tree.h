// The binary tree that the builders make, before its nodes are gathered into wide ones.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

#include "accel/bvh.h"
#include "base/large_array.h"

namespace steradian {

/// There are more of these than of anything else while a hierarchy is built, so they are as small as can be: a box, as
/// in BuildPrimitive, with a word in either fourth lane.
struct alignas(16) BinaryNode {
    float lo[3];
    uint32_t first;  ///< the left child, or the first primitive of a leaf; and flags
    float hi[3];
    uint32_t second;  ///< the right child, or the end of the primitives

    static constexpr uint32_t kIndex = (1u << 29) - 1, kLeaf = 1u << 31, kKindShift = 29;
    static constexpr uint32_t kLarge = 1u << 29, kUncounted = 1u << 30;

    void set_leaf(size_t begin, size_t end, ItemKind kind) {
        first = kLeaf | static_cast<uint32_t>(kind) << kKindShift | static_cast<uint32_t>(begin);
        second = static_cast<uint32_t>(end);
    }
    /// `large`: worth more than one task. `counted`: a level of depth; splits by kind are not.
    void set_children(uint32_t left, uint32_t right, bool large, bool counted) {
        first = left | (large ? kLarge : 0) | (counted ? 0 : kUncounted);
        second = right;
    }
    /// Everything else stays.
    void set_child(int which, uint32_t child) {
        if (which == 0)
            first = (first & ~kIndex) | child;
        else
            second = child;
    }
    void count() { first &= ~kUncounted; }

    bool is_leaf() const { return first & kLeaf; }
    uint32_t child(int which) const { return which == 0 ? first & kIndex : second; }
    bool large() const { return !is_leaf() && (first & kLarge); }
    bool counted() const { return !(first & kUncounted); }
    // Of a leaf.
    uint32_t begin() const { return first & kIndex; }
    uint32_t end() const { return second; }
    ItemKind kind() const { return static_cast<ItemKind>(first >> kKindShift & 3); }

    Box4 box() const { return {Float4::load(lo).first_three(), Float4::load(hi).first_three()}; }
    void set_box(const Box4& b) {
        const uint32_t f = first, s = second;
        b.lo.store(lo), b.hi.store(hi);
        first = f, second = s;
    }
};
static_assert(sizeof(BinaryNode) == 32);

/// Ranges of so many primitives are worth more than one task.
inline constexpr size_t kLargeRange = 4096;
/// Ranges of which both parts have as many primitives may be divided by two tasks, each with a source of its own: so
/// there are not more of these than m / kOwnSourceGrain, and what their last runs waste is bounded (build_memory.h).
inline constexpr size_t kOwnSourceGrain = 512;

/// No larger leaves are made of smaller ones, and none that a single reference could not lead to.
inline constexpr uint32_t kMaxMergedLeaf = 8;

/// Nodes by index, in chunks that never move. Every task has a Source of its own, so that workers meet only over runs
/// of nodes. The two children of a node begin where they share a line of the cache.
class BinaryPool {
public:
    static constexpr uint32_t kRun = 64, kChunkBits = 8, kChunk = 1u << kChunkBits;
    /// There never are more, in a tree over so many primitives: nodes, and what the last runs of all sources waste.
    static constexpr size_t most_nodes(size_t primitives) { return 4 * primitives + 4 * size_t(kRun); }

    explicit BinaryPool(size_t primitives) : most_(most_nodes(primitives)), chunk_((most_ + kChunk - 1) / kChunk) {}

    BinaryNode& operator[](uint32_t index) { return chunk_[index >> kChunkBits][index & (kChunk - 1)]; }
    const BinaryNode& operator[](uint32_t index) const { return chunk_[index >> kChunkBits][index & (kChunk - 1)]; }
    /// The same for a loop that should not look for the chunks each time.
    class View {
    public:
        explicit View(const BinaryPool& pool) : chunk_(pool.chunk_.data()) {}
        const BinaryNode& operator[](uint32_t index) const { return chunk_[index >> kChunkBits][index & (kChunk - 1)]; }

    private:
        const BinaryNode* const* chunk_;
    };
    /// All indices are below.
    uint32_t size() const { return used_; }

    class Source {
    public:
        explicit Source(BinaryPool& pool) : pool_(pool) {}
        /// The first of two.
        uint32_t next_two() {
            if (left_ == 0) left_ = pool_.take(next_);
            left_ -= 2;
            return (next_ += 2) - 2;
        }

    private:
        BinaryPool& pool_;
        uint32_t next_ = 0, left_ = 0;
    };

    /// What is below a node becomes what sources take first, where children are still beside each other: the node is to
    /// be divided anew. Not while sources take nodes.
    void give_back_below(uint32_t index) {
        const BinaryNode node = (*this)[index];
        if (node.is_leaf()) return;
        for (const int which : {0, 1}) give_back_below(node.child(which));
        if (node.child(1) != node.child(0) + 1) return;
        (*this)[node.child(0)].second = spare_;
        spare_ = node.child(0);
    }

    /// Gives back the memory of nodes that are not among the first `count`. Not while sources take nodes.
    void keep(uint32_t count) {
        used_ = (count + kRun - 1) / kRun * kRun;
        while (memory_.size() > (used_ + kChunk - 1) / kChunk) memory_.pop_back();
    }

private:
    static constexpr uint32_t kNone = ~0u;

    /// So many nodes from `first` on.
    uint32_t take(uint32_t& first) {
        const std::lock_guard lock(mutex_);
        if (spare_ == kNone) return first = take_run(), kRun;
        first = spare_, spare_ = (*this)[first].second;
        return 2;
    }
    uint32_t take_run() {
        const uint32_t run = used_;
        if (run % kChunk == 0) {
            memory_.emplace_back(std::min<size_t>(kChunk, most_ - run));
            chunk_[run / kChunk] = memory_.back().data();
        }
        used_ += kRun;
        return run;
    }

    const size_t most_;
    std::vector<BinaryNode*> chunk_;
    std::deque<LargeArray<BinaryNode>> memory_;
    std::mutex mutex_;
    uint32_t used_ = 0;
    uint32_t spare_ = kNone;  ///< the first of two nodes given back; its `second` says which two are next
};

/// What the leaves of a tree refer to, first `own` and then `moved`: leaves with parts of split boxes have all of
/// theirs there.
struct LeafPrimitives {
    LargeArray<BuildPrimitive>& own;
    std::deque<BuildPrimitive> moved = {};

    size_t size() const { return own.size() + moved.size(); }
    BuildPrimitive& operator[](size_t i) { return i < own.size() ? own[i] : moved[i - own.size()]; }
    const BuildPrimitive& operator[](size_t i) const { return i < own.size() ? own[i] : moved[i - own.size()]; }
};

/// What is to become a subtree: primitives [begin, end), under so many splits.
struct Subtree {
    size_t begin = 0, end = 0;
    uint32_t depth = 0;
};
/// Divides by options.builder, which is sah or median, into the node `out`; see build_bvh, defined in bvh.cpp.
void divide(std::span<BuildPrimitive> primitives, const Subtree& subtree, const BvhOptions& options,
            BuildMonitor& monitor, BinaryPool& pool, BinaryPool::Source& source, uint32_t out);

/// Gathers a binary tree into `out`, which is unfinished when cancelled; defined in gather.cpp. The primitives are gone
/// before most of `out` is there, where their boxes are not needed. Changes the tree where it would take more than it
/// may.
void gather(BinaryPool& pool, uint32_t root, LeafPrimitives& primitives, const BvhOptions& options,
            BuildMonitor& monitor, Bvh& out);

}  // namespace steradian
