#include "accel/geometry.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <string>

#include "accel/planar.h"
#include "accel/sphere.h"
#include "accel/triangle.h"
#include "base/parallel.h"

namespace steradian {
namespace {

constexpr size_t kGrain = 16384;
constexpr size_t kMaxPrimitives = ChildRef::kMaxItems - 1;

// A coordinate just below the bound may be rounded outwards over it.
bool within_bounds(const Box& box) {
    constexpr float kLimit = kMaxCoordinate * 1.000001f;
    return !box.empty() && box.lo.x >= -kLimit && box.lo.y >= -kLimit && box.lo.z >= -kLimit && box.hi.x <= kLimit &&
           box.hi.y <= kLimit && box.hi.z <= kLimit;
}

Error bad_geometry(size_t geometry, const std::string& what) {
    return {ErrorCode::bad_input, "geometry " + std::to_string(geometry) + ": " + what, {}, {}, {}};
}

/// Fills boxes with box_of(i) and reports the first primitive for which that is nothing.
template <class BoxOf>
Result<std::vector<BuildPrimitive>> collect(size_t geometry, size_t count, const char* kind, BoxOf box_of) {
    if (count > kMaxPrimitives)
        return Error{ErrorCode::resources,
                     "geometry " + std::to_string(geometry) + " has " + std::to_string(count) +
                         " primitives, more than the limit of " + std::to_string(kMaxPrimitives),
                     {},
                     {},
                     {}};
    std::vector<BuildPrimitive> boxes(count);
    std::atomic<size_t> first_bad{count};
    parallel_for(count, kGrain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            Box box;
            if (box_of(i, box) && within_bounds(box)) {
                boxes[i] = {box, static_cast<uint32_t>(i)};
                continue;
            }
            size_t seen = first_bad;
            while (i < seen && !first_bad.compare_exchange_weak(seen, i)) {
            }
            return;
        }
    });
    if (first_bad < count)
        return bad_geometry(geometry,
                            std::string(kind) + " " + std::to_string(first_bad) +
                                " has a size or coordinate that is not finite, negative where it must not be or "
                                "beyond 1e15");
    return boxes;
}

// min_of and max_of may pass over a NaN, so a box alone does not show one.
bool all_finite(Vec3 a, Vec3 b, Vec3 c) { return is_finite(a) && is_finite(b) && is_finite(c); }

Result<std::vector<BuildPrimitive>> bounds_of(const TriangleGeometry& mesh, size_t geometry) {
    if (mesh.indices.size() % 3 != 0)
        return bad_geometry(geometry, std::to_string(mesh.indices.size()) + " indices, expected a multiple of 3");
    for (size_t i = 0; i < mesh.indices.size(); ++i)
        if (mesh.indices[i] >= mesh.positions.size())
            return bad_geometry(geometry, "triangle " + std::to_string(i / 3) + " has vertex " +
                                              std::to_string(mesh.indices[i]) + ", but there are " +
                                              std::to_string(mesh.positions.size()));
    return collect(geometry, mesh.indices.size() / 3, "triangle", [&](size_t i, Box& box) {
        const Vec3 a = mesh.positions[mesh.indices[3 * i]], b = mesh.positions[mesh.indices[3 * i + 1]],
                   c = mesh.positions[mesh.indices[3 * i + 2]];
        box = triangle_bounds(a, b, c);
        return all_finite(a, b, c);
    });
}

Result<std::vector<BuildPrimitive>> bounds_of(std::span<const SphereGeometry> spheres, size_t geometry) {
    return collect(geometry, spheres.size(), "sphere", [&](size_t i, Box& box) {
        const SphereGeometry& s = spheres[i];
        if (!is_finite(s.center) || !(s.radius >= 0) || !is_finite(s.radius)) return false;
        box = sphere_bounds(s);
        return true;
    });
}

Result<std::vector<BuildPrimitive>> bounds_of(std::span<const RectangleGeometry> rectangles, size_t geometry) {
    return collect(geometry, rectangles.size(), "rectangle", [&](size_t i, Box& box) {
        const RectangleGeometry& r = rectangles[i];
        if (!all_finite(r.center, r.half_u, r.half_v)) return false;
        box = rectangle_bounds(r);
        return true;
    });
}

Result<std::vector<BuildPrimitive>> bounds_of(std::span<const DiskGeometry> disks, size_t geometry) {
    return collect(geometry, disks.size(), "disk", [&](size_t i, Box& box) {
        const DiskGeometry& d = disks[i];
        if (!all_finite(d.center, d.axis_u, d.axis_v)) return false;
        box = disk_bounds(d);
        return true;
    });
}

LargeArray<TriangleBlock> pack(const TriangleGeometry& mesh, std::span<const uint32_t> order) {
    LargeArray<TriangleBlock> blocks(order.size() / kBlock);
    parallel_for(blocks.size(), kGrain / kBlock, [&](size_t begin, size_t end) {
        for (size_t b = begin; b < end; ++b)
            for (size_t lane = 0; lane < kBlock; ++lane) {
                const uint32_t prim = order[b * kBlock + lane];
                const size_t source = prim == kNoHit ? order[b * kBlock] : prim;
                blocks[b].prim[lane] = prim;
                for (size_t which = 0; which < 3; ++which) {
                    const Vec3 p = mesh.positions[mesh.indices[3 * source + which]];
                    for (int axis = 0; axis < 3; ++axis) blocks[b].vertex[which][axis][lane] = p[axis];
                }
            }
    });
    return blocks;
}

}  // namespace

Result<std::vector<BuildPrimitive>> primitive_bounds(const Geometry& geometry, size_t geometry_index) {
    return std::visit([&](const auto& g) { return bounds_of(g, geometry_index); }, geometry);
}

BuiltGeometry build_geometry(const Geometry& geometry, std::span<BuildPrimitive> primitives,
                             const AccelOptions& options, Cancellation& cancelled) {
    const auto* mesh = std::get_if<TriangleGeometry>(&geometry);
    BvhOptions how;
    how.builder = options.builder;
    how.max_depth = options.max_depth;
    how.blocks = mesh != nullptr;
    BuiltGeometry out;
    out.count = primitives.size();
    out.bvh = build_bvh(primitives, how, cancelled);
    if (mesh) {
        out.primitives = pack(*mesh, out.bvh.order);
        out.bvh.order = {};
        return out;
    }
    std::visit(
        [&](const auto& g) {
            if constexpr (!std::is_same_v<decltype(g), const TriangleGeometry&>) out.primitives = g;
        },
        geometry);
    return out;
}

GeometryView view_of(const BuiltGeometry& geometry) {
    GeometryView view;
    if (geometry.bvh.nodes.empty()) return view;
    view.nodes = geometry.bvh.nodes.data();
    view.order = geometry.bvh.order.data();
    struct Fill {
        GeometryView& v;
        void operator()(const LargeArray<TriangleBlock>& b) { v.kind = PrimitiveKind::triangles, v.blocks = b.data(); }
        void operator()(std::span<const SphereGeometry> s) { v.kind = PrimitiveKind::spheres, v.spheres = s.data(); }
        void operator()(std::span<const RectangleGeometry> r) {
            v.kind = PrimitiveKind::rectangles, v.rectangles = r.data();
        }
        void operator()(std::span<const DiskGeometry> d) { v.kind = PrimitiveKind::disks, v.disks = d.data(); }
    };
    std::visit(Fill{view}, geometry.primitives);
    return view;
}

}  // namespace steradian
