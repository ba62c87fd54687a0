// The extensions of materials, as far as OpenPBR says the same or comes near.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/gltf/materials.h"
#include "math/vector.h"

namespace steradian::gltf {
namespace {

constexpr Range kNotNegative{0, 1e30};

/// The reflectance at normal incidence of a boundary with this index, and the other way round.
double reflectance_of(double ior) {
    const double f = (ior - 1) / (ior + 1);
    return f * f;
}
double ior_of(double reflectance) {
    const double f = std::sqrt(min_of(reflectance, 0.66));  // of an index of 9.7
    return (1 + f) / (1 - f);
}

}  // namespace

/// What passes is tinted by the base colour where it enters and where it leaves, and absorbed on the way. How thick a
/// body is says its mesh; a thickness of 0 is that of a sheet.
void Materials::read_transmission(const Object& material, Reading& r) {
    const auto transmission = material.extension("KHR_materials_transmission");
    if (!transmission) return;
    OpenPbrMaterial& s = r.surface;
    s.transmission_weight.value = unit(*transmission, "transmissionFactor", 0);
    s.transmission_weight.texture = texture(*transmission, "transmissionTexture", Plane::red, r);
    s.transmission_color = s.base_color;
    const auto volume = material.extension("KHR_materials_volume");
    const double thickness = volume ? volume->number_or("thicknessFactor", 0, kNotNegative) : 0;
    r.solid = thickness > 0;
    if (!r.solid || s.transmission_weight.value == 0 || !volume->has("attenuationDistance")) return;
    const double distance = volume->number_or("attenuationDistance", 1, {0, 1e30, true});
    const Rgb color = this->color(*volume, "attenuationColor", {1, 1, 1});
    s.interior = open_pbr_interior(color, static_cast<float>(std::max(distance, 1e-30)));
}

/// The extension's number is 20 over the Abbe number. Thin sheets do not refract, so they do not disperse either.
void Materials::read_dispersion(const Object& dispersion, Reading& r) {
    constexpr double kMost = 20;
    const double value = dispersion.number_or("dispersion", 0, kNotNegative);
    if (value == 0 || !r.solid) return;
    if (value > kMost)
        context_.not_honoured("a dispersion of more than 20, an Abbe number below 1, is taken as 20",
                              dispersion.offset_of("dispersion"));
    r.surface.transmission_dispersion_scale = 1;
    r.surface.transmission_dispersion_abbe_number = static_cast<float>(20 / min_of(value, kMost));
}

/// The reflectance at normal incidence is that of the index times factor and colour. Where there is metal, of which the
/// extension does not speak, the index says it all.
void Materials::read_specular(const Object& material, Reading& r) {
    OpenPbrMaterial& s = r.surface;
    double ior = 1.5;
    if (const auto extension = material.extension("KHR_materials_ior")) {
        constexpr double kLargest = 9.7;
        ior = extension->number_or("ior", 1.5, kNotNegative);
        if (ior > kLargest || ior < 1)
            context_.not_honoured("an index of refraction beyond 1 to 9.7 is taken as the nearer one",
                                  extension->offset_of("ior"));
        ior = ior == 0 ? kLargest : clamp_to(ior, 1.0, kLargest);
    }
    s.specular_ior = static_cast<float>(ior);
    const auto specular = material.extension("KHR_materials_specular");
    if (!specular) return;
    Rgb color = this->color(*specular, "specularColorFactor", {1, 1, 1}, kNotNegative.max);
    const double most = max_component(color);
    const double weight = static_cast<double>(unit(*specular, "specularFactor", 1)) * most;
    if (most > 0 && s.base_metalness.value < 1) {
        s.specular_color = {color * static_cast<float>(1 / most),
                            texture(*specular, "specularColorTexture", Plane::color, r)};
        for (int c = 0; c < 3; ++c) s.specular_color.value[c] = min_of(s.specular_color.value[c], 1.0f);
    }
    if (s.base_metalness.value == 0)
        s.specular_weight = static_cast<float>(min_of(weight, 10.0));
    else
        s.specular_ior = static_cast<float>(ior_of(weight * reflectance_of(ior)));
    if (weight > 0)
        read_weight(*specular, "specularTexture", Plane::alpha, r, [](OpenPbrMaterial& without) {
            if (without.base_metalness.value == 0)
                without.specular_weight = 0;
            else
                without.specular_ior = 1;
        });
}

void Materials::read_clearcoat(const Object& clearcoat, Reading& r) {
    OpenPbrMaterial& s = r.surface;
    s.coat_weight = unit(clearcoat, "clearcoatFactor", 0);
    if (s.coat_weight == 0) return;
    s.coat_roughness = {unit(clearcoat, "clearcoatRoughnessFactor", 0),
                        texture(clearcoat, "clearcoatRoughnessTexture", Plane::green, r)};
    s.coat_ior = 1.5f;
    s.coat_darkening = 0;
    read_weight(clearcoat, "clearcoatTexture", Plane::red, r,
                [](OpenPbrMaterial& without) { without.coat_weight = 0; });
    s.geometry_coat_normal = read_normal_map(clearcoat, "clearcoatNormalTexture", r);
}

/// As fuzz, of the same distribution of fibres: the extension squares its roughness, OpenPBR does not. What a base
/// below gets, and the masking, are near, not the same.
void Materials::read_sheen(const Object& sheen, Reading& r) {
    const Rgb color = this->color(sheen, "sheenColorFactor", {0, 0, 0});
    const float most = max_component(color);
    if (most == 0) return;
    OpenPbrMaterial& s = r.surface;
    s.fuzz_weight.value = most;
    s.fuzz_color = {color * (1 / most), texture(sheen, "sheenColorTexture", Plane::color, r)};
    const float roughness = unit(sheen, "sheenRoughnessFactor", 0);
    s.fuzz_roughness = {roughness * roughness};
    if (const auto t = texture(sheen, "sheenRoughnessTexture", Plane::alpha, r))
        s.fuzz_roughness.texture = context_.assets.add_texture(ProductTexture{*t, *t}, "");
    for (int c = 0; c < 3; ++c) s.fuzz_color.value[c] = min_of(s.fuzz_color.value[c], 1.0f);
}

/// The texture has the direction in red and green and the strength in blue.
void Materials::read_anisotropy(const Object& anisotropy, Reading& r) {
    OpenPbrMaterial& s = r.surface;
    const float strength = unit(anisotropy, "anisotropyStrength", 0);
    if (strength == 0) return;
    s.specular_grain_shape = GrainShape::gltf;
    s.specular_roughness_anisotropy = {strength};
    const double radians = anisotropy.number_or("anisotropyRotation", 0, {-1e6, 1e6});
    s.geometry_tangent.rotation = static_cast<float>(radians * (180 / std::numbers::pi));
    const auto use = images_.use(anisotropy, "anisotropyTexture");
    if (!use) return;
    s.specular_roughness_anisotropy.texture = texture(*use, Plane::blue, ColorSpace::linear, r);
    s.geometry_tangent.texture = texture(*use, Plane::color, ColorSpace::linear, r);
    r.grain_uv_set = use->uv_set;
}

/// As OpenPBR's thin film, which lies where the extension has it: on the base, below the coat.
void Materials::read_iridescence(const Object& iridescence, Reading& r) {
    OpenPbrMaterial& s = r.surface;
    s.thin_film_weight.value = unit(iridescence, "iridescenceFactor", 0);
    if (s.thin_film_weight.value == 0) return;
    s.thin_film_weight.texture = texture(iridescence, "iridescenceTexture", Plane::red, r);
    const auto thickness = [&](std::string_view key, double fallback) {
        constexpr double kNanometre = 1e-3, kThickest = 10;
        const double micrometres = iridescence.number_or(key, fallback, kNotNegative) * kNanometre;
        if (micrometres > kThickest)
            context_.not_honoured("a film of more than 10 micrometres is as thick as that", iridescence.offset_of(key));
        return static_cast<float>(min_of(micrometres, kThickest));
    };
    s.thin_film_thickness.maximum = thickness("iridescenceThicknessMaximum", 400);
    s.thin_film_thickness.texture = texture(iridescence, "iridescenceThicknessTexture", Plane::green, r);
    if (s.thin_film_thickness.texture) s.thin_film_thickness.minimum = thickness("iridescenceThicknessMinimum", 100);
    constexpr double kLargest = 3;
    const double ior = iridescence.number_or("iridescenceIor", 1.3, kNotNegative);
    if (ior < 1 || ior > kLargest)
        context_.not_honoured("an index of a film beyond 1 to 3 is taken as the nearer one",
                              iridescence.offset_of("iridescenceIor"));
    s.thin_film_ior = static_cast<float>(clamp_to(ior, 1.0, kLargest));
}

/// What the base scatters goes through the sheet instead, to that part: a thin wall whose subsurface scatters forward.
void Materials::read_diffuse_transmission(const Object& material, Reading& r) {
    const auto found = material.extension("KHR_materials_diffuse_transmission");
    if (!found) return;
    const Object& extension = *found;
    const float factor = unit(extension, "diffuseTransmissionFactor", 0);
    if (factor == 0) return;
    OpenPbrMaterial& s = r.surface;
    if (r.solid && s.transmission_weight.value > 0) {
        context_.not_honoured("diffuse transmission of a solid body that is also transparent has no effect",
                              extension.offset());
        return;
    }
    const auto volume = material.extension("KHR_materials_volume");
    if (volume && volume->number_or("thicknessFactor", 0, kNotNegative) > 0)
        context_.not_honoured("a body that scatters within is taken as a thin sheet", volume->offset());
    s.subsurface_weight = {factor, texture(extension, "diffuseTransmissionTexture", Plane::alpha, r)};
    s.subsurface_color = {color(extension, "diffuseTransmissionColorFactor", {1, 1, 1}),
                          texture(extension, "diffuseTransmissionColorTexture", Plane::color, r)};
    s.subsurface_scatter_anisotropy = 1;
    s.geometry_thin_walled = true;
}

/// A weight of a layer by a texture: where it is 1 there is the material as read so far, where it is 0 the same without
/// the layer, and between them a mix. That is how the specifications define these weights.
void Materials::read_weight(const Object& extension, std::string_view key, Plane plane, Reading& r, Remove remove) {
    const auto weight = texture(extension, key, plane, r);
    if (!weight) return;
    if (r.takes_another_layer())
        r.layers.push_back({*weight, remove});
    else
        no_texture(extension, key);
}

void Materials::read_extensions(const Object& material, Reading& r) {
    if (material.extension("KHR_materials_unlit")) {
        r.unlit = true;
        r.emission = r.surface.base_color.value;
        r.emission_texture = r.surface.base_color.texture;
        return;
    }
    if (r.metal) {
        report_excluded(material);
    } else {
        read_specular(material, r);
        read_transmission(material, r);
        if (const auto dispersion = material.extension("KHR_materials_dispersion")) read_dispersion(*dispersion, r);
        read_diffuse_transmission(material, r);
    }
    if (const auto coat = material.extension("KHR_materials_clearcoat")) read_clearcoat(*coat, r);
    if (const auto sheen = material.extension("KHR_materials_sheen")) read_sheen(*sheen, r);
    if (const auto anisotropy = material.extension("KHR_materials_anisotropy")) read_anisotropy(*anisotropy, r);
    if (const auto iridescence = material.extension("KHR_materials_iridescence")) read_iridescence(*iridescence, r);
    if (!r.solid && r.surface.transmission_weight.value > 0) r.surface.geometry_thin_walled = true;
}

}  // namespace steradian::gltf
