// Area lights of every kind of shape and transform, and the parametrisation of their surfaces, written down a second
// time and without the library's emitters.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "math/transform.h"
#include "shading/light.h"
#include "shading/world.h"

namespace steradian::test {

struct AreaLightCase {
    std::string name;
    Scene scene;  ///< instance 0 is the light's, light 0 the light
    bool two_sided = false;
};

inline AreaLightCase area_light(std::string name, Shape shape, const Affine& transform, bool two_sided = false) {
    AreaLightCase out{std::move(name), {}, two_sided};
    const InstanceId id = add_shape(out.scene, std::move(shape), transform);
    add<InstanceId>(out.scene.lights, Light{AreaLight{id, {1, 1, 1}, two_sided, 1}});
    return out;
}

inline Mesh box_mesh() {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back({i & 1 ? 1.0f : -1.0f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.3f : -0.3f});
    mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                    2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    return mesh;
}

inline std::vector<AreaLightCase> area_light_cases() {
    const Affine turned = translation(0.3, -0.2, 0.1) * rotation_degrees(40, {1, 0.5, -2});
    const Affine uniform = turned * scaling(-0.7, 0.7, 0.7);
    const Affine skewed = turned * scaling(0.4, 1.2, 0.9) * rotation_degrees(30, {0, 1, 1});
    const Rectangle rectangle{{0.1f, 0, 0}, {0.8f, 0, 0}, {0, 0, -0.4f}};
    const Sphere sphere{{0, 0.1f, 0}, 0.6f};
    const Disk disk{{0, 0, 0.1f}, {0.2f, 1, 0.1f}, 0.7f};
    std::vector<AreaLightCase> out;
    for (const auto& [name, transform] :
         {std::pair<const char*, Affine>{"", {}}, {" mirrored", uniform}, {" skewed", skewed}}) {
        out.push_back(area_light(std::string("rectangle") + name, rectangle, transform));
        out.push_back(area_light(std::string("sphere") + name, sphere, transform));
        out.push_back(area_light(std::string("disk") + name, disk, transform));
        Scene scene;
        const MeshId mesh = add<MeshId>(scene.meshes, box_mesh());
        AreaLightCase box = area_light(std::string("box") + name, mesh, transform);
        box.scene.meshes.push_back(box_mesh());
        out.push_back(std::move(box));
    }
    out.push_back(area_light("rectangle with two sides", rectangle, turned, true));
    AreaLightCase textured = area_light("textured box", MeshId{0}, turned);
    textured.scene.meshes.push_back(box_mesh());
    CheckerTexture checker{{3, 1, 0}, {0, 0.1f, 0.2f}};
    checker.scale = {1.7f, 2.3f};
    std::get<AreaLight>(textured.scene.lights[0]).texture = add<TextureId>(textured.scene.textures, Texture{checker});
    out.push_back(std::move(textured));
    out.push_back(area_light("sphere with two sides", sphere, uniform, true));
    return out;
}

/// A light's surface, one patch per primitive, each over the unit square.
class LightSurface {
public:
    explicit LightSurface(const World& world)
        : world_(world),
          transform_(world.shading.scene.instances[0].world_from_object),
          inverse_(world.shading.transform_of(0).identity ? Affine{} : *steradian::inverse(transform_)),
          shape_(world.shading.scene.shapes[0]) {
        if (const auto* id = std::get_if<MeshId>(&shape_)) mesh_ = &world.shading.scene.meshes[index(*id)];
    }

    uint32_t patches() const { return mesh_ ? static_cast<uint32_t>(mesh_->indices.size() / 3) : 1; }

    struct Element {
        SurfacePoint point;
        double area = 0;  ///< per unit of the square
    };
    Element at(uint32_t patch, double a, double b) const {
        if (const auto* sphere = std::get_if<Sphere>(&shape_)) return on_sphere(*sphere, a, b);
        Hit hit;
        hit.instance = 0, hit.prim = patch, hit.t = 1;
        double area;
        if (mesh_) {
            const double s = std::sqrt(a);
            hit.u = static_cast<float>(s * (1 - b)), hit.v = static_cast<float>(s * b);
            const auto corner = [&](uint32_t i) { return Vec3d(mesh_->positions[mesh_->indices[3 * patch + i]]); };
            area = spanned(corner(1) - corner(0), corner(2) - corner(0)) / 2;
        } else if (const auto* r = std::get_if<Rectangle>(&shape_)) {
            hit.u = static_cast<float>(2 * a - 1), hit.v = static_cast<float>(2 * b - 1);
            area = 4 * spanned(r->half_u, r->half_v);
        } else {
            const DiskAxes axes = disk_axes(std::get<Disk>(shape_));
            const double r0 = std::sqrt(a), phi = 2 * std::numbers::pi * b;
            hit.u = static_cast<float>(r0 * std::cos(phi)), hit.v = static_cast<float>(r0 * std::sin(phi));
            area = std::numbers::pi * spanned(axes.u, axes.v);
        }
        return {surface_at(world_.shading, Ray{}, hit), area};
    }

    struct Parameters {
        double a, b;
    };
    Parameters of(const Hit& hit, const SurfacePoint& point) const {
        const auto turn = [](double y, double x) {
            const double t = std::atan2(y, x) / (2 * std::numbers::pi);
            return t < 0 ? t + 1 : t;
        };
        if (mesh_) {
            const double s = static_cast<double>(hit.u) + hit.v;
            return {s * s, s > 0 ? hit.v / s : 0.0};
        }
        if (const auto* sphere = std::get_if<Sphere>(&shape_)) {
            const Vec3d n = normalize(transform_point(inverse_, point.p) - Vec3d(sphere->center));
            return {(1 - n.z) / 2, turn(n.y, n.x)};
        }
        if (std::holds_alternative<Rectangle>(shape_)) return {(hit.u + 1.0) / 2, (hit.v + 1.0) / 2};
        return {static_cast<double>(hit.u) * hit.u + static_cast<double>(hit.v) * hit.v, turn(hit.v, hit.u)};
    }

private:
    double spanned(Vec3d u, Vec3d v) const {
        return length(cross(transform_vector(transform_, u), transform_vector(transform_, v)));
    }

    Element on_sphere(const Sphere& sphere, double a, double b) const {
        const double z = 1 - 2 * a, s = std::sqrt(1 - z * z), phi = 2 * std::numbers::pi * b;
        const Vec3d n{s * std::cos(phi), s * std::sin(phi), z};
        const Vec3d by_z{-z / s * std::cos(phi), -z / s * std::sin(phi), 1},
            by_phi{-s * std::sin(phi), s * std::cos(phi), 0};
        const double r = sphere.radius;
        const Ray ray{static_cast<Vec3>(transform_point(transform_, Vec3d(sphere.center) + n * (2 * r))), 0,
                      static_cast<Vec3>(transform_vector(transform_, n * -r)), kInfinity};
        const Hit hit = world_.accel.intersect(ray);
        return {surface_at(world_.shading, ray, hit), spanned(by_z * (2 * r), by_phi * (2 * std::numbers::pi * r))};
    }

    const World& world_;
    Affine transform_, inverse_;
    Shape shape_;
    const Mesh* mesh_ = nullptr;
};

}  // namespace steradian::test
