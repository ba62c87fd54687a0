// The same hierarchy over geometry that has moved.
#include <algorithm>
#include <bit>

#include "accel/children.h"
#include "accel/geometry.h"
#include "base/parallel.h"

namespace steradian {
namespace {

class Refitter {
public:
    Refitter(Level& level, std::span<const Geometry> geometries, std::span<const LevelPart> parts,
             std::span<const PlacedGeometry> instances)
        : level_(level), geometries_(geometries), parts_(parts), instances_(instances) {}

    /// The nodes of a subtree are [node, end), with the root of every subtree before what is below it.
    Box refit(uint32_t index, uint32_t end) {
        WideNode& node = level_.nodes[index];
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
        Box all;
        for (uint32_t i = 0; i < children; ++i) set_child_box(node, i, boxes[i]), all.extend(boxes[i]);
        set_child_order(node, children);
        return all;
    }

private:
    static constexpr uint32_t kTaskNodes = 512;

    /// Where the next subtree begins, or the parent's ends.
    static uint32_t end_of(const WideNode& parent, uint32_t child, uint32_t end) {
        for (const uint32_t other : parent.child)
            if (!ChildRef::is_leaf(other) && other > child) end = std::min(end, other);
        return end;
    }

    const Geometry& geometry_of(const LeafEntry& shape) const {
        return geometries_[shape.instance == kNoHit ? parts_[0].geometry : instances_[shape.instance].geometry];
    }

    /// Every item is in one leaf.
    Box leaf_box(uint32_t leaf) {
        const uint32_t first = ChildRef::first(leaf);
        Box box;
        for (uint32_t i = first; i < first + ChildRef::count(leaf); ++i) {
            if (ChildRef::kind(leaf) == ItemKind::block) {
                const TriangleBlock& block = level_.blocks[i];
                for (int corner = 0; corner < 3; ++corner)
                    for (uint32_t lane = 0; lane < kBlock; ++lane) box.extend(block.corner(corner, lane));
            } else {
                LeafEntry& entry = level_.entries[i];
                const bool shape = ChildRef::kind(leaf) == ItemKind::shape;
                if (shape) entry.own = shape_bounds(geometry_of(entry), entry.prim);
                box.extend(shape ? entry.own : instances_[entry.instance].world);
            }
        }
        return box;
    }

    Level& level_;
    std::span<const Geometry> geometries_;
    std::span<const LevelPart> parts_;
    std::span<const PlacedGeometry> instances_;
};

}  // namespace

void refit_level(Level& level, std::span<const Geometry> geometries, std::span<const LevelPart> parts,
                 std::span<const PlacedGeometry> instances) {
    if (level.nodes.empty()) return;
    place_vertices(level.blocks, geometries, parts);
    level.bounds = Refitter(level, geometries, parts, instances).refit(0, static_cast<uint32_t>(level.nodes.size()));
}

namespace {

uint32_t child_count(const CompactNode& node) { return static_cast<uint32_t>(std::popcount(node.present())); }
Box child_box(const CompactNode& node, uint32_t i) { return node.box(i); }

/// Blocks, shapes or instances of a leaf.
uint32_t items_of(const LargeArray<TriangleBlock>&, uint32_t leaf) { return ChildRef::count(leaf); }
uint32_t items_of(const LargeArray<uint64_t>& blocks, uint32_t leaf) {
    if (ChildRef::kind(leaf) != ItemKind::block) return ChildRef::count(leaf);
    uint32_t count = 1;
    const uint64_t* at = &blocks[CompactRef::offset(leaf)];
    for (CompactBlock block(at); !block.last(); block = CompactBlock(block.unit + block.units())) ++count;
    return count;
}

/// In chunks that do not depend on the workers, added in order.
template <class Node, class Block>
double cost_of(const Level& level, const LargeArray<Node>& nodes, const LargeArray<Block>& blocks,
               std::span<const double> instance_costs) {
    constexpr size_t kGrain = 4096;
    const double whole = level.bounds.half_area();
    std::vector<double> parts((nodes.size() + kGrain - 1) / kGrain);
    parallel_for(nodes.size(), kGrain, [&](size_t begin, size_t end) {
        double sum = 0;
        for (const Node& node : std::span(nodes).subspan(begin, end - begin))
            for (uint32_t i = 0; i < child_count(node); ++i) {
                const uint32_t child = node.child[i];
                double cost = 1;
                if (ChildRef::is_leaf(child)) {
                    cost = items_of(blocks, child);
                    if (ChildRef::kind(child) == ItemKind::instance)
                        for (uint32_t k = 0; k < ChildRef::count(child); ++k)
                            cost += instance_costs[level.entries[ChildRef::first(child) + k].instance];
                }
                // A flat or single point of a scene is met as a whole.
                sum += whole > 0 ? cost * (child_box(node, i).half_area() / whole) : cost;
            }
        parts[begin / kGrain] = sum;
    });
    double sum = 1;
    for (const double part : parts) sum += part;
    return sum;
}

}  // namespace

double expected_cost(const Level& level, std::span<const double> instance_costs) {
    if (!level.compact.nodes.empty()) return cost_of(level, level.compact.nodes, level.compact.blocks, instance_costs);
    if (level.nodes.empty()) return 0;
    return cost_of(level, level.nodes, level.blocks, instance_costs);
}

}  // namespace steradian
