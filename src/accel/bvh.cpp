#include "accel/bvh.h"

#include <algorithm>
#include <bit>
#include <memory>

#include "accel/split.h"
#include "base/parallel.h"

namespace steradian {
namespace {

/// Ranges at least this large are divided by two workers, and ask about cancellation.
constexpr size_t kTaskGrain = 4096;
/// The heuristic makes no larger leaves, however little splitting promises: overlapping boxes do not stay alone.
constexpr size_t kMaxSahLeaf = 8;

/// A binary node. A subtree over n primitives has at most 2 n - 1 nodes, so every subtree knows its place beforehand
/// and workers need not agree on one: a node's left child follows it, the right one comes after the left one's place.
struct BinaryNode {
    Box box;
    uint32_t right = 0;  ///< 0 for a leaf
    uint32_t begin = 0, end = 0;
};

class BinaryBuilder {
public:
    BinaryBuilder(std::span<BuildPrimitive> primitives, const BvhOptions& options, Cancellation& cancelled)
        : primitives_(primitives),
          options_(options),
          cancelled_(cancelled),
          leaf_cost_{options.item_cost, options.blocks},
          // Untouched pages of the places that stay empty cost nothing.
          nodes_(std::make_unique_for_overwrite<BinaryNode[]>(2 * primitives.size())) {}

    const BinaryNode* run() {
        divide(0, 0, primitives_.size(), 0);
        return nodes_.get();
    }

private:
    void divide(size_t node, size_t begin, size_t end, uint32_t depth) {
        const std::span<BuildPrimitive> range = primitives_.subspan(begin, end - begin);
        const RangeBounds bounds = range_bounds(range);
        const size_t left = stop(range.size(), depth) ? 0 : split(range, bounds, depth);
        BinaryNode& out = nodes_[node];
        out = {bounds.box, 0, static_cast<uint32_t>(begin), static_cast<uint32_t>(end)};
        if (left == 0) return;
        const size_t middle = begin + left, right = node + 2 * left;
        out.right = static_cast<uint32_t>(right);
        const auto build_left = [=, this] { divide(node + 1, begin, middle, depth + 1); };
        const auto build_right = [=, this] { divide(right, middle, end, depth + 1); };
        if (range.size() >= kTaskGrain) {
            parallel_invoke(build_left, build_right);
        } else {
            build_left();
            build_right();
        }
    }

    bool stop(size_t count, uint32_t depth) {
        return count <= 1 || depth >= options_.max_depth || (count >= kTaskGrain && cancelled_.poll());
    }

    /// How many go to the left; 0 to make a leaf.
    size_t split(std::span<BuildPrimitive> range, const RangeBounds& bounds, uint32_t depth) {
        const size_t small = options_.blocks ? kBlock : 1;
        if (options_.builder == BvhBuilder::median) return range.size() <= small ? 0 : split_median(range, bounds);
        // A balanced tree only just fits below: no more room for lopsided splits.
        const auto levels = static_cast<uint32_t>(std::bit_width((range.size() - 1) / small));
        if (depth + levels >= options_.max_depth) return range.size() <= small ? 0 : split_median(range, bounds);
        const std::optional<SahSplit> best = find_sah_split(range, bounds, leaf_cost_);
        if (range.size() <= kMaxSahLeaf && (!best || leaf_cost_(range.size()) <= 1 + best->cost)) return 0;
        return best ? apply_sah_split(range, bounds, *best) : split_median(range, bounds);
    }

    std::span<BuildPrimitive> primitives_;
    const BvhOptions& options_;
    Cancellation& cancelled_;
    LeafCost leaf_cost_;
    std::unique_ptr<BinaryNode[]> nodes_;
};

/// Gathers binary nodes into nodes with four children, always opening the child with the largest surface.
class Collapser {
public:
    Collapser(const BinaryNode* nodes, std::span<const BuildPrimitive> primitives, bool blocks, Bvh& out)
        : nodes_(nodes), primitives_(primitives), blocks_(blocks), out_(out) {}

    void run() {
        out_.bounds = nodes_[0].box;
        out_.nodes.emplace_back();
        Child root{0, 0};
        if (is_leaf(root)) {
            fill(0, {&root, 1});
        } else {
            gather(0, root);
        }
    }

private:
    struct Child {
        uint32_t node = 0, depth = 0;
    };
    bool is_leaf(Child c) const { return nodes_[c.node].right == 0; }

    // Recursion is as deep as the tree: kMaxBvhDepth at most.
    void gather(uint32_t place, Child parent) {
        Child children[4] = {{parent.node + 1, parent.depth + 1}, {nodes_[parent.node].right, parent.depth + 1}};
        size_t count = 2;
        while (count < 4) {
            size_t widest = count;
            double area = -1;
            for (size_t i = 0; i < count; ++i)
                if (!is_leaf(children[i]) && nodes_[children[i].node].box.half_area() > area)
                    widest = i, area = nodes_[children[i].node].box.half_area();
            if (widest == count) break;
            const Child opened = children[widest];
            children[widest] = {opened.node + 1, opened.depth + 1};
            children[count++] = {nodes_[opened.node].right, opened.depth + 1};
        }
        fill(place, {children, count});
    }

    void fill(uint32_t place, std::span<const Child> children) {
        BvhNode node;
        uint32_t next = static_cast<uint32_t>(out_.nodes.size());
        for (size_t i = 0; i < 4; ++i) {
            const Box box = i < children.size() ? nodes_[children[i].node].box : Box{};
            for (int axis = 0; axis < 3; ++axis) node.lo[axis][i] = box.lo[axis], node.hi[axis][i] = box.hi[axis];
            node.first[i] = node.count[i] = 0;
            if (i >= children.size()) continue;
            if (is_leaf(children[i])) {
                add_leaf(children[i], node.first[i], node.count[i]);
            } else {
                node.first[i] = next++;
            }
        }
        out_.nodes[place] = node;
        out_.nodes.resize(next);
        for (size_t i = 0; i < children.size(); ++i)
            if (!is_leaf(children[i])) gather(node.first[i], children[i]);
    }

    void add_leaf(Child leaf, uint32_t& first, uint32_t& count) {
        const BinaryNode& node = nodes_[leaf.node];
        const size_t start = out_.order.size();
        for (uint32_t i = node.begin; i < node.end; ++i) out_.order.push_back(primitives_[i].id);
        if (blocks_) out_.order.resize((out_.order.size() + kBlock - 1) / kBlock * kBlock, kNoHit);
        const size_t item = blocks_ ? kBlock : 1;
        first = static_cast<uint32_t>(start / item);
        count = static_cast<uint32_t>((out_.order.size() - start) / item);
        ++out_.leaves;
        out_.depth = std::max(out_.depth, leaf.depth);
    }

    const BinaryNode* nodes_;
    std::span<const BuildPrimitive> primitives_;
    bool blocks_;
    Bvh& out_;
};

}  // namespace

Bvh build_bvh(std::span<const Box> boxes, const BvhOptions& options, Cancellation& cancelled) {
    Bvh out;
    if (boxes.empty()) return out;
    std::vector<BuildPrimitive> primitives(boxes.size());
    parallel_for(boxes.size(), 65536, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) primitives[i] = {boxes[i], static_cast<uint32_t>(i)};
    });
    BinaryBuilder builder(primitives, options, cancelled);
    const BinaryNode* nodes = builder.run();
    if (cancelled.poll()) return out;
    Collapser(nodes, primitives, options.blocks, out).run();
    out.nodes.shrink_to_fit();
    out.order.shrink_to_fit();
    return out;
}

}  // namespace steradian
