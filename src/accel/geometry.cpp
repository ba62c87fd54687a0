#include "accel/geometry.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>

#include "accel/children.h"
#include "accel/planar.h"
#include "accel/sphere.h"
#include "accel/triangle.h"
#include "base/parallel.h"

namespace steradian {
namespace {

constexpr size_t kGrain = 16384;

// A coordinate just below the bound may be rounded outwards over it.
bool within_bounds(const Box& box) {
    constexpr float kLimit = kMaxCoordinate * 1.000001f;
    return !box.empty() && box.lo.x >= -kLimit && box.lo.y >= -kLimit && box.lo.z >= -kLimit && box.hi.x <= kLimit &&
           box.hi.y <= kLimit && box.hi.z <= kLimit;
}

Error bad_geometry(size_t geometry, const std::string& what) {
    return {ErrorCode::bad_input, "geometry " + std::to_string(geometry) + ": " + what, {}, {}, {}};
}

/// Where the boxes of a geometry go.
struct Target {
    size_t geometry;
    uint32_t first_id;
    LargeArray<BuildPrimitive>* out;  ///< nullptr: only checked
    Box bounds;
};

/// Appends box_of(i) for all i and extends the bounds by them, or reports the first primitive for which that is
/// nothing.
template <class BoxOf>
Status append(Target& target, size_t count, ItemKind kind, const char* name, BoxOf box_of) {
    const size_t start = target.out ? target.out->size() : 0;
    if (target.out) target.out->resize(start + count);
    std::atomic<size_t> first_bad{count};
    std::mutex mutex;
    parallel_for(count, kGrain, [&](size_t begin, size_t end) {
        Box bounds;
        for (size_t i = begin; i < end; ++i) {
            Box box;
            if (box_of(i, box) && within_bounds(box)) {
                if (target.out) (*target.out)[start + i] = {box, target.first_id + static_cast<uint32_t>(i), kind};
                bounds.extend(box);
                continue;
            }
            size_t seen = first_bad;
            while (i < seen && !first_bad.compare_exchange_weak(seen, i)) {
            }
            return;
        }
        const std::lock_guard lock(mutex);
        target.bounds.extend(bounds);
    });
    if (first_bad < count)
        return bad_geometry(target.geometry,
                            std::string(name) + " " + std::to_string(first_bad) +
                                " has a size or coordinate that is not finite, negative where it must not be or "
                                "beyond 1e15");
    return Ok{};
}

// min_of and max_of may pass over a NaN, so a box alone does not show one.
bool all_finite(Vec3 a, Vec3 b, Vec3 c) { return is_finite(a) && is_finite(b) && is_finite(c); }

Status append(const TriangleGeometry& mesh, Target& target) {
    if (mesh.indices.size() % 3 != 0)
        return bad_geometry(target.geometry,
                            std::to_string(mesh.indices.size()) + " indices, expected a multiple of 3");
    for (size_t i = 0; i < mesh.indices.size(); ++i)
        if (mesh.indices[i] >= mesh.positions.size())
            return bad_geometry(target.geometry, "triangle " + std::to_string(i / 3) + " has vertex " +
                                                     std::to_string(mesh.indices[i]) + ", but there are " +
                                                     std::to_string(mesh.positions.size()));
    return append(target, mesh.indices.size() / 3, ItemKind::block, "triangle", [&](size_t i, Box& box) {
        const Vec3 a = mesh.positions[mesh.indices[3 * i]], b = mesh.positions[mesh.indices[3 * i + 1]],
                   c = mesh.positions[mesh.indices[3 * i + 2]];
        box = triangle_bounds(a, b, c);
        return all_finite(a, b, c);
    });
}

Status append(std::span<const SphereGeometry> spheres, Target& target) {
    return append(target, spheres.size(), ItemKind::shape, "sphere", [&](size_t i, Box& box) {
        const SphereGeometry& s = spheres[i];
        if (!is_finite(s.center) || !(s.radius >= 0) || !is_finite(s.radius)) return false;
        box = sphere_bounds(s);
        return true;
    });
}

Status append(std::span<const RectangleGeometry> rectangles, Target& target) {
    return append(target, rectangles.size(), ItemKind::shape, "rectangle", [&](size_t i, Box& box) {
        const RectangleGeometry& r = rectangles[i];
        if (!all_finite(r.center, r.half_u, r.half_v)) return false;
        box = rectangle_bounds(r);
        return true;
    });
}

Status append(std::span<const DiskGeometry> disks, Target& target) {
    return append(target, disks.size(), ItemKind::shape, "disk", [&](size_t i, Box& box) {
        const DiskGeometry& d = disks[i];
        if (!all_finite(d.center, d.axis_u, d.axis_v)) return false;
        box = disk_bounds(d);
        return true;
    });
}

/// The part to which an id belongs.
const LevelPart& part_of(std::span<const LevelPart> parts, uint32_t id) {
    return *(std::upper_bound(parts.begin(), parts.end(), id,
                              [](uint32_t i, const LevelPart& part) { return i < part.first; }) -
             1);
}

PackedTriangle triangle_of(std::span<const Geometry> geometries, std::span<const LevelPart> parts, uint32_t id) {
    const LevelPart& part = part_of(parts, id);
    const auto& mesh = std::get<TriangleGeometry>(geometries[part.geometry]);
    const uint32_t* corners = &mesh.indices[3 * size_t(id - part.first)];
    return {id, {mesh.positions[corners[0]], mesh.positions[corners[1]], mesh.positions[corners[2]]}};
}

/// Blocks of these ids, without their vertices.
LargeArray<TriangleBlock> blocks_of(std::span<const uint32_t> ids) {
    LargeArray<TriangleBlock> blocks(ids.size() / kBlock);
    parallel_for(blocks.size(), kGrain / kBlock, [&](size_t begin, size_t end) {
        for (size_t b = begin; b < end; ++b) std::copy_n(&ids[b * kBlock], kBlock, blocks[b].prim);
    });
    return blocks;
}

}  // namespace

uint32_t child_count(const Level& level, uint32_t node) {
    return level.compact.nodes.empty() ? child_count(level.nodes[node])
                                       : static_cast<uint32_t>(std::popcount(level.compact.nodes[node].present()));
}
uint32_t child_of(const Level& level, uint32_t node, uint32_t child) {
    return level.compact.nodes.empty() ? level.nodes[node].child[child] : level.compact.nodes[node].child[child];
}
Box child_box(const Level& level, uint32_t node, uint32_t child) {
    return level.compact.nodes.empty() ? child_box(level.nodes[node], child) : level.compact.nodes[node].box(child);
}

LevelView Level::view() const {
    const void* none = &kNoBlocks;
    const LeafEntry* const others = entries.empty() ? nullptr : entries.data();
    if (!compact.nodes.empty())
        return {compact.nodes.data(), compact.blocks.empty() ? none : compact.blocks.data(), others};
    if (nodes.empty()) return {};
    return {nodes.data(), blocks.empty() ? none : blocks.data(), others};
}

Box shape_bounds(const Geometry& geometry, uint32_t prim) {
    struct Bounds {
        uint32_t prim;
        Box operator()(const TriangleGeometry&) const { return {}; }
        Box operator()(std::span<const SphereGeometry> s) const { return sphere_bounds(s[prim]); }
        Box operator()(std::span<const RectangleGeometry> r) const { return rectangle_bounds(r[prim]); }
        Box operator()(std::span<const DiskGeometry> d) const { return disk_bounds(d[prim]); }
    };
    return std::visit(Bounds{prim}, geometry);
}

void place_vertices(std::span<TriangleBlock> blocks, std::span<const Geometry> geometries,
                    std::span<const LevelPart> parts) {
    parallel_for(blocks.size(), kGrain / kBlock, [&](size_t begin, size_t end) {
        for (TriangleBlock& block : blocks.subspan(begin, end - begin))
            for (size_t lane = 0; lane < kBlock; ++lane) {
                const uint32_t source = block.prim[lane] == kNoHit ? block.prim[0] : block.prim[lane];
                const PackedTriangle t = triangle_of(geometries, parts, source);
                for (size_t which = 0; which < 3; ++which)
                    for (int axis = 0; axis < 3; ++axis) block.vertex[which][axis][lane] = t.corner[which][axis];
            }
    });
}

std::vector<bool> upper_geometries(std::span<const Geometry> geometries, std::span<const GeometryInstance> instances) {
    std::vector<uint32_t> uses(geometries.size());
    std::vector<bool> upper(geometries.size());
    for (const GeometryInstance& i : instances) {
        upper[i.geometry] = uses[i.geometry]++ == 0 && is_identity(i.world_from_object);
    }
    return upper;
}

size_t primitive_count(const Geometry& geometry) {
    return std::visit(
        [](const auto& g) -> size_t {
            if constexpr (std::is_same_v<decltype(g), const TriangleGeometry&>)
                return g.indices.size() / 3;
            else
                return g.size();
        },
        geometry);
}

Status append_primitives(const Geometry& geometry, size_t geometry_index, uint32_t first_id,
                         LargeArray<BuildPrimitive>& out) {
    Target target{geometry_index, first_id, &out, {}};
    return std::visit([&](const auto& g) { return append(g, target); }, geometry);
}

Result<Box> checked_bounds(const Geometry& geometry, size_t geometry_index) {
    Target target{geometry_index, 0, nullptr, {}};
    if (Status status = std::visit([&](const auto& g) { return append(g, target); }, geometry); !status)
        return status.error();
    return target.bounds;
}

Level build_level(LargeArray<BuildPrimitive> primitives, std::span<const Geometry> geometries,
                  std::span<const LevelPart> parts, const InstanceIds& instances, const BvhOptions& options,
                  BuildMonitor& monitor) {
    const uint64_t work = primitives.size() * kPackWork;
    Bvh bvh = build_bvh(primitives, options, monitor);
    if (monitor.poll()) return {};
    CompactLevel compact;
    if (options.layout == BvhLayout::compact) {
        const auto triangle = [&](uint32_t id) { return triangle_of(geometries, parts, id); };
        compact = make_compact(bvh, triangle, monitor, work);
        if (monitor.poll()) return {};  // not the nodes of the other layout, which kernels would take for theirs
    }
    Level level = fill_level(std::move(bvh), geometries, parts, instances);
    level.compact = std::move(compact);
    if (options.layout == BvhLayout::full) monitor.advance(work);
    return level;
}

CompactLevel repack_level(const Level& level, std::span<const Geometry> geometries, std::span<const LevelPart> parts) {
    return repack(level.compact, [&](uint32_t id) { return triangle_of(geometries, parts, id); });
}

Level fill_level(Bvh bvh, std::span<const Geometry> geometries, std::span<const LevelPart> parts,
                 const InstanceIds& instances) {
    Level level;
    level.bounds = bvh.bounds, level.leaves = bvh.leaves, level.depth = bvh.depth;
    level.blocks = blocks_of(bvh.blocks);
    place_vertices(level.blocks, geometries, parts);
    level.entries.reserve(bvh.entries.size());
    for (const uint32_t id : bvh.entries) {
        if (id >= instances.first) {
            const InstancePart& part = instances.parts[id - instances.first];
            level.entries.push_back({part.instance, part.place, {}});
        } else {
            const LevelPart& part = part_of(parts, id);
            const uint32_t prim = id - part.first;
            level.entries.push_back({part.instance, prim, shape_bounds(geometries[part.geometry], prim)});
        }
    }
    level.nodes = std::move(bvh.nodes);
    return level;
}

ShapesView shapes_of(const Geometry& geometry) {
    ShapesView view;
    if (const auto* spheres = std::get_if<std::span<const SphereGeometry>>(&geometry)) view.spheres = spheres->data();
    if (const auto* rectangles = std::get_if<std::span<const RectangleGeometry>>(&geometry))
        view.rectangles = rectangles->data();
    if (const auto* disks = std::get_if<std::span<const DiskGeometry>>(&geometry)) view.disks = disks->data();
    return view;
}

}  // namespace steradian
