#include "accel/open.h"

#include <algorithm>
#include <queue>

namespace steradian {
namespace {

/// Items per instance: below the least of them rays enter parts more often than they did wholes, above the most little
/// is gained.
constexpr uint64_t kLeastItems = 16, kMostItems = 128;
/// In all: an item for so many primitives, which keeps what it takes to try whether opening pays below what the
/// primitives take, or, what takes no more than ten megabytes, so many.
constexpr uint64_t kPrimitivesPerItem = 4, kSmallTotal = 65536;
/// A node that is opened is at least so many times as large as what its children's boxes are grown by.
constexpr float kLeastMargins = 64;
/// What entering an instance costs, in visits of nodes, as measured.
constexpr double kEnterCost = 8;
constexpr uint32_t kSampledRays = 512;

/// Where a part leads to: a node or a leaf of its instance's hierarchy.
uint32_t node_of(const InstancePart& part, const Level& level) {
    return part.place == kWholeInstance ? ChildRef::node(0) : child_of(level, part.place / kWidth, part.place % kWidth);
}

Box box_of(const InstancePart& part, const Placement& placement, const Level& level) {
    if (part.place == kWholeInstance) return placement.placed[part.instance].world;
    return placement.world_box(part.instance, child_box(level, part.place / kWidth, part.place % kWidth));
}

/// Opens one part after the other.
class Opener {
public:
    Opener(InstanceParts& parts, const Placement& placement, std::span<const Level> levels)
        : parts_(parts), placement_(placement), levels_(levels) {
        for (uint32_t id = 0; id < parts_.size(); ++id) offer(id);
    }
    void run(uint64_t limit) {
        while (!largest_.empty()) {
            const uint32_t id = ~largest_.top().second;
            const uint32_t children = child_count(level_of(id), node_of(parts_[id], level_of(id)));
            if (parts_.size() + children - 1 > limit) return;
            largest_.pop();
            open(id, children);
        }
    }

private:
    const Level& level_of(uint32_t id) const { return levels_[placement_.placed[parts_[id].instance].geometry]; }
    void offer(uint32_t id) {
        const InstancePart& part = parts_[id];
        const std::optional<Vec3>& margin = placement_.margins[part.instance];
        if (ChildRef::is_leaf(node_of(part, level_of(id))) || !margin) return;
        const Box box = box_of(part, placement_, level_of(id));
        if (max_component(box.hi - box.lo) >= kLeastMargins * max_component(*margin))
            largest_.emplace(box.half_area(), ~id);
    }
    void open(uint32_t id, uint32_t children) {
        const uint32_t instance = parts_[id].instance, node = node_of(parts_[id], level_of(id));
        for (uint32_t child = 0; child < children; ++child) {
            const uint32_t to = child == 0 ? id : static_cast<uint32_t>(parts_.size());
            if (child > 0) parts_.emplace_back();
            parts_[to] = {instance, part_place(node, child)};
            offer(to);
        }
    }

    InstanceParts& parts_;
    const Placement& placement_;
    std::span<const Level> levels_;
    std::priority_queue<std::pair<double, uint32_t>> largest_;  ///< half areas, and of equal ones the first id
};

/// Van der Corput's sequence in two bases and more: points that fill the unit cube evenly (Halton 1960).
float halton(uint32_t i, uint32_t base) {
    double x = 0, part = 1;
    for (; i; i /= base) part /= base, x += part * (i % base);
    return static_cast<float>(x);
}

}  // namespace

ItemCounts count_items(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                       const std::vector<bool>& on_upper_level, const AccelOptions& options) {
    ItemCounts counts;
    for (size_t i = 0; i < geometries.size(); ++i)
        (on_upper_level[i] ? counts.in_place : counts.elsewhere) += primitive_count(geometries[i]);
    for (const GeometryInstance& i : instances) counts.instances += !on_upper_level[i.geometry];
    const uint64_t n = counts.instances, room = max_items(options.layout) - counts.in_place;
    const uint64_t wanted = kMostItems * n,
                   allowed = std::min(max_of(counts.elsewhere / kPrimitivesPerItem, kSmallTotal), room);
    if (options.open == OpenInstances::always) counts.opened = std::min(wanted, room);
    if (options.open == OpenInstances::automatic && n > 1 && allowed >= kLeastItems * n)
        counts.opened = std::min(wanted, allowed);
    return counts;
}

InstanceParts whole_instances(const Placement& placement) {
    InstanceParts parts;
    for (uint32_t i = 0; i < placement.placed.size(); ++i)
        if (!placement.placed[i].world.empty()) parts.push_back({i, kWholeInstance});
    return parts;
}

InstanceParts open_instances(const InstanceParts& whole, const Placement& placement, std::span<const Level> levels,
                             uint64_t limit) {
    InstanceParts parts;
    parts.reserve(limit);
    parts = whole;
    Opener(parts, placement, levels).run(limit);
    return parts;
}

void append_boxes(const InstanceParts& parts, const Placement& placement, std::span<const Level> levels,
                  uint32_t first_id, LargeArray<BuildPrimitive>& out) {
    out.reserve(out.size() + parts.size());
    for (const InstancePart& part : parts)
        out.emplace_back(box_of(part, placement, levels[placement.placed[part.instance].geometry]), first_id++,
                         ItemKind::instance);
}

double sampled_cost(const World& world, const Kernels& kernels, const Box& box) {
    double sum = 0;
    for (uint32_t i = 1; i <= kSampledRays; ++i) {
        Ray ray;
        ray.tmin = 0, ray.tmax = kInfinity;
        const Vec3 from{halton(i, 2), halton(i, 3), halton(i, 5)}, to{halton(i, 7), halton(i, 11), halton(i, 13)};
        for (int axis = 0; axis < 3; ++axis) {
            const float size = box.hi[axis] - box.lo[axis];
            ray.o[axis] = box.lo[axis] + from[axis] * size, ray.d[axis] = (to[axis] - from[axis]) * size;
        }
        uint32_t instances = 0;
        const RayVisits visits = kernels.visits(world, ray, instances);
        sum += visits.nodes + visits.items + kEnterCost * instances;
    }
    return sum / kSampledRays;
}

}  // namespace steradian
