#pragma once

#include "shading/light/light_kind.h"

namespace steradian {

inline uint32_t samples_wanted(const SpotLight&) { return 1; }

/// From 0 at the outer cone to 1 at the inner one, in the cosine of the angle; a step where both are one.
inline double spot_falloff(SpotFalloff kind, double cosine, double cos_inner, double cos_outer) {
    if (cosine >= cos_inner) return 1;
    if (cosine <= cos_outer) return 0;
    const double x = (cosine - cos_outer) / (cos_inner - cos_outer);
    return kind == SpotFalloff::squared ? x * x : x * x * (3 - 2 * x);
}

inline std::optional<LightSample> sample_kind(const SpotLight& light, const LightContext& context,
                                              const SurfacePoint& from, uint32_t, Vec2) {
    const auto towards = Towards::from_to(from.p, light.position);
    if (!towards) return std::nullopt;
    const ShadingScene::LightData& data = context.data();
    const Vec3d away = normalize(Vec3d(from.p) - Vec3d(light.position));
    const double falloff = spot_falloff(light.falloff, dot(away, data.direction), data.cos_inner, data.cos_outer);
    return delta_sample(from, light.position, light.intensity * static_cast<float>(falloff), *towards);
}

inline double pdf_kind(const SpotLight&, const LightContext&, const SurfacePoint&, Vec3, const SurfacePoint*) {
    return 0;
}

}  // namespace steradian
