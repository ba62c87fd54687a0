// Insertion-based optimisation: a node is taken out with everything below it and put beside another one, where that
// makes the sum of all surfaces smaller (Bittner, Hapala & Havran 2013, "Fast Insertion-Based Optimization of Bounding
// Volume Hierarchies"). As in Meister & Bittner 2018, "Parallel Reinsertion for Bounding Volume Hierarchy
// Optimization", the best places of many nodes are sought at once, by all workers, in a tree that stands still; then
// the moves are made one after the other, the most promising first, each after a look at what it gains in the tree as
// it is by then.
#include "accel/reinsert.h"

#include <algorithm>
#include <deque>
#include <mutex>

#include "base/parallel.h"

namespace steradian {
namespace {

constexpr uint32_t kNone = ~0u;
/// What a fifth one would gain is not worth its time.
constexpr int kPasses = 4;
/// Nodes looked at between questions about cancellation.
constexpr size_t kGrain = 256;

struct Move {
    float gain = 0;
    uint32_t rank = 0, target = 0;  ///< of the node, and the node itself
};

Box4 join(const Box4& a, const Box4& b) {
    Box4 both = a;
    both.extend(b);
    return both;
}

static_assert(kReinsertionTreeBytes == 2 * sizeof(uint32_t) + sizeof(uint8_t));
static_assert(kReinsertionBytes == kReinsertionTreeBytes + sizeof(Move));

class Tree {
public:
    Tree(BinaryPool& nodes, uint32_t root, uint32_t max_depth)
        : nodes_(nodes), root_(root), max_depth_(max_depth), parent_(nodes.size()), height_(nodes.size()) {
        const Box bounds = nodes_[root].box().box();
        const float scale = 1 / max_component(bounds.hi - bounds.lo);
        scale_ = Float4::all(is_finite(scale) ? scale : 0.0f);
        order_.reserve(count(root));
        append(root, kNone);
        // From now on all splits count: they may become others.
        if (has_room())
            for (const uint32_t node : order_)
                if (!nodes_[node].is_leaf()) nodes_[node].count();
    }
    /// False for a tree with all the levels that it may have.
    bool has_room() const { return height_[root_] < max_depth_; }
    size_t size() const { return order_.size(); }
    /// Where the node of that rank, in the order from the root down, would best go; the gain is 0 where it is best off
    /// already.
    Move best_move(uint32_t rank) const {
        const uint32_t node = order_[rank];
        Move best{0, rank, kNone};
        if (!movable(node)) return best;
        const Box4 box = nodes_[node].box();
        const float own = area(box);
        const uint32_t parent = parent_[node];
        // What its ancestors shrink to without it, and what has been gained by that so far.
        Box4 shrunken = nodes_[sibling(node)].box();
        float gain = area(parent);
        search(sibling(node), box, own, gain, best);
        for (uint32_t child = parent; child != root_;) {
            const uint32_t above = parent_[child];
            const BinaryNode& ancestor = nodes_[above];
            const uint32_t beside = ancestor.child(0) == child ? ancestor.child(1) : ancestor.child(0);
            // Beside all that is left of this ancestor.
            if (child != parent) consider(child, gain - area(child), best);
            if (gain - own > best.gain) search(beside, box, own, gain, best);
            shrunken.extend(nodes_[beside].box());
            gain += area(ancestor.box()) - area(shrunken);
            child = above;
        }
        return best;
    }

    /// Makes a move if it still is possible and still gains something.
    void apply(const Move& move) {
        const uint32_t node = order_[move.rank], target = move.target;
        if (!movable(node) || target == parent_[node] || target == sibling(node) || target == root_) return;
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

private:
    float area(const Box4& box) const { return half_area((box.hi - box.lo) * scale_); }
    float area(uint32_t node) const { return area(nodes_[node].box()); }
    /// The root has nowhere to go; without one of its children it would have only one.
    bool movable(uint32_t node) const { return node != root_ && parent_[node] != root_; }

    size_t count(uint32_t node) const {
        const BinaryNode& n = nodes_[node];
        return n.is_leaf() ? 1 : 1 + count(n.child(0)) + count(n.child(1));
    }
    void append(uint32_t node, uint32_t parent) {
        order_.push_back(node);
        parent_[node] = parent, height_[node] = 0;
        const BinaryNode& n = nodes_[node];
        if (n.is_leaf()) return;
        append(n.child(0), node), append(n.child(1), node);
        set_height(node);
    }
    void set_height(uint32_t node) {
        const BinaryNode& n = nodes_[node];
        height_[node] = static_cast<uint8_t>(1 + std::max(height_[n.child(0)], height_[n.child(1)]));
    }

    uint32_t sibling(uint32_t node) const {
        const BinaryNode& p = nodes_[parent_[node]];
        return p.child(0) == node ? p.child(1) : p.child(0);
    }
    void replace_child(uint32_t parent, uint32_t child, uint32_t by) {
        nodes_[parent].set_child(nodes_[parent].child(0) == child ? 0 : 1, by);
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
        const BinaryPool::View nodes(nodes_);
        Entry stack[2 * kMaxNodeLevels];
        uint32_t depth = 0;
        for (Entry e{top, gain};; e = stack[--depth]) {
            // The right side is next, without a detour by the stack.
            while (e.gain - own > best.gain) {
                const BinaryNode& node = nodes[e.node];
                const Box4 old = node.box();
                const float joint = area(join(old, box));
                consider(e.node, e.gain - joint, best);
                if (node.is_leaf()) break;
                e.gain -= joint - area(old);
                stack[depth++] = {node.child(0), e.gain};
                e.node = node.child(1);
            }
            if (depth == 0) return;
        }
    }

    /// Sets box and height from the children, from `node` up; returns how much smaller all together have become.
    double refit(uint32_t node) {
        double gain = 0;
        for (; node != kNone; node = parent_[node]) {
            BinaryNode& n = nodes_[node];
            gain += area(n.box());
            n.set_box(join(nodes_[n.child(0)].box(), nodes_[n.child(1)].box()));
            gain -= area(n.box());
            set_height(node);
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
        nodes_[parent].set_child(0, target), nodes_[parent].set_child(1, node);
        parent_[target] = parent;
        refit(parent);
    }

    BinaryPool& nodes_;
    uint32_t root_, max_depth_;
    Float4 scale_;
    std::vector<uint32_t> order_;  ///< every node before what is below it, the left side first
    LargeArray<uint32_t> parent_;  ///< by node, as the height
    LargeArray<uint8_t> height_;
};

/// The moves that gain something in the tree as it is, the best first. Most nodes are where they should be, so there is
/// no room for all of them; and none for an array that grows by doubling.
std::deque<Move> find_moves(const Tree& tree, BuildMonitor& monitor) {
    std::deque<Move> moves;
    std::mutex mutex;
    parallel_for(tree.size(), kGrain, [&](size_t begin, size_t end) {
        if (monitor.poll()) return;
        std::vector<Move> found;
        for (size_t i = begin; i < end; ++i)
            if (const Move move = tree.best_move(static_cast<uint32_t>(i)); move.gain > 0) found.push_back(move);
        const std::lock_guard lock(mutex);
        moves.insert(moves.end(), found.begin(), found.end());
    });
    std::sort(moves.begin(), moves.end(),
              [](const Move& a, const Move& b) { return a.gain != b.gain ? a.gain > b.gain : a.rank < b.rank; });
    return moves;
}

}  // namespace

void reinsert(BinaryPool& nodes, uint32_t root, uint32_t max_depth, BuildMonitor& monitor, uint64_t work) {
    Tree tree(nodes, root, max_depth);
    uint64_t work_left = work;
    for (int pass = 0; pass < kPasses && tree.has_room(); ++pass) {
        const std::deque<Move> moves = find_moves(tree, monitor);
        monitor.advance(work / kPasses);
        work_left -= work / kPasses;
        for (size_t i = 0; i < moves.size(); ++i) {
            if (i % kGrain == 0 && monitor.poll()) break;
            tree.apply(moves[i]);
        }
    }
    monitor.advance(work_left);
}

}  // namespace steradian
