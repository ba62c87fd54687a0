#include "formats/scene_json/native.h"

namespace steradian::scene_json {
namespace {

constexpr Range kUnit{0, 1};

}  // namespace

FloatInput NativeLoader::read_input(ObjectReader& material, std::string_view key, FloatInput fallback) {
    const auto value = material.find(key);
    if (!value) return fallback;
    if (const auto texture = find_texture(*value, TextureUse::weight)) return {1, texture};
    return {json::read_number(source_, *value, quoted(key), kUnit)};
}

ColorInput NativeLoader::read_input(ObjectReader& material, std::string_view key, ColorInput fallback, TextureUse use) {
    const auto value = material.find(key);
    if (!value) return fallback;
    if (const auto texture = find_texture(*value, use)) return {{1, 1, 1}, texture};
    return {json::read_color(source_, *value, quoted(key), kUnit)};
}

/// A number, or an object with a texture.
FilmThickness NativeLoader::read_film_thickness(Value value) {
    static constexpr Range kThickness{0, 10};
    static constexpr std::string_view kWhat = "'thin_film_thickness'";
    if (!value.is(Kind::object)) return {json::read_number(source_, value, kWhat, kThickness)};
    ObjectReader reader(source_, value, kFilmThicknessSpec, kWhat);
    FilmThickness out;
    out.texture = read_numbers(reader.require("texture"), "the texture of a thickness");
    out.minimum = reader.number_or("minimum", 0, kThickness);
    out.maximum = json::read_number(source_, reader.require("maximum"), "'maximum'", kThickness);
    reader.finish();
    return out;
}

/// Section "Translucent base": with a depth the colour is that of the interior, without one that of the surface.
void NativeLoader::read_open_pbr_interior(ObjectReader& material, OpenPbrMaterial& m) {
    const float depth = material.number_or("transmission_depth", 0, {0, 1e9});
    const Rgb scatter = material.color_or("transmission_scatter", {0, 0, 0}, kUnit);
    const float anisotropy = material.number_or("transmission_scatter_anisotropy", 0, {-1, 1});
    if (depth == 0) return;
    if (m.transmission_color.texture)
        source_.fail(material.key_offset("transmission_depth"),
                     "with a 'transmission_depth' the 'transmission_color' fills the body: it must not be a texture");
    if (m.geometry_thin_walled)
        source_.fail(material.key_offset("transmission_depth"), "a thin wall has no 'transmission_depth'");
    m.interior = open_pbr_interior(m.transmission_color.value, depth, scatter, anisotropy);
    m.transmission_color = {};
}

OpenPbrMaterial NativeLoader::read_open_pbr(ObjectReader& material) {
    OpenPbrMaterial m;
    const auto input = [&](std::string_view key, auto& in) { in = read_input(material, key, in); };
    const auto number = [&](std::string_view key, float& x, Range range = kUnit) {
        x = material.number_or(key, x, range);
    };
    number("base_weight", m.base_weight);
    input("base_color", m.base_color);
    input("base_metalness", m.base_metalness);
    number("base_diffuse_roughness", m.base_diffuse_roughness);
    number("specular_weight", m.specular_weight, {0, 10});
    input("specular_color", m.specular_color);
    input("specular_roughness", m.specular_roughness);
    number("specular_ior", m.specular_ior, {0.1, 10});
    input("specular_roughness_anisotropy", m.specular_roughness_anisotropy);
    number("geometry_tangent_rotation", m.geometry_tangent.rotation, {-360, 360});
    if (const auto direction = material.find("geometry_tangent"))
        m.geometry_tangent.texture = read_numbers(*direction, "'geometry_tangent'");
    input("transmission_weight", m.transmission_weight);
    input("transmission_color", m.transmission_color);
    number("transmission_dispersion_scale", m.transmission_dispersion_scale);
    number("transmission_dispersion_abbe_number", m.transmission_dispersion_abbe_number, {1, 1e6});
    input("subsurface_weight", m.subsurface_weight);
    input("subsurface_color", m.subsurface_color);
    number("subsurface_scatter_anisotropy", m.subsurface_scatter_anisotropy, {-1, 1});
    input("fuzz_weight", m.fuzz_weight);
    input("fuzz_color", m.fuzz_color);
    input("fuzz_roughness", m.fuzz_roughness);
    number("coat_weight", m.coat_weight);
    input("coat_color", m.coat_color);
    input("coat_roughness", m.coat_roughness);
    number("coat_roughness_anisotropy", m.coat_roughness_anisotropy);
    number("coat_ior", m.coat_ior, {1.01, 3});
    number("coat_darkening", m.coat_darkening);
    if (const auto normals = material.find("geometry_coat_normal"))
        m.geometry_coat_normal = read_normal_map(*normals, "'geometry_coat_normal'");
    input("thin_film_weight", m.thin_film_weight);
    if (const auto thickness = material.find("thin_film_thickness"))
        m.thin_film_thickness = read_film_thickness(*thickness);
    number("thin_film_ior", m.thin_film_ior, {1, 3});
    number("emission_luminance", m.emission_luminance, {0, 1e9});
    m.emission_color = read_input(material, "emission_color", m.emission_color, TextureUse::emission);
    input("geometry_opacity", m.geometry_opacity);
    m.geometry_thin_walled = material.boolean_or("geometry_thin_walled", m.geometry_thin_walled);
    read_open_pbr_interior(material, m);
    m.priority = read_priority(material);
    find_no_effect(material, m);
    return m;
}

}  // namespace steradian::scene_json
