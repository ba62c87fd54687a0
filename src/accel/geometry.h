// One geometry as the kernels see it: its hierarchy and what its leaves hold.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "accel/accel.h"
#include "accel/bvh.h"
#include "accel/world.h"

namespace steradian {

struct BuiltGeometry {
    Bvh bvh;
    /// Triangles are packed in the order of the leaves (bvh.order is dropped then); the others are read through
    /// bvh.order.
    std::variant<LargeArray<TriangleBlock>, std::span<const SphereGeometry>, std::span<const RectangleGeometry>,
                 std::span<const DiskGeometry>>
        primitives;
    uint64_t count = 0;
};

/// The box of every primitive of a geometry, or what is wrong with it (bad_input, resources).
Result<std::vector<BuildPrimitive>> primitive_bounds(const Geometry& geometry, size_t geometry_index);

/// `primitives` come from primitive_bounds and are reordered. Unfinished when cancelled.
BuiltGeometry build_geometry(const Geometry& geometry, std::span<BuildPrimitive> primitives,
                             const AccelOptions& options, Cancellation& cancelled);

GeometryView view_of(const BuiltGeometry& geometry);

}  // namespace steradian
