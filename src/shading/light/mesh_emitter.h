#pragma once

#include <algorithm>
#include <optional>

#include "math/transform.h"
#include "math/warp.h"
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

/// The first triangle whose cumulative area exceeds a uniform share of the total: one without area is never chosen.
inline uint32_t choose_triangle(const std::vector<double>& cumulative, uint32_t choice) {
    const double x = (choice + 0.5) * 0x1p-32 * cumulative.back();
    const auto at = std::upper_bound(cumulative.begin(), cumulative.end(), x);
    return static_cast<uint32_t>(min_of(at - cumulative.begin(), static_cast<std::ptrdiff_t>(cumulative.size()) - 1));
}

inline std::optional<EmitterSample> sample_emitter(const MeshEmitter& emitter, const EmitterContext& context,
                                                   Vec3d from, uint32_t choice, Vec2 u) {
    const ShadingScene& scene = context.scene;
    const ShadingScene::TransformData& instance = scene.transform_of(index(emitter.instance));
    const Affine& transform = scene.scene.instances[index(emitter.instance)].world_from_object;
    const uint32_t prim = choose_triangle(emitter.cumulative_area, choice);
    const EmitterTriangle object = object_triangle(scene.scene.meshes[index(emitter.mesh)], prim);
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
    out.pdf = solid_angle_pdf(1 / scene.lights[context.light].area, out.p - from, out.n);
    return out;
}

inline double emitter_pdf(const MeshEmitter&, const EmitterContext& context, Vec3d from, Vec3d p, Vec3d n) {
    return solid_angle_pdf(1 / context.scene.lights[context.light].area, p - from, n);
}

}  // namespace steradian
