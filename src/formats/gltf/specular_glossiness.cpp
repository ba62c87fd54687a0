#include "formats/gltf/specular_glossiness.h"

#include <array>
#include <cstring>

#include "formats/gltf/materials.h"
#include "image/view.h"
#include "math/vector.h"

namespace steradian::gltf {
namespace {

/// Channels of texels in [0, 1], as decode_texels has them: of 8 or 16 bits.
class Texels {
public:
    explicit Texels(const RawImage& image) : image_(image) {
        for (size_t i = 0; i < srgb_.size(); ++i) srgb_[i] = srgb_decode(static_cast<float>(i) / 255);
    }
    float alpha(size_t i) const { return image_.channels % 2 == 0 ? number(i, image_.channels - 1u) : 1; }
    Rgb color(size_t i) const {
        if (image_.channels >= 3) return {decoded(i, 0), decoded(i, 1), decoded(i, 2)};
        const float grey = decoded(i, 0);
        return {grey, grey, grey};
    }

private:
    uint32_t code(size_t texel, size_t channel) const {
        const size_t at = texel * image_.channels + channel;
        if (image_.format == TexelFormat::u8) return std::to_integer<uint32_t>(image_.data[at]);
        uint16_t out = 0;
        std::memcpy(&out, image_.data.data() + at * sizeof(out), sizeof(out));
        return out;
    }
    float number(size_t texel, size_t channel) const {
        return static_cast<float>(code(texel, channel)) / (image_.format == TexelFormat::u8 ? 255.0f : 65535.0f);
    }
    float decoded(size_t texel, size_t channel) const {
        return image_.format == TexelFormat::u8 ? srgb_[code(texel, channel)] : srgb_decode(number(texel, channel));
    }

    const RawImage& image_;
    std::array<float, 256> srgb_;
};

std::byte code_of(float x) { return static_cast<std::byte>(static_cast<int>(clamp_to(x, 0.0f, 1.0f) * 255 + 0.5f)); }

}  // namespace

SplitReflectance split_reflectance(Rgb specular) noexcept {
    constexpr float kLeast = kDielectricReflectance;
    SplitReflectance out;
    const float most = max_component(specular);
    out.dielectric = min_of(most / kLeast, 1.0f);
    out.metalness = clamp_to((most - kLeast) / (1 - kLeast), 0.0f, 1.0f);
    for (int c = 0; c < 3; ++c)
        if (out.metalness > 0)
            out.metal[c] = clamp_to((specular[c] - (1 - out.metalness) * kLeast) / out.metalness, 0.0f, 1.0f);
    return out;
}

RawImage convert_specular_glossiness(const RawImage& map, const SpecularGlossinessPlane& plane) {
    using Part = SpecularGlossinessPlane::Kind;
    const Texels texels(map);
    const SrgbQuantizer quantize;
    const size_t count = size_t(map.width) * map.height;
    RawImage out{map.width, map.height, static_cast<uint8_t>(plane.kind == Part::metal ? 3 : 1), TexelFormat::u8, {}};
    out.data.reserve(count * out.channels);
    for (size_t i = 0; i < count; ++i) {
        if (plane.kind == Part::roughness) {
            out.data.push_back(code_of(1 - plane.glossiness * texels.alpha(i)));
            continue;
        }
        const SplitReflectance split = split_reflectance(texels.color(i) * plane.specular);
        if (plane.kind == Part::metalness) out.data.push_back(code_of(split.metalness));
        if (plane.kind == Part::dielectric) out.data.push_back(code_of(split.dielectric));
        if (plane.kind == Part::metal)
            for (int c = 0; c < 3; ++c) out.data.push_back(std::byte{quantize(split.metal[c])});
    }
    return out;
}

/// In the place of metallic-roughness, as the extension says: a mix of a metal and of a matte surface under a
/// dielectric, which together have its diffuse colour, its reflectance and its roughness.
void Materials::read_specular_glossiness(const Object& extension, Reading& r) {
    using Part = SpecularGlossinessPlane::Kind;
    OpenPbrMaterial& s = r.surface;
    read_color_and_alpha(extension, "diffuseFactor", "diffuseTexture", r);
    s.base_metalness = {0};
    const Rgb specular = color(extension, "specularFactor", {1, 1, 1});
    const float glossiness = unit(extension, "glossinessFactor", 1);
    r.metal.emplace();
    const auto use = images_.use(extension, "specularGlossinessTexture");
    if (!use) {
        const SplitReflectance split = split_reflectance(specular);
        s.specular_roughness = {1 - glossiness};
        s.specular_weight = split.dielectric;
        r.metal->weight = {split.metalness};
        r.metal->color = {split.metal};
        return;
    }
    r.uv_sets |= 1u << use->uv_set;
    const auto plane = [&](Part part) { return images_.texture(*use, {part, specular, glossiness}); };
    s.specular_roughness = {1, plane(Part::roughness)};
    r.metal->weight = {1, plane(Part::metalness)};
    r.metal->color = {{1, 1, 1}, plane(Part::metal)};
    r.metal->reflects = plane(Part::dielectric);
}

/// These say something else about what the extension says already, and their specifications exclude them.
void Materials::report_excluded(const Object& material) {
    for (const char* name : {"KHR_materials_ior", "KHR_materials_specular", "KHR_materials_transmission",
                             "KHR_materials_volume", "KHR_materials_dispersion", "KHR_materials_diffuse_transmission"})
        if (const auto extension = material.extension(name))
            context_.not_honoured(std::string(name) + " has no effect beside KHR_materials_pbrSpecularGlossiness",
                                  extension->offset());
}

}  // namespace steradian::gltf
