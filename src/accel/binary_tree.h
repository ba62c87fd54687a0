// The binary tree that the builders make, before its nodes are gathered into wide ones.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "accel/bvh.h"

namespace steradian {

struct BinaryNode {
    Box4 box;
    BinaryNode* child[2] = {};  ///< both or none
    uint32_t begin = 0, end = 0;
    uint32_t depth = 0;
    /// Wide nodes and items that it takes to hold the subtree. Set by gather().
    uint32_t nodes = 0, items = 0;

    bool is_leaf() const { return child[0] == nullptr; }
};

/// Nodes in chunks that never move. Every task has a Source of its own, so that workers meet only over whole chunks.
class BinaryPool {
public:
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
    static constexpr size_t kChunk = 256;
    BinaryNode* grow() {
        const std::lock_guard lock(mutex_);
        chunks_.push_back(std::make_unique<BinaryNode[]>(kChunk));
        return chunks_.back().get();
    }

    std::mutex mutex_;
    std::vector<std::unique_ptr<BinaryNode[]>> chunks_;
};

/// Gathers a binary tree into `out`; defined in gather.cpp.
void gather(BinaryNode& root, std::span<const BuildPrimitive> primitives, bool blocks, Bvh& out);

}  // namespace steradian
