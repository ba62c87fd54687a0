#include "accel/merge_leaves.h"

#include <algorithm>
#include <vector>

#include "accel/compact_block.h"
#include "accel/compact_node.h"
#include "base/parallel.h"

namespace steradian {
namespace {

/// What a build holds at most: the result, and twice as much beside it.
constexpr uint64_t kMostTimes = 3;

/// Of the leaves of triangles in a subtree.
struct Sums {
    uint64_t held = 0, result = 0;  ///< bytes: now and in the next step; and of the result, at least
};

class Merger {
public:
    Merger(BinaryPool& pool, const LeafPrimitives& primitives, uint64_t for_each_node, uint64_t for_each_primitive)
        : pool_(pool),
          primitives_(primitives),
          of_leaf_(2 * (sizeof(BinaryNode) + for_each_node)),
          of_primitive_(sizeof(BuildPrimitive) + for_each_primitive) {}

    uint32_t run(uint32_t root) {
        const Sums sums = sum(root);
        if (sums.held <= kMostTimes * sums.result) return root;
        live_.resize(pool_.size());
        merge(root);
        return move_together(root);
    }

private:
    bool points(const BinaryNode& leaf) const {
        for (uint32_t i = leaf.begin(); i < leaf.end(); ++i)
            if (const BuildPrimitive& p = primitives_[i]; !std::equal(p.lo, p.lo + 3, p.hi)) return false;
        return true;
    }
    bool same_boxes(const BinaryNode& leaf) const {
        const BuildPrimitive& first = primitives_[leaf.begin()];
        for (uint32_t i = leaf.begin() + 1; i < leaf.end(); ++i) {
            const BuildPrimitive& p = primitives_[i];
            if (!std::equal(p.lo, p.lo + 3, first.lo) || !std::equal(p.hi, p.hi + 3, first.hi)) return false;
        }
        return true;
    }

    /// Of few points: whether no two are in the same place.
    bool all_apart(const BinaryNode& leaf) const {
        if (leaf.end() - leaf.begin() > kMaxMergedLeaf) return false;
        for (uint32_t i = leaf.begin(); i < leaf.end(); ++i)
            for (uint32_t other = leaf.begin(); other < i; ++other)
                if (std::equal(primitives_[i].lo, primitives_[i].lo + 3, primitives_[other].lo)) return false;
        return true;
    }

    Sums sum(uint32_t index) const {
        const BinaryNode& node = pool_[index];
        if (node.is_leaf()) return node.kind() == ItemKind::block ? sum_of_leaf(node) : Sums{};
        Sums l, r;
        if (node.large())
            parallel_invoke([&] { l = sum(node.child(0)); }, [&] { r = sum(node.child(1)); });
        else
            l = sum(node.child(0)), r = sum(node.child(1));
        return {l.held + r.held, l.result + r.result};
    }
    /// Triangles that differ have four vertices at least, but for points, which may also be put in fuller blocks. Of
    /// the nodes there is one for seven leaves, of two blocks each.
    Sums sum_of_leaf(const BinaryNode& leaf) const {
        const uint64_t count = leaf.end() - leaf.begin(), blocks = (count + kBlock - 1) / kBlock;
        const bool all_points = points(leaf);
        const bool few_vertices = all_points ? !all_apart(leaf) : same_boxes(leaf);
        const uint32_t vertices = CompactBlock::kMinVertices + (few_vertices ? 0 : 1);
        const uint64_t block =
            sizeof(uint64_t) * CompactBlock::units_for(vertices, false) + sizeof(CompactNode) / (2 * (kWidth - 1));
        return {of_leaf_ + of_primitive_ * count, all_points ? block * count / kBlock : block * blocks};
    }

    /// Marks what remains. Whether the node is a leaf of what may be merged.
    bool merge(uint32_t index) {
        live_[index] = true;
        BinaryNode& node = pool_[index];
        if (node.is_leaf()) return node.kind() == ItemKind::block && (same_boxes(node) || points(node));
        const uint32_t left = node.child(0), right = node.child(1);
        const bool alike_left = merge(left), alike_right = merge(right);
        if (!alike_left || !alike_right) return false;
        const BinaryNode &l = pool_[left], &r = pool_[right];
        if (l.end() != r.begin() || r.end() - l.begin() > kMaxMergedLeaf) return false;
        node.set_leaf(l.begin(), r.end(), ItemKind::block);
        live_[left] = live_[right] = false;
        return true;
    }

    /// Nodes from the end go to where there are none any more.
    uint32_t move_together(uint32_t root) {
        const auto count = static_cast<uint32_t>(std::count(live_.begin(), live_.end(), true));
        uint32_t free = 0;
        for (uint32_t i = count; i < live_.size(); ++i) {
            if (!live_[i]) continue;
            while (live_[free]) ++free;
            pool_[free] = pool_[i], pool_[i].second = free++;
        }
        const auto now_at = [&](uint32_t index) { return index < count ? index : pool_[index].second; };
        for (uint32_t i = 0; i < count; ++i)
            if (BinaryNode& node = pool_[i]; !node.is_leaf())
                for (const int which : {0, 1}) node.set_child(which, now_at(node.child(which)));
        root = now_at(root);
        pool_.keep(count);
        return root;
    }

    BinaryPool& pool_;
    const LeafPrimitives& primitives_;
    const uint64_t of_leaf_, of_primitive_;
    std::vector<bool> live_;  ///< by node
};

}  // namespace

uint32_t merge_alike_leaves(BinaryPool& pool, uint32_t root, const LeafPrimitives& primitives, uint64_t for_each_node,
                            uint64_t for_each_primitive) {
    return Merger(pool, primitives, for_each_node, for_each_primitive).run(root);
}

}  // namespace steradian
