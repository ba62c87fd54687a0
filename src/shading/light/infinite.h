// The environment.
#pragma once

#include "math/warp.h"
#include "shading/environment.h"
#include "shading/light/light_kind.h"

namespace steradian {

inline uint32_t samples_wanted(const EnvironmentLight& light) { return light.samples; }

/// Of a sky with an image.
inline EnvironmentDensity density_at(const EnvironmentTable& table, EnvironmentDensity wanted,
                                     const SurfacePoint& from) {
    return table.at_surface(wanted, from.ns, from.both_sides);
}

/// Of a constant sky: by the cosine about the shading normal, so that a diffuse surface under an open sky has no
/// variance at all; where light from behind counts as well, half of the directions are there. Where there is no
/// surface, all directions are alike.
inline float constant_sky_pdf(const SurfacePoint& from, Vec3 wi) {
    if (from.ns == Vec3{}) return static_cast<float>(1 / (4 * std::numbers::pi));
    const float cosine = dot(wi, from.ns);
    return from.both_sides ? 0.5f * kInvPi * std::fabs(cosine) : kInvPi * max_of(cosine, 0.0f);
}

inline std::optional<LightSample> sample_kind(const EnvironmentLight&, const LightContext& context,
                                              const SurfacePoint& from, uint32_t choice, Vec2 u) {
    const EnvironmentTable& table = *context.scene.environment;
    if (table.empty()) return std::nullopt;
    LightSample out;
    if (table.is_constant()) {
        if (from.ns == Vec3{}) {
            out.wi = static_cast<Vec3>(warp::sphere(u));
        } else {
            Vec3 local = static_cast<Vec3>(warp::cosine_hemisphere(u));
            if (from.both_sides && choice >> 31 != 0) local.z = -local.z;
            out.wi = normalize(Frame::from_z(from.ns).to_world(local));
        }
        out.pdf = constant_sky_pdf(from, out.wi);
    } else {
        const EnvironmentSample at = table.sample(choice, u, density_at(table, context.density, from));
        out.wi = at.direction;
        out.pdf = static_cast<float>(at.pdf);
    }
    out.radiance = table.radiance(context.scene.scene, out.wi);
    if (!(out.pdf > 0) || !is_finite(out.pdf) || is_black(out.radiance)) return std::nullopt;
    out.shadow_ray = shadow_ray_to_infinity(from, out.wi);
    return out;
}

inline double pdf_kind(const EnvironmentLight&, const LightContext& context, const SurfacePoint& from, Vec3 wi,
                       const SurfacePoint* hit) {
    const EnvironmentTable& table = *context.scene.environment;
    if (hit || table.empty()) return 0;
    return table.is_constant() ? constant_sky_pdf(from, wi) : table.pdf(wi, density_at(table, context.density, from));
}

}  // namespace steradian
