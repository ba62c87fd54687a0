// One geometry as the kernels see it: its hierarchy and what its leaves hold.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "accel/accel.h"
#include "accel/bvh.h"
#include "accel/triangle_block.h"

namespace steradian {

struct BuiltGeometry {
    Bvh bvh;
    /// Triangles are packed in the order of the leaves (bvh.order is dropped then); the others are read through
    /// bvh.order.
    std::variant<std::vector<TriangleBlock>, std::span<const SphereGeometry>, std::span<const RectangleGeometry>,
                 std::span<const DiskGeometry>>
        primitives;
    uint64_t count = 0;
};

/// The box of every primitive of a geometry, or what is wrong with it (bad_input, resources).
Result<std::vector<Box>> primitive_bounds(const Geometry& geometry, size_t geometry_index);

/// `boxes` come from primitive_bounds. Unfinished when cancelled.
BuiltGeometry build_geometry(const Geometry& geometry, std::span<const Box> boxes, const AccelOptions& options,
                             Cancellation& cancelled);

}  // namespace steradian
