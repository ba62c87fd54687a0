// A rough boundary between two dielectrics: one bounce at a microfacet, reflected or refracted (Walter et al. 2007,
// "Microfacet Models for Refraction through Rough Surfaces"), with visible normals and correlated heights (Heitz 2014);
// and a wide lobe for what meets the surface again.
//
// That lobe gives back exactly what the first one loses and is reciprocal. With the loss D(w), its mean D̄
// on each side, and the squared index n² of each side,
//   p(o → i) = D(o) D(i) n_i² cos θ_i / (π (n_o² D̄_o + n_t² D̄_t))
// integrates over both sides to D(o) and is symmetric up to n² cos θ. It divides the light between the sides like
// diffuse light in equilibrium, weighted by how much of it is lost.
#pragma once

#include "shading/bsdf/local.h"
#include "shading/thin_film.h"

namespace steradian {

inline bool lobe_is_specular(const RoughGlassBsdf&) { return false; }
inline bool lobe_has_direction(const RoughGlassBsdf& lobe) { return lobe.facets.alpha_x != lobe.facets.alpha_y; }

/// Of light from outside, at the cosine to a facet. `films`: null for none.
inline Rgb dielectric_reflectance(double cosine, double eta, const FilmOnDielectric* films, const PointFilm& film) {
    if (films && film.weight == 1) return films->reflectance(cosine, film.thickness);
    const auto f = static_cast<float>(fresnel_dielectric(cosine, eta));
    const Rgb bare{f, f, f};
    return films ? bare * (1 - film.weight) + films->reflectance(cosine, film.thickness) * film.weight : bare;
}

/// Of light from outside, at the cosine to a facet.
inline Rgb outside_reflectance(const RoughGlassBsdf& lobe, double cosine) {
    return dielectric_reflectance(cosine, static_cast<double>(lobe.eta), lobe.films, lobe.film);
}

/// With a film, from either side: what it reflects is that of the other side of the refracted light.
inline Rgb film_reflectance(const RoughGlassBsdf& lobe, double cosine, double eta, bool outside) {
    if (outside) return outside_reflectance(lobe, cosine);
    const double squared = 1 - (1 - cosine) * (1 + cosine) / (eta * eta);
    return squared > 0 ? outside_reflectance(lobe, std::sqrt(squared)) : Rgb{1, 1, 1};
}

/// The probability that a facet reflects, and the colours that go with either choice.
struct FacetChoice {
    double reflects = 0;
    Rgb reflected{1, 1, 1}, passed{1, 1, 1};
};
inline FacetChoice facet_choice(const RoughGlassBsdf& lobe, double cosine, double eta, bool outside) {
    if (!lobe.films) return {fresnel_dielectric(cosine, eta)};
    const Rgb r = film_reflectance(lobe, cosine, eta, outside);
    const float mean = (r.r + r.g + r.b) / 3;
    FacetChoice out{static_cast<double>(mean)};
    if (mean > 0) out.reflected = r / mean;
    if (mean < 1) out.passed = (Rgb{1, 1, 1} + r * -1) / (1 - mean);
    return out;
}

/// What the wide lobe needs to know, seen from a side: eta is the index of the far side over that of the near one.
struct RoughGlassLosses {
    double eta = 1, lost = 0;    ///< lost: of the light from wo; also the probability of the wide lobe
    double near = 0, far = 0;    ///< D̄ of the two sides
    double reflected_share = 1;  ///< of the wide lobe
    Side near_side = Side::outside, far_side = Side::inside;
};

inline RoughGlassLosses losses(const RoughGlassBsdf& lobe, Vec3d wo, bool outside) {
    RoughGlassLosses out;
    out.eta = outside ? lobe.eta : 1 / static_cast<double>(lobe.eta);
    if (!outside) std::swap(out.near_side, out.far_side);
    if (!lobe.energy) return out;
    out.near = lobe.energy->mean_loss(lobe.facets, out.near_side, lobe.index_place);
    out.far = lobe.energy->mean_loss(lobe.facets, out.far_side, lobe.index_place);
    const double sum = out.near + out.eta * out.eta * out.far;
    if (!(out.near > 0 && out.far > 0 && sum > 0)) return out;
    out.reflected_share = out.near / sum;
    out.lost = lobe.energy->loss(lobe.facets, wo, out.near_side, lobe.index_place);
    return out;
}

/// The facet that takes wo to wi, on the side of z; nothing where none does.
inline std::optional<Vec3d> facet_between(Vec3d wo, Vec3d wi, double eta) {
    const bool reflected = wi.z > 0;
    const Vec3d sum = wo + wi * (reflected ? 1 : eta);
    const double size = length(sum);
    if (!(size > 0)) return std::nullopt;
    const Vec3d h = sum * ((sum.z < 0 ? -1 : 1) / size);
    const bool possible = dot(wo, h) > 0 && (dot(wi, h) > 0) == reflected;
    return possible ? std::optional(h) : std::nullopt;
}

inline LocalEval eval_local(const RoughGlassBsdf& lobe, Vec3d wo, Vec3d wi, bool outside) {
    const RoughGlassLosses l = losses(lobe, wo, outside);
    const bool reflected = wi.z > 0;
    const Rgb tint = reflected ? lobe.reflectance : lobe.transmittance;
    const double radiance_scale = reflected ? 1 : 1 / (l.eta * l.eta);
    double f_cos = 0, pdf = 0;
    Rgb by_film{};
    if (const auto h = facet_between(wo, wi, l.eta)) {
        const Ggx ggx = lobe.facets.ggx();
        const double oh = dot(wo, *h), ih = dot(wi, *h);
        const FacetChoice choice = facet_choice(lobe, oh, l.eta, outside);
        // The solid angle of facets for that of wi, times o · h: Walter et al., equations 14 and 17.
        const double denominator = ih + oh / l.eta;
        const double jacobian = reflected ? 0.25 : oh * -ih / (denominator * denominator);
        const double facets = (reflected ? choice.reflects : 1 - choice.reflects) * ggx.density(*h) * jacobian;
        f_cos = facets * ggx.masking_over_cosine(wo, wi);
        pdf = (1 - l.lost) * facets * ggx.visible_over_projected(wo);
        if (lobe.films) {
            by_film = (reflected ? choice.reflected : choice.passed) * static_cast<float>(f_cos * radiance_scale);
            f_cos = 0;
        }
    }
    if (l.lost > 0) {
        const double share = reflected ? l.reflected_share : 1 - l.reflected_share;
        const double cosine = std::fabs(wi.z);
        const Side side = reflected ? l.near_side : l.far_side;
        const double from_wi =
            lobe.energy->loss(lobe.facets, {wi.x, wi.y, cosine}, side, lobe.index_place) / (reflected ? l.near : l.far);
        f_cos += l.lost * share * from_wi * cosine / std::numbers::pi;
        pdf += l.lost * share * WideLobe(lobe.facets).pdf(cosine);
    }
    const auto grey = static_cast<float>(f_cos * radiance_scale);
    return {lobe.films ? tint * (Rgb{grey, grey, grey} + by_film) : tint * grey, pdf, radiance_scale};
}

inline std::optional<Vec3d> sample_local(const RoughGlassBsdf& lobe, Vec3d wo, bool outside, float uc, Vec2 u) {
    const RoughGlassLosses l = losses(lobe, wo, outside);
    if (uc < l.lost) {
        const Vec3d wi = WideLobe(lobe.facets).sample(u);
        return uc < l.lost * l.reflected_share ? wi : Vec3d{wi.x, wi.y, -wi.z};
    }
    const Vec3d h = lobe.facets.ggx().sample_visible(wo, u);
    if ((uc - l.lost) / (1 - l.lost) < facet_choice(lobe, dot(wo, h), l.eta, outside).reflects) {
        const Vec3d wi = reflect(wo, h);
        return wi.z > 0 ? std::optional(wi) : std::nullopt;
    }
    const std::optional<Vec3d> wi = refract(wo, h, l.eta);
    return wi && wi->z < 0 ? wi : std::nullopt;
}

inline BsdfEval eval_lobe(const RoughGlassBsdf& lobe, const LobeGeometry& g, Vec3 wo, Vec3 wi) {
    return eval_by_frame(lobe, g, wo, wi);
}

inline std::optional<BsdfSample> sample_lobe(const RoughGlassBsdf& lobe, const LobeGeometry& g, Vec3 wo, float uc,
                                             Vec2 u) {
    return sample_by_frame(lobe, g, wo, uc, u);
}

}  // namespace steradian
