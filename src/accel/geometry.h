// From geometries to what hierarchies are built over, and from built hierarchies to what the leaves hold.
#pragma once

#include <span>
#include <vector>

#include "accel/bvh.h"
#include "accel/world.h"

namespace steradian {

/// A hierarchy with what its leaves hold.
struct Level {
    LargeArray<WideNode> nodes;
    LargeArray<TriangleBlock> blocks;
    std::vector<LeafEntry> entries;
    Box bounds;
    uint64_t leaves = 0;
    uint32_t depth = 0;

    LevelView view() const;
};

/// A geometry whose primitives' ids begin at `first`, of an instance or of none.
struct LevelPart {
    uint32_t first, instance, geometry;
};

size_t primitive_count(const Geometry& geometry);
/// Appends the box of every primitive, with ids from `first_id` on; or says what is wrong with it (bad_input).
Status append_primitives(const Geometry& geometry, size_t geometry_index, uint32_t first_id,
                         LargeArray<BuildPrimitive>& out);

/// `parts` are ascending and say whose the ids of blocks and shapes are; those of instances count from
/// `first_instance`. Unfinished when cancelled. Reorders the primitives.
Level build_level(std::span<BuildPrimitive> primitives, std::span<const Geometry> geometries,
                  std::span<const LevelPart> parts, uint32_t first_instance, const BvhOptions& options,
                  Cancellation& cancelled);

ShapesView shapes_of(const Geometry& geometry);

}  // namespace steradian
