#include "formats/scene_json/native.h"

namespace steradian::scene_json {
namespace {

constexpr Range kTextureScale{-1e6, 1e6};
constexpr Range kUnit{0, 1};

constexpr Range kAbbe{1, 1e6};

/// 0 stands for no dispersion.
float read_abbe(ObjectReader& material) {
    const auto value = material.find("abbe");
    const bool none = !value || (value->is(Kind::number) && value->number() == 0);
    return none ? 0 : material.number_or("abbe", 0, kAbbe);
}

std::string with_name(std::string_view what, const std::string& name) {
    return name.empty() ? std::string(what) : std::string(what) + " " + quoted(name);
}

void expect_names(const Source& source, Value value, std::string_view what, std::string_view element) {
    if (!value.is(Kind::object))
        source.fail(value.offset(), quoted(what) + " must be an object with a " + std::string(element) +
                                        " for each name, got " + json::describe(value));
}

/// Where a texture is looked up.
template <class T>
void read_placement(ObjectReader& reader, T& texture) {
    texture.scale = reader.vec2_or("scale", texture.scale, kTextureScale);
    texture.rotation = reader.number_or("rotation", texture.rotation, json::kAnyAngle);
    texture.offset = reader.vec2_or("offset", texture.offset, kTextureScale);
}

/// One word for both directions, or two.
void read_wrap(ObjectReader& reader, ImageTexture& texture) {
    const auto value = reader.find("wrap");
    if (!value) return;
    const Source& source = reader.source();
    if (value->is(Kind::array)) {
        static constexpr size_t kTwo[] = {2};
        json::expect_array(source, *value, "'wrap'", kTwo);
        auto element = value->elements().begin();
        texture.wrap_u = static_cast<Wrap>(json::read_choice(source, *element, "'wrap'", kWraps));
        texture.wrap_v = static_cast<Wrap>(json::read_choice(source, *++element, "'wrap'", kWraps));
    } else {
        texture.wrap_u = texture.wrap_v = static_cast<Wrap>(json::read_choice(source, *value, "'wrap'", kWraps));
    }
}

}  // namespace

void NativeLoader::read_textures(Value value) {
    expect_names(source_, value, "textures", "texture");
    for (const Member member : value.members())
        textures_.insert(member.key, read_texture(member.value, std::string(member.key)));
}

TextureId NativeLoader::read_texture(Value value, const std::string& name, bool numbers) {
    const Assets::Here here(assets_, value.offset());
    const std::string what = with_name("texture", name);
    const size_t type = read_type(source_, value, what, kTextureTypes);
    if (type == 1) return read_image_texture(value, name, numbers);

    ObjectReader reader(source_, value, kTextureSpecs[type], what);
    reader.require("type");
    Texture texture;
    Rgb brightest;
    if (type == 0) {
        brightest = reader.color("color", json::kReflectance);
        texture = ConstantTexture{brightest};
    } else if (type == 3) {
        texture = VertexColorTexture{};
    } else {
        CheckerTexture checker;
        checker.even = reader.color_or("color0", checker.even, json::kReflectance);
        checker.odd = reader.color_or("color1", checker.odd, json::kReflectance);
        read_placement(reader, checker);
        brightest = max_component(checker.even) > max_component(checker.odd) ? checker.even : checker.odd;
        texture = checker;
    }
    reader.finish();
    const TextureId id = assets_.add_texture(texture, name);
    if (max_component(brightest) > 1) too_bright_[id] = {brightest, value.offset()};
    return id;
}

TextureId NativeLoader::read_image_texture(Value value, const std::string& name, bool numbers) {
    ObjectReader reader(source_, value, kTextureSpecs[1], with_name("texture", name));
    reader.require("type");
    const NamedPath path = read_path(reader);
    ImageTexture texture;
    read_wrap(reader, texture);
    const size_t filter = reader.choice_or("filter", 1, kTextureFilters);
    texture.bilinear = filter >= 1;
    texture.mip_map = filter == 2;
    read_placement(reader, texture);
    const auto space = reader.find("color_space");
    const size_t chosen = space ? json::read_choice(source_, *space, "'color_space'", kColorSpaces) : 0;
    reader.finish();
    texture.image = source_.take(assets_.image(path.path), path.offset);
    texture.color_space = space     ? static_cast<ColorSpace>(chosen)
                          : numbers ? ColorSpace::linear
                                    : assets_.default_color_space(texture.image);
    return assets_.add_texture(texture, name);
}

std::optional<TextureId> NativeLoader::find_texture(Value value, TextureUse use) {
    std::optional<TextureId> id;
    if (value.is(Kind::string)) id = textures_.get(source_, value.string(), value.offset());
    if (value.is(Kind::object)) id = read_texture(value, "", use == TextureUse::numbers);
    if (!id || use != TextureUse::reflection) return id;
    if (const auto bright = too_bright_.find(*id); bright != too_bright_.end()) {
        context_.warn_about_reflectance(bright->second.color, bright->second.offset);
        too_bright_.erase(bright);
    }
    return id;
}

TextureId NativeLoader::read_reflectance(ObjectReader& material, std::string_view key) {
    const Value value = material.require(key);
    if (const auto texture = find_texture(value)) return *texture;
    if (!value.is(Kind::number) && !value.is(Kind::array))
        source_.fail(value.offset(), quoted(key) + " must be a colour, the name of a texture or a texture, got " +
                                         json::describe(value));
    const Rgb color = json::read_color(source_, value, quoted(key), json::kReflectance);
    context_.warn_about_reflectance(color, value.offset());
    const Assets::Here here(assets_, value.offset());
    return assets_.add_texture(ConstantTexture{color}, "");
}

Roughness NativeLoader::read_roughness(ObjectReader& material) {
    Roughness out;
    const auto alpha = material.find("alpha"), roughness = material.find("roughness");
    if (alpha && roughness)
        source_.fail(material.key_offset("alpha"), "either 'roughness' or 'alpha', not both: alpha = roughness²");
    out.squared = !alpha;
    const std::string_view key = alpha ? "alpha" : "roughness";
    const std::optional<Value> value = alpha ? alpha : roughness;
    if (!value) return out;
    out.texture = find_texture(*value, TextureUse::weight);
    out.value = out.texture ? Vec2{1, 1} : material.vec2_or(key, out.value, kUnit);
    return out;
}

Rgb NativeLoader::read_tint(ObjectReader& material, std::string_view key) {
    const Rgb color = material.color_or(key, {1, 1, 1}, json::kReflectance);
    context_.warn_about_reflectance(color, material.offset());
    return color;
}

Medium NativeLoader::read_interior(ObjectReader& material) {
    Medium out;
    const auto value = material.find("interior");
    if (!value) return out;
    ObjectReader reader(source_, *value, kMediumSpec, "interior");
    const Range coefficient{0, kMaxMediumCoefficient}, cosine{-kMaxAnisotropy, kMaxAnisotropy};
    out.absorption = reader.color_or("absorption", out.absorption, coefficient);
    out.scattering = reader.color_or("scattering", out.scattering, coefficient);
    out.anisotropy = reader.number_or("anisotropy", out.anisotropy, cosine);
    reader.finish();
    return out;
}

Priority NativeLoader::read_priority(ObjectReader& material) {
    if (!material.find("priority")) return std::nullopt;
    return static_cast<uint32_t>(material.integer_or("priority", 0, 0, 1'000'000));
}

GlassMaterial NativeLoader::read_glass(ObjectReader& material) {
    GlassMaterial out;
    out.eta = material.number_or("eta", out.eta, kEta);
    out.reflectance = read_tint(material, "reflectance");
    out.transmittance = read_tint(material, "transmittance");
    out.roughness = read_roughness(material);
    out.abbe = read_abbe(material);
    out.interior = read_interior(material);
    out.priority = read_priority(material);
    find_no_effect(material, out);
    return out;
}

ConductorMaterial NativeLoader::read_conductor(ObjectReader& material) {
    static constexpr Range kIndexN{1e-3, 1e3}, kIndexK{0, 1e3};
    ConductorMaterial out;
    const auto name = material.find("metal"), n = material.find("n"), reflectance = material.find("reflectance");
    if ((name ? 1 : 0) + (n ? 1 : 0) + (reflectance ? 1 : 0) != 1)
        source_.fail(material.offset(), "a conductor needs one of 'metal', 'n' with 'k', and 'reflectance'");
    if (name) {
        const size_t choice = json::read_choice(source_, *name, "'metal'", metal_names());
        out.reflectance = *metal_index(metal_names()[choice]);
    } else if (n) {
        out.reflectance = ComplexIndex{material.color("n", kIndexN), material.color("k", kIndexK)};
    } else {
        SchlickReflectance schlick{read_reflectance(material), {1, 1, 1}};
        schlick.grazing = material.color_or("edge_reflectance", schlick.grazing, json::kReflectance);
        context_.warn_about_reflectance(schlick.grazing, material.offset());
        out.reflectance = schlick;
    }
    out.roughness = read_roughness(material);
    out.tint = material.color_or("tint", out.tint, json::kReflectance);
    context_.warn_about_reflectance(out.tint, material.offset());
    return out;
}

DiffuseTransmissionMaterial NativeLoader::read_diffuse_transmission(ObjectReader& material) {
    DiffuseTransmissionMaterial out;
    out.reflectance = read_reflectance(material);
    out.transmittance = read_reflectance(material, "transmittance");
    const auto* r = std::get_if<ConstantTexture>(&scene().textures[index(out.reflectance)]);
    const auto* t = std::get_if<ConstantTexture>(&scene().textures[index(out.transmittance)]);
    // Each by itself has been looked at.
    if (r && t && max_component(r->value) <= 1 && max_component(t->value) <= 1)
        context_.warn_about_reflectance(r->value + t->value, material.offset());
    return out;
}

void NativeLoader::read_materials(Value value) {
    expect_names(source_, value, "materials", "material");
    for (const Member member : value.members())
        materials_.insert(member.key, read_material(member.value, std::string(member.key)));
}

MaterialId NativeLoader::read_material(Value value, const std::string& name) {
    const Assets::Here here(assets_, value.offset());
    const std::string what = with_name("material", name);
    const size_t type = read_type(source_, value, what, kMaterialTypes);
    ObjectReader reader(source_, value, kMaterialSpecs[type], what);
    reader.require("type");
    Material material;
    switch (type) {
        case 0: {
            DiffuseMaterial diffuse;
            diffuse.reflectance = read_reflectance(reader);
            diffuse.two_sided = reader.boolean_or("two_sided", false);
            diffuse.roughness = reader.number_or("roughness", 0, kUnit);
            material = diffuse;
            break;
        }
        case 1:
            material = RefractionMaterial{reader.number_or("eta", 1.5f, kEta)};
            break;
        case 2:
            material = read_glass(reader);
            break;
        case 3:
            material = MirrorMaterial{read_tint(reader, "reflectance")};
            break;
        case 4:
            material = read_conductor(reader);
            break;
        case 5: {
            ThinGlassMaterial sheet;
            sheet.eta = reader.number_or("eta", sheet.eta, kEta);
            sheet.transmittance = reader.color_or("transmittance", sheet.transmittance, kUnit);
            material = sheet;
            break;
        }
        case 7:
            material = read_open_pbr(reader);
            break;
        case 8:
            material = read_mix(reader);
            break;
        default:
            material = read_diffuse_transmission(reader);
            break;
    }
    std::optional<Relief> relief;
    if (type != 8) relief = read_relief(reader);
    reader.finish();
    const MaterialId id = assets_.add_material(material, name);
    if (relief) {
        relief->material = id;
        scene().reliefs.push_back(*relief);
    }
    return id;
}

MaterialId NativeLoader::use_material(Value value) {
    if (value.is(Kind::string)) return materials_.get(source_, value.string(), value.offset());
    if (value.is(Kind::object)) return read_material(value, "");
    source_.fail(value.offset(),
                 "'material' must be the name of a material or a material, got " + json::describe(value));
}

}  // namespace steradian::scene_json
