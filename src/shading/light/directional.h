#pragma once

#include "math/warp.h"
#include "shading/light/light_kind.h"

namespace steradian {

inline uint32_t samples_wanted(const DirectionalLight&) { return 1; }

/// 1 - cos of the angle between two unit vectors, without cancellation.
inline double one_minus_cos_between(Vec3d a, Vec3d b) {
    const Vec3d d = a - b;
    return dot(d, d) / 2;
}

/// Of a disc in the sky, along a ray of direction d.
inline Rgb disc_radiance(const ShadingScene::LightData& data, Vec3 d) {
    return one_minus_cos_between(d, -data.direction) <= data.one_minus_cos ? data.radiance : Rgb{};
}

inline std::optional<LightSample> sample_kind(const DirectionalLight& light, const LightContext& context,
                                              const SurfacePoint& from, uint32_t, Vec2 u) {
    if (is_black(light.irradiance)) return std::nullopt;
    const ShadingScene::LightData& data = context.data();
    if (data.one_minus_cos == 0) {
        const Vec3 wi = static_cast<Vec3>(-data.direction);
        return LightSample{wi, light.irradiance, 0, shadow_ray_to_infinity(from, wi)};
    }
    const Vec3d direction = Frame3d::from_z(-data.direction).to_world(warp::cone(u, data.one_minus_cos));
    const Vec3 wi = static_cast<Vec3>(normalize(direction));
    const auto pdf = static_cast<float>(warp::cone_pdf(data.one_minus_cos));
    return LightSample{wi, data.radiance, pdf, shadow_ray_to_infinity(from, wi)};
}

inline double pdf_kind(const DirectionalLight& light, const LightContext& context, const SurfacePoint&, Vec3 wi,
                       const SurfacePoint* hit) {
    const ShadingScene::LightData& data = context.data();
    if (hit || data.one_minus_cos == 0 || is_black(light.irradiance) || is_black(disc_radiance(data, wi))) return 0;
    return warp::cone_pdf(data.one_minus_cos);
}

}  // namespace steradian
