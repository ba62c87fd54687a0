// From geometries to what hierarchies are built over, and from built hierarchies to what the leaves hold.
#pragma once

#include <span>
#include <vector>

#include "accel/bvh.h"
#include "accel/compact.h"
#include "accel/triangle_block.h"
#include "accel/world.h"

namespace steradian {

/// A hierarchy with what its leaves hold.
struct Level {
    LargeArray<WideNode> nodes;
    LargeArray<TriangleBlock> blocks;
    CompactLevel compact;  ///< instead of nodes and blocks
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

/// Geometries that are on the upper level: in one place only, and not transformed. (In several places they would be
/// copied.)
std::vector<bool> upper_geometries(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances);
size_t primitive_count(const Geometry& geometry);
/// Appends the box of every primitive, with ids from `first_id` on; or says what is wrong with it (bad_input).
Status append_primitives(const Geometry& geometry, size_t geometry_index, uint32_t first_id,
                         LargeArray<BuildPrimitive>& out);
/// The bounds of all primitives, when they are what append_primitives would take.
Result<Box> checked_bounds(const Geometry& geometry, size_t geometry_index);
/// Of one shape; nothing for triangles.
Box shape_bounds(const Geometry& geometry, uint32_t prim);
/// Fills in the vertices of blocks whose prims are set.
void place_vertices(std::span<TriangleBlock> blocks, std::span<const Geometry> geometries,
                    std::span<const LevelPart> parts);

/// `parts` are ascending and say whose the ids of blocks and shapes are; those of instances count from
/// `first_instance`. Unfinished when cancelled. Takes the primitives.
Level build_level(LargeArray<BuildPrimitive> primitives, std::span<const Geometry> geometries,
                  std::span<const LevelPart> parts, uint32_t first_instance, const BvhOptions& options,
                  BuildMonitor& monitor);

/// The part of a refit that may fail, and changes nothing: in the compact layout, where vertices that move take another
/// number of bytes, blocks for the same parts with other vertices, over the nodes of before. Empty in the full layout.
CompactLevel repack_level(const Level& level, std::span<const Geometry> geometries, std::span<const LevelPart> parts);
/// What build_level made, for the same parts with other vertices, shapes and places of instances, once they are
/// repacked: boxes and orders are computed anew, from the leaves up, by all workers of the caller's arena.
void refit_level(Level& level, CompactLevel repacked, std::span<const Geometry> geometries,
                 std::span<const LevelPart> parts, std::span<const PlacedGeometry> instances);

/// The visits of nodes and tests of blocks, shapes and instances that a ray is expected to need which meets the bounds,
/// with the costs of the hierarchies that the instances of the upper level lead to.
double expected_cost(const Level& level, std::span<const double> instance_costs);

/// The rest of build_level, in the full layout: what the leaves of a hierarchy hold. An id may be in several of them.
Level fill_level(Bvh bvh, std::span<const Geometry> geometries, std::span<const LevelPart> parts,
                 uint32_t first_instance);

ShapesView shapes_of(const Geometry& geometry);

}  // namespace steradian
