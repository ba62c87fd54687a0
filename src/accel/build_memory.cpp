#include "accel/build_memory.h"

#include <algorithm>

#include "accel/binary_tree.h"
#include "accel/geometry.h"
#include "accel/open.h"
#include "accel/reinsert.h"
#include "accel/split_spatial.h"
#include "accel/world.h"

namespace steradian {
namespace {

/// What does not grow with the scene: histograms of sorting, bins, first chunks, and what tasks hold.
constexpr uint64_t kFixed = uint64_t(1) << 20;
/// An array that grows by doubling: the old one is still there when the new one is.
constexpr uint64_t kGrowing = 3;

struct LevelCounts {
    uint64_t triangles = 0, others = 0;
    bool split_boxes = false;
};

/// Of one level, without kFixed.
BuildMemory level_memory(const LevelCounts& counts, const AccelOptions& options) {
    const uint64_t n = counts.triangles + counts.others;
    if (n == 0) return {};
    const bool high_quality = options.builder == BvhBuilder::high_quality, fast = options.builder == BvhBuilder::fast;
    const bool compact = options.layout == BvhLayout::compact;
    // Only triangles are cut.
    const uint64_t added = high_quality && counts.split_boxes && counts.triangles ? n / kPrimitivesPerCut : 0;
    // In the worst case a leaf holds one primitive, and a node two leaves.
    const uint64_t m = n + added, triangles = counts.triangles + added;
    const uint64_t nodes = m + 1, binary_nodes = 2 * m;
    const uint64_t entries = counts.others * sizeof(LeafEntry);
    const uint64_t ids = triangles * kBlock * sizeof(uint32_t) + counts.others * sizeof(uint32_t);
    const uint64_t wide = nodes * sizeof(WideNode), compact_nodes = nodes * sizeof(CompactNode);
    const uint64_t compact_blocks = triangles * kMaxUnitsPerTriangle * sizeof(uint64_t);

    const uint64_t sources = 1 + m / kOwnSourceGrain + (fast ? 2 + n / 64 : 0);
    const uint64_t slots =
        std::min<uint64_t>(binary_nodes + sources * BinaryPool::kRun + BinaryPool::kChunk, BinaryPool::most_nodes(m));
    const uint64_t pool = slots * sizeof(BinaryNode) +
                          (1 + BinaryPool::most_nodes(m) / BinaryPool::kChunk) * 2 * sizeof(LargeArray<BinaryNode>);
    // What is added is held by whoever divides, and then by the leaf, with all else that this leaf has.
    const uint64_t boxes = (n + (added ? added + m : 0)) * sizeof(BuildPrimitive);
    uint64_t dividing = boxes + pool + n / 2;  // and bins
    // Sorted along the curve: digits, and treelets, where these begin, and the leaves over them.
    if (fast) dividing += n * (1 + sizeof(BuildPrimitive) + kGrowing * (sizeof(uint32_t) + sizeof(uint64_t)));
    if (high_quality) dividing += slots * kReinsertionBytes;
    BuildMemory out;
    out.result = (compact ? compact_nodes + compact_blocks + kPaddingUnits * sizeof(uint64_t)
                          : wide + triangles * sizeof(TriangleBlock)) +
                 entries;
    const uint64_t gathering = boxes + m * sizeof(uint32_t) + pool + slots * sizeof(uint32_t) + wide + ids;
    const uint64_t packing = wide + ids + entries +
                             (compact ? compact_nodes + kGrowing * compact_blocks : triangles * sizeof(TriangleBlock));
    out.peak = std::max({dividing, gathering, packing});
    return out;
}

}  // namespace

BuildMemory build_memory(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                         const AccelOptions& options) {
    const std::vector<bool> on_upper_level = upper_geometries(geometries, instances);
    const uint64_t lists =
        geometries.size() *
            (sizeof(Level) + kGrowing * (sizeof(LevelPart) + sizeof(LevelView) + sizeof(ShapesView) + 64)) +
        instances.size() * (sizeof(PlacedGeometry) + sizeof(std::optional<Vec3>) + sizeof(void*) +
                            kGrowing * (sizeof(LevelPart) + sizeof(TrianglePart) + sizeof(double)));
    BuildMemory all{kFixed + lists, kFixed + lists};
    const auto add = [&](const LevelCounts& counts) {
        const BuildMemory level = level_memory(counts, options);
        all.peak = std::max(all.peak, all.result + level.peak);
        all.result += level.result;
    };
    LevelCounts upper{0, 0, true};
    for (size_t i = 0; i < geometries.size(); ++i) {
        const bool mesh = std::holds_alternative<TriangleGeometry>(geometries[i]);
        LevelCounts counts;
        (mesh ? counts.triangles : counts.others) = primitive_count(geometries[i]);
        if (!on_upper_level[i])
            add(counts);
        else
            upper.triangles += counts.triangles, upper.others += counts.others;
    }
    const ItemCounts counts = count_items(geometries, instances, on_upper_level, options);
    upper.others += counts.most_items();
    // What is to stand for the instances, whole and opened, and while that is compared both hierarchies of it.
    const BuildMemory far = level_memory({0, counts.opened ? counts.instances : 0}, options);
    const BuildMemory trial = level_memory({0, counts.opened}, options);
    const uint64_t items = (counts.instances + counts.opened) * kGrowing *
                           (sizeof(InstancePart) + sizeof(BuildPrimitive) + sizeof(std::pair<double, uint32_t>));
    const uint64_t boxes = (upper.triangles + upper.others) * sizeof(BuildPrimitive);
    all.result += far.result;
    all.peak = std::max(all.peak, all.result + items + boxes + trial.peak);
    const BuildMemory level = level_memory(upper, options);
    all.peak = std::max(all.peak, all.result + items + level.peak);
    all.result += level.result;
    // The costs of nodes that parts of instances lead to.
    if (counts.opened)
        all.peak = std::max(all.peak, all.result + (counts.elsewhere + geometries.size()) * sizeof(double));
    return all;
}

}  // namespace steradian
