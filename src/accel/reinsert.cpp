// Insertion-based optimisation: a node is taken out with everything below it and put beside another one, where that
// makes the sum of all surfaces smaller (Bittner, Hapala & Havran 2013, "Fast Insertion-Based Optimization of Bounding
// Volume Hierarchies"). As in Meister & Bittner 2018, "Parallel Reinsertion for Bounding Volume Hierarchy
// Optimization", the best places of many nodes are sought at once, by all workers, in a tree that stands still; then
// the moves are made one after the other, the most promising first, each after a look at what it gains in the tree as
// it is by then.
#include "accel/reinsert.h"

#include <algorithm>

#include "base/parallel.h"

namespace steradian {
namespace {

constexpr uint32_t kNone = ~0u, kRoot = 0, kLeafBit = 1u << 31;
/// What a fifth one would gain is not worth its time.
constexpr int kPasses = 4;
/// Nodes looked at between questions about cancellation.
constexpr size_t kGrain = 256;

struct Move {
    float gain = 0;
    uint32_t node = 0, target = 0;
};

struct alignas(16) FlatNode {
    float lo[3];
    uint32_t left;  ///< or the first primitive of a leaf, with kLeafBit
    float hi[3];
    uint32_t right;  ///< or the end of the primitives

    bool is_leaf() const { return left & kLeafBit; }
    Box4 box() const { return {Float4::load(lo).first_three(), Float4::load(hi).first_three()}; }
    void set_box(const Box4& b) {
        const uint32_t l = left, r = right;
        b.lo.store(lo), b.hi.store(hi);
        left = l, right = r;
    }
};

Box4 join(const Box4& a, const Box4& b) {
    Box4 both = a;
    both.extend(b);
    return both;
}

static_assert(kReinsertionBytes ==
              sizeof(FlatNode) + sizeof(BinaryNode*) + sizeof(uint32_t) + sizeof(uint8_t) + sizeof(Move));

class Tree {
public:
    Tree(BinaryNode& root, uint32_t max_depth) : max_depth_(max_depth) {
        const Box bounds = root.box().box();
        const float scale = 1 / max_component(bounds.hi - bounds.lo);
        scale_ = Float4::all(is_finite(scale) ? scale : 0.0f);
        const size_t nodes = count(root);
        nodes_.reserve(nodes), origin_.reserve(nodes), parent_.reserve(nodes), height_.reserve(nodes);
        append(root, kNone);
    }
    /// False for a tree with all the levels that it may have.
    bool has_room() const { return height_[kRoot] < max_depth_; }
    size_t size() const { return nodes_.size(); }
    /// Where `node` would best go; the gain is 0 where it is best off already.
    Move best_move(uint32_t node) const {
        Move best{0, node, kNone};
        if (!movable(node)) return best;
        const Box4 box = nodes_[node].box();
        const float own = area(box);
        const uint32_t parent = parent_[node];
        // What its ancestors shrink to without it, and what has been gained by that so far.
        Box4 shrunken = nodes_[sibling(node)].box();
        float gain = area(parent);
        search(sibling(node), box, own, gain, best);
        for (uint32_t child = parent; child != kRoot; child = parent_[child]) {
            const uint32_t beside = sibling(child), above = parent_[child];
            // Beside all that is left of this ancestor.
            if (child != parent) consider(child, gain - area(child), best);
            if (gain - own > best.gain) search(beside, box, own, gain, best);
            const Box4 before = shrunken;
            shrunken = join(before, nodes_[beside].box());
            gain += area(above) - area(shrunken);
        }
        return best;
    }

    /// Makes a move if it still is possible and still gains something.
    void apply(const Move& move) {
        const uint32_t node = move.node, target = move.target;
        if (!movable(node) || target == parent_[node] || target == sibling(node) || target == kRoot) return;
        for (uint32_t above = target; above != kNone; above = parent_[above])
            if (above == node) return;
        const uint32_t back = sibling(node);
        double gain = detach(node);
        uint32_t depth = 0;
        for (uint32_t above = parent_[target]; above != kNone; above = parent_[above]) ++depth;
        if (depth + 1 + std::max(height_[node], height_[target]) <= max_depth_) {
            gain -= cost_of_attaching(node, target);
            if (gain > 0) return attach(node, target);
        }
        attach(node, back);
    }

    /// Back into the nodes that it is from, whose leaves keep their primitives: see put_in_order.
    void store() const { store(kRoot, 0); }

private:
    float area(const Box4& box) const { return half_area((box.hi - box.lo) * scale_); }
    float area(uint32_t node) const { return area(nodes_[node].box()); }
    /// The root has nowhere to go; without one of its children it would have only one.
    bool movable(uint32_t node) const { return node != kRoot && parent_[node] != kRoot; }

    static size_t count(const BinaryNode& from) {
        return from.is_leaf() ? 1 : 1 + count(*from.child[0]) + count(*from.child[1]);
    }
    uint32_t append(BinaryNode& from, uint32_t parent) {
        const auto index = static_cast<uint32_t>(nodes_.size());
        nodes_.emplace_back();
        origin_.push_back(&from);
        parent_.push_back(parent);
        height_.push_back(0);
        uint32_t left = from.begin | kLeafBit, right = from.end;
        if (!from.is_leaf()) {
            left = append(*from.child[0], index);
            right = append(*from.child[1], index);
            height_[index] = static_cast<uint8_t>(1 + std::max(height_[left], height_[right]));
        }
        nodes_[index].left = left, nodes_[index].right = right;
        nodes_[index].set_box(from.box());
        return index;
    }

    BinaryNode* store(uint32_t from, uint32_t depth) const {
        BinaryNode& to = *origin_[from];
        const FlatNode& node = nodes_[from];
        to.set_box(node.box());
        // Splits by kind do not count.
        to.depth = std::min(depth, max_depth_);
        if (!node.is_leaf()) to.child[0] = store(node.left, depth + 1), to.child[1] = store(node.right, depth + 1);
        return &to;
    }

    uint32_t sibling(uint32_t node) const {
        const FlatNode& p = nodes_[parent_[node]];
        return p.left == node ? p.right : p.left;
    }
    void replace_child(uint32_t parent, uint32_t child, uint32_t by) {
        (nodes_[parent].left == child ? nodes_[parent].left : nodes_[parent].right) = by;
        parent_[by] = parent;
    }

    static void consider(uint32_t target, float gain, Move& best) {
        if (gain > best.gain) best.gain = gain, best.target = target;
    }

    /// The best place below `top`, whose ancestors gain `gain`. Every place costs a new node no smaller than the box.
    void search(uint32_t top, const Box4& box, float own, float gain, Move& best) const {
        struct Entry {
            uint32_t node;
            float gain;
        };
        Entry stack[2 * kMaxNodeLevels];
        uint32_t depth = 0;
        stack[depth++] = {top, gain};
        while (depth) {
            const Entry e = stack[--depth];
            if (e.gain - own <= best.gain) continue;
            const FlatNode& node = nodes_[e.node];
            const Box4 old = node.box();
            const float joint = area(join(old, box));
            consider(e.node, e.gain - joint, best);
            if (node.is_leaf()) continue;
            const float below = e.gain - (joint - area(old));
            if (below - own <= best.gain) continue;
            stack[depth++] = {node.left, below};
            stack[depth++] = {node.right, below};
        }
    }

    /// Sets box and height from the children, from `node` up; returns how much smaller all together have become.
    double refit(uint32_t node) {
        double gain = 0;
        for (; node != kNone; node = parent_[node]) {
            FlatNode& n = nodes_[node];
            gain += area(n.box());
            n.set_box(join(nodes_[n.left].box(), nodes_[n.right].box()));
            gain -= area(n.box());
            height_[node] = static_cast<uint8_t>(1 + std::max(height_[n.left], height_[n.right]));
        }
        return gain;
    }
    /// Its parent goes with it. Returns the gain.
    double detach(uint32_t node) {
        const uint32_t parent = parent_[node], above = parent_[parent];
        const double gain = area(parent);
        replace_child(above, parent, sibling(node));
        return gain + refit(above);
    }
    double cost_of_attaching(uint32_t node, uint32_t target) const {
        const Box4 box = nodes_[node].box();
        double cost = area(join(nodes_[target].box(), box));
        for (uint32_t above = parent_[target]; above != kNone; above = parent_[above])
            cost += area(join(nodes_[above].box(), box)) - area(above);
        return cost;
    }
    void attach(uint32_t node, uint32_t target) {
        const uint32_t parent = parent_[node];
        replace_child(parent_[target], target, parent);
        nodes_[parent].left = target, nodes_[parent].right = node;
        parent_[target] = parent;
        refit(parent);
    }

    Float4 scale_;
    uint32_t max_depth_;
    std::vector<FlatNode> nodes_;
    std::vector<BinaryNode*> origin_;
    std::vector<uint32_t> parent_;
    std::vector<uint8_t> height_;
};

/// The moves that gain something in the tree as it is, the best first.
std::vector<Move> find_moves(const Tree& tree, BuildMonitor& monitor) {
    std::vector<Move> moves(tree.size());
    parallel_for(moves.size(), kGrain, [&](size_t begin, size_t end) {
        if (monitor.poll()) return;
        for (size_t i = begin; i < end; ++i) moves[i] = tree.best_move(static_cast<uint32_t>(i));
    });
    moves.erase(std::remove_if(moves.begin(), moves.end(), [](const Move& m) { return !(m.gain > 0); }), moves.end());
    std::sort(moves.begin(), moves.end(),
              [](const Move& a, const Move& b) { return a.gain != b.gain ? a.gain > b.gain : a.node < b.node; });
    return moves;
}

/// Appends the primitives of all leaves below to `ordered`, and says where they are now.
void put_in_order(BinaryNode& node, std::span<const BuildPrimitive> primitives, LargeArray<BuildPrimitive>& ordered) {
    const auto begin = static_cast<uint32_t>(ordered.size());
    if (node.is_leaf()) {
        const std::span<const BuildPrimitive> own = primitives.subspan(node.begin, node.end - node.begin);
        ordered.insert(ordered.end(), own.begin(), own.end());
    } else {
        for (BinaryNode* child : node.child) put_in_order(*child, primitives, ordered);
    }
    node.begin = begin, node.end = static_cast<uint32_t>(ordered.size());
}
uint32_t primitives_below(const BinaryNode& node) {
    return node.is_leaf() ? node.end - node.begin : primitives_below(*node.child[0]) + primitives_below(*node.child[1]);
}

/// Everything that is held only for this is gone again at its end.
void optimise(BinaryNode& root, uint32_t max_depth, BuildMonitor& monitor, uint64_t work) {
    Tree tree(root, max_depth);
    uint64_t work_left = work;
    for (int pass = 0; pass < kPasses && tree.has_room(); ++pass) {
        const std::vector<Move> moves = find_moves(tree, monitor);
        monitor.advance(work / kPasses);
        work_left -= work / kPasses;
        for (size_t i = 0; i < moves.size(); ++i) {
            if (i % kGrain == 0 && monitor.poll()) break;
            tree.apply(moves[i]);
        }
    }
    monitor.advance(work_left);
    tree.store();
}

}  // namespace

void reinsert(BinaryNode& root, LargeArray<BuildPrimitive>& primitives, uint32_t max_depth, BuildMonitor& monitor,
              uint64_t work) {
    optimise(root, max_depth, monitor, work);
    LargeArray<BuildPrimitive> ordered;
    ordered.reserve(primitives_below(root));
    put_in_order(root, primitives, ordered);
    primitives = std::move(ordered);
}

}  // namespace steradian
