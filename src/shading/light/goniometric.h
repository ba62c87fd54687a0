#pragma once

#include "math/elementary.h"
#include "scene/intensity_profile.h"
#include "shading/light/light_kind.h"

namespace steradian {

inline uint32_t samples_wanted(const GoniometricLight&) { return 1; }

/// Candela into a direction `away` from the light (unit).
inline double candela_towards(const IntensityProfile& profile, const LightAxes& axes, Vec3d away) {
    constexpr double kDegrees = 180 / std::numbers::pi;
    const double x = dot(away, axes.zero), y = dot(away, axes.quarter), z = dot(away, axes.down);
    const double vertical = math::atan2(std::sqrt(x * x + y * y), z) * kDegrees;
    if (profile.horizontal.size() == 1) return intensity_at(profile, vertical, 0);
    const double horizontal = math::atan2(y, x) * kDegrees;
    return intensity_at(profile, vertical, horizontal < 0 ? horizontal + 360 : horizontal);
}

inline std::optional<LightSample> sample_kind(const GoniometricLight& light, const LightContext& context,
                                              const SurfacePoint& from, uint32_t, Vec2) {
    const auto towards = Towards::from_to(from.p, light.position);
    if (!towards) return std::nullopt;
    const Vec3d away = normalize(Vec3d(from.p) - Vec3d(light.position));
    const IntensityProfile& profile = context.scene.scene.profiles[index(light.profile)];
    const double candela = candela_towards(profile, context.data().axes, away);
    return delta_sample(from, light.position, light.intensity * static_cast<float>(candela), *towards);
}

inline double pdf_kind(const GoniometricLight&, const LightContext&, const SurfacePoint&, Vec3, const SurfacePoint*) {
    return 0;
}

}  // namespace steradian
