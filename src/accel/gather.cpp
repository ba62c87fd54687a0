// From two children a node to eight: always opens the child with the largest surface. A first pass decides and counts,
// so that a second one can fill exact places from several workers.
#include <algorithm>
#include <array>

#include "accel/binary_tree.h"
#include "base/parallel.h"

namespace steradian {
namespace {

constexpr uint32_t kTaskGrain = 4096;  ///< primitives

struct Children {
    BinaryNode* node[kWidth];
    uint32_t count = 0;
};

Children children_of(const BinaryNode& parent) {
    Children c;
    if (parent.is_leaf()) return c;
    c.node[0] = parent.child[0], c.node[1] = parent.child[1], c.count = 2;
    float area[kWidth];
    const auto measure = [&](uint32_t i) {
        const Float4 e = c.node[i]->box.hi - c.node[i]->box.lo;
        // Larger coordinates than 1e15 do not occur: no overflow.
        area[i] = c.node[i]->is_leaf() ? -1.0f : half_area(e);
    };
    measure(0), measure(1);
    while (c.count < kWidth) {
        const uint32_t widest = static_cast<uint32_t>(std::max_element(area, area + c.count) - area);
        if (area[widest] < 0) break;
        BinaryNode* opened = c.node[widest];
        c.node[widest] = opened->child[0], c.node[c.count++] = opened->child[1];
        measure(widest), measure(c.count - 1);
    }
    return c;
}

class Gatherer {
public:
    Gatherer(std::span<const BuildPrimitive> primitives, bool blocks, Bvh& out)
        : primitives_(primitives), item_(blocks ? kBlock : 1), out_(out) {}

    void run(BinaryNode& root) {
        out_.bounds = root.box.box();
        const Totals totals = count(root);
        out_.nodes.resize(totals.nodes);
        out_.order.resize(totals.items * item_);
        out_.leaves = totals.leaves, out_.depth = totals.depth;
        fill(root, 0, 0);
    }

private:
    struct Totals {
        uint32_t nodes = 0, items = 0, depth = 0;
        uint64_t leaves = 0;

        void add(const Totals& t) {
            nodes += t.nodes, items += t.items, leaves += t.leaves;
            depth = std::max(depth, t.depth);
        }
    };

    uint32_t items_of(const BinaryNode& leaf) const { return (leaf.end - leaf.begin + item_ - 1) / item_; }
    /// Nodes that it takes to gather a leaf's items, kMaxRun to a run and kWidth runs or nodes to a node.
    static uint32_t nodes_for(uint32_t items) {
        if (items <= ChildRef::kMaxRun) return 0;
        const uint32_t share = share_of(items);
        uint32_t nodes = 1;
        for (uint32_t first = 0; first < items; first += share) nodes += nodes_for(std::min(share, items - first));
        return nodes;
    }
    /// Items of each child of such a node: the least power of kWidth runs that makes do with kWidth children.
    static uint32_t share_of(uint32_t items) {
        uint32_t share = ChildRef::kMaxRun;
        while (uint64_t(share) * kWidth < items) share *= kWidth;
        return share;
    }

    /// Of everything below, when `root` becomes a wide node.
    Totals count(BinaryNode& root) {
        Totals totals;
        totals.nodes = 1;
        if (root.is_leaf()) {
            totals.add(count_leaf(root));
            return totals;
        }
        const Children children = children_of(root);
        Totals parts[kWidth];
        each(root, children, [&](uint32_t i) {
            BinaryNode& child = *children.node[i];
            parts[i] = child.is_leaf() ? count_leaf(child) : count(child);
            child.nodes = parts[i].nodes, child.items = parts[i].items;
        });
        for (uint32_t i = 0; i < children.count; ++i) totals.add(parts[i]);
        return totals;
    }
    Totals count_leaf(const BinaryNode& leaf) const {
        const uint32_t items = items_of(leaf);
        return {nodes_for(items), items, leaf.depth, 1};
    }

    /// body(i) for every child, by several workers where that pays.
    template <class Body>
    static void each(const BinaryNode& parent, const Children& children, const Body& body) {
        if (parent.end - parent.begin < kTaskGrain) {
            for (uint32_t i = 0; i < children.count; ++i) body(i);
        } else {
            parallel_for(children.count, 1, [&](size_t i, size_t) { body(static_cast<uint32_t>(i)); });
        }
    }

    /// Writes `root` as the wide node at `place`, what is below it behind, and its items from `item` on.
    void fill(const BinaryNode& root, uint32_t place, uint32_t item) {
        Children children = children_of(root);
        if (root.is_leaf()) children.node[0] = const_cast<BinaryNode*>(&root), children.count = 1;
        uint32_t places[kWidth], items[kWidth];
        uint32_t next_place = place + 1;
        // Leaves first, so that the items of one node's leaves lie together.
        for (const bool leaves : {true, false})
            for (uint32_t i = 0; i < children.count; ++i) {
                const BinaryNode& child = *children.node[i];
                if (child.is_leaf() != leaves) continue;
                places[i] = next_place, items[i] = item;
                next_place += root.is_leaf() ? 0 : child.nodes;
                item += child.is_leaf() ? items_of(child) : child.items;
            }
        WideNode node = empty_node();
        each(root, children, [&](uint32_t i) {
            const BinaryNode& child = *children.node[i];
            set_box(node, i, child.box.box());
            if (child.is_leaf()) {
                node.child[i] = fill_leaf(child, places[i], items[i]);
            } else {
                node.child[i] = ChildRef::node(places[i]);
                fill(child, places[i], items[i]);
            }
        });
        finish(node, children.count);
        out_.nodes[place] = node;
    }

    uint32_t fill_leaf(const BinaryNode& leaf, uint32_t place, uint32_t item) {
        uint32_t* to = &out_.order[size_t(item) * item_];
        for (uint32_t i = leaf.begin; i < leaf.end; ++i) *to++ = primitives_[i].id;
        const uint32_t items = items_of(leaf);
        std::fill(to, &out_.order[0] + (size_t(item) + items) * item_, kNoHit);
        return gather_items(leaf.begin, leaf.end, item, items, place);
    }

    /// A run of items, or a node over several runs, at `place` and behind it; which moves on.
    uint32_t gather_items(uint32_t begin, uint32_t end, uint32_t item, uint32_t items, uint32_t& place) {
        if (items <= ChildRef::kMaxRun) return ChildRef::leaf(item, items);
        const uint32_t own = place++, share = share_of(items);
        WideNode node = empty_node();
        uint32_t children = 0;
        for (uint32_t first = 0; first < items; first += share, ++children) {
            const uint32_t b = begin + first * item_, e = std::min(end, b + share * item_);
            set_box(node, children, range_bounds(primitives_.subspan(b, e - b)).box.box());
            node.child[children] = gather_items(b, e, item + first, std::min(share, items - first), place);
        }
        finish(node, children);
        out_.nodes[own] = node;
        return ChildRef::node(own);
    }

    static WideNode empty_node() {
        WideNode node;
        for (auto& axis : node.plane) {
            std::fill_n(axis[0], kWidth, kInfinity);
            std::fill_n(axis[1], kWidth, -kInfinity);
        }
        std::fill_n(node.child, kWidth, 0u);
        return node;
    }
    static void set_box(WideNode& node, uint32_t i, const Box& box) {
        for (int axis = 0; axis < 3; ++axis)
            node.plane[axis][0][i] = box.lo[axis], node.plane[axis][1][i] = box.hi[axis];
    }

    /// The order of the children by their centres along the diagonal of each octant.
    static void finish(WideNode& node, uint32_t children) {
        float centre[3][kWidth];
        for (int axis = 0; axis < 3; ++axis)
            for (uint32_t i = 0; i < children; ++i) centre[axis][i] = node.plane[axis][0][i] + node.plane[axis][1][i];
        std::fill_n(node.order, kWidth, 0u);
        for (uint32_t octant = 0; octant < 8; ++octant) {
            float key[kWidth];
            for (uint32_t i = 0; i < children; ++i)
                key[i] = (octant & 1 ? -centre[0][i] : centre[0][i]) + (octant & 2 ? -centre[1][i] : centre[1][i]) +
                         (octant & 4 ? -centre[2][i] : centre[2][i]);
            for (uint32_t i = 0; i < kWidth; ++i) {
                // Its place: how many are farther; children that do not exist come first, where they do no harm.
                uint32_t place = i < children ? kWidth - children : i - children;
                for (uint32_t j = 0; j < children && i < children; ++j)
                    place += key[j] > key[i] || (key[j] == key[i] && j < i);
                node.order[place] |= i << (3 * octant);
            }
        }
    }

    std::span<const BuildPrimitive> primitives_;
    const uint32_t item_;
    Bvh& out_;
};

}  // namespace

void gather(BinaryNode& root, std::span<const BuildPrimitive> primitives, bool blocks, Bvh& out) {
    Gatherer(primitives, blocks, out).run(root);
}

}  // namespace steradian
