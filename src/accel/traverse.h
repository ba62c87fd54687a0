// The kernels: one ray through the two levels of hierarchies.
#pragma once

#include "accel/geometry.h"
#include "accel/instance.h"
#include "accel/planar.h"
#include "accel/simd.h"
#include "accel/sphere.h"

namespace steradian {

/// Everything that a query reads.
struct World {
    std::vector<BuiltGeometry> geometries;
    std::vector<PlacedGeometry> instances;
    Bvh bvh;  ///< over the instances that have anything in them
};

/// Order of hits along a ray: by t, then instance, then primitive.
inline bool comes_before(const Hit& a, const Hit& b) {
    if (a.t != b.t) return a.t < b.t;
    if (a.instance != b.instance) return a.instance < b.instance;
    return a.prim < b.prim;
}

/// The part of a query that depends on the instance. Without a transform the world's interval contains every
/// primitive's own, so that clamping to it does nothing and the whole line stands for it.
struct Scope {
    uint32_t instance = 0;
    Interval world;
};

/// The first hit in the order; with an `after`, the first one that comes after it. `kAny` stops at the first hit found.
template <bool kAny, bool kAfter>
class Query {
public:
    Query(float tmin, float tmax, const Hit& after) : tmin_(tmin), after_(after) {
        // Ids that every candidate comes before: one at tmax itself is still a hit.
        best_.t = tmax;
        start_ = kAfter && after.t > tmin ? after.t : tmin;
    }

    /// Boxes outside [start, limit] cannot hold what is sought. Inside an instance, where t is clamped once more, an
    /// end of the range that the clamping can reach does not bound the t before it.
    float start(const Scope& scope) const { return scope.world.in < start_ ? start_ : -kInfinity; }
    float limit(const Scope& scope) const { return best_.t < scope.world.out ? best_.t : kInfinity; }
    float start() const { return start_; }
    float limit() const { return best_.t; }

    /// True when the query is done.
    bool offer(const Scope& scope, float t, Interval own, float u, float v, uint32_t prim) {
        Hit hit;
        if (!settle(t, own, scope.world, hit.t) || !(hit.t >= tmin_)) return false;
        hit.u = u, hit.v = v, hit.prim = prim, hit.instance = scope.instance;
        if (!comes_before(hit, best_)) return false;
        if (kAfter && !comes_before(after_, hit)) return false;
        best_ = hit;
        return kAny;
    }

    Hit result() const { return best_.found() ? best_ : Hit{}; }

private:
    float tmin_, start_;
    Hit after_;
    Hit best_;
};

/// A ray spread over four lanes.
struct SlabRay4 {
    Float4 o[3], inv_d[3];
    bool negative[3];

    explicit SlabRay4(const SlabRay& ray) {
        for (int axis = 0; axis < 3; ++axis) {
            o[axis] = Float4::all(ray.o[axis]);
            inv_d[axis] = Float4::all(ray.inv_d[axis]);
            negative[axis] = ray.negative[axis];
        }
    }
};

/// slab_interval() for the four children of a node, cut to [start, limit]; a bit for each that is met.
inline uint32_t test_children(const BvhNode& node, const SlabRay4& ray, float start, float limit, float t_in[4]) {
    Float4 in = Float4::all(start), out = Float4::all(kInfinity);
    for (int axis = 0; axis < 3; ++axis) {
        const float* near_plane = ray.negative[axis] ? node.hi[axis] : node.lo[axis];
        const float* far_plane = ray.negative[axis] ? node.lo[axis] : node.hi[axis];
        in = larger((Float4::load(near_plane) - ray.o[axis]) * ray.inv_d[axis], in);
        out = smaller((Float4::load(far_plane) - ray.o[axis]) * ray.inv_d[axis], out);
    }
    out = out * Float4::all(kFarScale) + Float4::all(kFarPad);
    in.store(t_in);
    return bits((in <= out) & (in <= Float4::all(limit)));
}

/// Visits the leaves that the ray meets, near ones first; `leaf(first, count)` returns true to stop everything.
/// `limit` is asked again and again, since it falls with every hit.
template <class Limit, class Leaf>
bool walk(const std::vector<BvhNode>& nodes, const SlabRay& slab, float start, Limit limit, Leaf leaf) {
    struct Entry {
        uint32_t first, count;
        float t_in;
    };
    // Every level of nodes leaves at most three siblings behind.
    Entry stack[3 * kMaxBvhDepth + 4];
    size_t top = 0;
    const SlabRay4 ray(slab);
    uint32_t current = 0;
    while (true) {
        const BvhNode& node = nodes[current];
        alignas(16) float t_in[4];
        const size_t base = top;
        for (uint32_t met = test_children(node, ray, start, limit(), t_in); met; met &= met - 1) {
            const auto child = static_cast<uint32_t>(__builtin_ctz(met));
            size_t place = top++;
            for (; place > base && stack[place - 1].t_in < t_in[child]; --place) stack[place] = stack[place - 1];
            stack[place] = {node.first[child], node.count[child], t_in[child]};
        }
        while (true) {
            if (top == 0) return false;
            const Entry& entry = stack[--top];
            if (entry.t_in > limit()) continue;
            if (entry.count == 0) {
                current = entry.first;
                break;
            }
            if (leaf(entry.first, entry.count)) return true;
        }
    }
}

template <class Q>
bool walk_geometry(const BuiltGeometry& geometry, const std::vector<TriangleBlock>& blocks, const Ray& ray,
                   const SlabRay& slab, const Scope& scope, Q& query) {
    const TriangleRay triangle_ray(ray);
    const BlockRay block_ray(triangle_ray);
    const auto leaf = [&](uint32_t first, uint32_t count) {
        for (uint32_t b = first; b < first + count; ++b) {
            const TriangleBlock& block = blocks[b];
            for (uint32_t maybe = filter_block(block, block_ray); maybe; maybe &= maybe - 1) {
                const auto lane = static_cast<uint32_t>(__builtin_ctz(maybe));
                if (block.prim[lane] == kNoHit) break;
                const Vec3 p0 = block.corner(0, lane), p1 = block.corner(1, lane), p2 = block.corner(2, lane);
                TriangleCandidate c;
                if (!intersect_triangle(triangle_ray, p0, p1, p2, c)) continue;
                const Interval own = slab_interval(triangle_bounds(p0, p1, p2), slab);
                if (query.offer(scope, c.t, own, c.u, c.v, block.prim[lane])) return true;
            }
        }
        return false;
    };
    return walk(
        geometry.bvh.nodes, slab, query.start(scope), [&] { return query.limit(scope); }, leaf);
}

template <class Q>
bool offer_shape(const SphereGeometry& sphere, const Ray& ray, const SlabRay& slab, const Scope& scope, uint32_t prim,
                 Q& query) {
    const SphereCandidates c = intersect_sphere(ray, sphere);
    for (int i = 0; i < c.count; ++i)
        if (query.offer(scope, c.t[i], slab_interval(sphere_bounds(sphere), slab), 0, 0, prim)) return true;
    return false;
}
template <class Q>
bool offer_shape(const RectangleGeometry& rectangle, const Ray& ray, const SlabRay& slab, const Scope& scope,
                 uint32_t prim, Q& query) {
    PlanarCandidate c;
    return intersect_rectangle(ray, rectangle, c) &&
           query.offer(scope, c.t, slab_interval(rectangle_bounds(rectangle), slab), c.a, c.b, prim);
}
template <class Q>
bool offer_shape(const DiskGeometry& disk, const Ray& ray, const SlabRay& slab, const Scope& scope, uint32_t prim,
                 Q& query) {
    PlanarCandidate c;
    return intersect_disk(ray, disk, c) &&
           query.offer(scope, c.t, slab_interval(disk_bounds(disk), slab), c.a, c.b, prim);
}

template <class Shape, class Q>
bool walk_geometry(const BuiltGeometry& geometry, std::span<const Shape> shapes, const Ray& ray, const SlabRay& slab,
                   const Scope& scope, Q& query) {
    const auto leaf = [&](uint32_t first, uint32_t count) {
        for (uint32_t i = first; i < first + count; ++i) {
            const uint32_t prim = geometry.bvh.order[i];
            if (offer_shape(shapes[prim], ray, slab, scope, prim, query)) return true;
        }
        return false;
    };
    return walk(
        geometry.bvh.nodes, slab, query.start(scope), [&] { return query.limit(scope); }, leaf);
}

template <class Q>
bool walk_instance(const World& world, uint32_t index, const Ray& ray, const SlabRay& slab, Q& query) {
    const PlacedGeometry& instance = world.instances[index];
    const BuiltGeometry& geometry = world.geometries[instance.geometry];
    Scope scope;
    scope.instance = index;
    const auto enter = [&](const Ray& r, const SlabRay& s) {
        return std::visit([&](const auto& p) { return walk_geometry(geometry, p, r, s, scope, query); },
                          geometry.primitives);
    };
    if (instance.identity) return enter(ray, slab);
    scope.world = slab_interval(instance.world, slab);
    Ray object_ray;
    if (scope.world.empty() || !instance.to_object(ray, object_ray)) return false;
    return enter(object_ray, SlabRay(object_ray));
}

/// `ray` must be canonical.
template <class Q>
void walk_world(const World& world, const Ray& ray, Q& query) {
    if (world.bvh.nodes.empty()) return;
    const SlabRay slab(ray);
    const auto leaf = [&](uint32_t first, uint32_t count) {
        for (uint32_t i = first; i < first + count; ++i)
            if (walk_instance(world, world.bvh.order[i], ray, slab, query)) return true;
        return false;
    };
    walk(
        world.bvh.nodes, slab, query.start(), [&] { return query.limit(); }, leaf);
}

}  // namespace steradian
