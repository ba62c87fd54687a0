// KHR_materials_pbrSpecularGlossiness: what such surfaces reflect is what the extension says.
#include "formats/gltf/specular_glossiness.h"

#include <cmath>

#include "image/tone.h"
#include "wall.h"

namespace steradian {
namespace {

using namespace test;

constexpr const char* kExtension = "KHR_materials_pbrSpecularGlossiness";

std::string by(const std::string& members, const std::string& more = {}) {
    return "\"extensions\": {\"" + std::string(kExtension) + "\": {" + members + "}" + more + "}";
}
std::string triple(Rgb c) {
    return "[" + std::to_string(c.r) + ", " + std::to_string(c.g) + ", " + std::to_string(c.b) + "]";
}
std::string quadruple(Rgb c) {
    return "[" + std::to_string(c.r) + ", " + std::to_string(c.g) + ", " + std::to_string(c.b) + ", 1]";
}

/// For any reflectance: the two parts make it up, and the dielectric leaves 1 - max for what lies below it.
TEST(GltfSpecularGlossiness, PartsMakeUpTheWhole) {
    const double least = gltf::kDielectricReflectance;
    for (int i = 0; i < 1000; ++i) {
        const Rgb s{float(i % 10) / 9, float(i / 10 % 10) / 9, float(i / 100) / 9};
        const gltf::SplitReflectance split = gltf::split_reflectance(s);
        const double rest = 1 - double(split.metalness), most = double(max_component(s));
        ASSERT_GE(split.metalness, 0);
        ASSERT_LE(split.metalness, 1);
        EXPECT_NEAR(rest * (1 - least * double(split.dielectric)), 1 - most, 1e-6);
        for (int c = 0; c < 3; ++c) {
            const double sum =
                double(split.metalness) * double(split.metal[c]) + rest * least * double(split.dielectric);
            // What would have to be less than nothing is nothing: there the dielectric alone reflects more.
            EXPECT_NEAR(sum, std::max(double(s[c]), rest * least * double(split.dielectric)), 1e-6);
            ASSERT_LE(split.metal[c], 1);
        }
    }
    EXPECT_EQ(gltf::split_reflectance({0.02f, 0.01f, 0.02f}).metalness, 0);
    EXPECT_FLOAT_EQ(gltf::split_reflectance({0.02f, 0.01f, 0.02f}).dielectric, 0.5f);
}

void expect_color(const Mean& mean, Rgb expected) {
    EXPECT_LT(mean.error, 1e-3);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean.color[c], expected[c], 5 * mean.error + 5e-4) << c << " of " << triple(expected);
}
/// F0 + (1 - max F0) diffuse: at a right angle Schlick's factor is F0.
Rgb closed_form(Rgb diffuse, Rgb specular) { return specular + diffuse * (1 - max_component(specular)); }

TEST(GltfSpecularGlossiness, PolishedWallsReflectWhatTheyShould) {
    const Rgb diffuse{0.2f, 0.6f, 0.8f};
    for (const Rgb specular : {Rgb{0.04f, 0.04f, 0.04f}, Rgb{0.02f, 0.02f, 0.02f}, Rgb{0.5f, 0.3f, 0.1f},
                               Rgb{1, 0.766f, 0.336f}, Rgb{0, 0, 0}, Rgb{0.06f, 0.05f, 0.045f}}) {
        const LoadedScene loaded =
            wall(by("\"diffuseFactor\": " + quadruple(diffuse) + ", \"specularFactor\": " + triple(specular)));
        expect_color(under_a_white_sky(loaded.scene, 0, kWidth), closed_form(diffuse, specular));
    }
}

/// On the left a brownish texel, on the right a white one; then one that reflects nothing, and one that reflects less
/// than the dielectric, which has no colour.
TEST(GltfSpecularGlossiness, MapsMultiplyTheFactors) {
    const Rgb diffuse{0.4f, 0.3f, 0.9f}, factor{0.5f, 0.8f, 0.6f};
    const auto scene = [&](const std::vector<int>& rgba) {
        return wall(by("\"diffuseFactor\": " + quadruple(diffuse) + ", \"specularFactor\": " + triple(factor) +
                       ", \"specularGlossinessTexture\": {\"index\": 0}"),
                    texture_of(rgba))
            .scene;
    };
    const Scene two = scene({186, 100, 60, 255, 255, 255, 255, 255});
    const auto linear = [](int code) { return srgb_decode(static_cast<float>(code) / 255); };
    const Rgb left = Rgb{linear(186), linear(100), linear(60)} * factor;
    // A code of 8 bits is half of a 255th off, in sRGB or of the part that is metal.
    const auto near = [](const Mean& mean, Rgb expected) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean.color[c], expected[c], 5 * mean.error + 4e-3) << c;
    };
    near(under_a_white_sky(two, 0, kWidth / 2), closed_form(diffuse, left));
    near(under_a_white_sky(two, kWidth / 2, kWidth), closed_form(diffuse, factor));
    near(under_a_white_sky(scene({0, 0, 0, 255}), 0, kWidth), diffuse);
    const float dim = max_component(factor * linear(40));
    near(under_a_white_sky(scene({40, 40, 40, 255}), 0, kWidth), closed_form(diffuse, {dim, dim, dim}));
}

template <class M>
M part(const Scene& scene, MaterialId id) {
    return std::get<M>(scene.materials[index(id)]);
}

TEST(GltfSpecularGlossiness, GlossIsOneMinusRoughness) {
    const LoadedScene loaded = wall(by("\"specularFactor\": [0.52, 0.52, 0.52], \"glossinessFactor\": 0.7"));
    const auto mix = part<MixMaterial>(loaded.scene, loaded.scene.instances.at(0).material);
    EXPECT_FLOAT_EQ(mix.weight.value, 0.5f);
    for (const MaterialId id : {mix.first, mix.second})
        EXPECT_FLOAT_EQ(part<OpenPbrMaterial>(loaded.scene, id).specular_roughness.value, 0.3f);
    EXPECT_EQ(part<OpenPbrMaterial>(loaded.scene, mix.first).base_metalness.value, 0);
    EXPECT_EQ(part<OpenPbrMaterial>(loaded.scene, mix.second).base_metalness.value, 1);

    const LoadedScene mapped = wall(by("\"glossinessFactor\": 0.5, \"specularGlossinessTexture\": {\"index\": 0}"),
                                    texture_of({9, 9, 9, 0, 9, 9, 9, 102, 9, 9, 9, 255}));
    const auto both = part<MixMaterial>(mapped.scene, mapped.scene.instances.at(0).material);
    const auto dielectric = part<MixMaterial>(mapped.scene, both.first);
    EXPECT_TRUE(part<DiffuseMaterial>(mapped.scene, dielectric.first).two_sided);
    const TextureId rough = *part<OpenPbrMaterial>(mapped.scene, dielectric.second).specular_roughness.texture;
    const auto& texture = std::get<ImageTexture>(mapped.scene.textures[index(rough)]);
    EXPECT_EQ(texture.color_space, ColorSpace::linear);
    EXPECT_EQ(mapped.scene.images[index(texture.image)].data,
              (std::vector{std::byte{255}, std::byte{204}, std::byte{128}}));
    EXPECT_EQ(part<OpenPbrMaterial>(mapped.scene, both.second).specular_roughness.texture, rough);
}

/// Colours of 16 bits and grey ones have the same meaning.
TEST(GltfSpecularGlossiness, MapsOfAllKindsOfTexels) {
    using Part = gltf::SpecularGlossinessPlane::Kind;
    const RawImage bytes{1, 1, 4, TexelFormat::u8, {std::byte{200}, std::byte{200}, std::byte{200}, std::byte{51}}};
    RawImage words{1, 1, 2, TexelFormat::u16, {}};  // grey and alpha; 200 · 257 and 51 · 257
    for (const int x : {200, 51}) words.data.insert(words.data.end(), 2, std::byte(x));
    const RawImage opaque{1, 1, 1, TexelFormat::u8, {std::byte{200}}};
    for (const Part kind : {Part::metalness, Part::metal, Part::dielectric, Part::roughness}) {
        const gltf::SpecularGlossinessPlane plane{kind, {1, 0.5f, 0.25f}, 0.8f};
        const RawImage out = convert_specular_glossiness(bytes, plane);
        EXPECT_EQ(out.channels, kind == Part::metal ? 3 : 1);
        EXPECT_EQ(convert_specular_glossiness(words, plane).data, out.data);
        if (kind == Part::roughness)
            EXPECT_EQ(std::to_integer<int>(convert_specular_glossiness(opaque, plane).data[0]), 51);
        else
            EXPECT_EQ(convert_specular_glossiness(opaque, plane).data, out.data);
    }
}

TEST(GltfSpecularGlossiness, AlphaOpacityAndReliefAreThoseOfTheMaterial) {
    const LoadedScene loaded =
        wall("\"alphaMode\": \"BLEND\", \"normalTexture\": {\"index\": 0}, " +
             by("\"diffuseFactor\": [0.1, 0.2, 0.3, 0.5], \"specularFactor\": [0.5, 0.5, 0.5], \"diffuseTexture\": "
                "{\"index\": 0}"));
    const Scene& scene = loaded.scene;
    const auto mix = part<MixMaterial>(scene, scene.instances.at(0).material);
    ASSERT_EQ(scene.reliefs.size(), 2u);
    for (const MaterialId id : {mix.first, mix.second}) {
        const auto m = part<OpenPbrMaterial>(scene, id);
        EXPECT_EQ(m.geometry_opacity.value, 0.5f);
        EXPECT_TRUE(m.geometry_opacity.texture);
    }
    EXPECT_EQ(part<OpenPbrMaterial>(scene, mix.first).base_color.value, (Rgb{0.1f, 0.2f, 0.3f}));
    EXPECT_TRUE(part<OpenPbrMaterial>(scene, mix.first).base_color.texture);
    EXPECT_FALSE(part<OpenPbrMaterial>(scene, mix.second).base_color.texture);
}

/// It takes the place of metallic-roughness, may be required, and its factors are clamped.
TEST(GltfSpecularGlossiness, IsReadInstead) {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle);
    const auto load = [&](const std::string& material) {
        return good_gltf(b.text(one_mesh(p, ", \"material\": 0") + ", \"extensionsUsed\": [\"" + kExtension +
                                "\"], \"extensionsRequired\": [\"" + kExtension + "\"], \"materials\": [{" + material +
                                "}]"));
    };
    const LoadedScene both =
        load("\"pbrMetallicRoughness\": {\"baseColorFactor\": [1, 0, 0, 1]}, " +
             by("\"diffuseFactor\": [0, 1, 0, 1], \"specularFactor\": [0.04, 0.04, 0.04], \"glossinessFactor\": 0.5"));
    EXPECT_EQ(part<OpenPbrMaterial>(both.scene, MaterialId{0}).base_color.value, (Rgb{0, 1, 0}));
    EXPECT_TRUE(both.fidelity.empty());
    const LoadedScene clamped = load(by("\"specularFactor\": [2, 0.5, -1], \"glossinessFactor\": 0.5"));
    EXPECT_TRUE(has(clamped.diagnostics, "'specularFactor' of a material must be between 0 and 1"));
    EXPECT_EQ(part<OpenPbrMaterial>(clamped.scene, MaterialId{0}).base_color.value, (Rgb{1, 0.5f, 0}));
    const LoadedScene beside = load(by("\"glossinessFactor\": 0.5",
                                       ", \"KHR_materials_ior\": {\"ior\": 2}, \"KHR_materials_transmission\": "
                                       "{\"transmissionFactor\": 1}"));
    EXPECT_TRUE(has(beside.fidelity, "KHR_materials_ior has no effect beside"));
    EXPECT_TRUE(has(beside.fidelity, "KHR_materials_transmission has no effect beside"));
    EXPECT_EQ(part<OpenPbrMaterial>(beside.scene, MaterialId{0}).transmission_weight.value, 0);
}

}  // namespace
}  // namespace steradian
