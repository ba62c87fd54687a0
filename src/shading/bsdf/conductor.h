// Metal: one bounce off a microfacet by Cook & Torrance with GGX (ggx.h), all further bounces by a second, wide lobe
// that gives back exactly what the first one loses (Kulla & Conty 2017). Both are reciprocal.
#pragma once

#include "shading/bsdf/local.h"
#include "shading/bsdf/specular.h"
#include "shading/texture.h"
#include "shading/thin_film.h"

namespace steradian {

inline ConductorBsdf make_lobe(const ConductorMaterial& material, const LobeContext& context) {
    const auto read = [&](TextureId id) { return eval_texture(context.scene, id, context.point); };
    ConductorBsdf out;
    if (const auto* complex = std::get_if<ComplexIndex>(&material.reflectance)) {
        out.fresnel = *complex;
        out.mean_fresnel = context.material.mean_fresnel;
    } else {
        const auto& schlick = std::get<SchlickReflectance>(material.reflectance);
        const ConductorBsdf::Schlick colors{eval_color(context.scene, schlick.normal, context.point), schlick.grazing};
        out.fresnel = colors;
        out.mean_fresnel = mean_fresnel_schlick(colors.normal, colors.grazing);
    }
    out.facets = microfacets(material.roughness, material.roughness.texture ? read(*material.roughness.texture).r : 1);
    out.energy = context.material.energy.get();
    out.tint = material.tint;
    return out;
}

inline bool lobe_is_specular(const ConductorBsdf& lobe) { return lobe.facets.smooth(); }
inline bool lobe_only_reflects(const ConductorBsdf&) { return true; }
inline bool lobe_has_direction(const ConductorBsdf& lobe) { return lobe.facets.alpha_x != lobe.facets.alpha_y; }

inline Rgb fresnel(const ConductorBsdf& lobe, double cosine) {
    if (const auto* complex = std::get_if<ComplexIndex>(&lobe.fresnel)) return fresnel_conductor(cosine, *complex);
    const auto& schlick = std::get<ConductorBsdf::Schlick>(lobe.fresnel);
    const double mu = clamp_to(cosine, 0.0, 1.0), m2 = (1 - mu) * (1 - mu);
    const Rgb f = fresnel_schlick(mu, schlick.normal, schlick.grazing);
    const auto dip = static_cast<float>(mu * m2 * m2 * m2);
    const Rgb bare{max_of(f.r - schlick.dip.r * dip, 0.0f), max_of(f.g - schlick.dip.g * dip, 0.0f),
                   max_of(f.b - schlick.dip.b * dip, 0.0f)};
    if (!lobe.films) return bare;
    const Rgb under_film = lobe.films->reflectance(mu, schlick.normal, lobe.film.thickness);
    return bare * (1 - lobe.film.weight) + under_film * lobe.film.weight;
}

/// What part of the light leaves after more than one bounce when facets reflect all of it: also the probability of
/// sampling the wide lobe.
inline double multiple_bounces(const ConductorBsdf& lobe, Vec3d wo) {
    return lobe.energy ? lobe.energy->loss(lobe.facets, wo) : 0;
}

/// The colour of the wide lobe: a geometric series of bounces, each of which leaves the surface or, with the
/// probability `mean_loss`, meets it again (Jakob et al. 2014, as in Kulla & Conty).
inline Rgb multiple_bounce_color(Rgb mean_fresnel, double mean_loss) {
    Rgb out;
    for (int c = 0; c < 3; ++c) {
        const double f = mean_fresnel[c];
        out[c] = static_cast<float>(f * f * (1 - mean_loss) / max_of(1 - f * mean_loss, 1e-6));
    }
    return out;
}

inline LocalEval eval_local(const ConductorBsdf& lobe, Vec3d wo, Vec3d wi, bool) {
    if (!(wi.z > 0)) return {};
    const Ggx ggx = lobe.facets.ggx();
    const Vec3d h = normalize(wo + wi);
    const double d = ggx.density(h), lost = multiple_bounces(lobe, wo);
    LocalEval out{lobe.tint * fresnel(lobe, dot(wo, h)) * static_cast<float>(d * ggx.masking_over_cosine(wo, wi) / 4),
                  (1 - lost) * d * ggx.visible_over_projected(wo) / 4};
    if (!(lost > 0)) return out;
    const double mean = lobe.energy->mean_loss(lobe.facets);
    const double wide = lost * multiple_bounces(lobe, wi) / mean * wi.z / std::numbers::pi;
    out.f_cos = out.f_cos + lobe.tint * multiple_bounce_color(lobe.mean_fresnel, mean) * static_cast<float>(wide);
    out.pdf += lost * WideLobe(lobe.facets).pdf(wi.z);
    return out;
}

inline std::optional<Vec3d> sample_local(const ConductorBsdf& lobe, Vec3d wo, bool, float uc, Vec2 u) {
    if (uc < multiple_bounces(lobe, wo)) return WideLobe(lobe.facets).sample(u);
    return reflect(wo, lobe.facets.ggx().sample_visible(wo, u));
}

inline BsdfEval eval_lobe(const ConductorBsdf& lobe, const LobeGeometry& g, Vec3 wo, Vec3 wi) {
    return lobe.facets.smooth() ? BsdfEval{} : eval_by_frame(lobe, g, wo, wi);
}

inline std::optional<BsdfSample> sample_lobe(const ConductorBsdf& lobe, const LobeGeometry& g, Vec3 wo, float uc,
                                             Vec2 u) {
    if (!lobe.facets.smooth()) return sample_by_frame(lobe, g, wo, uc, u);
    const auto surface = Interface::seen_from(g, wo);
    if (!surface) return std::nullopt;
    const Vec3d wi = surface->reflected(wo);
    // Whichever normal it was reflected about, the angle to it is half of that between the directions.
    const double cosine = std::sqrt(clamp_to((1 + dot(Vec3d(wo), wi)) / 2, 0.0, 1.0));
    return specular_sample(wi, lobe.tint * fresnel(lobe, cosine), false);
}

}  // namespace steradian
