// A thin sheet that scatters light to both sides by Lambert's law: leaves, paper, lampshades. Of what arrives, the
// reflectance goes back and the transmittance through, whichever side it comes from.
#pragma once

#include "shading/bsdf/diffuse.h"

namespace steradian {

inline DiffuseTransmissionBsdf make_lobe(const DiffuseTransmissionMaterial& material, const LobeContext& context) {
    const auto read = [&](TextureId id) { return eval_color(context.scene, id, context.point); };
    return {read(material.reflectance), read(material.transmittance)};
}

inline bool lobe_is_specular(const DiffuseTransmissionBsdf&) { return false; }

/// The probability of sampling a reflection.
inline float reflected_share(const DiffuseTransmissionBsdf& lobe) {
    const float r = max_component(lobe.reflectance), t = max_component(lobe.transmittance);
    return r + t > 0 ? r / (r + t) : 1;
}

inline BsdfEval eval_lobe(const DiffuseTransmissionBsdf& lobe, const LobeGeometry& g, Vec3 wo, Vec3 wi) {
    const int from = side_by_both_normals(g, wo), to = side_by_both_normals(g, wi);
    if (from == 0 || to == 0) return {};
    const float density = std::fabs(dot(wi, g.frame.z)) * kInvPi, share = reflected_share(lobe);
    const Rgb f_cos = (from == to ? lobe.reflectance : lobe.transmittance) * density;
    return {f_cos, (from == to ? share : 1 - share) * density, f_cos};
}

inline std::optional<BsdfSample> sample_lobe(const DiffuseTransmissionBsdf& lobe, const LobeGeometry& g, Vec3 wo,
                                             float uc, Vec2 u) {
    const int from = side_by_both_normals(g, wo);
    if (from == 0) return std::nullopt;
    const bool reflects = uc < reflected_share(lobe);
    const Vec3 local = static_cast<Vec3>(warp::cosine_hemisphere(u));
    const bool up = (from > 0) == reflects;
    const Vec3 wi = normalize(g.frame.to_world({local.x, local.y, up ? local.z : -local.z}));
    const BsdfEval e = eval_lobe(lobe, g, wo, wi);
    if (!(e.pdf > 0)) return std::nullopt;
    return BsdfSample{wi, e.f_cos / e.pdf, e.pdf, false, !reflects};
}

}  // namespace steradian
