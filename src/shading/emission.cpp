#include "shading/emission.h"

#include "shading/bsdf/open_pbr.h"
#include "shading/opacity.h"

namespace steradian {
namespace {

/// What the layers above the base let pass towards the cosine mu, as of light that the base reflects (open_pbr.h), but
/// once. The coat's grain does not matter: it is looked at halfway between its axes.
Rgb passed_by_layers(const OpenPbrMaterial& m, const LobeContext& context, double mu) {
    const OpenPbrTables& tables = *context.material.open_pbr;
    double left = 1;
    const auto number = [&](const FloatInput& in) { return eval_input(context.scene, in, context.point); };
    if (tables.fuzz) left -= number(m.fuzz_weight) * tables.fuzz->albedo(number(m.fuzz_roughness), mu);
    Rgb tint{1, 1, 1};
    if (tables.coat) {
        const double across = std::sqrt((1 - mu) * (1 + mu) / 2);
        const Microfacets facets = open_pbr_coat(m, tables, number(m.coat_roughness));
        left *= 1 - m.coat_weight * (1 - tables.coat->loss(facets, {across, across, mu}));
        const double eta2 = tables.coat_eta * tables.coat_eta;
        const double way = 0.5 / std::sqrt(max_of(1 - (1 - mu) * (1 + mu) / eta2, 1e-4));
        const Rgb color = eval_input(context.scene, m.coat_color, context.point);
        for (int c = 0; c < 3; ++c) {
            const double passed = color[c] < 1 ? math::pow(static_cast<double>(color[c]), way) : 1;
            tint[c] = static_cast<float>(1 + (passed - 1) * m.coat_weight);
        }
    }
    return tint * static_cast<float>(left);
}

Rgb plain_emission(const ShadingScene& scene, const SurfacePoint& point, MaterialId id, Vec3 w) {
    const auto* m = std::get_if<OpenPbrMaterial>(&scene.scene.materials[index(id)]);
    if (!m || m->emission_luminance == 0) return {};
    if (!m->geometry_thin_walled && !(dot(w, point.ng) > 0)) return {};
    const double mu = min_of(std::fabs(dot(Vec3d(w), Vec3d(point.ns))), 1.0);
    const LobeContext context{scene, point, scene.materials[index(id)]};
    return eval_input(scene, m->emission_color, point) * passed_by_layers(*m, context, mu) * m->emission_luminance;
}

}  // namespace

Rgb material_emission(const ShadingScene& scene, const SurfacePoint& point, Vec3 w) noexcept {
    const MaterialId id = scene.scene.instances[point.instance].material;
    const Mixture mixture(scene, point, id);
    if (mixture.parts().size() == 1) return plain_emission(scene, point, mixture.parts()[0].material, w);
    const float all = opacity_at(scene, point);
    Rgb sum;
    for (const Mixture::Share& share : mixture.parts())
        if (const float there = share.weight * opacity_at(scene, point, share.material); there > 0)
            sum = sum + plain_emission(scene, point, share.material, w) * (there / all);
    return sum;
}

}  // namespace steradian
