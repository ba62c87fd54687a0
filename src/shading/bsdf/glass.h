// A smooth boundary between two dielectrics, and the material that may be rough.
#pragma once

#include "shading/bsdf/specular.h"
#include "shading/texture.h"

namespace steradian {

inline PlainLobe make_lobe(const GlassMaterial& material, const LobeContext& context) {
    const float own = context.material.glass.at(context.wavelength), eta = relative_index(own, context);
    const Roughness& roughness = material.roughness;
    if (refracts_visibly(relative_index(material.eta, context)) && roughness.value != Vec2{0, 0}) {
        const auto read = [&](TextureId id) { return eval_texture(context.scene, id, context.point).r; };
        const Microfacets facets = microfacets(roughness, roughness.texture ? read(*roughness.texture) : 1);
        if (!facets.smooth())
            return RoughGlassBsdf{eta,
                                  material.reflectance,
                                  material.transmittance,
                                  facets,
                                  energy_of_boundary(context, context.material.energy),
                                  context.material.glass.range().place(own)};
    }
    return GlassBsdf{eta, material.reflectance, material.transmittance};
}

inline bool lobe_is_specular(const GlassBsdf&) { return true; }

inline BsdfEval eval_lobe(const GlassBsdf&, const LobeGeometry&, Vec3, Vec3) { return {}; }

/// Reflects with the probability of the Fresnel reflectance, which thereby cancels. What is transmitted is scaled by
/// (η_i/η_t)², i being the side of wo: radiance over the square of the index is what an interface conserves.
inline std::optional<BsdfSample> sample_lobe(const GlassBsdf& lobe, const LobeGeometry& g, Vec3 wo, float uc, Vec2) {
    const auto surface = Interface::seen_from(g, wo);
    if (!surface) return std::nullopt;
    const double eta = surface->outside ? lobe.eta : 1 / static_cast<double>(lobe.eta);
    const double cos_o = min_of(dot(Vec3d(wo), surface->ns), 1.0);
    if (uc >= fresnel_dielectric(static_cast<float>(cos_o), static_cast<float>(eta)))
        if (const auto wi = surface->refracted(wo, eta)) {
            const auto scale = static_cast<float>(1 / (eta * eta));
            BsdfSample out = specular_sample(*wi, lobe.transmittance * scale, true);
            out.radiance_scale = scale;
            return out;
        }
    return specular_sample(surface->reflected(wo), lobe.reflectance, false);
}

}  // namespace steradian
