#include "accel/fuller.h"

#include <algorithm>
#include <utility>

#include "accel/tree_bytes.h"

namespace steradian {
namespace {

/// Subtrees of up to so many primitives are divided anew as wholes.
constexpr uint64_t kTreelet = 256;
constexpr uint32_t kNowhere = ~0u;
/// What every leaf may count on for its share of the nodes. From the leaves up, let every node have the children of
/// both its sides, and where these are more than eight, make a node of the larger side, which has five of them at
/// least: so there is a node for every four leaves, and the root.
constexpr uint64_t kShareOfNodes = sizeof(WideNode) / 4;
/// Below kMostTriangleBytes by what the sums of floats in gather() may be off. Full blocks take 56.
constexpr uint64_t kEnoughTriangleBytes = kMostTriangleBytes - 1;
static_assert((sizeof(TriangleBlock) + kShareOfNodes) / kBlock < kEnoughTriangleBytes);
static_assert(sizeof(LeafEntry) + kShareOfNodes <= kMostOtherBytes);

/// Of a subtree.
struct Contents {
    uint64_t triangles = 0, others = 0;
    uint64_t bytes = 0;  ///< as gather() would make it without merging leaves, at most

    uint64_t primitives() const { return triangles + others; }
};

/// Once all of it is divided anew.
uint64_t full_bytes(const Contents& c) {
    return (c.triangles + kBlock - 1) / kBlock * (sizeof(TriangleBlock) + kShareOfNodes) + c.others * kMostOtherBytes;
}

class Filler {
public:
    Filler(BinaryPool& pool, LeafPrimitives& primitives, const BvhOptions& options, BuildMonitor& monitor)
        : pool_(pool), primitives_(primitives), options_(options), monitor_(monitor), source_(pool) {
        options_.builder = BvhBuilder::median, options_.kinds_first = true;
        options_.work = 0;
    }

    void run(uint32_t root) {
        size_t next = 0;
        if (!in_order(root, next)) sort(root);
        marked_.resize(pool_.size());
        Contents all = visit(root);
        if (all.primitives() <= kTreelet) mark(root, all);
        fill(root, 0);
    }

private:
    /// Whether the leaves have what follows each other, from `next` on.
    bool in_order(uint32_t index, size_t& next) const {
        const BinaryNode& node = pool_[index];
        if (!node.is_leaf()) return in_order(node.child(0), next) && in_order(node.child(1), next);
        if (node.begin() != next || node.end() > primitives_.own.size()) return false;
        next = node.end();
        return true;
    }
    /// By where each goes: a copy of all would be half of what is held then. What is for no leaf, as it was moved, goes
    /// behind everything else and is dropped.
    void sort(uint32_t root) {
        LargeArray<uint32_t> to(primitives_.size());
        std::fill(to.begin(), to.end(), kNowhere);
        uint32_t next = 0;
        find_places(root, next, to);
        const size_t live = next;
        for (uint32_t& place : to)
            if (place == kNowhere) place = next++;
        for (uint32_t i = 0; i < to.size(); ++i)
            while (to[i] != i) {
                const uint32_t place = to[i];
                std::swap(primitives_[i], primitives_[place]), std::swap(to[i], to[place]);
            }
        primitives_.moved.resize(live - primitives_.own.size());
    }
    void find_places(uint32_t index, uint32_t& next, LargeArray<uint32_t>& to) {
        BinaryNode& node = pool_[index];
        if (!node.is_leaf()) {
            for (const int which : {0, 1}) find_places(node.child(which), next, to);
            return;
        }
        const uint32_t first = next;
        for (uint32_t i = node.begin(); i < node.end(); ++i) to[i] = next++;
        node.set_leaf(first, next, node.kind());
    }

    /// Marks what is to be divided anew, from the leaves up; parts of what is marked may be marked as well. What is
    /// larger than a treelet takes no more than it may then.
    Contents visit(uint32_t index) {
        const BinaryNode& node = pool_[index];
        if (node.is_leaf()) return leaf(node);
        const uint32_t child[2] = {node.child(0), node.child(1)};
        Contents part[2] = {visit(child[0]), visit(child[1])};
        if (part[0].primitives() + part[1].primitives() <= kTreelet) return join(part[0], part[1]);
        for (const int which : {0, 1})
            if (part[which].primitives() <= kTreelet) mark(child[which], part[which]);
        Contents all = join(part[0], part[1]);
        mark(index, all);
        return all;
    }
    static Contents leaf(const BinaryNode& node) {
        const uint32_t primitives = node.end() - node.begin();
        Contents c;
        (node.kind() == ItemKind::block ? c.triangles : c.others) = primitives;
        c.bytes = leaf_bytes(node.kind(), primitives) + kShareOfNodes;
        return c;
    }
    static Contents join(const Contents& a, const Contents& b) {
        return {a.triangles + b.triangles, a.others + b.others, a.bytes + b.bytes};
    }
    /// What takes too much and takes less when it is divided anew.
    void mark(uint32_t node, Contents& c) {
        const uint64_t enough = kEnoughTriangleBytes * c.triangles + kMostOtherBytes * c.others;
        if (c.bytes <= std::max(enough, full_bytes(c))) return;
        marked_[node] = true;
        c.bytes = full_bytes(c);
    }

    void fill(uint32_t index, uint32_t depth) {
        const BinaryNode node = pool_[index];
        if (node.is_leaf() || monitor_.poll()) return;
        if (marked_[index]) {
            const Subtree all{pool_[edge(index, 0)].begin(), pool_[edge(index, 1)].end(), depth};
            pool_.give_back_below(index);
            if (all.end <= primitives_.own.size())
                return divide(primitives_.own, all, options_, monitor_, pool_, source_, index);
            return divide_copied(all, index);
        }
        for (const int which : {0, 1}) fill(node.child(which), depth + (node.counted() ? 1 : 0));
    }
    /// What is not, or not all of it, in one array.
    void divide_copied(const Subtree& all, uint32_t index) {
        LargeArray<BuildPrimitive> copy;
        copy.reserve(all.end - all.begin);
        for (size_t i = all.begin; i < all.end; ++i) copy.push_back(primitives_[i]);
        divide(copy, {0, copy.size(), all.depth}, options_, monitor_, pool_, source_, index);
        for (size_t i = all.begin; i < all.end; ++i) primitives_[i] = copy[i - all.begin];
        move_leaves(index, all.begin);
    }
    void move_leaves(uint32_t index, size_t by) {
        BinaryNode& node = pool_[index];
        if (node.is_leaf()) return node.set_leaf(node.begin() + by, node.end() + by, node.kind());
        for (const int which : {0, 1}) move_leaves(node.child(which), by);
    }
    /// The first or the last leaf.
    uint32_t edge(uint32_t node, int which) const {
        while (!pool_[node].is_leaf()) node = pool_[node].child(which);
        return node;
    }

    BinaryPool& pool_;
    LeafPrimitives& primitives_;
    BvhOptions options_;
    BuildMonitor& monitor_;
    BinaryPool::Source source_;
    std::vector<bool> marked_;  ///< by node
};

}  // namespace

void make_fuller(BinaryPool& pool, uint32_t root, LeafPrimitives& primitives, const BvhOptions& options,
                 BuildMonitor& monitor) {
    Filler(pool, primitives, options, monitor).run(root);
}

}  // namespace steradian
