// Refraction that loses nothing: what a thin lens of a teaching renderer does.
#pragma once

#include "shading/bsdf/specular.h"

namespace steradian {

inline RefractionBsdf make_lobe(const RefractionMaterial& material, const LobeContext&) { return {material.eta}; }

inline bool lobe_is_specular(const RefractionBsdf&) { return true; }

inline BsdfEval eval_lobe(const RefractionBsdf&, const LobeGeometry&, Vec3, Vec3) { return {}; }

inline std::optional<BsdfSample> sample_lobe(const RefractionBsdf& lobe, const LobeGeometry& g, Vec3 wo, float, Vec2) {
    const auto surface = Interface::seen_from(g, wo);
    if (!surface) return std::nullopt;
    const double eta = surface->outside ? lobe.eta : 1 / static_cast<double>(lobe.eta);
    if (const auto wi = surface->refracted(wo, eta)) return specular_sample(*wi, {1, 1, 1}, true);
    return specular_sample(surface->reflected(wo), {1, 1, 1}, false);
}

}  // namespace steradian
