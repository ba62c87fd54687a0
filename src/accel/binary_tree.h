// The binary tree that the builders make, before its nodes are gathered into wide ones.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "accel/bvh.h"

namespace steradian {

struct BinaryNode {
    Box4 box;
    BinaryNode* child[2] = {};  ///< both or none
    uint32_t begin = 0, end = 0;
    uint32_t depth = 0;
    // The rest is set by gather().
    /// Wide nodes, blocks and entries that it takes to hold the subtree.
    uint32_t nodes = 0, blocks = 0, entries = 0;
    /// Least cost of the subtree in at most i + 1 of a wide node's children.
    float cost[kWidth - 1] = {};
    /// How many of i + 2 children the left side gets at that cost; 0 when one child fewer is as good. The last one is
    /// for a node of its own, with kWidth children.
    uint8_t left_share[kWidth - 1] = {};
    bool one_leaf = false;  ///< cheaper as one leaf than in any other way
    bool one_kind = true;

    bool is_leaf() const { return child[0] == nullptr || one_leaf; }
};

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

/// Gathers a binary tree into `out`, which is unfinished when cancelled; defined in gather.cpp.
void gather(BinaryNode& root, std::span<const BuildPrimitive> primitives, BuildMonitor& monitor, Bvh& out);

}  // namespace steradian
