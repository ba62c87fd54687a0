// A scene together with the ray kernels, as a renderer would put them together, and a small random number generator.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "accel/accel.h"
#include "math/vector.h"
#include "shading/shading_scene.h"
#include "shading/surface.h"

namespace steradian::test {

/// SplitMix64 (Steele, Lea & Flood 2014).
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}
    uint64_t bits() {
        uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    uint32_t bits32() { return static_cast<uint32_t>(bits() >> 32); }
    /// Multiples of 2^-24 in [0, 1), as the samplers give them.
    float uniform() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }
    Vec2 uniform2() {
        const float x = uniform(), y = uniform();
        return {x, y};
    }
    double between(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(bits() >> 11) * 0x1p-53); }
    Vec3d direction() {
        for (;;) {
            const double x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
            const double l2 = x * x + y * y + z * z;
            if (l2 > 0.01 && l2 <= 1) return normalize(Vec3d{x, y, z});
        }
    }

private:
    uint64_t state_;
};

/// Bakes nothing: every instance keeps its transform.
class World {
public:
    explicit World(Scene scene) : shading(make(std::move(scene))), accel(build()) {}
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    ShadingScene shading;

private:
    static ShadingScene make(Scene scene) {
        Diagnostics diagnostics;
        return std::move(make_shading_scene(std::move(scene), diagnostics)).value();
    }

    Accel build() {
        const Scene& scene = shading.scene;
        spheres_.reserve(scene.shapes.size());
        rectangles_.reserve(scene.shapes.size());
        disks_.reserve(scene.shapes.size());
        std::vector<Geometry> geometries;
        for (const Shape& shape : scene.shapes) {
            if (const auto* id = std::get_if<MeshId>(&shape)) {
                const Mesh& mesh = scene.meshes[index(*id)];
                geometries.push_back(TriangleGeometry{mesh.positions, mesh.indices});
            } else if (const auto* s = std::get_if<Sphere>(&shape)) {
                spheres_.push_back({s->center, s->radius});
                geometries.push_back(std::span<const SphereGeometry>(&spheres_.back(), 1));
            } else if (const auto* r = std::get_if<Rectangle>(&shape)) {
                rectangles_.push_back({r->center, r->half_u, r->half_v});
                geometries.push_back(std::span<const RectangleGeometry>(&rectangles_.back(), 1));
            } else {
                const Disk& d = std::get<Disk>(shape);
                const DiskAxes axes = disk_axes(d);
                disks_.push_back({d.center, axes.u, axes.v});
                geometries.push_back(std::span<const DiskGeometry>(&disks_.back(), 1));
            }
        }
        std::vector<GeometryInstance> instances;
        for (const Instance& i : scene.instances) instances.push_back({index(i.shape), i.world_from_object});
        return std::move(Accel::build(geometries, instances)).value();
    }

    std::vector<SphereGeometry> spheres_;
    std::vector<RectangleGeometry> rectangles_;
    std::vector<DiskGeometry> disks_;

public:
    Accel accel;
};

/// One instance of one shape with a grey diffuse material.
inline InstanceId add_shape(Scene& scene, Shape shape, const Affine& world_from_object = {}) {
    if (scene.materials.empty()) {
        const TextureId grey = add<TextureId>(scene.textures, Texture{ConstantTexture{{0.5f, 0.5f, 0.5f}}});
        add<MaterialId>(scene.materials, Material{DiffuseMaterial{grey, false}});
    }
    const ShapeId id = add<ShapeId>(scene.shapes, std::move(shape));
    return add<InstanceId>(scene.instances, Instance{id, MaterialId{}, world_from_object});
}

inline InstanceId add_mesh(Scene& scene, Mesh mesh, const Affine& world_from_object = {}) {
    const MeshId id = add<MeshId>(scene.meshes, std::move(mesh));
    return add_shape(scene, id, world_from_object);
}

/// A receiving point that belongs to no surface.
inline SurfacePoint receiver(Vec3 p, Vec3 n) {
    SurfacePoint out;
    out.p = p;
    out.ng = out.ns = normalize(n);
    return out;
}

inline Ray ray_towards(Vec3d o, Vec3d target) {
    return {static_cast<Vec3>(o), 0, static_cast<Vec3>(normalize(target - o)), kInfinity};
}

}  // namespace steradian::test
