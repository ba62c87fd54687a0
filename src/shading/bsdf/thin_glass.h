// A thin sheet of glass, both of whose surfaces are one: what bounces inside it leaves at the same place, and what
// passes goes straight on.
#pragma once

#include "shading/bsdf/specular.h"

namespace steradian {

inline ThinGlassBsdf make_lobe(const ThinGlassMaterial& material, const LobeContext&) {
    return {material.eta, material.transmittance};
}

inline bool lobe_is_specular(const ThinGlassBsdf&) { return true; }

inline BsdfEval eval_lobe(const ThinGlassBsdf&, const LobeGeometry&, Vec3, Vec3) { return {}; }

/// With R of one surface and t once through: reflected R + (1 - R)² R t² (1 + R² t² + …), passed (1 - R)² t (1 + R² t²
/// + …). The choice is that of clear glass, 2R / (1 + R), and the weights make up for the tint.
inline std::optional<BsdfSample> sample_lobe(const ThinGlassBsdf& lobe, const LobeGeometry& g, Vec3 wo, float uc,
                                             Vec2) {
    const auto surface = Interface::seen_from(g, wo);
    if (!surface) return std::nullopt;
    // Below 1 the sheet is a film of air, which is symmetric as well.
    const double cosine = dot(Vec3d(wo), surface->ns), eta = lobe.eta;
    const double r = fresnel_dielectric(cosine, eta), reflects = 2 * r / (1 + r);
    Rgb reflected, passed;
    for (int c = 0; c < 3; ++c) {
        const double t = lobe.transmittance[c], series = r < 1 ? (1 - r) * (1 - r) / (1 - r * r * t * t) : 0;
        reflected[c] = static_cast<float>((r + series * r * t * t) / reflects);
        passed[c] = static_cast<float>(series * t / (1 - reflects));
    }
    if (uc < static_cast<float>(reflects)) return specular_sample(surface->reflected(wo), reflected, false);
    return specular_sample(-Vec3d(wo), passed, true);
}

}  // namespace steradian
