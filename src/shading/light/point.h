#pragma once

#include "shading/light/light_kind.h"

namespace steradian {

inline uint32_t samples_wanted(const PointLight&) { return 1; }

inline std::optional<LightSample> sample_kind(const PointLight& light, const LightContext&, const SurfacePoint& from,
                                              uint32_t, Vec2) {
    const auto towards = Towards::from_to(from.p, light.position);
    if (!towards) return std::nullopt;
    return delta_sample(from, light.position, light.intensity, *towards);
}

inline double pdf_kind(const PointLight&, const LightContext&, const SurfacePoint&, Vec3, const SurfacePoint*) {
    return 0;
}

}  // namespace steradian
