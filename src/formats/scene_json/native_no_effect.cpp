// What a file says of a material and what changes nothing, because something else that it needs is not there. A weight
// that is written as 0 switches its layer off on purpose; one that is missing has been forgotten.
#include "formats/scene_json/native.h"

namespace steradian::scene_json {
namespace {

struct Option {
    std::string_view key;
    double neutral;  ///< the number, or all numbers of the colour, by which nothing is asked for
};
/// Options without effect as long as `needs` is 0.
struct Layer {
    std::string_view needs;
    bool even_if_written;  ///< a body's inside is more than a switch
    std::vector<Option> options;
};

const std::vector<Layer>& open_pbr_layers() {
    static const std::vector<Layer> layers{
        {"transmission_weight",
         true,
         {{"transmission_depth", 0}, {"transmission_scatter", 0}, {"transmission_dispersion_scale", 0}}},
        {"transmission_weight", false, {{"transmission_color", 1}}},
        {"transmission_depth", true, {{"transmission_scatter", 0}}},
        {"transmission_scatter", true, {{"transmission_scatter_anisotropy", 0}}},
        {"transmission_dispersion_scale", false, {{"transmission_dispersion_abbe_number", 20}}},
        {"subsurface_weight", false, {{"subsurface_color", 0.8}, {"subsurface_scatter_anisotropy", 0}}},
        {"fuzz_weight", false, {{"fuzz_color", 1}, {"fuzz_roughness", 0.5}}},
        {"coat_weight",
         false,
         {{"coat_color", 1},
          {"coat_roughness", 0},
          {"coat_roughness_anisotropy", 0},
          {"coat_ior", 1.6},
          {"geometry_coat_normal", 0}}},
        {"thin_film_weight", false, {{"thin_film_thickness", 0.5}, {"thin_film_ior", 1.4}}},
        {"emission_luminance", false, {{"emission_color", 1}}},
        {"specular_roughness_anisotropy", false, {{"geometry_tangent", 0}, {"geometry_tangent_rotation", 0}}},
    };
    return layers;
}

/// A number, or a list of them, that is everywhere this.
bool is_all(Value value, double number) {
    if (value.is(Kind::number)) return value.number() == number;
    if (!value.is(Kind::array) || value.size() == 0) return false;
    for (const Value element : value.elements())
        if (!is_all(element, number)) return false;
    return true;
}

/// The first of the options that asks for something.
std::optional<std::string_view> asked_for(ObjectReader& material, const std::vector<Option>& options) {
    for (const Option& option : options)
        if (const auto value = material.find(option.key); value && !is_all(*value, option.neutral)) return option.key;
    return std::nullopt;
}

}  // namespace

void NativeLoader::note_no_effect(ObjectReader& material, std::string_view key, const std::string& why) {
    // So many with names of their own: to compare each with all of a large file would take long.
    constexpr size_t kMostNamed = 256;
    Diagnostics& notes = context_.loaded.unused;
    const std::string whose = notes.warnings().size() < kMostNamed ? material.what() + ": " : "";
    notes.warn(whose + quoted(key) + " has no effect: " + why, source_.where(material.key_offset(key)), 1, "no-effect");
}

void NativeLoader::find_no_effect(ObjectReader& material, const OpenPbrMaterial& m) {
    for (const Layer& layer : open_pbr_layers()) {
        const auto weight = material.find(layer.needs);
        if (weight && (!layer.even_if_written || !is_all(*weight, 0))) continue;
        if (const auto key = asked_for(material, layer.options))
            note_no_effect(material, *key,
                           (weight ? "" : "there is no ") + quoted(layer.needs) + (weight ? " is 0" : ""));
    }
    const bool metal = m.base_metalness.value == 1 && !m.base_metalness.texture;
    const bool transmits = m.transmission_weight.value > 0;
    if (metal && transmits) note_no_effect(material, "transmission_weight", "metals let nothing pass");
    if (metal && m.subsurface_weight.value > 0)
        note_no_effect(material, "subsurface_weight", "light does not get into metals");
    if (m.priority && (metal || !transmits))
        note_no_effect(material, "priority", "nothing is seen through the surface");
}

void NativeLoader::find_no_effect(ObjectReader& material, const GlassMaterial& m) {
    if (m.interior.anisotropy != 0 && m.interior.scattering == Rgb{0, 0, 0})
        note_no_effect(material, "interior", "without 'scattering' its 'anisotropy' turns nothing");
}

}  // namespace steradian::scene_json
