// Materials that are put together of others, and the maps that turn their normals.
#include "formats/scene_json/native.h"

namespace steradian::scene_json {

/// How many materials that are no mixes it consists of.
static uint32_t parts_of(const Scene& scene, MaterialId id) {
    const auto* mix = std::get_if<MixMaterial>(&scene.materials[index(id)]);
    return mix ? parts_of(scene, mix->first) + parts_of(scene, mix->second) : 1;
}

MixMaterial NativeLoader::read_mix(ObjectReader& material) {
    static constexpr size_t kTwo[] = {2};
    const Value two = material.require("materials");
    json::expect_array(source_, two, "'materials'", kTwo);
    auto element = two.elements().begin();
    MixMaterial out;
    out.first = use_material(*element);
    out.second = use_material(*++element);
    out.weight = read_input(material, "weight", out.weight);
    const uint32_t parts = parts_of(scene(), out.first) + parts_of(scene(), out.second);
    if (parts > kMaxMixed)
        source_.fail(two.offset(),
                     "a mix of " + std::to_string(parts) + " materials, expected at most " + std::to_string(kMaxMixed));
    return out;
}

TextureId NativeLoader::read_numbers(Value value, std::string_view what) {
    const auto texture = find_texture(value, TextureUse::numbers);
    if (!texture)
        source_.fail(value.offset(),
                     std::string(what) + " must be the name of a texture or a texture, got " + json::describe(value));
    const auto* image = std::get_if<ImageTexture>(&scene().textures[index(*texture)]);
    if (image && image->color_space == ColorSpace::srgb)
        source_.fail(value.offset(), std::string(what) + " has numbers, not colours: its texture must be linear",
                     "give the texture \"color_space\": \"linear\"");
    return *texture;
}

NormalMap NativeLoader::read_normal_map(Value value, std::string_view what) {
    static constexpr Range kStrength{0, 100};
    NormalMap out;
    // A texture has a type, a map has none.
    bool is_texture = !value.is(Kind::object);
    if (!is_texture)
        for (const Member member : value.members()) is_texture = is_texture || member.key == "type";
    if (is_texture) {
        out.texture = read_numbers(value, what);
        return out;
    }
    ObjectReader reader(source_, value, kNormalMapSpec, what);
    out.texture = read_numbers(reader.require("texture"), "a normal map");
    out.strength = reader.number_or("strength", out.strength, kStrength);
    out.flip_y = reader.boolean_or("flip_y", out.flip_y);
    reader.finish();
    return out;
}

std::optional<Relief> NativeLoader::read_relief(ObjectReader& material) {
    static constexpr Range kHeight{-1e6, 1e6};
    const auto normals = material.find("normal_map"), heights = material.find("bump_map");
    if (normals && heights)
        source_.fail(material.key_offset("bump_map"), "either 'normal_map' or 'bump_map', not both");
    Relief out;
    if (normals) {
        out.map = read_normal_map(*normals, "'normal_map'");
    } else if (heights) {
        ObjectReader reader(source_, *heights, kBumpMapSpec, "'bump_map'");
        BumpMap map;
        map.texture = read_numbers(reader.require("texture"), "a bump map");
        if (std::holds_alternative<VertexColorTexture>(scene().textures[index(map.texture)]))
            source_.fail(heights->offset(), "heights must come from an image or a pattern");
        map.scale = reader.number_or("scale", map.scale, kHeight);
        reader.finish();
        out.map = map;
    } else {
        return std::nullopt;
    }
    return out;
}

}  // namespace steradian::scene_json
