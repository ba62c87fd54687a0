#pragma once

#include "shading/light/light_kind.h"

namespace steradian {

inline uint32_t samples_wanted(const DirectionalLight&) { return 1; }

inline std::optional<LightSample> sample_kind(const DirectionalLight& light, const LightContext& context,
                                              const SurfacePoint& from, uint32_t, Vec2) {
    if (is_black(light.irradiance)) return std::nullopt;
    const Vec3 wi = static_cast<Vec3>(-context.data().direction);
    return LightSample{wi, light.irradiance, 0, shadow_ray_to_infinity(from, wi)};
}

inline double pdf_kind(const DirectionalLight&, const LightContext&, const SurfacePoint&, Vec3, const SurfacePoint*) {
    return 0;
}

}  // namespace steradian
