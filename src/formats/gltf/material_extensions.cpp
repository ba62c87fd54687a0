// The extensions of materials, as far as OpenPBR says the same or comes near.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/gltf/materials.h"
#include "math/vector.h"

namespace steradian::gltf {
namespace {

constexpr Range kNotNegative{0, 1e30};
constexpr double kLargestFilmIor = 3;  ///< of OpenPBR

/// The reflectance at normal incidence of a boundary with this index, and the other way round.
constexpr double reflectance_of(double ior) {
    const double f = (ior - 1) / (ior + 1);
    return f * f;
}
double ior_of(double reflectance) {
    const double f = std::sqrt(reflectance);
    return (1 + f) / (1 - f);
}

/// What the index can say of a dielectric beside metal, where specular_weight would scale the metal as well: that of
/// an index of 6.5, which times the index of a clearcoat is within OpenPBR's range.
constexpr double kMostBesideMetal = reflectance_of(6.5);

/// For what the index cannot say: any reflectance, by the weight of a high index.
void reflect(OpenPbrMaterial& s, double reflectance) {
    constexpr double kIor = 3, kReflectance = 0.25;
    s.specular_ior = static_cast<float>(kIor);
    s.specular_weight = static_cast<float>(reflectance / kReflectance);
}

/// Of the coat, seen from the base.
double coat_index(const OpenPbrMaterial& s) { return 1 + (static_cast<double>(s.coat_ior) - 1) * s.coat_weight; }

bool is_whole(const FloatInput& weight) { return weight.value == 1 && !weight.texture; }
bool is_grey(Rgb c) { return c.r == c.g && c.g == c.b; }

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
    if (s.transmission_weight.value > 0 && !is_whole(s.base_metalness) && !first_transmitting_)
        first_transmitting_ = transmission->offset();
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

/// 0 stands for an interface that reflects everything.
double Materials::read_ior(const Object& material) {
    constexpr double kLargest = 9.7;
    const auto extension = material.extension("KHR_materials_ior");
    const double ior = extension ? extension->number_or("ior", 1.5, kNotNegative) : 1.5;
    if (ior == 0) return 0;
    if (ior > kLargest)
        context_.not_honoured("an index of refraction of more than 9.7 is taken as 9.7", extension->offset_of("ior"));
    if (ior < 1)
        context_.warn("'ior' of a material must be 0, or at least 1 as which it is taken", extension->offset_of("ior"),
                      "out-of-range");
    return clamp_to(ior, 1.0, kLargest);
}

/// The reflectance at normal incidence is that of the index times the colour, at most 1 in each channel, times the
/// factor. Metal, of which the extension does not speak, OpenPBR would scale and tint alike: where that matters the
/// two become a mix.
void Materials::read_specular(const Object& material, Reading& r) {
    OpenPbrMaterial& s = r.surface;
    const double ior = read_ior(material), normal = ior == 0 ? 1 : reflectance_of(ior);
    const auto specular = material.extension("KHR_materials_specular");
    const bool all_metal = is_whole(s.base_metalness);
    Rgb color{1, 1, 1};
    std::optional<TextureId> map;
    if (specular) {
        color = this->color(*specular, "specularColorFactor", color, kNotNegative.max);
        if (!is_black(color) && !all_metal) map = texture(*specular, "specularColorTexture", Plane::color, r);
    }
    for (int c = 0; c < 3; ++c)
        color[c] = static_cast<float>(min_of(static_cast<double>(color[c]), 1 / max_of(normal, 1e-30)));
    const double most = max_component(color);
    const double weight = (specular ? static_cast<double>(unit(*specular, "specularFactor", 1)) : 1) * most;
    const bool index_says_it = !map && is_grey(color) && weight * normal <= kMostBesideMetal;
    if (s.base_metalness.value > 0 && !all_metal && !index_says_it) {
        r.metal = {s.base_metalness, s.base_color, {}};
        s.base_metalness = {0};
    }
    s.specular_ior = static_cast<float>(ior);
    if (s.base_metalness.value > 0) {
        if (weight != 1 || normal > kMostBesideMetal)
            s.specular_ior = static_cast<float>(ior_of(min_of(weight * normal, kMostBesideMetal)));
    } else {
        if (most > 0) s.specular_color = {color * static_cast<float>(1 / most), map};
        for (int c = 0; c < 3; ++c) s.specular_color.value[c] = min_of(s.specular_color.value[c], 1.0f);
        s.specular_weight = static_cast<float>(min_of(weight, 10.0));
        if (ior == 0 || weight > 10) reflect(s, weight * normal);
    }
    if (specular && weight > 0)
        read_weight(*specular, "specularTexture", Plane::alpha, r, [](OpenPbrMaterial& without) {
            if (without.base_metalness.value == 0)
                without.specular_weight = 0;
            else
                without.specular_ior = 1;
        });
}

/// OpenPBR looks at what lies below a coat from within the coat: a base of the coat's index would reflect nothing. In
/// the extensions all layers lie in air as it were. Times the coat's index, base and film have the same ratios in it,
/// and the film the same optical thickness. What transmits keeps its index, which is that of the body.
OpenPbrMaterial Materials::below_coat(OpenPbrMaterial s) {
    if (s.coat_weight == 0 || s.transmission_weight.value > 0) return s;
    const double coat = coat_index(s), ior = s.specular_ior;
    if (ior * coat > 10) reflect(s, s.specular_weight * reflectance_of(ior));
    s.specular_ior = static_cast<float>(s.specular_ior * coat);
    s.thin_film_ior = static_cast<float>(min_of(s.thin_film_ior * coat, kLargestFilmIor));
    s.thin_film_thickness.minimum = static_cast<float>(s.thin_film_thickness.minimum / coat);
    s.thin_film_thickness.maximum = static_cast<float>(s.thin_film_thickness.maximum / coat);
    return s;
}

/// Where a base below a coat transmits a part of the light, what transmits and what does not have different indices
/// there: they become a mix.
void Materials::split_below_coat(const Object& clearcoat, Reading& r) {
    OpenPbrMaterial& s = r.surface;
    const FloatInput passed = s.transmission_weight;
    if (s.coat_weight == 0 || passed.value == 0 || is_whole(passed) || is_whole(s.base_metalness)) return;
    if (!r.takes_another_layer()) {
        context_.not_honoured(
            "below a clearcoat a base that transmits a part of the light has no highlight of its own, where textures "
            "weigh other layers",
            clearcoat.offset());
        return;
    }
    s.transmission_weight = {1};
    r.layers.push_back({passed, [](OpenPbrMaterial& without) { without.transmission_weight = {0}; }});
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
    if (!is_black(r.emission))
        context_.not_honoured("a clearcoat does not darken what the surface below it emits", clearcoat.offset());
}

/// As fuzz, of the same distribution of fibres: the extension squares its roughness, OpenPBR does not.
void Materials::read_sheen(const Object& sheen, Reading& r) {
    const Rgb color = this->color(sheen, "sheenColorFactor", {0, 0, 0});
    const float most = max_component(color);
    if (most == 0) return;
    context_.not_honoured(
        "sheen is approximated by OpenPBR's fuzz, whose fibres hide each other, and darken the base, in another way",
        sheen.offset());
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
    // Of what the coat lies on, only the part that is opaque has other indices below it.
    const double largest = kLargestFilmIor / (is_whole(s.transmission_weight) ? 1 : coat_index(s));
    const double ior = iridescence.number_or("iridescenceIor", 1.3, kNotNegative);
    if (ior > largest)
        context_.not_honoured(largest < kLargestFilmIor
                                  ? "an index of a film below a clearcoat of more than 3 over the coat's is clamped"
                                  : "an index of a film of more than 3 is taken as 3",
                              iridescence.offset_of("iridescenceIor"));
    if (ior < 1)
        context_.warn("'iridescenceIor' must be at least 1, as which it is taken",
                      iridescence.offset_of("iridescenceIor"), "out-of-range");
    s.thin_film_ior = static_cast<float>(clamp_to(ior, 1.0, largest));
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
        r.layers.push_back({{1, weight}, remove});
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
    const auto coat = material.extension("KHR_materials_clearcoat");
    if (coat) read_clearcoat(*coat, r);
    if (const auto sheen = material.extension("KHR_materials_sheen")) read_sheen(*sheen, r);
    if (const auto anisotropy = material.extension("KHR_materials_anisotropy")) read_anisotropy(*anisotropy, r);
    if (const auto iridescence = material.extension("KHR_materials_iridescence")) read_iridescence(*iridescence, r);
    if (!r.solid && r.surface.transmission_weight.value > 0) r.surface.geometry_thin_walled = true;
    if (coat) split_below_coat(*coat, r);
}

}  // namespace steradian::gltf
