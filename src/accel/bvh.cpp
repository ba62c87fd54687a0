#include "accel/bvh.h"

#include <algorithm>
#include <bit>

#include "accel/binary_tree.h"
#include "base/parallel.h"

namespace steradian {
namespace {

/// Ranges at least this large are divided by two workers, and ask about cancellation.
constexpr size_t kTaskGrain = 4096;
/// The heuristic makes no larger leaves, however little splitting promises: overlapping boxes do not stay alone.
constexpr size_t kMaxSahLeaf = 8;

class BinaryBuilder {
public:
    BinaryBuilder(std::span<BuildPrimitive> primitives, const BvhOptions& options, Cancellation& cancelled)
        : primitives_(primitives),
          options_(options),
          cancelled_(cancelled),
          leaf_cost_{options.item_cost, options.blocks} {}

    BinaryNode& run() {
        BinaryPool::Source source(pool_);
        BinaryNode& root = *source.next();
        divide(root, 0, primitives_.size(), range_bounds(primitives_), 0, source);
        return root;
    }

private:
    void divide(BinaryNode& out, size_t begin, size_t end, const RangeBounds& bounds, uint32_t depth,
                BinaryPool::Source& source) {
        const std::span<BuildPrimitive> range = primitives_.subspan(begin, end - begin);
        out.box = bounds.box;
        out.begin = static_cast<uint32_t>(begin), out.end = static_cast<uint32_t>(end);
        out.depth = depth;
        if (stop(range.size(), depth)) return;
        const Halves halves = split(range, bounds, depth);
        if (halves.left == 0) return;
        const size_t middle = begin + halves.left;
        for (BinaryNode*& child : out.child) child = source.next();
        if (range.size() >= kTaskGrain) {
            parallel_invoke([&] { divide(*out.child[0], begin, middle, halves.bounds[0], depth + 1, source); },
                            [&] {
                                BinaryPool::Source own(pool_);
                                divide(*out.child[1], middle, end, halves.bounds[1], depth + 1, own);
                            });
        } else {
            divide(*out.child[0], begin, middle, halves.bounds[0], depth + 1, source);
            divide(*out.child[1], middle, end, halves.bounds[1], depth + 1, source);
        }
    }

    bool stop(size_t count, uint32_t depth) {
        const size_t small = options_.blocks ? kBlock : 1;
        return count <= small || depth >= options_.max_depth || (count >= kTaskGrain && cancelled_.poll());
    }

    /// Nothing on the left: make a leaf.
    Halves split(std::span<BuildPrimitive> range, const RangeBounds& bounds, uint32_t depth) {
        if (options_.builder == BvhBuilder::median) return split_median(range, bounds);
        // A balanced tree only just fits below: no more room for lopsided splits.
        const size_t small = options_.blocks ? kBlock : 1;
        const auto levels = static_cast<uint32_t>(std::bit_width((range.size() - 1) / small));
        if (depth + levels >= options_.max_depth) return split_median(range, bounds);
        const std::optional<SahSplit> best = find_sah_split(range, bounds, leaf_cost_);
        if (range.size() <= kMaxSahLeaf && (!best || leaf_cost_(range.size()) <= 1 + best->cost)) return {};
        return best ? apply_sah_split(range, bounds, *best) : split_median(range, bounds);
    }

    std::span<BuildPrimitive> primitives_;
    const BvhOptions& options_;
    Cancellation& cancelled_;
    LeafCost leaf_cost_;
    BinaryPool pool_;
};

}  // namespace

Bvh build_bvh(std::span<BuildPrimitive> primitives, const BvhOptions& options, Cancellation& cancelled) {
    Bvh out;
    if (primitives.empty()) return out;
    BinaryBuilder builder(primitives, options, cancelled);
    BinaryNode& root = builder.run();
    if (!cancelled.poll()) gather(root, primitives, options, out);
    return out;
}

}  // namespace steradian
