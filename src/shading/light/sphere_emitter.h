#pragma once

#include <optional>

#include "math/transform.h"
#include "math/warp.h"
#include "shading/shading_scene.h"

namespace steradian {

/// 1 - cos of the half angle of the cone that a sphere fills, seen from outside; exact for small spheres as well.
inline double sphere_cone(const SphereEmitter& sphere, double distance) {
    const double sine2 = (sphere.radius / distance) * (sphere.radius / distance);
    const double cosine2 = (distance - sphere.radius) * (distance + sphere.radius) / (distance * distance);
    return sine2 / (1 + std::sqrt(cosine2));
}

/// Of a point on the surface rounding decides whether it is inside or outside. So it counts as neither, and the sphere
/// is sampled by area, which is right from both sides: for such a point it is the cosine about its normal.
inline bool is_on_surface(const SphereEmitter& sphere, double distance) {
    return std::fabs(distance - sphere.radius) <= 2 * length(Vec3d(sphere.p_error));
}

inline double sphere_area_pdf(const SphereEmitter& sphere, Vec3d to_surface, Vec3d n) {
    return solid_angle_pdf(1 / (4 * std::numbers::pi * sphere.radius * sphere.radius), to_surface, n);
}

inline std::optional<EmitterSample> sample_emitter(const SphereEmitter& sphere, const EmitterContext& context,
                                                   Vec3d from, uint32_t, Vec2 u) {
    const Vec3d to_center = sphere.center - from;
    const double distance = length(to_center), r = sphere.radius;
    EmitterSample out;
    out.p_error = sphere.p_error;
    if (is_on_surface(sphere, distance)) {
        out.n = warp::sphere(u);
        out.p = sphere.center + out.n * r;
        if (!emits_towards(out.p, out.n, from, context.two_sided)) return std::nullopt;
        out.pdf = sphere_area_pdf(sphere, out.p - from, out.n);
        return out;
    }
    if (distance > r) {
        const double cap = sphere_cone(sphere, distance);
        const Vec3d local = warp::cone(u, cap);
        const Vec3d direction = Frame3d::from_z(to_center * (1 / distance)).to_world(local);
        const double sine2 = local.x * local.x + local.y * local.y;
        const double chord = std::sqrt(max_of(r * r - distance * distance * sine2, 0.0));
        out.n = normalize(direction * (distance * local.z - chord) - to_center);
        out.pdf = warp::cone_pdf(cap);
    } else {
        if (!context.two_sided) return std::nullopt;
        const Vec3d direction = warp::sphere(u);
        const double along = dot(direction, to_center);
        const double chord = std::sqrt(max_of(r * r - distance * distance + along * along, 0.0));
        out.n = normalize(direction * (along + chord) - to_center);
        out.pdf = warp::kSpherePdf;
    }
    out.p = sphere.center + out.n * r;
    return out;
}

inline double emitter_pdf(const SphereEmitter& sphere, const EmitterContext&, Vec3d from, Vec3d p, Vec3d n) {
    const double distance = length(sphere.center - from);
    if (is_on_surface(sphere, distance)) return sphere_area_pdf(sphere, p - from, n);
    if (!(distance > sphere.radius)) return warp::kSpherePdf;
    return warp::cone_pdf(sphere_cone(sphere, distance));
}

/// Area in the world per area on the object's sphere, at a point with unit outward normal n in the world.
inline double area_magnification(const EllipsoidEmitter& e, const ShadingScene& scene, Vec3d n) {
    const auto& m = scene.scene.instances[index(e.instance)].world_from_object.m;
    const auto column = [&](size_t c) { return m[0][c] * n.x + m[1][c] * n.y + m[2][c] * n.z; };
    return e.abs_determinant / length(Vec3d{column(0), column(1), column(2)});
}

inline double emitter_pdf(const EllipsoidEmitter& e, const EmitterContext& context, Vec3d from, Vec3d p, Vec3d n) {
    const double object_area = 4 * std::numbers::pi * e.radius * e.radius;
    return solid_angle_pdf(1 / (object_area * area_magnification(e, context.scene, n)), p - from, n);
}

inline std::optional<EmitterSample> sample_emitter(const EllipsoidEmitter& e, const EmitterContext& context, Vec3d from,
                                                   uint32_t, Vec2 u) {
    const Vec3d n = warp::sphere(u);
    EmitterSample out;
    out.p =
        transform_point(context.scene.scene.instances[index(e.instance)].world_from_object, e.center + n * e.radius);
    out.n = normalize(transform_normal_by_inverse(context.scene.transform_of(index(e.instance)).object_from_world, n));
    out.p_error = e.p_error;
    if (!emits_towards(out.p, out.n, from, context.two_sided)) return std::nullopt;
    out.pdf = emitter_pdf(e, context, from, out.p, out.n);
    return out;
}

}  // namespace steradian
