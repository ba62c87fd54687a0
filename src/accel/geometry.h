// From geometries to what hierarchies are built over, and from built hierarchies to what the leaves hold.
#pragma once

#include <functional>
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

/// An instance as an item of the upper level, or a part of one: see LeafEntry.
struct InstancePart {
    uint32_t instance, place;
};

/// Children of a node of a level in either layout.
uint32_t child_count(const Level& level, uint32_t node);
uint32_t child_of(const Level& level, uint32_t node, uint32_t child);
Box child_box(const Level& level, uint32_t node, uint32_t child);
/// Blocks, shapes or instances of a leaf of a level.
uint32_t item_count(const Level& level, uint32_t leaf);

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

/// What the ids of instances and parts of them mean, which count from `first`.
struct InstanceIds {
    uint32_t first = kNoHit;
    std::span<const InstancePart> parts;
};

/// `parts` are ascending and say whose the ids of blocks and shapes are. Empty when cancelled, as rays may look into
/// any level that there is. Takes the primitives.
Level build_level(LargeArray<BuildPrimitive> primitives, std::span<const Geometry> geometries,
                  std::span<const LevelPart> parts, const InstanceIds& instances, const BvhOptions& options,
                  BuildMonitor& monitor);

/// The part of a refit that may fail, and changes nothing: in the compact layout, where vertices that move take another
/// number of bytes, blocks for the same parts with other vertices, over the nodes of before. Empty in the full layout.
CompactLevel repack_level(const Level& level, std::span<const Geometry> geometries, std::span<const LevelPart> parts);
using BoxOfInstance = std::function<Box(const LeafEntry&)>;
/// What build_level made, for the same parts with other vertices, shapes and places of instances, once they are
/// repacked: boxes and orders are computed anew, from the leaves up, by all workers of the caller's arena.
void refit_level(Level& level, CompactLevel repacked, std::span<const Geometry> geometries,
                 std::span<const LevelPart> parts, std::span<const PlacedGeometry> instances,
                 const BoxOfInstance& instance_box);

/// The visits of nodes and tests of blocks, shapes and instances that a ray is expected to need which meets the bounds,
/// with the costs of what the instances of the upper level, or parts of them, lead to.
using CostOfInstance = std::function<double(const LeafEntry&)>;
double expected_cost(const Level& level, const CostOfInstance& instance_cost);
/// The same for a ray that meets the box of a node, for all nodes.
std::vector<double> costs_below(const Level& level);

/// The rest of build_level, in the full layout: what the leaves of a hierarchy hold. An id may be in several of them.
Level fill_level(Bvh bvh, std::span<const Geometry> geometries, std::span<const LevelPart> parts,
                 const InstanceIds& instances);

ShapesView shapes_of(const Geometry& geometry);

}  // namespace steradian
