#include "accel/bvh.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "accel/binary_tree.h"
#include "accel/build_fast.h"
#include "accel/compact.h"
#include "accel/reinsert.h"
#include "accel/split_spatial.h"
#include "base/parallel.h"

namespace steradian {
namespace {

/// Ranges at least this large are divided by two workers, and ask about cancellation.
constexpr size_t kTaskGrain = 4096;
/// The heuristic makes no larger leaves, however little splitting promises: overlapping boxes do not stay alone.
constexpr size_t kMaxSahLeaf = 8;
/// Boxes are split where they overlap by more than this share of the surface of all (as in Stich et al. 2009).
constexpr float kLeastOverlap = 1e-5f;

class BinaryBuilder {
public:
    BinaryBuilder(std::span<BuildPrimitive> primitives, const BvhOptions& options, BuildMonitor& monitor,
                  BinaryPool& pool)
        : primitives_(primitives), options_(options), monitor_(monitor), pool_(pool) {}

    /// Primitives [begin, end); up to room_end there is room for what splits in space add.
    void run(BinaryNode& out, size_t begin, size_t end, size_t room_end, uint32_t depth, BinaryPool::Source& source) {
        whole_ = range_bounds(primitives_.subspan(begin, end - begin));
        divide(out, begin, end, room_end, whole_, depth, source);
        if (end - begin < kTaskGrain) done(end - begin);
    }
    /// What has been reported, of options.work for every primitive.
    uint64_t reported() const { return reported_; }

private:
    void divide(BinaryNode& out, size_t begin, size_t end, size_t room_end, const RangeBounds& bounds, uint32_t depth,
                BinaryPool::Source& source) {
        const std::span<BuildPrimitive> range = primitives_.subspan(begin, end - begin);
        out.begin = static_cast<uint32_t>(begin), out.end = static_cast<uint32_t>(end);
        out.set_box(bounds.box);
        out.depth = depth;
        const Halves halves = split(range, primitives_.subspan(begin, room_end - begin), bounds, depth);
        if (halves.left == 0) {
            if (range.size() >= kTaskGrain) done(range.size());
            return;
        }
        depth += halves.by_kind ? 0 : 1;
        const size_t middle = begin + halves.left, last = end + halves.added;
        // Each side gets room by its size.
        const auto gap = static_cast<size_t>(uint64_t(room_end - last) * halves.left / (last - begin));
        move_up(middle, last, gap);
        const size_t right = middle + gap, right_end = last + gap;
        for (BinaryNode*& child : out.child) child = source.next();
        const bool large = range.size() >= kTaskGrain;
        const auto divide_left = [&] {
            divide(*out.child[0], begin, middle, right, halves.bounds[0], depth, source);
            if (large && middle - begin < kTaskGrain) done(middle - begin);
        };
        const auto divide_right = [&](BinaryPool::Source& from) {
            divide(*out.child[1], right, right_end, room_end, halves.bounds[1], depth, from);
            if (large && right_end - right < kTaskGrain) done(right_end - right);
        };
        if (large && std::min(middle - begin, right_end - right) >= kOwnSourceGrain) {
            parallel_invoke(divide_left, [&] {
                BinaryPool::Source own(pool_);
                divide_right(own);
            });
        } else {
            divide_left(), divide_right(source);
        }
    }

    /// With ranges of which none was large enough to say so itself.
    void done(size_t primitives) {
        monitor_.advance(primitives * options_.work);
        reported_.fetch_add(primitives * options_.work, std::memory_order_relaxed);
    }

    /// The order does not matter, so what has to move is no more than the gap.
    void move_up(size_t begin, size_t end, size_t gap) {
        const size_t moved = std::min(gap, end - begin);
        std::copy_n(primitives_.begin() + ptrdiff_t(begin), moved, primitives_.begin() + ptrdiff_t(end + gap - moved));
    }

    /// `range` is what there is in `room`. Nothing on the left: make a leaf.
    Halves split(std::span<BuildPrimitive> range, std::span<BuildPrimitive> room, const RangeBounds& bounds,
                 uint32_t depth) {
        const bool last = depth >= options_.max_depth || (range.size() >= kTaskGrain && monitor_.poll());
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
        const Halves halves = best ? apply_sah_split(range, bounds, *best) : split_median(range, bounds);
        const size_t added = room.size() - range.size();
        const float area = Area(whole_)(bounds.box);
        if (added == 0 || overlap(halves, bounds) * area <= kLeastOverlap * Area(whole_)(whole_.box)) return halves;
        const std::optional<SpatialSplit> cut = find_spatial_split(range, bounds, kind, added);
        return cut && (!best || cut->cost < best->cost) ? apply_spatial_split(room, range.size(), *cut) : halves;
    }

    std::span<BuildPrimitive> primitives_;
    const BvhOptions& options_;
    BuildMonitor& monitor_;
    BinaryPool& pool_;
    RangeBounds whole_;
    std::atomic<uint64_t> reported_{0};
};

void build_high_quality(LargeArray<BuildPrimitive>& primitives, const BvhOptions& options, BuildMonitor& monitor,
                        BinaryPool& pool, Bvh& out) {
    const size_t count = primitives.size(), most = max_items(options.layout);
    primitives.resize(count + (options.split_boxes ? std::min(count / kPrimitivesPerCut, most - count) : 0));
    // Reinsertion takes about two thirds of the time.
    BvhOptions dividing = options;
    dividing.work = options.work / 3;
    BinaryBuilder builder(primitives, dividing, monitor, pool);
    BinaryPool::Source source(pool);
    BinaryNode& root = *source.next();
    builder.run(root, 0, count, primitives.size(), 0, source);
    if (monitor.poll()) return;
    const uint64_t all = count * options.work;
    reinsert(root, primitives, options.max_depth, monitor, all - std::min(all, builder.reported()));
    if (!monitor.poll()) gather(root, primitives, monitor, out);
}

}  // namespace

void divide(std::span<BuildPrimitive> primitives, const Subtree& subtree, const BvhOptions& options,
            BuildMonitor& monitor, BinaryPool& pool, BinaryPool::Source& source, BinaryNode& out) {
    BinaryBuilder builder(primitives, options, monitor, pool);
    builder.run(out, subtree.begin, subtree.end, subtree.end, subtree.depth, source);
}

Bvh build_bvh(LargeArray<BuildPrimitive>& primitives, const BvhOptions& options, BuildMonitor& monitor) {
    Bvh out;
    if (primitives.empty()) return out;
    BinaryPool pool;
    if (options.builder == BvhBuilder::high_quality) {
        build_high_quality(primitives, options, monitor, pool, out);
        return out;
    }
    BinaryNode* root = nullptr;
    if (options.builder == BvhBuilder::fast) root = build_fast(primitives, options, pool, monitor);
    if (!root) {
        BinaryPool::Source source(pool);
        root = source.next();
        divide(primitives, {0, primitives.size(), 0}, options, monitor, pool, source, *root);
    }
    if (!monitor.poll()) gather(*root, primitives, monitor, out);
    return out;
}

}  // namespace steradian
