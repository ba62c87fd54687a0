// A perfect mirror, on both sides.
#pragma once

#include "shading/bsdf/specular.h"

namespace steradian {

inline MirrorBsdf make_lobe(const MirrorMaterial& material, const LobeContext&) { return {material.reflectance}; }

inline bool lobe_is_specular(const MirrorBsdf&) { return true; }

inline BsdfEval eval_lobe(const MirrorBsdf&, const LobeGeometry&, Vec3, Vec3) { return {}; }

inline std::optional<BsdfSample> sample_lobe(const MirrorBsdf& lobe, const LobeGeometry& g, Vec3 wo, float, Vec2) {
    const auto surface = Interface::seen_from(g, wo);
    if (!surface) return std::nullopt;
    return specular_sample(surface->reflected(wo), lobe.reflectance, false);
}

}  // namespace steradian
