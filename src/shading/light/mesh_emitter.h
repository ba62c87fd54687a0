#pragma once

#include <numbers>
#include <optional>

#include "math/transform.h"
#include "math/warp.h"
#include "shading/light/emitter.h"
#include "shading/shading_scene.h"
#include "shading/surface_error.h"

namespace steradian {

/// The corners of a triangle, in double; degenerate when it has no area.
struct EmitterTriangle {
    Vec3d p0, e1, e2;
    Vec3d scaled_normal() const { return cross(e1, e2); }
};

inline EmitterTriangle object_triangle(const Mesh& mesh, uint32_t prim) {
    const uint32_t* i = mesh.indices.data() + size_t(3) * prim;
    const Vec3d p0 = mesh.positions[i[0]];
    return {p0, Vec3d(mesh.positions[i[1]]) - p0, Vec3d(mesh.positions[i[2]]) - p0};
}

inline EmitterTriangle world_triangle(const Affine& world_from_object, const EmitterTriangle& t) {
    return {transform_point(world_from_object, t.p0), transform_vector(world_from_object, t.e1),
            transform_vector(world_from_object, t.e2)};
}

/// Of one triangle per radiance; no strength where it has no area.
inline LightBounds triangle_bounds(const EmitterTriangle& t, bool flips, bool two_sided) {
    const Vec3d p1 = t.p0 + t.e1, p2 = t.p0 + t.e2, n = t.scaled_normal();
    const double l = length(n);
    if (!(l > 0) || !std::isfinite(l)) return {};
    const auto least = [](double a, double b, double c) { return min_of(a, min_of(b, c)); };
    const auto most = [](double a, double b, double c) { return max_of(a, max_of(b, c)); };
    return {{least(t.p0.x, p1.x, p2.x), least(t.p0.y, p1.y, p2.y), least(t.p0.z, p1.z, p2.z)},
            {most(t.p0.x, p1.x, p2.x), most(t.p0.y, p1.y, p2.y), most(t.p0.z, p1.z, p2.z)},
            {n * ((flips ? -1.0 : 1.0) / l), 0, std::numbers::pi / 2, two_sided},
            l / 2};
}

/// Calls each(bounds) for every triangle, in order.
template <class Each>
void each_triangle_bounds(const ShadingScene& scene, InstanceId instance, MeshId mesh, bool two_sided, Each each) {
    const ShadingScene::TransformData& data = scene.transform_of(index(instance));
    const Affine& transform = scene.scene.instances[index(instance)].world_from_object;
    const Mesh& m = scene.scene.meshes[index(mesh)];
    for (uint32_t i = 0; i < m.indices.size() / 3; ++i) {
        const EmitterTriangle object = object_triangle(m, i);
        each(triangle_bounds(data.identity ? object : world_triangle(transform, object), data.flips, two_sided));
    }
}

/// Of a triangle that is chosen with a probability and then sampled uniformly. One without area is never chosen.
inline double triangle_pdf(const EmitterTriangle& world, double probability, Vec3d to_surface, Vec3d n) {
    return probability > 0 ? solid_angle_pdf(2 * probability / length(world.scaled_normal()), to_surface, n) : 0;
}

inline std::optional<EmitterSample> sample_emitter(const MeshEmitter& emitter, const EmitterContext& context,
                                                   Vec3d from, uint32_t choice, Vec2 u) {
    const ShadingScene& scene = context.scene;
    const ShadingScene::TransformData& instance = scene.transform_of(index(emitter.instance));
    const Affine& transform = scene.scene.instances[index(emitter.instance)].world_from_object;
    const std::optional<ChosenLight> chosen =
        context.part ? context.part->chosen : emitter.triangles.choose(context.receiver, choice);
    if (!chosen) return std::nullopt;
    const EmitterTriangle object = object_triangle(scene.scene.meshes[index(emitter.mesh)], chosen->light);
    const EmitterTriangle world = instance.identity ? object : world_triangle(transform, object);
    const warp::TrianglePoint b = warp::triangle(u);
    const Vec3d p_object = object.p0 + object.e1 * b.b1 + object.e2 * b.b2;

    EmitterSample out;
    out.p = world.p0 + world.e1 * b.b1 + world.e2 * b.b2;
    out.n = normalize(world.scaled_normal()) * (instance.flips ? -1.0 : 1.0);
    if (!emits_towards(out.p, out.n, from, context.two_sided)) return std::nullopt;
    const double size = length(object.e1) + length(object.e2);
    const double reach = max_component(abs(object.p0)) + size;
    out.p_error =
        surface_error(transform, instance, p_object, out.p, flat_slack(size, reach, length(object.scaled_normal())));
    out.pdf = triangle_pdf(world, chosen->probability, out.p - from, out.n);
    out.u = static_cast<float>(b.b1), out.v = static_cast<float>(b.b2), out.prim = chosen->light;
    return out;
}

inline double emitter_pdf(const MeshEmitter& emitter, const EmitterContext& context, Vec3d from, Vec3d p, Vec3d n) {
    const ShadingScene& scene = context.scene;
    const EmitterTriangle object = object_triangle(scene.scene.meshes[index(emitter.mesh)], context.prim);
    const Instance& instance = scene.scene.instances[index(emitter.instance)];
    const bool identity = scene.transform_of(index(emitter.instance)).identity;
    const EmitterTriangle world = identity ? object : world_triangle(instance.world_from_object, object);
    return triangle_pdf(world, emitter.triangles.probability(context.receiver, context.prim), p - from, n);
}

}  // namespace steradian
