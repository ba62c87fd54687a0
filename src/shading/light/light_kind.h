// What the kinds of lights share. Each is one file with three functions, found by overloading:
//   uint32_t samples_wanted(const Kind&);
//   std::optional<LightSample> sample_kind(const Kind&, const LightContext&, const SurfacePoint& from, uint32_t choice,
//   Vec2 u); double pdf_kind(const Kind&, const LightContext&, const SurfacePoint& from, Vec3 wi, const SurfacePoint*
//   hit);
#pragma once

#include <optional>

#include "shading/light.h"
#include "shading/shading_scene.h"

namespace steradian {

struct LightContext {
    const ShadingScene& scene;
    uint32_t light = 0;
    const ShadingScene::LightData& data() const { return scene.lights[light]; }
};

/// How much of the way to its target a shadow ray goes: the last 2^-17 is more than the rounding of its direction, and
/// less than the distance at which an occluder in front of a light is worth seeing.
inline constexpr float kShadowRayEnd = 1 - 0x1p-17f;

/// Towards a light that is infinitely far away.
inline Ray shadow_ray_to_infinity(const SurfacePoint& from, Vec3 wi) { return spawn_ray(from, wi); }

/// Towards a point that no surface belongs to. Nothing when it cannot be told apart from the receiving point.
inline std::optional<Ray> shadow_ray_to_point(const SurfacePoint& from, Vec3 target, Vec3 wi) {
    const Vec3 o = offset_origin(from.p, from.p_error, from.ng, wi);
    const Vec3 d = target - o;
    if (d == Vec3{} || !is_finite(d)) return std::nullopt;
    return Ray{o, 0, d, kShadowRayEnd};
}

/// Towards a point of an emitting surface with normal n. The target is moved off the surface as the origin is off its
/// own. What is left is the rounding of d, which matters for rays that graze the light: so the ray ends where, with the
/// direction it really has, it would reach the tangent plane in that point, if that comes first.
inline std::optional<Ray> shadow_ray_to_surface(const SurfacePoint& from, const EmitterSample& target, Vec3 wi) {
    const Vec3 p = static_cast<Vec3>(target.p);
    std::optional<Ray> ray =
        shadow_ray_to_point(from, offset_origin(p, target.p_error, static_cast<Vec3>(target.n), -wi), wi);
    if (!ray) return std::nullopt;
    const double reach = dot(target.n, target.p - Vec3d(ray->o)) / dot(target.n, Vec3d(ray->d));
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

/// Intensity over the square of the distance. Nothing when that is black or too much for a float.
inline std::optional<LightSample> delta_sample(const SurfacePoint& from, Vec3 position, Rgb intensity,
                                               const Towards& towards) {
    const double falloff = 1 / (towards.distance * towards.distance);
    const Rgb arriving{static_cast<float>(intensity.r * falloff), static_cast<float>(intensity.g * falloff),
                       static_cast<float>(intensity.b * falloff)};
    const std::optional<Ray> ray = shadow_ray_to_point(from, position, towards.wi);
    if (is_black(arriving) || !is_finite(arriving) || !ray) return std::nullopt;
    return LightSample{towards.wi, arriving, 0, *ray};
}

}  // namespace steradian
