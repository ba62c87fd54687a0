#include "brute_force.h"

#include <bit>
#include <cstdio>
#include <map>

#include "accel/margin.h"
#include "accel/planar.h"
#include "accel/sphere.h"
#include "accel/triangle.h"

namespace steradian::test {

struct BruteForce::Data {
    std::vector<Geometry> geometries;
    std::vector<PlacedGeometry> instances;
    std::vector<std::vector<uint8_t>> cut_outs;  ///< by instance
};

namespace {

struct EachCandidate {
    const Ray& ray;
    const SlabRay slab;
    std::function<void(uint32_t prim, const Box& own, float t, float u, float v)> sink;

    void operator()(const TriangleGeometry& mesh) const {
        const TriangleRay triangle_ray(ray);
        for (uint32_t i = 0; i < mesh.indices.size() / 3; ++i) {
            const Vec3 a = mesh.positions[mesh.indices[3 * i]], b = mesh.positions[mesh.indices[3 * i + 1]],
                       c = mesh.positions[mesh.indices[3 * i + 2]];
            TriangleCandidate found;
            if (intersect_triangle(triangle_ray, a, b, c, found))
                sink(i, triangle_bounds(a, b, c), found.t, found.u, found.v);
        }
    }
    void operator()(std::span<const SphereGeometry> spheres) const {
        for (uint32_t i = 0; i < spheres.size(); ++i) {
            const SphereCandidates found = intersect_sphere(ray, spheres[i]);
            for (int k = 0; k < found.count; ++k) sink(i, sphere_bounds(spheres[i]), found.t[k], 0, 0);
        }
    }
    void operator()(std::span<const RectangleGeometry> rectangles) const {
        PlanarCandidate found;
        for (uint32_t i = 0; i < rectangles.size(); ++i)
            if (intersect_rectangle(ray, rectangles[i], found))
                sink(i, rectangle_bounds(rectangles[i]), found.t, found.a, found.b);
    }
    void operator()(std::span<const DiskGeometry> disks) const {
        PlanarCandidate found;
        for (uint32_t i = 0; i < disks.size(); ++i)
            if (intersect_disk(ray, disks[i], found)) sink(i, disk_bounds(disks[i]), found.t, found.a, found.b);
    }
};

struct EachBox {
    Box box;
    void operator()(const TriangleGeometry& mesh) {
        for (const uint32_t i : mesh.indices) box.extend(mesh.positions[i]);
    }
    void operator()(std::span<const SphereGeometry> all) {
        for (const auto& s : all) box.extend(sphere_bounds(s));
    }
    void operator()(std::span<const RectangleGeometry> all) {
        for (const auto& r : all) box.extend(rectangle_bounds(r));
    }
    void operator()(std::span<const DiskGeometry> all) {
        for (const auto& d : all) box.extend(disk_bounds(d));
    }
};

bool ordered(const Hit& a, const Hit& b) {
    return std::tie(a.t, a.instance, a.prim) < std::tie(b.t, b.instance, b.prim);
}

}  // namespace

BruteForce::BruteForce(const TestScene& scene) : data_(std::make_unique<Data>()) {
    data_->geometries = scene.geometries();
    Placement placement;
    placement.instances = scene.instances;
    for (const GeometryInstance& instance : scene.instances) {
        EachBox bounds;
        std::visit(bounds, data_->geometries[instance.geometry]);
        placement.placed.push_back(*place(instance.geometry, instance.world_from_object, bounds.box));
        placement.scene.extend(placement.placed.back().world);
        data_->cut_outs.emplace_back(instance.cut_outs.begin(), instance.cut_outs.end());
    }
    placement.add_margins();
    data_->instances = placement.placed;
}
BruteForce::~BruteForce() = default;

template <class Sink>
void BruteForce::each(const Ray& in, Sink sink) const {
    Ray ray;
    if (!canonical(in, ray)) return;
    const SlabRay slab(ray);
    for (uint32_t i = 0; i < data_->instances.size(); ++i) {
        const PlacedGeometry& placed = data_->instances[i];
        const Interval world = slab_interval(placed.world, slab);
        Ray object_ray = ray;
        if (!placed.identity && !placed.to_object(ray, object_ray)) continue;
        const SlabRay object_slab(object_ray);
        const auto take = [&](uint32_t prim, const Box& own, float t, float u, float v) {
            Hit hit{0, u, v, prim, i};
            if (settle(t, slab_interval(own, object_slab), world, hit.t) && hit.t >= ray.tmin && hit.t <= ray.tmax)
                sink(hit);
        };
        std::visit(EachCandidate{object_ray, object_slab, take}, data_->geometries[placed.geometry]);
    }
}

std::vector<Hit> BruteForce::all_hits(const Ray& ray) const {
    std::vector<Hit> hits;
    each(ray, [&](const Hit& hit) { hits.push_back(hit); });
    std::sort(hits.begin(), hits.end(), ordered);
    // The two roots of a sphere may have been clamped to one.
    hits.erase(std::unique(hits.begin(), hits.end()), hits.end());
    return hits;
}

Hit BruteForce::first_hit(const Ray& ray) const {
    Hit best;
    each(ray, [&](const Hit& hit) {
        if (!best.found() || ordered(hit, best)) best = hit;
    });
    return best;
}

Accel::Occlusion BruteForce::occlusion(const Ray& ray) const {
    Accel::Occlusion result = Accel::clear;
    each(ray, [&](const Hit& hit) {
        const std::vector<uint8_t>& bits = data_->cut_outs[hit.instance];
        const bool cut_out = !bits.empty() && (bits[hit.prim / 8] & 1u << (hit.prim % 8)) != 0;
        if (!cut_out || result == Accel::blocked)
            result = Accel::blocked;
        else
            result = Accel::cut_out;
    });
    return result;
}

bool same_bits(const Hit& a, const Hit& b) {
    const auto bits = [](float x) { return std::bit_cast<uint32_t>(x); };
    return bits(a.t) == bits(b.t) && bits(a.u) == bits(b.u) && bits(a.v) == bits(b.v) && a.prim == b.prim &&
           a.instance == b.instance;
}

std::string describe(const Ray& r) {
    char text[256];
    std::snprintf(text, sizeof text, "o (%a, %a, %a) d (%a, %a, %a) t [%a, %a]", r.o.x, r.o.y, r.o.z, r.d.x, r.d.y,
                  r.d.z, r.tmin, r.tmax);
    return text;
}

std::string describe(const Hit& h) {
    char text[160];
    std::snprintf(text, sizeof text, "t %a u %a v %a prim %u instance %u", h.t, h.u, h.v, h.prim, h.instance);
    return text;
}

}  // namespace steradian::test
