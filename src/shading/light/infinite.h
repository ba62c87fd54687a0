// The environment.
#pragma once

#include "math/warp.h"
#include "shading/environment.h"
#include "shading/light/light_kind.h"

namespace steradian {

inline uint32_t samples_wanted(const EnvironmentLight& light) { return light.samples; }

/// Constant: by the cosine about the shading normal, so that a diffuse surface under an open sky has no variance at
/// all.
inline std::optional<LightSample> sample_kind(const EnvironmentLight&, const LightContext& context,
                                              const SurfacePoint& from, uint32_t choice, Vec2 u) {
    const EnvironmentTable& table = *context.scene.environment;
    if (table.empty()) return std::nullopt;
    LightSample out;
    if (table.is_constant()) {
        const Vec3 local = static_cast<Vec3>(warp::cosine_hemisphere(u));
        out.wi = normalize(Frame::from_z(from.ns).to_world(local));
        out.pdf = dot(out.wi, from.ns) * kInvPi;
    } else {
        const EnvironmentSample at = table.sample(choice, u);
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
    return table.is_constant() ? max_of(dot(wi, from.ns), 0.0f) * kInvPi : table.pdf(wi);
}

}  // namespace steradian
