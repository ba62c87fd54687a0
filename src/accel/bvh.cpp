#include "accel/bvh.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "accel/binary_tree.h"
#include "accel/build_fast.h"
#include "accel/compact.h"
#include "accel/merge_leaves.h"
#include "accel/reinsert.h"
#include "accel/split_spatial.h"
#include "base/parallel.h"

namespace steradian {
namespace {

/// Boxes are split where they overlap by more than this share of the surface of all (as in Stich et al. 2009).
constexpr float kLeastOverlap = 1e-5f;

bool same_centroid(const RangeBounds& bounds) {
    const Box box = bounds.centroids.box();
    return box.lo == box.hi;
}

/// Points of a line, say: the heuristic knows nothing of them, and no ray can tell.
bool no_surface(const RangeBounds& bounds) { return !(Area(bounds)(bounds.box) > 0); }

class BinaryBuilder {
public:
    using Added = std::vector<BuildPrimitive>;

    /// Where boxes are split, `moved` takes what LeafPrimitives::moved is.
    BinaryBuilder(std::span<BuildPrimitive> primitives, const BvhOptions& options, BuildMonitor& monitor,
                  BinaryPool& pool, std::deque<BuildPrimitive>* moved = nullptr)
        : primitives_(primitives), options_(options), monitor_(monitor), pool_(pool), moved_(moved) {}

    /// Primitives [begin, end), to which splits of boxes may add up to `room`.
    void run(uint32_t out, size_t begin, size_t end, size_t room, uint32_t depth, BinaryPool::Source& source) {
        whole_ = range_bounds(primitives_.subspan(begin, end - begin));
        Added added;
        divide(out, begin, end, added, room, whole_, depth, source);
        if (end - begin < kLargeRange) done(end - begin);
    }
    /// What has been reported, of options.work for every primitive.
    uint64_t reported() const { return reported_; }

private:
    /// Takes what was added.
    void divide(uint32_t out, size_t begin, size_t end, Added& added, size_t room, const RangeBounds& bounds,
                uint32_t depth, BinaryPool::Source& source) {
        const Range range{primitives_.subspan(begin, end - begin), added};
        const size_t size = range.size();
        const bool large = size >= kLargeRange;
        BinaryNode& node = pool_[out];
        node.set_box(bounds.box);
        Added cut;
        const Halves halves = split(range, room, bounds, depth, cut);
        if (halves.left() == 0) {
            make_leaf(node, begin, end, added);
            if (large) done(size);
            return;
        }
        depth += halves.by_kind ? 0 : 1;
        Added right_added = share(added, halves.added, std::move(cut));
        const size_t middle = begin + halves.own, on_left = halves.left(), on_right = end - middle + right_added.size();
        // Each side gets room by its size.
        room -= on_left + on_right - size;
        const auto left_room = static_cast<size_t>(uint64_t(room) * on_left / (on_left + on_right));
        const uint32_t left = source.next_two(), right = left + 1;
        node.set_children(left, right, large, !halves.by_kind);
        const auto divide_left = [&] {
            divide(left, begin, middle, added, left_room, halves.bounds[0], depth, source);
            if (large && on_left < kLargeRange) done(on_left);
        };
        const auto divide_right = [&](BinaryPool::Source& from) {
            divide(right, middle, end, right_added, room - left_room, halves.bounds[1], depth, from);
            if (large && on_right < kLargeRange) done(on_right);
        };
        if (large && std::min(on_left, on_right) >= kOwnSourceGrain) {
            parallel_invoke(divide_left, [&] {
                BinaryPool::Source own(pool_);
                divide_right(own);
            });
        } else {
            divide_left(), divide_right(source);
        }
    }

    /// Leaves the first `left` in `added`; the others, with what has been cut off, are for the right side.
    static Added share(Added& added, size_t left, Added cut) {
        cut.insert(cut.end(), added.begin() + ptrdiff_t(left), added.end());
        added.resize(left);
        for (Added* one : {&added, &cut})
            if (one->capacity() > 2 * one->size()) one->shrink_to_fit();
        return cut;
    }

    void make_leaf(BinaryNode& node, size_t begin, size_t end, Added& added) {
        const std::span<BuildPrimitive> own = primitives_.subspan(begin, end - begin);
        const ItemKind kind = Range{own, added}.front().kind;
        if (added.empty()) return node.set_leaf(begin, end, kind);
        const std::lock_guard lock(moved_mutex_);
        const size_t first = primitives_.size() + moved_->size();
        moved_->insert(moved_->end(), own.begin(), own.end());
        moved_->insert(moved_->end(), added.begin(), added.end());
        Added().swap(added);
        node.set_leaf(first, primitives_.size() + moved_->size(), kind);
    }

    /// With ranges of which none was large enough to say so itself.
    void done(size_t primitives) {
        monitor_.advance(primitives * options_.work);
        reported_.fetch_add(primitives * options_.work, std::memory_order_relaxed);
    }

    /// Nothing on the left: make a leaf. What splits of boxes add, up to `room`, goes to `cut`, for the right side.
    Halves split(const Range& range, size_t room, const RangeBounds& bounds, uint32_t depth, Added& cut) {
        const bool last = depth >= options_.max_depth || (range.size() >= kLargeRange && monitor_.poll());
        const bool few = range.size() <= options_.max_leaf;
        ItemKind kind = options_.mostly;
        if (last || few || options_.kinds_first) {
            const std::optional<ItemKind> only = only_kind(range);
            if (!only) return split_by_kind(range);
            kind = *only;
        }
        const size_t small = kind == ItemKind::block ? kBlock : 1;
        if (last || range.size() <= small || (few && (same_centroid(bounds) || no_surface(bounds)))) return {};
        if (options_.builder == BvhBuilder::median) return split_median(range, bounds);
        // A balanced tree only just fits below: no more room for lopsided splits.
        const auto levels = static_cast<uint32_t>(std::bit_width((range.size() - 1) / small));
        if (depth + levels >= options_.max_depth) return split_median(range, bounds);
        const std::optional<SahSplit> best = find_sah_split(range, bounds, kind);
        if (few && (!best || leaf_cost(kind, range.size()) <= 1 + best->cost)) return {};
        const Halves halves = best ? apply_sah_split(range, bounds, *best) : split_median(range, bounds);
        const float area = Area(whole_)(bounds.box);
        if (room == 0 || overlap(halves, bounds) * area <= kLeastOverlap * Area(whole_)(whole_.box)) return halves;
        const std::optional<SpatialSplit> spatial = find_spatial_split(range, bounds, kind, room);
        if (!spatial || (best && !(spatial->cost < best->cost))) return halves;
        cut.reserve(spatial->left + spatial->right - range.size() + range.added.size());
        return apply_spatial_split(range, *spatial, cut);
    }

    std::span<BuildPrimitive> primitives_;
    const BvhOptions& options_;
    BuildMonitor& monitor_;
    BinaryPool& pool_;
    RangeBounds whole_;
    std::deque<BuildPrimitive>* const moved_;
    std::mutex moved_mutex_;
    std::atomic<uint64_t> reported_{0};
};

void build_high_quality(LargeArray<BuildPrimitive>& primitives, const BvhOptions& options, BuildMonitor& monitor,
                        Bvh& out) {
    const size_t count = primitives.size(), most = max_items(options.layout);
    const size_t room = options.split_boxes ? std::min(count / kPrimitivesPerCut, most - count) : 0;
    BinaryPool pool(count + room);
    // Reinsertion takes about two thirds of the time.
    BvhOptions dividing = options;
    dividing.work = options.work / 3;
    LeafPrimitives leaves{primitives};
    BinaryBuilder builder(primitives, dividing, monitor, pool, &leaves.moved);
    BinaryPool::Source source(pool);
    uint32_t root = source.next_two();
    builder.run(root, 0, count, room, 0, source);
    if (monitor.poll()) return;
    if (options.layout == BvhLayout::compact) root = merge_alike_leaves(pool, root, leaves, kReinsertionTreeBytes, 0);
    const uint64_t all = count * options.work;
    reinsert(pool, root, options.max_depth, monitor, all - std::min(all, builder.reported()));
    if (!monitor.poll()) gather(pool, root, leaves, options, monitor, out);
}

}  // namespace

void divide(std::span<BuildPrimitive> primitives, const Subtree& subtree, const BvhOptions& options,
            BuildMonitor& monitor, BinaryPool& pool, BinaryPool::Source& source, uint32_t out) {
    BinaryBuilder builder(primitives, options, monitor, pool);
    builder.run(out, subtree.begin, subtree.end, 0, subtree.depth, source);
}

Bvh build_bvh(LargeArray<BuildPrimitive>& primitives, const BvhOptions& options, BuildMonitor& monitor) {
    Bvh out;
    if (primitives.empty()) return out;
    if (options.builder == BvhBuilder::high_quality) {
        build_high_quality(primitives, options, monitor, out);
        return out;
    }
    BinaryPool pool(primitives.size());
    std::optional<uint32_t> root;
    if (options.builder == BvhBuilder::fast) root = build_fast(primitives, options, pool, monitor);
    if (!root) {
        BinaryPool::Source source(pool);
        root = source.next_two();
        divide(primitives, {0, primitives.size(), 0}, options, monitor, pool, source, *root);
    }
    LeafPrimitives leaves{primitives};
    if (monitor.poll()) return out;
    if (options.layout == BvhLayout::compact) root = merge_alike_leaves(pool, *root, leaves, 0, sizeof(uint32_t));
    gather(pool, *root, leaves, options, monitor, out);
    return out;
}

}  // namespace steradian
