// Which textures a material reads, and what for.
#pragma once

#include <string_view>

#include "steradian/scene.h"

namespace steradian {

enum class TextureRole : uint8_t {
    color,     ///< of what is reflected or passes
    emission,  ///< of what is sent
    number,    ///< a weight, a roughness, an opacity: the first channel in [0, 1]
    normal,
    height,
    direction,  ///< of a grain
};

/// Calls `visit(texture, role, what)` for each texture that a material names itself, `what` in the words of our own
/// scene format. Of a mix the weight alone.
template <class Visit>
void each_texture(const Material& material, const Visit& visit) {
    const auto number = [&](const auto& input, std::string_view what) {
        if (input.texture) visit(*input.texture, TextureRole::number, what);
    };
    const auto color = [&](const ColorInput& input, std::string_view what, TextureRole role = TextureRole::color) {
        if (input.texture) visit(*input.texture, role, what);
    };
    if (const auto* diffuse = std::get_if<DiffuseMaterial>(&material))
        visit(diffuse->reflectance, TextureRole::color, "reflectance");
    if (const auto* glass = std::get_if<GlassMaterial>(&material)) number(glass->roughness, "roughness");
    if (const auto* metal = std::get_if<ConductorMaterial>(&material)) {
        if (const auto* schlick = std::get_if<SchlickReflectance>(&metal->reflectance))
            visit(schlick->normal, TextureRole::color, "reflectance");
        number(metal->roughness, "roughness");
    }
    if (const auto* sheet = std::get_if<DiffuseTransmissionMaterial>(&material)) {
        visit(sheet->reflectance, TextureRole::color, "reflectance");
        visit(sheet->transmittance, TextureRole::color, "transmittance");
    }
    if (const auto* mix = std::get_if<MixMaterial>(&material)) number(mix->weight, "weight");
    if (const auto* m = std::get_if<OpenPbrMaterial>(&material)) {
        color(m->base_color, "base_color"), number(m->base_metalness, "base_metalness");
        color(m->specular_color, "specular_color"), number(m->specular_roughness, "specular_roughness");
        number(m->transmission_weight, "transmission_weight"), color(m->transmission_color, "transmission_color");
        number(m->subsurface_weight, "subsurface_weight"), color(m->subsurface_color, "subsurface_color");
        number(m->fuzz_weight, "fuzz_weight"), color(m->fuzz_color, "fuzz_color");
        number(m->fuzz_roughness, "fuzz_roughness"), number(m->coat_roughness, "coat_roughness");
        number(m->thin_film_weight, "thin_film_weight"), number(m->thin_film_thickness, "thin_film_thickness");
        number(m->specular_roughness_anisotropy, "specular_roughness_anisotropy");
        if (m->geometry_tangent.texture)
            visit(*m->geometry_tangent.texture, TextureRole::direction, "geometry_tangent");
        if (m->geometry_coat_normal)
            visit(m->geometry_coat_normal->texture, TextureRole::normal, "geometry_coat_normal");
        color(m->coat_color, "coat_color"), color(m->emission_color, "emission_color", TextureRole::emission);
        number(m->geometry_opacity, "geometry_opacity");
    }
}

template <class Visit>
void each_texture(const Relief& relief, const Visit& visit) {
    if (const auto* normals = std::get_if<NormalMap>(&relief.map))
        visit(normals->texture, TextureRole::normal, "normal_map");
    if (const auto* heights = std::get_if<BumpMap>(&relief.map))
        visit(heights->texture, TextureRole::height, "bump_map");
}

/// The texture itself, or the two that it is a product of.
template <class Visit>
void each_factor(const Scene& scene, TextureId id, const Visit& visit) {
    if (const auto* product = std::get_if<ProductTexture>(&scene.textures[index(id)])) {
        visit(product->first);
        visit(product->second);
    } else {
        visit(id);
    }
}

}  // namespace steradian
