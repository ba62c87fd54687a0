// Lambert's law.
#pragma once

#include "math/warp.h"
#include "shading/bsdf/lobe.h"
#include "shading/texture.h"

namespace steradian {

inline DiffuseBsdf make_lobe(const DiffuseMaterial& material, const LobeContext& context) {
    return {eval_texture(context.scene.scene, material.reflectance, context.point.uv), material.two_sided};
}

inline bool lobe_is_specular(const DiffuseBsdf&) { return false; }

/// 1: w is on the front by both normals, -1: on the back by both, 0: they disagree. A direction on which they disagree
/// neither gives nor gets light, so that nothing leaks through a surface whose shading normals are bent.
inline int side_by_both_normals(const LobeGeometry& g, Vec3 w) {
    const float by_shading = dot(w, g.frame.z), by_geometry = dot(w, g.ng);
    if (by_shading > 0 && by_geometry > 0) return 1;
    if (by_shading < 0 && by_geometry < 0) return -1;
    return 0;
}

inline BsdfEval eval_lobe(const DiffuseBsdf& lobe, const LobeGeometry& g, Vec3 wo, Vec3 wi) {
    const int side = side_by_both_normals(g, wo);
    if (side == 0 || (side < 0 && !lobe.two_sided) || side_by_both_normals(g, wi) != side) return {};
    const float density = std::fabs(dot(wi, g.frame.z)) * kInvPi;
    return {lobe.reflectance * density, density};
}

/// By the cosine about the shading normal. Directions that are behind the geometric surface are given up, not redrawn:
/// the density is the cosine's, and integrates to less than 1 where the normals differ.
inline std::optional<BsdfSample> sample_lobe(const DiffuseBsdf& lobe, const LobeGeometry& g, Vec3 wo, float, Vec2 u) {
    const int side = side_by_both_normals(g, wo);
    if (side == 0 || (side < 0 && !lobe.two_sided)) return std::nullopt;
    const Vec3 local = static_cast<Vec3>(warp::cosine_hemisphere(u));
    const Vec3 wi = normalize(g.frame.to_world({local.x, local.y, side > 0 ? local.z : -local.z}));
    if (side_by_both_normals(g, wi) != side) return std::nullopt;
    return BsdfSample{wi, lobe.reflectance, std::fabs(dot(wi, g.frame.z)) * kInvPi, false, false};
}

}  // namespace steradian
