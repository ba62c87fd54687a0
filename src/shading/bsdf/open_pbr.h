// OpenPBR Surface 1.1 (Academy Software Foundation): a base that is metal, glass or matte under a dielectric boundary,
// below a coat, below fuzz. Every layer lets pass what it does not reflect of the light from wo, by its tabulated
// albedo E: f = f_layer + (1 - E(wo)) f_below. That neither makes nor loses energy; it is not reciprocal.
#pragma once

#include "shading/bsdf/conductor.h"
#include "shading/bsdf/diffuse.h"
#include "shading/bsdf/rough_glass.h"
#include "shading/bsdf/thin_wall.h"
#include "shading/mixture.h"
#include "shading/open_pbr_tables.h"

namespace steradian {

inline Microfacets open_pbr_facets(Vec2 alpha, float level) {
    return {max_of(min_of(alpha.x, 1.0f), kMinAlpha), max_of(min_of(alpha.y, 1.0f), kMinAlpha), level};
}

/// Of the base, where its roughness is that.
inline Microfacets open_pbr_base(const OpenPbrMaterial& m, const OpenPbrTables& tables, float roughness,
                                 float anisotropy) {
    const Vec2 alpha = open_pbr_alpha(roughness, anisotropy, m.specular_grain_shape);
    Microfacets out = open_pbr_facets(alpha, tables.textured ? roughness : 1);
    if (!tables.every_grain) return out;
    out.level = std::sqrt(out.alpha_x);
    out.across = out.alpha_y / out.alpha_x;
    return out;
}

/// Of the coat, where its roughness is that.
inline Microfacets open_pbr_coat(const OpenPbrMaterial& m, const OpenPbrTables& tables, float roughness) {
    return open_pbr_facets(open_pbr_alpha(roughness, m.coat_roughness_anisotropy),
                           tables.coat_textured ? roughness : 1);
}

/// The metal: Schlick's approximation with a dip at 82 degrees ("F82-tint").
inline ConductorBsdf open_pbr_metal(const OpenPbrMaterial& m, Rgb color, Rgb specular_color, Microfacets facets,
                                    const MicrofacetEnergy* energy, const FilmOnMetal* films, PointFilm film) {
    constexpr double kMu = 1.0 / 7, kRest = 6.0 / 7;
    const double schlick = kRest * kRest * kRest * kRest * kRest;
    ConductorBsdf::Schlick f{color, {1, 1, 1}, {}};
    for (int c = 0; c < 3; ++c) {
        const double at_82 = color[c] + (1 - color[c]) * schlick;
        f.dip[c] = static_cast<float>(at_82 * (1 - specular_color[c]) / (kMu * schlick * kRest));
    }
    ConductorBsdf out;
    out.fresnel = f;
    // 2 ∫ μ² (1 - μ)⁶ dμ = 1/126.
    out.mean_fresnel = mean_fresnel_schlick(f.normal, f.grazing) + f.dip * (-1 / 126.0f);
    for (int c = 0; c < 3; ++c) out.mean_fresnel[c] = max_of(out.mean_fresnel[c], 0.0f);
    const float w = m.specular_weight;
    out.tint = {w, w, w};
    out.facets = facets;
    out.energy = energy;
    if (films && film.weight > 0) {
        out.films = films, out.film = film;
        out.mean_fresnel = out.mean_fresnel * (1 - film.weight) + films->mean(color, film.thickness) * film.weight;
    }
    return out;
}

inline PointFilm open_pbr_film(const OpenPbrMaterial& m, const OpenPbrTables& tables, const LobeContext& context) {
    if (m.thin_film_weight.value == 0) return {};
    const FilmThickness& in = m.thin_film_thickness;
    const double t = in.texture ? clamp_to(eval_texture(context.scene, *in.texture, context.point).r, 0.0f, 1.0f) : 1;
    return {eval_input(context.scene, m.thin_film_weight, context.point),
            tables.film.thicknesses.place(in.minimum * (1 - t) + in.maximum * t)};
}

/// By how much the base is darker because the coat sends light back to it (section "Coat darkening"): with K the part
/// that the coat reflects from inside and E what the base reflects, (1 - K) / (1 - E K).
inline Rgb coat_darkening(const OpenPbrMaterial& m, const OpenPbrTables& tables, Rgb albedo, float base_roughness) {
    const double k_smooth = tables.coat_normal_reflectance, k_rough = tables.coat_inner_reflectance;
    const double k = k_smooth + (k_rough - k_smooth) * base_roughness;
    const double share = static_cast<double>(m.coat_weight) * m.coat_darkening;
    Rgb out;
    for (int c = 0; c < 3; ++c) {
        const double dark = (1 - k) / (1 - min_of(static_cast<double>(albedo[c]), 1.0) * k);
        out[c] = static_cast<float>(1 + (dark - 1) * share);
    }
    return out;
}

inline OpenPbrBsdf make_lobe(const OpenPbrMaterial& m, const LobeContext& context) {
    const OpenPbrTables& tables = *context.material.open_pbr;
    const auto color = [&](const ColorInput& in) { return eval_input(context.scene, in, context.point); };
    const auto number = [&](const FloatInput& in) { return eval_input(context.scene, in, context.point); };
    OpenPbrBsdf out;
    out.tables = &tables;
    const Rgb base = color(m.base_color) * m.base_weight;
    const float coat_roughness = number(m.coat_roughness);
    const float roughness = open_pbr_roughness(m, number(m.specular_roughness), coat_roughness);
    const Microfacets facets = open_pbr_base(m, tables, roughness, number(m.specular_roughness_anisotropy));
    out.metalness = number(m.base_metalness);
    out.specular_color = color(m.specular_color);
    out.film = open_pbr_film(m, tables, context);
    out.metal =
        open_pbr_metal(m, base, out.specular_color, facets, tables.metal.get(), tables.film.metal.get(), out.film);
    out.transmission = number(m.transmission_weight);
    const float own = tables.glass_index.at(context.wavelength);
    float eta = relative_index(own, context);
    if (!refracts_visibly(eta)) eta = kLeastVisibleIndex;
    out.glass = {eta,
                 out.specular_color,
                 color(m.transmission_color),
                 facets,
                 energy_of_boundary(context, tables.glass),
                 tables.glass_index.range().place(own),
                 out.film.weight > 0 ? tables.film.glass.get() : nullptr,
                 out.film};
    out.diffuse = base;
    out.diffuse_roughness = m.base_diffuse_roughness;
    out.subsurface = number(m.subsurface_weight);
    out.subsurface_color = color(m.subsurface_color);
    out.thin_walled = m.geometry_thin_walled;
    if (out.thin_walled) out.passed_share = (1 + m.subsurface_scatter_anisotropy) / 2;
    out.coat_weight = m.coat_weight;
    out.coat_color = color(m.coat_color);
    if (tables.coat) {
        out.coat = open_pbr_coat(m, tables, coat_roughness);
        const double spec = 1 - tables.dielectric->mean_loss(facets);
        const float t = out.transmission, s = out.subsurface;
        Rgb albedo;
        for (int c = 0; c < 3; ++c) {
            const double matte = spec + (1 - spec) * ((1 - s) * base[c] + s * out.subsurface_color[c]);
            const double dielectric = (1 - t) * matte + t;
            albedo[c] = static_cast<float>(dielectric + (out.metal.mean_fresnel[c] - dielectric) * out.metalness);
        }
        const float matte = 1 + (roughness - 1) * t;
        out.darkening = coat_darkening(m, tables, albedo, matte + (roughness - matte) * out.metalness);
    }
    out.fuzz_weight = number(m.fuzz_weight);
    out.fuzz_color = color(m.fuzz_color);
    out.fuzz_roughness = number(m.fuzz_roughness);
    return out;
}

inline bool lobe_is_specular(const OpenPbrBsdf&) { return false; }
inline bool lobe_only_reflects(const OpenPbrBsdf& lobe) {
    if (lobe.coat_apart) return false;
    const bool passes = lobe.transmission > 0 || (lobe.passed_share > 0 && lobe.subsurface > 0);
    return !passes || lobe.metalness == 1;
}
inline bool lobe_has_direction(const OpenPbrBsdf& lobe) {
    return lobe.metal.facets.alpha_x != lobe.metal.facets.alpha_y || lobe.coat.alpha_x != lobe.coat.alpha_y;
}

/// What is left for each lobe of the light from wo, as a factor of the lobe; and with what probability it is sampled.
/// Seen from the coat's frame wo is wo_coat.
struct OpenPbrShares {
    double fuzz = 0, coat = 0, metal = 0, dielectric = 0, diffuse = 0, glass = 0;
    double p_fuzz = 0, p_coat = 0, p_metal = 0, p_dielectric = 0, p_diffuse = 0, p_glass = 0, p_through = 0;
    Rgb diffuse_tint{1, 1, 1};  ///< by a film: what it lets pass, over its mean

    OpenPbrShares(const OpenPbrBsdf& lobe, Vec3d wo, Vec3d wo_coat) {
        const OpenPbrTables& t = *lobe.tables;
        double left = 1;
        fuzz = left * lobe.fuzz_weight;
        if (t.fuzz) {
            const double albedo = t.fuzz->albedo(lobe.fuzz_roughness, wo.z);
            p_fuzz = fuzz * albedo;
            left -= p_fuzz;
        }
        coat = left * lobe.coat_weight;
        if (t.coat) {
            p_coat = coat * (1 - t.coat->loss(lobe.coat, wo_coat));
            left -= p_coat;
        }
        metal = left * lobe.metalness;
        left -= metal;
        glass = left * lobe.transmission;
        dielectric = left - glass;
        const double below = passed(lobe, wo);
        diffuse = dielectric * below;
        p_metal = metal * max_component(lobe.metal.mean_fresnel * lobe.metal.tint);
        p_glass = glass;
        p_dielectric = dielectric * (1 - below) * max_component(lobe.specular_color);
        const double scattered = lobe.subsurface * max_component(lobe.subsurface_color);
        p_through = diffuse * lobe.passed_share * scattered;
        p_diffuse = diffuse * ((1 - lobe.subsurface) * max_component(lobe.diffuse) + scattered) - p_through;
        const double sum = p_fuzz + p_coat + p_metal + p_dielectric + p_diffuse + p_through + p_glass;
        const double scale = sum > 0 ? 1 / sum : 0;
        for (double* p : {&p_fuzz, &p_coat, &p_metal, &p_dielectric, &p_diffuse, &p_through, &p_glass}) *p *= scale;
    }

private:
    /// What passes the dielectric boundary, with a film the mean over the channels. That is linear in what facets
    /// reflect, so it is interpolated with the weights that those colours have, and nothing is gained or lost by that.
    double passed(const OpenPbrBsdf& lobe, Vec3d wo) {
        const OpenPbrTables& t = *lobe.tables;
        const Microfacets& facets = lobe.metal.facets;
        const double weight = t.film.dielectric ? lobe.film.weight : 0;
        const double bare = weight < 1 ? t.dielectric->loss(facets, wo) : 0;
        if (weight == 0) return bare;
        const double f = lobe.film.thickness.f;
        Vec3d loss[2];
        t.film.energy->losses(facets, wo, lobe.film.thickness.first, {loss, f > 0 ? 2u : 1u});
        const Vec3d film = loss[0] * (1 - f) + loss[1] * f;
        const double r = bare + (film.x - bare) * weight, g = bare + (film.y - bare) * weight,
                     b = bare + (film.z - bare) * weight, mean = (r + g + b) / 3;
        if (mean > 0)
            diffuse_tint = {static_cast<float>(r / mean), static_cast<float>(g / mean), static_cast<float>(b / mean)};
        return mean;
    }
};

/// One bounce off the facets of a dielectric; what is missing passes.
inline LocalEval eval_dielectric(const Microfacets& facets, double eta, Vec3d wo, Vec3d wi,
                                 const FilmOnDielectric* films = nullptr, const PointFilm& film = {}) {
    const Ggx ggx = facets.ggx();
    const Vec3d h = normalize(wo + wi);
    const double d = ggx.density(h) / 4;
    if (films)
        return {dielectric_reflectance(dot(wo, h), eta, films, film) *
                    static_cast<float>(d * ggx.masking_over_cosine(wo, wi)),
                d * ggx.visible_over_projected(wo)};
    const auto f = static_cast<float>(fresnel_dielectric(dot(wo, h), eta) * d * ggx.masking_over_cosine(wo, wi));
    return {{f, f, f}, d * ggx.visible_over_projected(wo)};
}

inline Rgb eval_open_pbr_diffuse(const OpenPbrBsdf& lobe, Vec3d wo, Vec3d wi) {
    const RoughDiffuse model(lobe.diffuse_roughness);
    const double s = dot(wo, wi) - wo.z * wi.z, lost = (1 - model.albedo(wo.z)) * (1 - model.albedo(wi.z));
    Rgb out;
    for (int c = 0; c < 3; ++c) {
        const double matte = lobe.diffuse_roughness > 0 ? model.pi_f(lobe.diffuse[c], wo.z, wi.z, s, lost)
                                                        : static_cast<double>(lobe.diffuse[c]);
        const double scattered = lobe.subsurface_color[c] * (1 - static_cast<double>(lobe.passed_share));
        const double mixed = matte + (scattered - matte) * lobe.subsurface;
        out[c] = static_cast<float>(mixed * wi.z / std::numbers::pi);
    }
    return out;
}

/// The coat's colour is what passes it twice at normal incidence; obliquely the way through it is longer (Snell).
inline Rgb coat_tint(const OpenPbrBsdf& lobe, Vec3d wo, Vec3d wi) {
    if (lobe.coat_weight == 0) return {1, 1, 1};
    const double eta2 = lobe.tables->coat_eta * lobe.tables->coat_eta;
    const auto inside = [&](double mu) { return std::sqrt(max_of(1 - (1 - mu) * (1 + mu) / eta2, 1e-4)); };
    const double way = (1 / inside(wo.z) + 1 / inside(std::fabs(wi.z))) / 2;
    Rgb out;
    for (int c = 0; c < 3; ++c) {
        const double passed = lobe.coat_color[c] < 1 ? math::pow(static_cast<double>(lobe.coat_color[c]), way) : 1;
        out[c] = static_cast<float>(1 + (passed * lobe.darkening[c] - 1) * lobe.coat_weight);
    }
    return out;
}

inline double open_pbr_diffuse_pdf(const OpenPbrBsdf& lobe, double mu_o, double mu_i) {
    const double uniform = 0.5 * lobe.diffuse_roughness * (1 - mu_o);
    return (1 - uniform) * mu_i / std::numbers::pi + uniform * warp::kHemispherePdf;
}

inline LocalEval eval_shares(const OpenPbrBsdf& lobe, const OpenPbrShares& s, Vec3d wo, Vec3d wi, bool outside) {
    const OpenPbrTables& t = *lobe.tables;
    LocalEval out;
    const auto add = [&](const LocalEval& e, double share, double p, Rgb tint) {
        const Rgb f_cos = e.f_cos * tint * static_cast<float>(share);
        out.f_cos = out.f_cos + f_cos;
        out.pdf += p * e.pdf;
        return f_cos;
    };
    const Rgb below = coat_tint(lobe, wo, wi);
    if (wi.z > 0) {
        if (s.p_fuzz > 0)
            out.diffuse = add({t.fuzz->eval(lobe.fuzz_roughness, wo, wi), warp::kHemispherePdf}, s.fuzz, s.p_fuzz,
                              lobe.fuzz_color);
        if (s.p_coat > 0) add(eval_dielectric(lobe.coat, t.coat_eta, wo, wi), s.coat, s.p_coat, {1, 1, 1});
        if (s.p_metal > 0) add(eval_local(lobe.metal, wo, wi, outside), s.metal, s.p_metal, below);
        if (s.p_dielectric > 0)
            add(eval_dielectric(lobe.metal.facets, t.eta_outside, wo, wi,
                                lobe.film.weight > 0 ? t.film.dielectric.get() : nullptr, lobe.film),
                s.dielectric, s.p_dielectric, lobe.specular_color * below);
        if (s.p_diffuse > 0)
            out.diffuse =
                out.diffuse + add({eval_open_pbr_diffuse(lobe, wo, wi), open_pbr_diffuse_pdf(lobe, wo.z, wi.z)},
                                  s.diffuse, s.p_diffuse, below * s.diffuse_tint);
    } else if (s.p_through > 0) {
        const auto cosine = static_cast<float>(-wi.z / std::numbers::pi);
        const Rgb f = lobe.subsurface_color * (lobe.subsurface * lobe.passed_share * cosine);
        out.diffuse = add({f, -wi.z / std::numbers::pi}, s.diffuse, s.p_through, below * s.diffuse_tint);
    }
    if (s.p_glass > 0 && lobe.thin_walled) {
        add(eval_wall(lobe.glass, *t.metal, wo, wi), s.glass, s.p_glass, below);
    } else if (s.p_glass > 0) {
        const LocalEval glass = eval_local(lobe.glass, wo, wi, outside);
        out.radiance_scale = glass.radiance_scale;
        add(glass, s.glass, s.p_glass, below);
    }
    return out;
}

inline LocalEval eval_local(const OpenPbrBsdf& lobe, Vec3d wo, Vec3d wi, bool outside) {
    return eval_shares(lobe, OpenPbrShares(lobe, wo, wo), wo, wi, outside);
}

/// `left` is uniform below the sum of the probabilities.
inline std::optional<Vec3d> sample_shares(const OpenPbrBsdf& lobe, const OpenPbrShares& s, Vec3d wo, bool outside,
                                          double left, Vec2 u) {
    // Whether p chooses; the number that is left is uniform again.
    const auto chooses = [&](double p) {
        if (left < p) {
            left = min_of(left / p, static_cast<double>(kOneMinusEpsilon));
            return true;
        }
        left -= p;
        return false;
    };
    // What facets reflect into the surface is lost: it must not pass for something that the glass transmits.
    const auto above = [](std::optional<Vec3d> wi) { return wi && wi->z > 0 ? wi : std::nullopt; };
    const auto off_facets = [&](const Microfacets& facets) {
        return above(reflect(wo, facets.ggx().sample_visible(wo, u)));
    };
    if (chooses(s.p_fuzz)) return warp::hemisphere(u);
    if (chooses(s.p_coat)) return off_facets(lobe.coat);
    if (chooses(s.p_metal)) return above(sample_local(lobe.metal, wo, outside, static_cast<float>(left), u));
    if (chooses(s.p_dielectric)) return off_facets(lobe.metal.facets);
    if (chooses(s.p_glass)) {
        const auto again = static_cast<float>(left);
        return lobe.thin_walled ? sample_wall(lobe.glass, *lobe.tables->metal, wo, again, u)
                                : sample_local(lobe.glass, wo, outside, again, u);
    }
    if (chooses(s.p_through)) {
        const Vec3d wi = warp::cosine_hemisphere(u);
        return Vec3d{wi.x, wi.y, -wi.z};
    }
    if (!(s.p_diffuse > 0)) return std::nullopt;
    const double uniform = 0.5 * lobe.diffuse_roughness * (1 - wo.z);
    return left < uniform * s.p_diffuse ? warp::hemisphere(u) : warp::cosine_hemisphere(u);
}

inline std::optional<Vec3d> sample_local(const OpenPbrBsdf& lobe, Vec3d wo, bool outside, float uc, Vec2 u) {
    return sample_shares(lobe, OpenPbrShares(lobe, wo, wo), wo, outside, uc, u);
}

}  // namespace steradian
