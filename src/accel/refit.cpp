// The same hierarchy over geometry that has moved.
#include <algorithm>
#include <bit>

#include "accel/children.h"
#include "accel/geometry.h"
#include "base/parallel.h"

namespace steradian {
namespace {

// --- What differs between the layouts. -------------------------------------------------------------------------

uint32_t child_count(const CompactNode& node) { return static_cast<uint32_t>(std::popcount(node.present())); }
Box child_box(const CompactNode& node, uint32_t i) { return node.box(i); }

/// The boxes of all children, and their order.
void set_children(WideNode& node, const Box boxes[], uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) set_child_box(node, i, boxes[i]);
    set_child_order(node, count);
}
void set_children(CompactNode& node, const Box boxes[], uint32_t count) {
    WideNode wide{};
    std::copy_n(node.child, kWidth, wide.child);
    set_children(wide, boxes, count);
    node = quantise(wide, count);
}

/// Of whatever has corner(which, lane); lanes without a triangle repeat another one.
template <class Block>
void extend_by(const Block& block, Box& box) {
    for (int corner = 0; corner < 3; ++corner)
        for (uint32_t lane = 0; lane < kBlock; ++lane) box.extend(block.corner(static_cast<uint32_t>(corner), lane));
}
Box block_bounds(const LargeArray<TriangleBlock>& blocks, uint32_t leaf) {
    Box box;
    for (const TriangleBlock& block : std::span(blocks).subspan(ChildRef::first(leaf), ChildRef::count(leaf)))
        extend_by(block, box);
    return box;
}
Box block_bounds(const LargeArray<uint64_t>& blocks, uint32_t leaf) {
    Box box;
    for_each_block(&blocks[CompactRef::offset(leaf)], [&](const CompactBlock& block) { extend_by(block, box); });
    return box;
}

/// Blocks, shapes or instances of a leaf.
uint32_t items_of(const LargeArray<TriangleBlock>&, uint32_t leaf) { return ChildRef::count(leaf); }
uint32_t items_of(const LargeArray<uint64_t>& blocks, uint32_t leaf) {
    if (ChildRef::kind(leaf) != ItemKind::block) return ChildRef::count(leaf);
    uint32_t count = 0;
    for_each_block(&blocks[CompactRef::offset(leaf)], [&](const CompactBlock&) { ++count; });
    return count;
}

// ---------------------------------------------------------------------------------------------------------------

template <class Node, class Block>
class Refitter {
public:
    Refitter(LargeArray<Node>& nodes, const LargeArray<Block>& blocks, std::vector<LeafEntry>& entries,
             std::span<const Geometry> geometries, std::span<const LevelPart> parts,
             std::span<const PlacedGeometry> instances, const BoxOfInstance& instance_box)
        : nodes_(nodes),
          blocks_(blocks),
          entries_(entries),
          geometries_(geometries),
          parts_(parts),
          instances_(instances),
          instance_box_(instance_box) {}

    Box run() { return refit(0, static_cast<uint32_t>(nodes_.size())); }

private:
    static constexpr uint32_t kTaskNodes = 512;

    /// The nodes of a subtree are [node, end), with the root of every subtree before what is below it.
    Box refit(uint32_t index, uint32_t end) {
        Node& node = nodes_[index];
        const uint32_t children = child_count(node);
        Box boxes[kWidth];
        const auto one = [&](size_t i, size_t) {
            const uint32_t child = node.child[i];
            boxes[i] = ChildRef::is_leaf(child) ? leaf_box(child) : refit(child, end_of(node, child, end));
        };
        if (end - index < kTaskNodes)
            for (uint32_t i = 0; i < children; ++i) one(i, i + 1);
        else
            parallel_for(children, 1, one);
        set_children(node, boxes, children);
        Box all;
        for (uint32_t i = 0; i < children; ++i) all.extend(boxes[i]);
        return all;
    }

    /// Where the next subtree begins, or the parent's ends.
    static uint32_t end_of(const Node& parent, uint32_t child, uint32_t end) {
        for (const uint32_t other : parent.child)
            if (!ChildRef::is_leaf(other) && other > child) end = std::min(end, other);
        return end;
    }

    const Geometry& geometry_of(const LeafEntry& shape) const {
        return geometries_[shape.instance == kNoHit ? parts_[0].geometry : instances_[shape.instance].geometry];
    }

    /// Shapes and instances are in one leaf each.
    Box leaf_box(uint32_t leaf) {
        if (ChildRef::kind(leaf) == ItemKind::block) return block_bounds(blocks_, leaf);
        Box box;
        for (LeafEntry& entry : std::span(entries_).subspan(ChildRef::first(leaf), ChildRef::count(leaf))) {
            const bool shape = ChildRef::kind(leaf) == ItemKind::shape;
            if (shape) entry.own = shape_bounds(geometry_of(entry), entry.prim);
            box.extend(shape ? entry.own : instance_box_(entry));
        }
        return box;
    }

    LargeArray<Node>& nodes_;
    const LargeArray<Block>& blocks_;
    std::vector<LeafEntry>& entries_;
    std::span<const Geometry> geometries_;
    std::span<const LevelPart> parts_;
    std::span<const PlacedGeometry> instances_;
    const BoxOfInstance& instance_box_;
};

/// What visits of children and tests of items cost that a node leads to directly, times their surfaces.
template <class Node, class Block>
double own_cost(const Level& level, const Node& node, const LargeArray<Block>& blocks, double whole,
                const CostOfInstance& instance_cost) {
    double sum = 0;
    for (uint32_t i = 0; i < child_count(node); ++i) {
        const uint32_t child = node.child[i];
        double cost = 1;
        if (ChildRef::is_leaf(child)) {
            cost = items_of(blocks, child);
            if (ChildRef::kind(child) == ItemKind::instance)
                for (uint32_t k = 0; k < ChildRef::count(child); ++k)
                    cost += instance_cost(level.entries[ChildRef::first(child) + k]);
        }
        // A flat or single point of a scene is met as a whole.
        sum += whole > 0 ? cost * (child_box(node, i).half_area() / whole) : cost;
    }
    return sum;
}

/// In chunks that do not depend on the workers, added in order.
template <class Node, class Block>
double cost_of(const Level& level, const LargeArray<Node>& nodes, const LargeArray<Block>& blocks,
               const CostOfInstance& instance_cost) {
    constexpr size_t kGrain = 4096;
    const double whole = level.bounds.half_area();
    std::vector<double> parts((nodes.size() + kGrain - 1) / kGrain);
    parallel_for(nodes.size(), kGrain, [&](size_t begin, size_t end) {
        double sum = 0;
        for (const Node& node : std::span(nodes).subspan(begin, end - begin))
            sum += own_cost(level, node, blocks, whole, instance_cost);
        parts[begin / kGrain] = sum;
    });
    double sum = 1;
    for (const double part : parts) sum += part;
    return sum;
}

template <class Node, class Block>
std::vector<double> below(const Level& level, const LargeArray<Node>& nodes, const LargeArray<Block>& blocks) {
    std::vector<double> sum(nodes.size());
    for (size_t i = nodes.size(); i-- > 0;) {
        Box box;
        double children = 0;
        for (uint32_t c = 0; c < child_count(nodes[i]); ++c) {
            const uint32_t child = nodes[i].child[c];
            const Box of_child = child_box(nodes[i], c);
            box.extend(of_child);
            if (!ChildRef::is_leaf(child)) children += (sum[child] - 1) * of_child.half_area();
        }
        const double whole = box.half_area();
        sum[i] = 1 + own_cost(level, nodes[i], blocks, whole, {}) + (whole > 0 ? children / whole : 0);
    }
    return sum;
}

}  // namespace

uint32_t item_count(const Level& level, uint32_t leaf) {
    return level.compact.nodes.empty() ? items_of(level.blocks, leaf) : items_of(level.compact.blocks, leaf);
}

void refit_level(Level& level, CompactLevel repacked, std::span<const Geometry> geometries,
                 std::span<const LevelPart> parts, std::span<const PlacedGeometry> instances,
                 const BoxOfInstance& instance_box) {
    level.compact = std::move(repacked);
    if (!level.compact.nodes.empty()) {
        level.bounds = Refitter(level.compact.nodes, level.compact.blocks, level.entries, geometries, parts, instances,
                                instance_box)
                           .run();
    } else if (!level.nodes.empty()) {
        place_vertices(level.blocks, geometries, parts);
        level.bounds =
            Refitter(level.nodes, level.blocks, level.entries, geometries, parts, instances, instance_box).run();
    }
}

double expected_cost(const Level& level, const CostOfInstance& instance_cost) {
    if (!level.compact.nodes.empty()) return cost_of(level, level.compact.nodes, level.compact.blocks, instance_cost);
    if (level.nodes.empty()) return 0;
    return cost_of(level, level.nodes, level.blocks, instance_cost);
}

std::vector<double> costs_below(const Level& level) {
    if (!level.compact.nodes.empty()) return below(level, level.compact.nodes, level.compact.blocks);
    return below(level, level.nodes, level.blocks);
}

}  // namespace steradian
