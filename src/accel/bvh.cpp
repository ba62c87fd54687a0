#include "accel/bvh.h"

#include <algorithm>
#include <bit>

#include "accel/binary_tree.h"
#include "accel/build_fast.h"
#include "base/parallel.h"

namespace steradian {
namespace {

/// Ranges at least this large are divided by two workers, and ask about cancellation.
constexpr size_t kTaskGrain = 4096;
/// The heuristic makes no larger leaves, however little splitting promises: overlapping boxes do not stay alone.
constexpr size_t kMaxSahLeaf = 8;

class BinaryBuilder {
public:
    BinaryBuilder(std::span<BuildPrimitive> primitives, const BvhOptions& options, Cancellation& cancelled,
                  BinaryPool& pool)
        : primitives_(primitives), options_(options), cancelled_(cancelled), pool_(pool) {}

    void divide(BinaryNode& out, size_t begin, size_t end, const RangeBounds& bounds, uint32_t depth,
                BinaryPool::Source& source) {
        const std::span<BuildPrimitive> range = primitives_.subspan(begin, end - begin);
        out.box = bounds.box;
        out.begin = static_cast<uint32_t>(begin), out.end = static_cast<uint32_t>(end);
        out.depth = depth;
        const Halves halves = split(range, bounds, depth);
        if (halves.left == 0) {
            if (range.size() >= kTaskGrain) done(range.size());
            return;
        }
        depth += halves.by_kind ? 0 : 1;
        const size_t middle = begin + halves.left;
        for (BinaryNode*& child : out.child) child = source.next();
        if (range.size() >= kTaskGrain) {
            parallel_invoke(
                [&] {
                    divide(*out.child[0], begin, middle, halves.bounds[0], depth, source);
                    if (middle - begin < kTaskGrain) done(middle - begin);
                },
                [&] {
                    BinaryPool::Source own(pool_);
                    divide(*out.child[1], middle, end, halves.bounds[1], depth, own);
                    if (end - middle < kTaskGrain) done(end - middle);
                });
        } else {
            divide(*out.child[0], begin, middle, halves.bounds[0], depth, source);
            divide(*out.child[1], middle, end, halves.bounds[1], depth, source);
        }
    }

    /// With ranges of which none was large enough to say so itself.
    void done(size_t primitives) { cancelled_.advance(primitives * options_.work); }

private:
    /// Nothing on the left: make a leaf.
    Halves split(std::span<BuildPrimitive> range, const RangeBounds& bounds, uint32_t depth) {
        const bool last = depth >= options_.max_depth || (range.size() >= kTaskGrain && cancelled_.poll());
        const bool few = range.size() <= kMaxSahLeaf;
        ItemKind kind = options_.mostly;
        if (last || few) {
            const std::optional<ItemKind> only = only_kind(range);
            if (!only) return split_by_kind(range);
            kind = *only;
        }
        const size_t small = kind == ItemKind::block ? kBlock : 1;
        if (last || range.size() <= small) return {};
        if (options_.builder == BvhBuilder::median) return split_median(range, bounds);
        // A balanced tree only just fits below: no more room for lopsided splits.
        const auto levels = static_cast<uint32_t>(std::bit_width((range.size() - 1) / small));
        if (depth + levels >= options_.max_depth) return split_median(range, bounds);
        const std::optional<SahSplit> best = find_sah_split(range, bounds, kind);
        if (few && (!best || leaf_cost(kind, range.size()) <= 1 + best->cost)) return {};
        return best ? apply_sah_split(range, bounds, *best) : split_median(range, bounds);
    }

    std::span<BuildPrimitive> primitives_;
    const BvhOptions& options_;
    Cancellation& cancelled_;
    BinaryPool& pool_;
};

}  // namespace

void divide(std::span<BuildPrimitive> primitives, const Subtree& subtree, const BvhOptions& options,
            Cancellation& cancelled, BinaryPool& pool, BinaryPool::Source& source, BinaryNode& out) {
    const auto [begin, end, depth] = subtree;
    BinaryBuilder builder(primitives, options, cancelled, pool);
    builder.divide(out, begin, end, range_bounds(primitives.subspan(begin, end - begin)), depth, source);
    if (end - begin < kTaskGrain) builder.done(end - begin);
}

Bvh build_bvh(std::span<BuildPrimitive> primitives, const BvhOptions& options, Cancellation& cancelled) {
    Bvh out;
    if (primitives.empty()) return out;
    BinaryPool pool;
    BinaryNode* root = nullptr;
    if (options.builder == BvhBuilder::fast) root = build_fast(primitives, options, pool, cancelled);
    if (!root) {
        BinaryPool::Source source(pool);
        root = source.next();
        divide(primitives, {0, primitives.size(), 0}, options, cancelled, pool, source, *root);
    }
    if (!cancelled.poll()) gather(*root, primitives, cancelled, out);
    return out;
}

}  // namespace steradian
