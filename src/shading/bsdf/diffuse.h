// Lambert's law, and with a roughness the energy-preserving model of Oren and Nayar: J. Portsmouth, P. Kutz and S.
// Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", 2025. In it r is the roughness, A = 1 / (1 + (1/2 -
// 2/3π) r).
#pragma once

#include "math/warp.h"
#include "shading/bsdf/lobe.h"
#include "shading/texture.h"

namespace steradian {

inline DiffuseBsdf make_lobe(const DiffuseMaterial& material, const LobeContext& context) {
    return {eval_color(context.scene, material.reflectance, context.point), material.two_sided, material.roughness};
}

inline bool lobe_is_specular(const DiffuseBsdf&) { return false; }
inline bool lobe_only_reflects(const DiffuseBsdf&) { return true; }

/// 1: w is on the front by both normals, -1: on the back by both, 0: they disagree. A direction on which they disagree
/// neither gives nor gets light, so that nothing leaks through a surface whose shading normals are bent.
inline int side_by_both_normals(const LobeGeometry& g, Vec3 w) {
    const float by_shading = dot(w, g.frame.z), by_geometry = dot(w, g.ng);
    if (by_shading > 0 && by_geometry > 0) return 1;
    if (by_shading < 0 && by_geometry < 0) return -1;
    return 0;
}

struct RoughDiffuse {
    double r, a;
    explicit RoughDiffuse(float roughness) : r(roughness), a(1 / (1 + (0.5 - 2 / (3 * std::numbers::pi)) * r)) {}

    /// What a white surface reflects after one bounce of light at the cosine mu (section 3: Ê of Fujii's model).
    double albedo(double mu) const {
        const double c = min_of(mu, 1.0), s = std::sqrt((1 - c) * (1 + c)), theta = math::atan2(s, c);
        // tan θ (1 - sin³ θ), without its pole.
        const double tail = s * c * (1 + s + s * s) / (1 + s);
        const double g = s * (theta - s * c) + 2.0 / 3 * (tail - s);
        return a * (1 + r * g / std::numbers::pi);
    }
    double mean_albedo() const { return a * (1 + (2.0 / 3 - 28 / (15 * std::numbers::pi)) * r); }

    /// π f for one reflectance; s = o · i - cos θ_o cos θ_i.
    double pi_f(double reflectance, double mu_o, double mu_i, double s, double lost) const {
        const double once =
            a * max_of(1 + r * (s > 0 ? s / max_of(mu_o, mu_i) : s), 0.0);  // 0 at r = 1 but for rounding
        const double mean = mean_albedo();
        const double more = reflectance * mean / max_of(1 - reflectance * (1 - mean), 1e-6);
        return reflectance * (once + more * lost / (1 - mean));
    }
};

/// How much of the sampling is uniform over the hemisphere: at grazing angles the rough surface is bright where the
/// cosine is small.
inline double uniform_share(const DiffuseBsdf& lobe, double mu_o) { return 0.5 * lobe.roughness * (1 - mu_o); }

inline BsdfEval eval_rough_diffuse(const DiffuseBsdf& lobe, const LobeGeometry& g, Vec3 wo, Vec3 wi) {
    const Vec3d o = wo, i = wi, n = g.frame.z;
    const double mu_o = min_of(std::fabs(dot(o, n)), 1.0), mu_i = min_of(std::fabs(dot(i, n)), 1.0);
    const RoughDiffuse model(lobe.roughness);
    const double s = dot(o, i) - mu_o * mu_i, lost = (1 - model.albedo(mu_o)) * (1 - model.albedo(mu_i));
    BsdfEval out;
    for (int c = 0; c < 3; ++c)
        out.f_cos[c] =
            static_cast<float>(model.pi_f(lobe.reflectance[c], mu_o, mu_i, s, lost) * mu_i / std::numbers::pi);
    const double share = uniform_share(lobe, mu_o);
    out.diffuse = out.f_cos;
    out.pdf = static_cast<float>((1 - share) * mu_i / std::numbers::pi + share * warp::kHemispherePdf);
    return out;
}

inline BsdfEval eval_lobe(const DiffuseBsdf& lobe, const LobeGeometry& g, Vec3 wo, Vec3 wi) {
    const int side = side_by_both_normals(g, wo);
    if (side == 0 || (side < 0 && !lobe.two_sided) || side_by_both_normals(g, wi) != side) return {};
    if (lobe.roughness > 0) return eval_rough_diffuse(lobe, g, wo, wi);
    const float density = std::fabs(dot(wi, g.frame.z)) * kInvPi;
    const Rgb f_cos = lobe.reflectance * density;
    return {f_cos, density, f_cos};
}

/// By the cosine about the shading normal. Directions that are behind the geometric surface are given up, not redrawn:
/// the density is the cosine's, and integrates to less than 1 where the normals differ.
inline std::optional<BsdfSample> sample_lobe(const DiffuseBsdf& lobe, const LobeGeometry& g, Vec3 wo, float uc,
                                             Vec2 u) {
    const int side = side_by_both_normals(g, wo);
    if (side == 0 || (side < 0 && !lobe.two_sided)) return std::nullopt;
    const bool uniform = uc < uniform_share(lobe, min_of(std::fabs(dot(wo, g.frame.z)), 1.0f));
    const Vec3 local = static_cast<Vec3>(uniform ? warp::hemisphere(u) : warp::cosine_hemisphere(u));
    const Vec3 wi = normalize(g.frame.to_world({local.x, local.y, side > 0 ? local.z : -local.z}));
    if (side_by_both_normals(g, wi) != side) return std::nullopt;
    if (lobe.roughness > 0) {
        const BsdfEval e = eval_rough_diffuse(lobe, g, wo, wi);
        if (!(e.pdf > 0)) return std::nullopt;
        return BsdfSample{wi, e.f_cos / e.pdf, e.pdf, false, false};
    }
    return BsdfSample{wi, lobe.reflectance, std::fabs(dot(wi, g.frame.z)) * kInvPi, false, false};
}

}  // namespace steradian
