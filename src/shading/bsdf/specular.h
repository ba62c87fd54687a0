// Perfect reflection and refraction about a shading normal, without leaving to the wrong side of the surface.
#pragma once

#include "shading/bsdf/lobe.h"

namespace steradian {

/// wo + wi = 2 (wo · n) n.
inline Vec3d reflect(Vec3d wo, Vec3d n) { return n * (2 * dot(wo, n)) - wo; }

/// Snell's law, eta = index on the far side over index on the side of wo; n on the side of wo, both unit vectors.
/// Nothing for total internal reflection.
inline std::optional<Vec3d> refract(Vec3d wo, Vec3d n, double eta) {
    const double cos_o = dot(wo, n);
    const double cos2_t = 1 - (1 - cos_o) * (1 + cos_o) / (eta * eta);
    if (!(cos2_t > 0)) return std::nullopt;
    return wo * (-1 / eta) + n * (cos_o / eta - std::sqrt(cos2_t));
}

/// The side that wo is on and the normals as seen from there. Which medium that is is decided by the geometric normal;
/// the shading normal is used for directions where it agrees about the side, otherwise the geometric one takes its
/// place.
struct Interface {
    Vec3d ng, ns;         ///< both on the side of wo
    bool outside = true;  ///< wo is outside

    /// Nothing when wo lies in the surface.
    static std::optional<Interface> seen_from(const LobeGeometry& g, Vec3 wo) {
        const Vec3d w = wo, n = g.ng, s = g.frame.z;
        const double side = dot(w, n);
        if (side == 0) return std::nullopt;
        const double sign = side > 0 ? 1 : -1;
        return Interface{n * sign, dot(w, s) * sign > 0 ? s * sign : n * sign, side > 0};
    }

    /// About ns, or about ng where that would go below the surface.
    Vec3d reflected(Vec3 wo) const {
        const Vec3d wi = reflect(wo, ns);
        return dot(wi, ng) > 0 ? wi : reflect(wo, ng);
    }

    /// About ns, or about ng where that would stay above the surface; nothing for total internal reflection.
    std::optional<Vec3d> refracted(Vec3 wo, double eta) const {
        const std::optional<Vec3d> wi = refract(wo, ns, eta);
        return !wi || dot(*wi, ng) < 0 ? wi : refract(wo, ng, eta);
    }
};

inline BsdfSample specular_sample(Vec3d wi, Rgb weight, bool transmitted) {
    return {static_cast<Vec3>(normalize(wi)), weight, 0, true, transmitted};
}

}  // namespace steradian
