#include "formats/gltf/materials.h"

#include <cmath>

#include "math/vector.h"

namespace steradian::gltf {

namespace {

constexpr Range kNotNegative{0, 1e30}, kAnyNumber{-1e30, 1e30};

bool is_white(Rgb c) { return c.r == 1 && c.g == 1 && c.b == 1; }

}  // namespace

/// A factor in [0, `most`], which is 1 or as good as no limit; what lies outside is clamped, with a warning.
float Materials::factor(double x, const Object& object, std::string_view key, double most) {
    if (!(x >= 0 && x <= most))
        context_.warn(quoted(key) + " of a material must " + (most > 1 ? "not be negative" : "be between 0 and 1") +
                          " and was clamped",
                      object.offset_of(key), "out-of-range");
    return static_cast<float>(clamp_to(x, 0.0, most));
}

float Materials::unit(const Object& object, std::string_view key, float fallback) {
    return factor(object.number_or(key, static_cast<double>(fallback), kAnyNumber), object, key);
}

Rgb Materials::color(const Object& object, std::string_view key, Rgb fallback, double most) {
    const auto numbers = object.numbers(key, 3, kAnyNumber);
    if (!numbers) return fallback;
    Rgb out;
    for (int c = 0; c < 3; ++c) out[c] = factor((*numbers)[static_cast<size_t>(c)], object, key, most);
    return out;
}

void Materials::no_texture(const Object& object, std::string_view key) {
    if (const auto value = object.find(key))
        context_.not_honoured("the texture " + quoted(key) + " has no effect", value->offset());
}

std::optional<TextureId> Materials::texture(const Object& object, std::string_view key, Plane plane, Reading& r) {
    const auto use = images_.use(object, key);
    if (!use) return std::nullopt;
    return texture(*use, plane, plane == Plane::color ? ColorSpace::srgb : ColorSpace::linear, r);
}

TextureId Materials::texture(const TextureUse& use, Plane plane, ColorSpace space, Reading& r) {
    r.uv_sets |= 1u << use.uv_set;
    return images_.texture(use, plane, space);
}

/// Section 3.7.2.1 of the specification: COLOR_0 multiplies what factor and texture say.
void Materials::multiply_by_vertices(std::optional<TextureId>& texture, bool alpha) {
    std::optional<TextureId>& vertices = vertex_colors_[alpha];
    if (!vertices) vertices = context_.assets.add_texture(VertexColorTexture{alpha}, "COLOR_0");
    texture = texture ? context_.assets.add_texture(ProductTexture{*texture, *vertices}, "") : *vertices;
}

void Materials::read_color_and_alpha(const Object& object, std::string_view factors, std::string_view map, Reading& r) {
    OpenPbrMaterial& s = r.surface;
    if (const auto numbers = object.numbers(factors, 4, kAnyNumber)) {
        for (int c = 0; c < 3; ++c) s.base_color.value[c] = factor((*numbers)[static_cast<size_t>(c)], object, factors);
        s.geometry_opacity.value = factor((*numbers)[3], object, factors);
    }
    r.base_color = images_.use(object, map);
    s.base_color.texture = texture(object, map, Plane::color, r);
}

/// Section 3.9.2 of the specification.
void Materials::read_metallic_roughness(const Object& material, Reading& r) {
    OpenPbrMaterial& s = r.surface;
    const auto pbr = material.object("pbrMetallicRoughness");
    if (!pbr) return;
    read_color_and_alpha(*pbr, "baseColorFactor", "baseColorTexture", r);
    s.base_metalness.value = unit(*pbr, "metallicFactor", 1);
    s.specular_roughness.value = unit(*pbr, "roughnessFactor", 1);
    s.base_metalness.texture = texture(*pbr, "metallicRoughnessTexture", Plane::blue, r);
    s.specular_roughness.texture = texture(*pbr, "metallicRoughnessTexture", Plane::green, r);
}

/// Section 3.9.4. What is masked is there or not; what is blended is there for a part of the light.
void Materials::read_alpha(const Object& material, Reading& r) {
    const std::string_view mode = material.string_or("alphaMode", "OPAQUE");
    OpenPbrMaterial& s = r.surface;
    if (mode != "MASK" && mode != "BLEND") {
        if (mode != "OPAQUE")
            context_.warn("an 'alphaMode' is none of OPAQUE, MASK and BLEND; OPAQUE is used",
                          material.offset_of("alphaMode"));
        s.geometry_opacity = {1};
        return;
    }
    if (r.base_color) s.geometry_opacity.texture = texture(*r.base_color, Plane::alpha, ColorSpace::linear, r);
    if (r.colors == VertexColors::rgba) multiply_by_vertices(s.geometry_opacity.texture, true);
    if (mode == "BLEND") return;
    const double cutoff = material.number_or("alphaCutoff", 0.5, kNotNegative);
    if (cutoff > 1) s.geometry_opacity = {0};
    if (cutoff == 0) s.geometry_opacity = {1};
    if (cutoff <= 1) s.geometry_opacity_cutoff = static_cast<float>(cutoff);
}

void Materials::read_emission(const Object& material, Reading& r) {
    r.emission = color(material, "emissiveFactor", {0, 0, 0});
    if (const auto strength = material.extension("KHR_materials_emissive_strength"))
        r.emission = r.emission * static_cast<float>(strength->number_or("emissiveStrength", 1, kNotNegative));
    if (is_black(r.emission)) return;
    r.emission_texture = texture(material, "emissiveTexture", Plane::color, r);
}

/// The default material of the specification.
Materials::Reading Materials::start(VertexColors colors) {
    Reading r;
    r.colors = colors;
    r.surface.base_color = {{1, 1, 1}};
    r.surface.base_metalness = {1};
    r.surface.specular_roughness = {1};
    return r;
}

/// Some surfaces have materials of their own, which are exact and take less time.
std::optional<Material> Materials::make_simple(const Reading& r, const std::string& name) {
    const OpenPbrMaterial& s = r.surface;
    const auto color = [&]() -> TextureId {
        if (s.base_color.texture) return *s.base_color.texture;
        return context_.assets.add_texture(ConstantTexture{s.base_color.value}, name);
    };
    const bool there = s.geometry_opacity.value == 1 && !s.geometry_opacity.texture;
    const bool layered = s.coat_weight > 0 || s.fuzz_weight.value > 0 || s.thin_film_weight.value > 0;
    if (!there || layered || (s.base_color.texture && !is_white(s.base_color.value))) return std::nullopt;
    const bool smooth = s.specular_roughness.value == 0 && s.specular_roughness_anisotropy.value == 0;
    if (s.base_metalness.value == 1 && !s.base_metalness.texture && smooth)
        return ConductorMaterial{SchlickReflectance{color()}, Roughness{}};
    if (s.base_metalness.value > 0) return std::nullopt;
    const bool all_glass = s.transmission_weight.value == 1 && !s.transmission_weight.texture;
    if (all_glass && smooth && !s.base_color.texture && s.specular_weight == 1 && !s.specular_color.texture) {
        const Rgb tint = s.transmission_color.value;
        if (r.solid) {
            const float abbe = s.transmission_dispersion_scale > 0 ? s.transmission_dispersion_abbe_number : 0;
            return GlassMaterial{s.specular_ior, s.specular_color.value, tint, {}, abbe, s.interior};
        }
        if (is_white(s.specular_color.value)) return ThinGlassMaterial{s.specular_ior, tint};
    }
    if (s.specular_weight == 0 && s.transmission_weight.value == 0 && s.subsurface_weight.value == 0)
        return DiffuseMaterial{color(), true};
    return std::nullopt;
}

/// It reflects nothing, and is there as far as its alpha says: what is not there does not shine either.
MaterialId Materials::make_unlit(const Reading& r, const std::string& name) {
    const FloatInput& opacity = r.surface.geometry_opacity;
    if (opacity.value == 1 && !opacity.texture) return context_.assets.add_diffuse({0, 0, 0}, true, name);
    OpenPbrMaterial black;
    black.base_color = {{0, 0, 0}};
    black.specular_weight = 0;
    black.geometry_opacity = opacity;
    black.geometry_opacity_cutoff = r.surface.geometry_opacity_cutoff;
    return context_.assets.add_material(black, name);
}

MaterialId Materials::make_split(const Reading& r, const std::string& name) {
    Reading dielectric = r, metal = r;
    dielectric.metal.reset(), metal.metal.reset();
    metal.surface.base_metalness = {1};
    metal.surface.base_color = r.metal->color;
    metal.surface.specular_weight = 1;
    metal.surface.specular_ior = 1.5f;
    metal.surface.specular_color = {};
    const FloatInput& weight = r.metal->weight;
    if (!weight.texture && weight.value == 0) return make_plain(dielectric, name);
    if (!weight.texture && weight.value == 1) return make_plain(metal, name);
    MaterialId first = make_plain(dielectric, name);
    if (r.metal->reflects) {
        dielectric.surface.specular_weight = 0;
        const MaterialId matte = make_plain(dielectric, name);
        first = context_.assets.add_material(MixMaterial{matte, first, {1, r.metal->reflects}}, name);
    }
    const MaterialId second = make_plain(metal, name);
    return context_.assets.add_material(MixMaterial{first, second, weight}, name);
}

MaterialId Materials::make_plain(const Reading& r, const std::string& name) {
    if (r.metal && !r.unlit) return make_split(r, name);
    const auto simple = r.unlit ? std::nullopt : make_simple(r, name);
    const MaterialId out = r.unlit  ? make_unlit(r, name)
                           : simple ? context_.assets.add_material(*simple, name)
                                    : context_.assets.add_material(below_coat(r.surface), name);
    if (r.normals) context_.loaded.scene.reliefs.push_back({out, *r.normals});
    return out;
}

MaterialId Materials::make(const Reading& r, const std::string& name) {
    if (r.layers.empty()) return make_plain(r, name);
    Reading with = r;
    with.layers.pop_back();
    Reading without = with;
    r.layers.back().remove(without.surface);
    const MaterialId first = make(without, name), second = make(with, name);
    return context_.assets.add_material(MixMaterial{first, second, r.layers.back().weight}, name);
}

/// Section 3.9.3. The map turns the normals; `scale` multiplies what is along the surface.
std::optional<NormalMap> Materials::read_normal_map(const Object& object, std::string_view key, Reading& r) {
    const auto use = images_.use(object, key);
    if (!use) return std::nullopt;
    constexpr double kMost = 100;
    const Object info = *object.object(key);
    const double scale = info.number_or("scale", 1, {-1e30, 1e30});
    if (std::fabs(scale) > kMost)
        context_.not_honoured("the 'scale' of a normal texture beyond 100 is taken as 100", info.offset_of("scale"));
    if (!r.tangents) r.tangents = use->uv_set;
    return NormalMap{texture(*use, Plane::color, ColorSpace::linear, r),
                     static_cast<float>(clamp_to(scale, -kMost, kMost))};
}

void Materials::read_normals(const Object& material, Reading& r) {
    r.normals = read_normal_map(material, "normalTexture", r);
}

Look Materials::finish(const Reading& r, const std::string& name) {
    Look out;
    out.material = make(r, name);
    out.emission = r.emission;
    out.emission_texture = r.emission_texture;
    out.uv_sets = r.uv_sets;
    const bool has_grain = r.surface.specular_roughness_anisotropy.value > 0;
    out.tangents = r.tangents ? r.tangents : has_grain ? std::optional(r.grain_uv_set) : std::nullopt;
    if (out.tangents) out.uv_sets |= 1u << *out.tangents;
    return out;
}

Look Materials::read(const Object& material, VertexColors colors, const std::string& name) {
    const Assets::Here here(context_.assets, material.offset());
    Reading r = start(colors);
    if (const auto other = material.extension("KHR_materials_pbrSpecularGlossiness"))
        read_specular_glossiness(*other, r);
    else
        read_metallic_roughness(material, r);
    if (colors != VertexColors::none) multiply_by_vertices(r.surface.base_color.texture, false);
    read_alpha(material, r);
    read_emission(material, r);
    if (!material.extension("KHR_materials_unlit")) read_normals(material, r);
    read_extensions(material, r);
    Look out = finish(r, name);
    // A colour and no lamp: from behind as from the front, like every surface that does not shine.
    out.two_sided = material.boolean_or("doubleSided", false) || r.unlit;
    return out;
}

const Look& Materials::look(std::optional<uint32_t> number, VertexColors colors) {
    const std::pair key(number, colors);
    if (const auto known = looks_.find(key); known != looks_.end()) return known->second;
    if (!number) {
        Reading r = start(colors);
        if (colors != VertexColors::none) multiply_by_vertices(r.surface.base_color.texture, false);
        return looks_.emplace(key, finish(r, "default material")).first->second;
    }
    const Object material(context_.source, context_.tables.materials.elements[*number], "a material");
    return looks_.emplace(key, read(material, colors, name_of(material, "material", *number))).first->second;
}

}  // namespace steradian::gltf
