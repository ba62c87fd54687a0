// The binary tree that the builders make, before its nodes are gathered into wide ones.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "accel/bvh.h"

namespace steradian {

/// There are more of these than of anything else while a hierarchy is built, so they are packed.
struct alignas(16) BinaryNode {
    // The box, as in BuildPrimitive.
    float lo[3];
    uint32_t begin = 0;  ///< primitives [begin, end)
    float hi[3];
    uint32_t end = 0;
    BinaryNode* child[2] = {};  ///< both or none
    // gather() sets the costs, and once these have been decided by, the places.
    struct Places {
        uint32_t nodes, blocks, entries;  ///< that it takes to hold the subtree
    };
    union {
        /// Least cost of the subtree in at most i + 1 of a wide node's children.
        float cost[kWidth - 1];
        Places places;
    };
    uint32_t depth : 7 = 0;
    // The rest is set by gather().
    uint32_t one_leaf : 1 = 0;  ///< cheaper as one leaf than in any other way
    uint32_t one_kind : 1 = 1;
    uint32_t first_kind : 2 = 0;  ///< the ItemKind of the first primitive
    uint32_t shares : 3 * (kWidth - 1) = 0;

    bool is_leaf() const { return child[0] == nullptr || one_leaf; }
    Box4 box() const { return {Float4::load(lo).first_three(), Float4::load(hi).first_three()}; }
    void set_box(const Box4& b) {
        const uint32_t first = begin, last = end;
        b.lo.store(lo), b.hi.store(hi);
        begin = first, end = last;
    }
    /// How many of `children` (at least 2) of a wide node the left side gets at the least cost; 0 when one child fewer
    /// is as good. With kWidth children in a node of its own.
    uint32_t left_share(uint32_t children) const { return shares >> 3 * (children - 2) & 7; }
    void set_left_share(uint32_t children, uint32_t left) {
        const uint32_t at = 3 * (children - 2);
        shares = (shares & ~(7u << at)) | left << at;
    }
};
static_assert(sizeof(BinaryNode) == 80 && kMaxBvhDepth < 128);

/// Nodes in chunks that never move. Every task has a Source of its own, so that workers meet only over whole chunks.
class BinaryPool {
public:
    static constexpr size_t kChunk = 64;

    class Source {
    public:
        explicit Source(BinaryPool& pool) : pool_(pool) {}
        BinaryNode* next() {
            if (used_ == kChunk) chunk_ = pool_.grow(), used_ = 0;
            return &chunk_[used_++];
        }

    private:
        BinaryPool& pool_;
        BinaryNode* chunk_ = nullptr;
        size_t used_ = kChunk;
    };

private:
    BinaryNode* grow() {
        const std::lock_guard lock(mutex_);
        chunks_.push_back(std::make_unique<BinaryNode[]>(kChunk));
        return chunks_.back().get();
    }

    std::mutex mutex_;
    std::vector<std::unique_ptr<BinaryNode[]>> chunks_;
};

/// Ranges of which both parts have as many primitives may be divided by two tasks, each with a source of its own: so
/// there are not more of these than m / kOwnSourceGrain, and what their last chunks waste is bounded (build_memory.h).
inline constexpr size_t kOwnSourceGrain = 512;

/// What is to become a subtree: primitives [begin, end), under so many splits.
struct Subtree {
    size_t begin = 0, end = 0;
    uint32_t depth = 0;
};
/// Divides by options.builder, which is sah or median, into `out`; see build_bvh, defined in bvh.cpp.
void divide(std::span<BuildPrimitive> primitives, const Subtree& subtree, const BvhOptions& options,
            BuildMonitor& monitor, BinaryPool& pool, BinaryPool::Source& source, BinaryNode& out);

/// Gathers a binary tree into `out`, which is unfinished when cancelled; defined in gather.cpp. The primitives are gone
/// before most of `out` is there, where their boxes are not needed.
void gather(BinaryNode& root, LargeArray<BuildPrimitive>& primitives, BuildMonitor& monitor, Bvh& out);

}  // namespace steradian
