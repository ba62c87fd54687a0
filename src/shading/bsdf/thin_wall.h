// A thin sheet of a rough dielectric, both of whose surfaces are one: what bounces within it leaves at the same place.
// What is reflected is spread by the facets, and what passes like its mirror image behind the sheet, so that it goes
// straight on through a smooth one; what bounces between the facets is made up for as for metals (conductor.h).
#pragma once

#include "shading/bsdf/conductor.h"
#include "shading/bsdf/rough_glass.h"

namespace steradian {

struct WallColors {
    Rgb reflected, passed;
};

/// With R of one surface and t once through: R + (1 - R)² R t² (1 + R² t² + …) and (1 - R)² t (1 + R² t² + …), at the
/// cosine to a facet. `transmittance` is that of the sheet at normal incidence.
inline WallColors wall_colors(const RoughGlassBsdf& sheet, double cosine) {
    const double eta = sheet.eta, inside = std::sqrt(max_of(1 - (1 - cosine) * (1 + cosine) / (eta * eta), 1e-4));
    const Rgb fresnel = outside_reflectance(sheet, cosine);
    WallColors out;
    for (int c = 0; c < 3; ++c) {
        const double r = fresnel[c], tint = sheet.transmittance[c];
        const double t = tint < 1 ? math::pow(tint, 1 / inside) : 1;
        const double series = r < 1 ? (1 - r) * (1 - r) / (1 - r * r * t * t) : 0;
        out.reflected[c] = static_cast<float>(sheet.reflectance[c] * r + series * r * t * t);
        out.passed[c] = static_cast<float>(series * t);
    }
    return out;
}

/// The probability that what bounces once is reflected: that of a sheet that absorbs nothing.
inline double wall_choice(const RoughGlassBsdf& sheet, double cosine) {
    const Rgb fresnel = outside_reflectance(sheet, cosine);
    const double r = (static_cast<double>(fresnel.r) + fresnel.g + fresnel.b) / 3;
    return 2 * r / (1 + r);
}

/// `energy`: of facets that reflect everything.
inline LocalEval eval_wall(const RoughGlassBsdf& sheet, const MicrofacetEnergy& energy, Vec3d wo, Vec3d wi) {
    const bool reflected = wi.z > 0;
    const Vec3d image{wi.x, wi.y, std::fabs(wi.z)};
    if (!(image.z > 0)) return {};
    const Ggx ggx = sheet.facets.ggx();
    const Vec3d h = normalize(wo + image);
    const double d = ggx.density(h) / 4, lost = energy.loss(sheet.facets, wo);
    const WallColors once = wall_colors(sheet, dot(wo, h));
    const double r = wall_choice(sheet, dot(wo, h)), chosen = reflected ? r : 1 - r;
    LocalEval out{
        (reflected ? once.reflected : once.passed) * static_cast<float>(d * ggx.masking_over_cosine(wo, image)),
        (1 - lost) * chosen * d * ggx.visible_over_projected(wo)};
    if (!(lost > 0)) return out;
    // What has bounced more often does so at all angles: that of 60 degrees stands for them.
    const WallColors mean = wall_colors(sheet, 0.5);
    const double wide =
        lost * energy.loss(sheet.facets, image) / energy.mean_loss(sheet.facets) * image.z / std::numbers::pi;
    const double mean_r = wall_choice(sheet, 0.5), mean_chosen = reflected ? mean_r : 1 - mean_r;
    out.f_cos = out.f_cos + (reflected ? mean.reflected : mean.passed) * static_cast<float>(wide);
    out.pdf += lost * mean_chosen * WideLobe(sheet.facets).pdf(image.z);
    return out;
}

inline std::optional<Vec3d> sample_wall(const RoughGlassBsdf& sheet, const MicrofacetEnergy& energy, Vec3d wo, float uc,
                                        Vec2 u) {
    const double lost = energy.loss(sheet.facets, wo);
    const auto behind = [](Vec3d w) { return Vec3d{w.x, w.y, -w.z}; };
    if (uc < lost) {
        const Vec3d wi = WideLobe(sheet.facets).sample(u);
        return uc < lost * wall_choice(sheet, 0.5) ? wi : behind(wi);
    }
    const Vec3d h = sheet.facets.ggx().sample_visible(wo, u), wi = reflect(wo, h);
    if (!(wi.z > 0)) return std::nullopt;
    return (uc - lost) / (1 - lost) < wall_choice(sheet, dot(wo, h)) ? wi : behind(wi);
}

}  // namespace steradian
