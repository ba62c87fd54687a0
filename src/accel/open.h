// Opening instances on the upper level: where instances lie within each other, nodes of their hierarchies take the
// places of whole instances, so that rays come to what is near first and are done before they enter all the others
// (Benthin et al. 2017, "Improved Two-Level BVHs using Partial Re-Braiding").
//
// Hits do not depend on it: see margin.h.
#pragma once

#include <span>
#include <vector>

#include "accel/geometry.h"
#include "accel/kernels/kernels.h"
#include "accel/margin.h"

namespace steradian {

/// What hierarchies are built over, known from numbers alone.
struct ItemCounts {
    uint64_t in_place = 0;   ///< primitives on the upper level
    uint64_t elsewhere = 0;  ///< primitives of hierarchies that instances lead to
    uint64_t instances = 0;  ///< on the upper level
    uint64_t opened = 0;     ///< items that stand for the instances when these are opened, at most; 0: they cannot be

    uint64_t most_items() const { return max_of(instances, opened); }
};
ItemCounts count_items(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances,
                       const std::vector<bool>& on_upper_level, const AccelOptions& options);

/// What stands for instances on the upper level.
using InstanceParts = std::vector<InstancePart>;
InstanceParts whole_instances(const Placement& placement);
/// Replaces the largest parts by the children of their nodes, for as long as there are no more than `limit`.
InstanceParts open_instances(const InstanceParts& whole, const Placement& placement, std::span<const Level> levels,
                             uint64_t limit);
/// Appends their boxes, with ids from `first_id` on.
void append_boxes(const InstanceParts& parts, const Placement& placement, std::span<const Level> levels,
                  uint32_t first_id, LargeArray<BuildPrimitive>& out);

/// What rays through a box cost on average, in visits of nodes, by tracing some.
double sampled_cost(const World& world, const Kernels& kernels, const Box& box);
/// Opening pays when rays cost less than this share of what they did.
inline constexpr double kWorthOpening = 0.9;

}  // namespace steradian
