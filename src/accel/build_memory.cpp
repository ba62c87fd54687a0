#include "accel/build_memory.h"

#include <algorithm>
#include <bit>

#include "accel/binary_tree.h"
#include "accel/build_fast.h"
#include "accel/geometry.h"
#include "accel/open.h"
#include "accel/reinsert.h"
#include "accel/split_spatial.h"
#include "accel/tree_bytes.h"
#include "accel/world.h"

namespace steradian {
namespace {

/// What does not grow with the scene: histograms of sorting, bins, first chunks, and what tasks hold.
constexpr uint64_t kFixed = 128 << 10;
/// An array that grows by doubling: the old one is still there when the new one is.
constexpr uint64_t kGrowing = 3;

struct LevelCounts {
    uint64_t triangles = 0, others = 0;
    bool split_boxes = false;
    double positions = 0;  ///< about how many different ones the vertices of the triangles have
};

/// The most that is possible with most_tree_bytes(). At least a block for four triangles is not for nodes, and where
/// leaves are fuller than they must be, that goes into nodes: compact blocks take most where each has three triangles.
struct TreeBytes {
    uint64_t wide, wide_and_ids;  ///< nodes in the full layout, and the ids of what is in leaves
    uint64_t compact_blocks, compact;

    TreeBytes(uint64_t triangles, uint64_t others) {
        constexpr uint64_t kFull = sizeof(TriangleBlock) / kBlock;
        wide =
            (kMostTriangleBytes - kFull) * triangles + (kMostOtherBytes - sizeof(LeafEntry)) * others + kMostRootBytes;
        wide_and_ids = wide + sizeof(uint32_t) * (triangles + others);
        compact_blocks = 56 * triangles + kPaddingUnits * sizeof(uint64_t);
        compact = kMostTriangleBytes * triangles + (kMostOtherBytes + sizeof(LeafEntry)) / 2 * others + kMostRootBytes;
    }
};

/// Of one level, without kFixed.
BuildMemory most_of_level(const LevelCounts& counts, const AccelOptions& options) {
    const uint64_t n = counts.triangles + counts.others;
    if (n == 0) return {};
    const bool high_quality = options.builder == BvhBuilder::high_quality, fast = options.builder == BvhBuilder::fast;
    const bool compact = options.layout == BvhLayout::compact;
    // Only triangles are cut.
    const uint64_t added = high_quality && counts.split_boxes && counts.triangles ? n / kPrimitivesPerCut : 0;
    const uint64_t m = n + added, triangles = counts.triangles + added;
    const TreeBytes tree(triangles, counts.others);

    // In the worst case there is a leaf for every primitive; and then what is divided anew.
    const uint64_t sources = 2 + m / kOwnSourceGrain + (fast ? 2 + most_treelets(n) / 64 : 0);
    const uint64_t slots =
        std::min<uint64_t>(2 * m + m / 2 + sources * BinaryPool::kRun + BinaryPool::kChunk, BinaryPool::most_nodes(m));
    const uint64_t pool = slots * sizeof(BinaryNode) +
                          (1 + BinaryPool::most_nodes(m) / BinaryPool::kChunk) * 2 * sizeof(LargeArray<BinaryNode>);
    // What is added is held by whoever divides, and then by the leaf, with all else that this leaf has.
    const uint64_t boxes = (n + (added ? added + m : 0)) * sizeof(BuildPrimitive);
    uint64_t dividing = boxes + pool + n / 2;  // and bins
    // Digits of sorting, and treelets, where these begin, and the leaves over them.
    if (fast)
        dividing += n + most_treelets(n) * (sizeof(BuildPrimitive) + kGrowing * (sizeof(uint32_t) + sizeof(uint64_t)));
    if (high_quality) dividing += slots * kReinsertionBytes;
    // In the order of the leaves, where it is another one.
    const uint64_t sorted = fast || high_quality ? m * sizeof(BuildPrimitive) : 0;
    const uint64_t choosing = boxes + pool + m * sizeof(uint32_t) + std::max(slots * sizeof(uint32_t), sorted);
    // Where leaves may be large, boxes are needed to the end.
    const bool keeps_boxes = counts.others > 0 || high_quality || options.max_depth <= uint32_t(std::bit_width(m / 4));
    const uint64_t gathering = choosing + tree.wide_and_ids - (keeps_boxes ? 0 : boxes);
    const uint64_t entries = counts.others * sizeof(LeafEntry), full = most_tree_bytes(triangles, counts.others);
    BuildMemory out;
    out.result = compact ? tree.compact : full;
    const uint64_t packing = compact ? tree.wide_and_ids + tree.wide / 2 + entries + kGrowing * tree.compact_blocks
                                     : full + 6 * triangles + counts.others * sizeof(uint32_t);
    out.peak = std::max({dividing, choosing, gathering, packing});
    return out;
}

/// As measured, for meshes that are closed or nearly so, and for triangles and shapes that are scattered.
BuildMemory expected_of_level(const LevelCounts& counts, const AccelOptions& options) {
    const auto t = static_cast<double>(counts.triangles), o = static_cast<double>(counts.others);
    double result = 0, beside = 0;
    if (options.layout == BvhLayout::compact) {
        // Between closed meshes with half a vertex a triangle, and scattered triangles.
        const double vertices = t > 0 ? std::clamp(counts.positions / t, 0.5, 3.0) : 0.5;
        const double blocks = (22 + 7.5 * (vertices - 0.5)) * t;
        result = blocks + 6 * t + 62 * o, beside = blocks + 78 * o;
    } else {
        const double triangle = options.builder == BvhBuilder::median         ? 51
                                : options.builder == BvhBuilder::high_quality ? 57
                                                                              : 55;
        result = triangle * t + 92 * o, beside = 4 * t + 48 * o;
    }
    return {static_cast<uint64_t>(result), static_cast<uint64_t>(result + beside)};
}

/// About how many different ones there are: by the least of their hashes, which are as dense as there are many
/// (Bar-Yossef et al. 2002, "Counting Distinct Elements in a Data Stream").
double different(std::span<const Vec3> positions) {
    constexpr size_t kKept = 1024;
    std::vector<uint64_t> least;  ///< a heap, the largest first
    least.reserve(kKept);
    for (const Vec3& p : positions) {
        uint64_t hash = 1;
        for (int axis = 0; axis < 3; ++axis) {
            hash = (hash ^ std::bit_cast<uint32_t>(p[axis])) * 0x9e3779b97f4a7c15;
            hash ^= hash >> 32;
        }
        hash *= 0xd6e8feb86659fd93;
        if (least.size() == kKept && hash >= least.front()) continue;
        if (std::find(least.begin(), least.end(), hash) != least.end()) continue;
        if (least.size() == kKept) std::pop_heap(least.begin(), least.end()), least.pop_back();
        least.push_back(hash), std::push_heap(least.begin(), least.end());
    }
    if (least.size() < kKept) return static_cast<double>(least.size());
    return (kKept - 1) / (static_cast<double>(least.front()) / 0x1p64);
}

template <class MemoryOfLevel>
BuildMemory all_levels(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                       const AccelOptions& options, bool at_most, const MemoryOfLevel& memory_of_level) {
    const std::vector<bool> on_upper_level = upper_geometries(geometries, instances);
    const uint64_t growing = at_most ? kGrowing : 1;
    const uint64_t lists = geometries.size() * (sizeof(Level) + growing * (sizeof(LevelPart) + sizeof(LevelView) +
                                                                           sizeof(ShapesView) + sizeof(uint64_t) * 2)) +
                           instances.size() * (sizeof(PlacedGeometry) + growing * sizeof(TrianglePart));
    const uint64_t beside = at_most ? geometries.size() * kGrowing * 48 +
                                          instances.size() * (sizeof(std::optional<Vec3>) + sizeof(void*) +
                                                              kGrowing * (sizeof(LevelPart) + sizeof(double)))
                                    : 0;
    const uint64_t object = Accel::object_bytes();
    BuildMemory all{object + lists, object + lists + beside};
    const auto add = [&](const BuildMemory& level, uint64_t more) {
        all.peak = std::max(all.peak, all.result + beside + more + level.peak);
        all.result += level.result;
    };
    LevelCounts upper{0, 0, true, 0};
    for (size_t i = 0; i < geometries.size(); ++i) {
        LevelCounts counts;
        if (const auto* mesh = std::get_if<TriangleGeometry>(&geometries[i])) {
            counts.triangles = primitive_count(geometries[i]);
            if (!at_most && options.layout == BvhLayout::compact) counts.positions = different(mesh->positions);
        } else {
            counts.others = primitive_count(geometries[i]);
        }
        if (!on_upper_level[i]) {
            add(memory_of_level(counts, options), 0);
            continue;
        }
        upper.triangles += counts.triangles, upper.others += counts.others, upper.positions += counts.positions;
    }
    const ItemCounts counts = count_items(geometries, instances, on_upper_level, options);
    const uint64_t items = (counts.instances + counts.opened) * growing *
                           (sizeof(InstancePart) + (at_most ? sizeof(BuildPrimitive) : 0) +
                            (at_most || counts.opened ? sizeof(std::pair<double, uint32_t>) : 0));
    // What is to stand for the instances, whole and opened, and while that is compared both hierarchies of it.
    if (counts.opened) {
        BuildMemory far = memory_of_level({0, counts.instances}, options);
        const BuildMemory trial = memory_of_level({0, counts.opened}, options);
        const uint64_t boxes =
            counts.in_place > 0 ? (counts.in_place + counts.most_items()) * sizeof(BuildPrimitive) : 0;
        all.peak = std::max(all.peak, all.result + beside + far.result + items + boxes + trial.peak);
        if (!at_most) far.result = 0;
        add(far, 0);
    }
    upper.others += at_most ? counts.most_items() : counts.instances;
    add(memory_of_level(upper, options), items);
    // The costs of nodes that parts of instances lead to.
    if (counts.opened)
        all.peak = std::max(all.peak, all.result + (counts.elsewhere + geometries.size()) * sizeof(double));
    return all;
}

}  // namespace

BuildMemory build_memory(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                         const AccelOptions& options) {
    BuildMemory all = all_levels(geometries, instances, options, true, most_of_level);
    all.peak += kFixed;
    return all;
}

BuildMemory expected_build_memory(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                                  const AccelOptions& options) {
    return all_levels(geometries, instances, options, false, expected_of_level);
}

}  // namespace steradian
