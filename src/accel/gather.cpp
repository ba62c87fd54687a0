// From two children a node to eight, at the least expected cost: dynamic programming over the number of children that a
// subtree gets in the node above it (after Ylitie, Karras & Laine 2017, "Efficient Incoherent Ray Traversal on GPUs
// Through Compressed Wide BVHs", section 3.1). Passes over the tree decide, count, and fill exact places, all of them
// by several workers.
#include <algorithm>
#include <memory>

#include "accel/binary_tree.h"
#include "accel/children.h"
#include "accel/compact_block.h"
#include "accel/compact_node.h"
#include "accel/fuller.h"
#include "accel/merge_leaves.h"
#include "accel/tree_bytes.h"
#include "base/parallel.h"

namespace steradian {
namespace {

constexpr size_t kIdGrain = 4096;

/// What is decided of an inner node.
class Choice {
public:
    Choice() = default;
    Choice(bool one_leaf, ItemKind kind) : bits_(uint32_t(one_leaf) | static_cast<uint32_t>(kind) << 1) {}
    bool one_leaf() const { return bits_ & 1; }  ///< cheaper as one leaf than in any other way
    ItemKind kind() const { return static_cast<ItemKind>(bits_ >> 1 & 3); }  ///< of its first primitive
    /// How many of `children` (at least 2) of a wide node the left side gets at the least cost; 0 when one child fewer
    /// is as good. With kWidth children in a node of its own.
    uint32_t left_share(uint32_t children) const { return bits_ >> at(children) & 7; }
    void set_left_share(uint32_t children, uint32_t left) { bits_ |= left << at(children); }

private:
    static uint32_t at(uint32_t children) { return 3 * (children - 1); }
    uint32_t bits_;
};

struct Children {
    uint32_t node[kWidth], depth[kWidth];
    uint32_t count = 0;
};

/// Where things go that are yet to be written.
struct Places {
    uint32_t node = 0, block = 0, entry = 0;
};

struct Totals {
    uint32_t nodes = 0, blocks = 0, entries = 0, depth = 0;
    uint32_t runs = 0;       ///< nodes over the runs of a leaf
    uint32_t triangles = 0;  ///< in blocks
    uint64_t leaves = 0;

    void add(const Totals& t) {
        nodes += t.nodes, blocks += t.blocks, entries += t.entries, runs += t.runs, leaves += t.leaves;
        triangles += t.triangles;
        depth = std::max(depth, t.depth);
    }
    uint64_t bytes() const {
        return nodes * sizeof(WideNode) + blocks * sizeof(TriangleBlock) + entries * sizeof(LeafEntry);
    }
    bool within_bounds() const { return bytes() <= most_tree_bytes(triangles, entries); }
};

/// What is below the children of a wide node that several workers fill; of smaller ones it need not be known.
struct Plan {
    Totals child[kWidth];
    std::unique_ptr<Plan> below[kWidth];
};

class Gatherer {
public:
    Gatherer(const BinaryPool& pool, LeafPrimitives& primitives, BuildMonitor& monitor, Bvh& out)
        : pool_(pool), primitives_(primitives), monitor_(monitor), out_(out) {}

    /// Decides how, at the least expected cost with which it takes no more than it may. False when there is none.
    bool choose(uint32_t root) {
        out_.bounds = pool_[root].box().box();
        const float scale = 1 / max_component(out_.bounds.hi - out_.bounds.lo);
        scale_ = Float4::all(is_finite(scale) ? scale : 0.0f);
        choice_.resize(pool_.size());
        const float cost = choose(root, 0);
        if (monitor_.poll() || totals_.within_bounds()) return true;
        // Bytes cost more and more, and in the end nothing else does.
        const float cost_of_byte = cost / static_cast<float>(totals_.bytes());
        for (const float factor : {0.01f, 0.03f, 0.1f, 0.3f, 1.0f, 3.0f}) {
            if (!(cost_of_byte > 0)) break;
            choose(root, factor * cost_of_byte);
            if (monitor_.poll() || totals_.within_bounds()) return true;
        }
        scale_ = Float4::all(0);
        choose(root, 1);
        return totals_.within_bounds();
    }
    /// Another tree will be chosen.
    void forget() { LargeArray<Choice>().swap(choice_); }

    void run(uint32_t root, BvhLayout layout) {
        // What was moved is reported with what it was moved from.
        const uint64_t work = primitives_.own.size();
        monitor_.advance(work);
        const bool again = layout == BvhLayout::compact && totals_.runs == 0 && holds_much();
        if (again) forget();
        take_ids(totals_.runs > 0);
        if (again) {
            choice_.resize(pool_.size());
            choose(root, cost_of_byte_);
            if (monitor_.poll()) return;
        }
        out_.nodes.resize(totals_.nodes);
        out_.blocks.resize(size_t(totals_.blocks) * kBlock);
        out_.entries.resize(totals_.entries);
        out_.leaves = totals_.leaves, out_.depth = totals_.depth;
        Places at;
        fill(root, at, plan_.get());
        monitor_.advance((kGatherWork - 1) * work);
    }

private:
    /// Of a subtree.
    struct Decided {
        uint32_t primitives;
        ItemKind kind;  ///< of the first primitive
        bool one_kind;
    };

    bool is_leaf(uint32_t node) const { return pool_[node].is_leaf() || choice_[node].one_leaf(); }
    ItemKind kind_of(uint32_t leaf) const { return pool_[leaf].is_leaf() ? pool_[leaf].kind() : choice_[leaf].kind(); }
    static uint32_t item_size(ItemKind kind) { return kind == ItemKind::block ? kBlock : 1; }
    float choose(uint32_t root, float cost_of_byte) {
        cost_of_byte_ = cost_of_byte, cost_of_node_ = cost_of_byte * sizeof(WideNode);
        float cost[kWidth - 1];
        decide(root, cost);
        plan_.reset();
        totals_ = count(root, 0, plan_);
        return cost[0];
    }
    uint32_t primitives_below(uint32_t node) const {
        const BinaryNode& n = pool_[node];
        return n.is_leaf() ? n.end() - n.begin() : primitives_below(n.child(0)) + primitives_below(n.child(1));
    }

    /// Of a leaf with such a surface.
    float cost_of_leaf(float area, ItemKind kind, uint32_t primitives) const {
        const float cost = area * leaf_cost(kind, primitives);
        if (cost_of_byte_ == 0) return cost;
        return cost + cost_of_byte_ * static_cast<float>(leaf_bytes(kind, primitives));
    }
    /// Costs are surfaces (in units of the root's largest extent) times visits of nodes and tests of items, and bytes
    /// at their price; cost[i] is the least one of the subtree in at most i + 1 of a wide node's children.
    Decided decide(uint32_t index, float cost[kWidth - 1]) {
        const BinaryNode& node = pool_[index];
        const Box4 box = node.box();
        const float area = half_area((box.hi - box.lo) * scale_);
        if (node.is_leaf()) {
            const uint32_t primitives = node.end() - node.begin();
            std::fill_n(cost, kWidth - 1, cost_of_leaf(area, node.kind(), primitives));
            return {primitives, node.kind(), true};
        }
        float left_cost[kWidth - 1], right_cost[kWidth - 1];
        Decided l, r;
        if (node.large()) {
            parallel_invoke([&] { l = decide(node.child(0), left_cost); },
                            [&] { r = decide(node.child(1), right_cost); });
        } else {
            l = decide(node.child(0), left_cost), r = decide(node.child(1), right_cost);
        }
        const Decided both{l.primitives + r.primitives, l.kind, l.one_kind && r.one_kind && l.kind == r.kind};
        float best[kWidth + 1];
        uint32_t best_left[kWidth + 1] = {};
        for (uint32_t share = 2; share <= kWidth; ++share) {
            best[share] = kInfinity;
            for (uint32_t left = 1; left < share; ++left) {
                const float sum = left_cost[left - 1] + right_cost[share - left - 1];
                if (sum < best[share]) best[share] = sum, best_left[share] = left;
            }
        }
        const float as_leaf = cost_of_leaf(area, l.kind, both.primitives),
                    as_node = area + cost_of_node_ + best[kWidth];
        const bool one_leaf = both.one_kind && both.primitives <= kMaxMergedLeaf &&
                              items_for(l.kind, both.primitives) <= ChildRef::kMaxRun && as_leaf <= as_node;
        Choice choice(one_leaf, l.kind);
        choice.set_left_share(kWidth, best_left[kWidth]);
        cost[0] = one_leaf ? as_leaf : as_node;
        for (uint32_t share = 2; share < kWidth; ++share) {
            const bool gains = best[share] < cost[share - 2];
            cost[share - 1] = gains ? best[share] : cost[share - 2];
            if (gains) choice.set_left_share(share, best_left[share]);
        }
        choice_[index] = choice;
        return both;
    }

    /// Adds what represents `node`, under so many splits, in at most `share` children.
    void add_children(uint32_t node, uint32_t depth, uint32_t share, Children& out) const {
        if (share > 1 && !is_leaf(node)) {
            while (share > 1 && choice_[node].left_share(share) == 0) --share;
            if (share > 1) return divide_share(node, depth, share, out);
        }
        out.node[out.count] = node, out.depth[out.count++] = depth;
    }
    void divide_share(uint32_t node, uint32_t depth, uint32_t share, Children& out) const {
        const uint32_t left = choice_[node].left_share(share), below = depth + (pool_[node].counted() ? 1 : 0);
        add_children(pool_[node].child(0), below, left, out);
        add_children(pool_[node].child(1), below, share - left, out);
    }

    /// Of the wide node that stands for `parent`: a leaf, which only the root may be, is its own child.
    Children children_of(uint32_t parent, uint32_t depth) const {
        Children c;
        if (is_leaf(parent))
            add_children(parent, depth, 1, c);
        else
            divide_share(parent, depth, kWidth, c);
        return c;
    }

    /// Of everything below, when `root` becomes a wide node under so many splits.
    Totals count(uint32_t root, uint32_t depth, std::unique_ptr<Plan>& plan) const {
        Totals totals;
        totals.nodes = 1;
        const Children children = children_of(root, depth);
        if (pool_[root].large()) plan = std::make_unique<Plan>();
        Totals parts[kWidth];
        each(plan != nullptr, children, [&](uint32_t i) {
            const uint32_t child = children.node[i];
            std::unique_ptr<Plan> none;
            parts[i] = is_leaf(child) ? count_leaf(child, children.depth[i])
                                      : count(child, children.depth[i], plan ? plan->below[i] : none);
        });
        for (uint32_t i = 0; i < children.count; ++i) totals.add(parts[i]);
        if (plan) std::copy_n(parts, children.count, plan->child);
        return totals;
    }
    Totals count_leaf(uint32_t leaf, uint32_t depth) const {
        const uint32_t primitives = primitives_below(leaf);
        const uint32_t items = items_for(kind_of(leaf), primitives), nodes = nodes_for(items);
        const bool blocks = kind_of(leaf) == ItemKind::block;
        return {nodes, blocks ? items : 0, blocks ? 0 : items, depth, nodes, blocks ? primitives : 0, 1};
    }

    /// Whether ids beside everything else might be more than thrice the result, which happens where triangles are
    /// points: then it is decided once more, when the boxes are gone. Blocks take least where all their triangles have
    /// the same vertices.
    bool holds_much() const {
        const uint64_t now = primitives_.size() * (sizeof(BuildPrimitive) + sizeof(uint32_t)) +
                             pool_.size() * (sizeof(BinaryNode) + sizeof(Choice));
        const uint64_t least =
            totals_.blocks * sizeof(uint64_t) * uint64_t(CompactBlock::units_for(CompactBlock::kMinVertices, false)) +
            totals_.entries * sizeof(LeafEntry) + totals_.nodes * sizeof(CompactNode);
        return now > 3 * least;
    }
    /// Of the primitives only their ids are needed from now on, and boxes where there are nodes over runs.
    void take_ids(bool boxes_too) {
        const size_t own = primitives_.own.size();
        ids_.resize(primitives_.size());
        parallel_for(own, kIdGrain, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) ids_[i] = primitives_.own[i].id;
        });
        for (size_t i = own; i < ids_.size(); ++i) ids_[i] = primitives_[i].id;
        if (boxes_too) return;
        LargeArray<BuildPrimitive>().swap(primitives_.own);
        std::deque<BuildPrimitive>().swap(primitives_.moved);
    }

    /// body(i) for every child, by several workers where that pays.
    template <class Body>
    static void each(bool by_several, const Children& children, const Body& body) {
        if (by_several)
            parallel_for(children.count, 1, [&](size_t i, size_t) { body(static_cast<uint32_t>(i)); });
        else
            for (uint32_t i = 0; i < children.count; ++i) body(i);
    }

    /// Writes `root` as the wide node at `at.node`, what is below it behind that, and its items from the other places
    /// on; these move on to what is behind all of it.
    void fill(uint32_t root, Places& at, const Plan* plan) {
        const Children children = children_of(root, 0);
        const uint32_t own = at.node++;
        WideNode node = empty_node();
        // Leaves first, so that the items of one node's leaves lie together.
        for (uint32_t i = 0; i < children.count; ++i)
            if (is_leaf(children.node[i])) node.child[i] = fill_leaf(children.node[i], at);
        Places places[kWidth];
        for (uint32_t i = 0; i < children.count; ++i) {
            set_child_box(node, i, pool_[children.node[i]].box().box());
            if (is_leaf(children.node[i])) continue;
            if (!plan) {
                node.child[i] = ChildRef::node(at.node);
                fill(children.node[i], at, nullptr);
                continue;
            }
            const Totals& below = plan->child[i];
            places[i] = at;
            node.child[i] = ChildRef::node(at.node);
            at.node += below.nodes, at.block += below.blocks, at.entry += below.entries;
        }
        set_child_order(node, children.count);
        out_.nodes[own] = node;
        if (!plan || monitor_.poll()) return;
        each(true, children, [&](uint32_t i) {
            if (!is_leaf(children.node[i])) fill(children.node[i], places[i], plan->below[i].get());
        });
    }

    uint32_t* put_ids(uint32_t node, uint32_t* to) const {
        const BinaryNode& n = pool_[node];
        if (n.is_leaf()) return std::copy(ids_.begin() + n.begin(), ids_.begin() + n.end(), to);
        return put_ids(n.child(1), put_ids(n.child(0), to));
    }
    /// A leaf that was merged is never more than a run.
    uint32_t fill_leaf(uint32_t leaf, Places& at) {
        const ItemKind kind = kind_of(leaf);
        uint32_t& next = kind == ItemKind::block ? at.block : at.entry;
        const uint32_t first = next, size = item_size(kind), items = items_for(kind, primitives_below(leaf));
        uint32_t* const to = (kind == ItemKind::block ? out_.blocks : out_.entries).data() + size_t(first) * size;
        std::fill(put_ids(leaf, to), to + size_t(items) * size, kNoHit);
        next += items;
        if (items <= ChildRef::kMaxRun) return ChildRef::leaf(kind, first, items);
        return gather_items(pool_[leaf].begin(), pool_[leaf].end(), kind, first, items, at.node);
    }

    /// A run of items, or a node over several runs, at `place` and behind it; which moves on.
    uint32_t gather_items(uint32_t begin, uint32_t end, ItemKind kind, uint32_t item, uint32_t items, uint32_t& place) {
        if (items <= ChildRef::kMaxRun) return ChildRef::leaf(kind, item, items);
        const uint32_t own = place++, share = share_of(items), size = item_size(kind);
        WideNode node = empty_node();
        uint32_t children = 0;
        for (uint32_t first = 0; first < items; first += share, ++children) {
            const uint32_t b = begin + first * size, e = std::min(end, b + share * size);
            set_child_box(node, children, bounds_of(b, e));
            node.child[children] = gather_items(b, e, kind, item + first, std::min(share, items - first), place);
        }
        set_child_order(node, children);
        out_.nodes[own] = node;
        return ChildRef::node(own);
    }
    Box bounds_of(uint32_t begin, uint32_t end) const {
        RangeBounds bounds;
        for (uint32_t i = begin; i < end; ++i) bounds.extend(primitives_[i]);
        return bounds.box.box();
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

    const BinaryPool& pool_;
    LeafPrimitives& primitives_;
    LargeArray<Choice> choice_;  ///< by node
    LargeArray<uint32_t> ids_;
    BuildMonitor& monitor_;
    Float4 scale_;
    float cost_of_byte_ = 0, cost_of_node_ = 0;
    Totals totals_;  ///< of what was chosen last
    std::unique_ptr<Plan> plan_;
    Bvh& out_;
};

}  // namespace

void gather(BinaryPool& pool, uint32_t root, LeafPrimitives& primitives, const BvhOptions& options,
            BuildMonitor& monitor, Bvh& out) {
    Gatherer gatherer(pool, primitives, monitor, out);
    if (!gatherer.choose(root)) {
        gatherer.forget();
        make_fuller(pool, root, primitives, options, monitor);
        if (monitor.poll()) return;
        if (options.layout == BvhLayout::compact)
            root = merge_alike_leaves(pool, root, primitives, 0, sizeof(uint32_t));
        gatherer.choose(root);
    }
    if (!monitor.poll()) gatherer.run(root, options.layout);
}

}  // namespace steradian
