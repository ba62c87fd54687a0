// What the kinds of lights share. Each is one file with three functions, found by overloading:
//   uint32_t samples_wanted(const Kind&);
//   std::optional<LightSample> sample_kind(const Kind&, const LightContext&, const SurfacePoint& from, uint32_t choice,
//   Vec2 u); double pdf_kind(const Kind&, const LightContext&, const SurfacePoint& from, Vec3 wi, const SurfacePoint*
//   hit);
#pragma once

#include <optional>

#include "shading/environment.h"
#include "shading/light.h"
#include "shading/shading_scene.h"
#include "shading/surface_error.h"

namespace steradian {

struct LightContext {
    const ShadingScene& scene;
    uint32_t light = 0;
    EnvironmentDensity density = EnvironmentDensity::complete;
    const LightQuery* part = nullptr;  ///< see sample_light()
    const ShadingScene::LightData& data() const { return scene.lights[light]; }
};

/// Towards a light that is infinitely far away.
inline Ray shadow_ray_to_infinity(const SurfacePoint& from, Vec3 wi) { return spawn_ray(from, wi); }

/// Towards a point that no surface belongs to. Nothing when it cannot be told apart from the receiving point.
inline std::optional<Ray> shadow_ray_to_point(const SurfacePoint& from, Vec3 target, Vec3 wi) {
    const Vec3 o = offset_origin(from.p, from.p_error, from.ng, wi);
    const Vec3 d = target - o;
    if (d == Vec3{} || !is_finite(d)) return std::nullopt;
    return Ray{o, 0, d, kShadowRayEnd};
}

/// Where, in units of its length, a ray crosses the tangent plane in a point of an instance's surface, as the kernels
/// see that ray; not finite when it runs along the plane.
inline double tangent_plane_distance(const LightContext& context, InstanceId id, const EmitterSample& at,
                                     const Ray& ray) {
    const ShadingScene::TransformData& instance = context.scene.transform_of(index(id));
    const LocalRay local = local_ray(instance, ray);
    if (instance.identity) return dot(at.n, at.p - local.o) / dot(at.n, local.d);
    const Vec3d p = transform_point(instance.object_from_world, at.p);
    const Vec3d n = transform_normal_by_inverse(context.scene.scene.instances[index(id)].world_from_object, at.n);
    return dot(n, p - local.o) / dot(n, local.d);
}

/// Towards a point of an emitting surface with normal n. The target is moved off the surface as the origin is off its
/// own. What is left is the rounding of the ray, which matters where it grazes the light: so it ends where, as it
/// really runs, it would reach the tangent plane in that point, if that comes first.
inline std::optional<Ray> shadow_ray_to_surface(const SurfacePoint& from, const LightContext& context, InstanceId id,
                                                const EmitterSample& at, Vec3 wi) {
    const Vec3 target = offset_origin(static_cast<Vec3>(at.p), at.p_error, static_cast<Vec3>(at.n), -wi);
    std::optional<Ray> ray = shadow_ray_to_point(from, target, wi);
    if (!ray) return std::nullopt;
    const double reach = tangent_plane_distance(context, id, at, *ray);
    if (reach > 0 && reach < 1) ray->tmax = static_cast<float>(reach * kShadowRayEnd);
    return ray;
}

/// The unit vector between two points, and their distance, in double; nothing when they coincide.
struct Towards {
    Vec3 wi;
    double distance = 0;
    static std::optional<Towards> from_to(Vec3 from, Vec3d to) {
        const Vec3d d = to - Vec3d(from);
        const double l = length(d);
        if (!(l > 0) || !std::isfinite(l)) return std::nullopt;
        return Towards{static_cast<Vec3>(d * (1 / l)), l};
    }
};

/// Intensity over the square of the distance. Nothing when that is black; what is too much for a float arrives as
/// infinity, so that the sample is counted as a bad one and not lost in silence.
inline std::optional<LightSample> delta_sample(const SurfacePoint& from, Vec3 position, Rgb intensity,
                                               const Towards& towards) {
    const double falloff = 1 / (towards.distance * towards.distance);
    const Rgb arriving{static_cast<float>(intensity.r * falloff), static_cast<float>(intensity.g * falloff),
                       static_cast<float>(intensity.b * falloff)};
    const std::optional<Ray> ray = shadow_ray_to_point(from, position, towards.wi);
    if (is_black(arriving) || !ray) return std::nullopt;
    return LightSample{towards.wi, arriving, 0, *ray};
}

}  // namespace steradian
