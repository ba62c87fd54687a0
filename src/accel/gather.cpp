// From two children a node to eight, at the least expected cost: dynamic programming over the number of children that a
// subtree gets in the node above it (after Ylitie, Karras & Laine 2017, "Efficient Incoherent Ray Traversal on GPUs
// Through Compressed Wide BVHs", section 3.1). Passes over the tree decide, count, and fill exact places, all of them
// by several workers.
#include <algorithm>
#include <array>

#include "accel/binary_tree.h"
#include "accel/children.h"
#include "base/parallel.h"

namespace steradian {
namespace {

constexpr uint32_t kTaskGrain = 4096;  ///< primitives
/// No larger leaves are made of smaller ones.
constexpr uint32_t kMaxMergedLeaf = 8;

struct Children {
    BinaryNode* node[kWidth];
    uint32_t count = 0;
};

/// Adds what represents `node` in at most `share` children.
void add_children(BinaryNode& node, uint32_t share, Children& out) {
    while (share > 1 && !node.is_leaf() && node.left_share(share) == 0) --share;
    if (share == 1 || node.is_leaf()) {
        out.node[out.count++] = &node;
        return;
    }
    const uint32_t left = node.left_share(share);
    add_children(*node.child[0], left, out);
    add_children(*node.child[1], share - left, out);
}

/// Of the wide node that stands for `parent`; none when that is a leaf.
Children children_of(const BinaryNode& parent) {
    Children c;
    if (parent.is_leaf()) return c;
    const uint32_t left = parent.left_share(kWidth);
    add_children(*parent.child[0], left, c);
    add_children(*parent.child[1], kWidth - left, c);
    return c;
}

class Gatherer {
public:
    Gatherer(LargeArray<BuildPrimitive>& primitives, BuildMonitor& monitor, Bvh& out)
        : primitives_(primitives), monitor_(monitor), out_(out) {}

    void run(BinaryNode& root) {
        out_.bounds = root.box().box();
        const Vec3 size = out_.bounds.hi - out_.bounds.lo;
        const float scale = 1 / max_component(size);
        scale_ = Float4::all(is_finite(scale) ? scale : 0.0f);
        decide(root);
        monitor_.advance(primitives_.size());
        if (monitor_.poll()) return;
        const Totals totals = count(root);
        if (monitor_.poll()) return;
        const uint64_t work = (kGatherWork - 1) * primitives_.size();
        take_ids(totals.runs > 0);
        out_.nodes.resize(totals.nodes);
        out_.blocks.resize(size_t(totals.blocks) * kBlock);
        out_.entries.resize(totals.entries);
        out_.leaves = totals.leaves, out_.depth = totals.depth;
        fill(root, {0, 0, 0});
        monitor_.advance(work);
    }

private:
    struct Totals {
        uint32_t nodes = 0, blocks = 0, entries = 0, depth = 0;
        uint32_t runs = 0;  ///< nodes over the runs of a leaf
        uint64_t leaves = 0;

        void add(const Totals& t) {
            nodes += t.nodes, blocks += t.blocks, entries += t.entries, runs += t.runs, leaves += t.leaves;
            depth = std::max(depth, t.depth);
        }
    };

    /// Where things go that are yet to be written.
    struct Places {
        uint32_t node, block, entry;
    };

    static ItemKind kind_of(const BinaryNode& leaf) { return static_cast<ItemKind>(leaf.first_kind); }
    static uint32_t item_size(ItemKind kind) { return kind == ItemKind::block ? kBlock : 1; }
    static uint32_t items_of(const BinaryNode& leaf) {
        const uint32_t size = item_size(kind_of(leaf));
        return (leaf.end - leaf.begin + size - 1) / size;
    }
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

    /// Costs are surfaces (in units of the root's largest extent) times visits of nodes and tests of items.
    void decide(BinaryNode& node) {
        const Box4 box = node.box();
        const float area = half_area((box.hi - box.lo) * scale_);
        const uint32_t primitives = node.end - node.begin;
        node.first_kind = static_cast<uint32_t>(primitives_[node.begin].kind) & 3;
        const float as_leaf = area * leaf_cost(kind_of(node), primitives);
        if (node.is_leaf()) {
            std::fill_n(node.cost, kWidth - 1, as_leaf);
            return;
        }
        BinaryNode &l = *node.child[0], &r = *node.child[1];
        if (primitives >= kTaskGrain) {
            parallel_invoke([&] { decide(l); }, [&] { decide(r); });
        } else {
            decide(l), decide(r);
        }
        node.one_kind = l.one_kind && r.one_kind && kind_of(l) == kind_of(r);
        float best[kWidth + 1];
        for (uint32_t share = 2; share <= kWidth; ++share) {
            best[share] = kInfinity;
            for (uint32_t left = 1; left < share; ++left) {
                const float cost = l.cost[left - 1] + r.cost[share - left - 1];
                if (cost < best[share]) best[share] = cost, node.set_left_share(share, left);
            }
        }
        const float as_node = area + best[kWidth];
        node.one_leaf = node.one_kind && primitives <= kMaxMergedLeaf && as_leaf <= as_node;
        node.cost[0] = node.one_leaf ? as_leaf : as_node;
        for (uint32_t share = 2; share < kWidth; ++share) {
            node.cost[share - 1] = best[share];
            if (best[share] < node.cost[share - 2]) continue;
            node.cost[share - 1] = node.cost[share - 2], node.set_left_share(share, 0);
        }
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
            child.places = {parts[i].nodes, parts[i].blocks, parts[i].entries};
        });
        for (uint32_t i = 0; i < children.count; ++i) totals.add(parts[i]);
        return totals;
    }
    static Totals count_leaf(const BinaryNode& leaf) {
        const uint32_t items = items_of(leaf), nodes = nodes_for(items);
        const bool blocks = kind_of(leaf) == ItemKind::block;
        return {nodes, blocks ? items : 0, blocks ? 0 : items, leaf.depth, nodes, 1};
    }

    /// Of the primitives only their ids are needed from now on, and boxes where there are nodes over runs.
    void take_ids(bool boxes_too) {
        ids_.resize(primitives_.size());
        parallel_for(ids_.size(), kTaskGrain, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) ids_[i] = primitives_[i].id;
        });
        if (!boxes_too) LargeArray<BuildPrimitive>().swap(primitives_);
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

    /// Writes `root` as the wide node at `at.node`, what is below it behind that, and its items from the other places
    /// on.
    void fill(const BinaryNode& root, Places at) {
        Children children = children_of(root);
        if (root.is_leaf()) children.node[0] = const_cast<BinaryNode*>(&root), children.count = 1;
        Places places[kWidth];
        ++at.node;
        const uint32_t own = at.node - 1;
        // Leaves first, so that the items of one node's leaves lie together.
        for (const bool leaves : {true, false})
            for (uint32_t i = 0; i < children.count; ++i) {
                const BinaryNode& child = *children.node[i];
                if (child.is_leaf() != leaves) continue;
                places[i] = at;
                at.node += child.places.nodes, at.block += child.places.blocks, at.entry += child.places.entries;
            }
        if (root.end - root.begin >= kTaskGrain && monitor_.poll()) return;
        WideNode node = empty_node();
        each(root, children, [&](uint32_t i) {
            const BinaryNode& child = *children.node[i];
            set_child_box(node, i, child.box().box());
            if (child.is_leaf()) {
                node.child[i] = fill_leaf(child, places[i]);
            } else {
                node.child[i] = ChildRef::node(places[i].node);
                fill(child, places[i]);
            }
        });
        set_child_order(node, children.count);
        out_.nodes[own] = node;
    }

    uint32_t fill_leaf(const BinaryNode& leaf, Places at) {
        const ItemKind kind = kind_of(leaf);
        const uint32_t size = item_size(kind), items = items_of(leaf);
        const uint32_t first = kind == ItemKind::block ? at.block : at.entry;
        uint32_t* const begin = (kind == ItemKind::block ? out_.blocks : out_.entries).data() + size_t(first) * size;
        uint32_t* to = begin;
        for (uint32_t i = leaf.begin; i < leaf.end; ++i) *to++ = ids_[i];
        std::fill(to, begin + size_t(items) * size, kNoHit);
        return gather_items(leaf.begin, leaf.end, kind, first, items, at.node);
    }

    /// A run of items, or a node over several runs, at `place` and behind it; which moves on.
    uint32_t gather_items(uint32_t begin, uint32_t end, ItemKind kind, uint32_t item, uint32_t items, uint32_t& place) {
        if (items <= ChildRef::kMaxRun) return ChildRef::leaf(kind, item, items);
        const uint32_t own = place++, share = share_of(items), size = item_size(kind);
        WideNode node = empty_node();
        uint32_t children = 0;
        for (uint32_t first = 0; first < items; first += share, ++children) {
            const uint32_t b = begin + first * size, e = std::min(end, b + share * size);
            set_child_box(node, children, range_bounds(std::span(primitives_).subspan(b, e - b)).box.box());
            node.child[children] = gather_items(b, e, kind, item + first, std::min(share, items - first), place);
        }
        set_child_order(node, children);
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

    LargeArray<BuildPrimitive>& primitives_;
    LargeArray<uint32_t> ids_;
    BuildMonitor& monitor_;
    Float4 scale_;
    Bvh& out_;
};

}  // namespace

void gather(BinaryNode& root, LargeArray<BuildPrimitive>& primitives, BuildMonitor& monitor, Bvh& out) {
    Gatherer(primitives, monitor, out).run(root);
}

}  // namespace steradian
