// Textures of the extensions of materials: where the texel is 0 or 1, a surface has the bits of one without the
// texture.
#include "wall.h"

namespace steradian {
namespace {

using namespace test;

struct TexturedFactor {
    std::string base, extension;
    std::string textured, left, right;  ///< members of the extension
};

void expect_halves(const TexturedFactor& f) {
    SCOPED_TRACE(f.extension + " " + f.textured);
    const auto with = [&](const std::string& members) {
        return picture("\"pbrMetallicRoughness\": {\"baseColorFactor\": [0.8, 0.6, 0.4, 1], " + f.base +
                       "}, \"extensions\": {\"" + f.extension + "\": {" + members + "}}");
    };
    const std::vector<Rgb> textured = with(f.textured), left = with(f.left), right = with(f.right);
    size_t same = 0, different = 0;
    for (size_t i = 0; i < textured.size(); ++i) {
        same += textured[i] == (i % kWidth < kWidth / 2 ? left[i] : right[i]);
        different += left[i] != right[i];
    }
    EXPECT_EQ(same, textured.size());
    EXPECT_EQ(different, textured.size());
}

constexpr const char* kMatte = "\"metallicFactor\": 0, \"roughnessFactor\": 0.4";
constexpr const char* kRough = "\"metallicFactor\": 0, \"roughnessFactor\": 1";

/// Values of a factor, with more members of the extension: of the textured surface, and of the two halves.
TexturedFactor textured(const std::string& extension, const std::string& factor, const std::string& texture,
                        const std::string& left, const std::string& right, int number, const std::string& more) {
    const auto at = [&](const std::string& value) { return "\"" + factor + "\": " + value + more; };
    return {kMatte, extension, at(right) + ", \"" + texture + "\": {\"index\": " + std::to_string(number) + "}",
            at(left), at(right)};
}
TexturedFactor weight(const std::string& extension, const std::string& factor, const std::string& texture,
                      const std::string& more = {}) {
    return textured(extension, factor, texture, "0", "0.7", 0, more);
}
/// Their tables are over all roughnesses, and exact at both ends.
TexturedFactor roughness(const std::string& extension, const std::string& factor, const std::string& texture,
                         const std::string& more) {
    TexturedFactor out = textured(extension, factor, texture, "0", "1", 0, more);
    out.base = kRough;
    return out;
}
TexturedFactor color(const std::string& extension, const std::string& factor, const std::string& texture,
                     const std::string& more = {}) {
    return textured(extension, factor, texture, "[1, 0, 0]", "[1, 1, 1]", 1, more);
}

TEST(GltfExtensionTextures, Weights) {
    TexturedFactor specular = weight("KHR_materials_specular", "specularFactor", "specularTexture");
    expect_halves(specular);
    specular.base = "\"metallicFactor\": 0.5, \"roughnessFactor\": 0.4";
    expect_halves(specular);
    expect_halves(weight("KHR_materials_clearcoat", "clearcoatFactor", "clearcoatTexture",
                         ", \"clearcoatRoughnessFactor\": 0.2"));
    expect_halves(weight("KHR_materials_transmission", "transmissionFactor", "transmissionTexture"));
    expect_halves(weight("KHR_materials_iridescence", "iridescenceFactor", "iridescenceTexture"));
    expect_halves(weight("KHR_materials_diffuse_transmission", "diffuseTransmissionFactor",
                         "diffuseTransmissionTexture", ", \"diffuseTransmissionColorFactor\": [0.2, 0.9, 0.1]"));
}

TEST(GltfExtensionTextures, Roughnesses) {
    expect_halves(roughness("KHR_materials_clearcoat", "clearcoatRoughnessFactor", "clearcoatRoughnessTexture",
                            ", \"clearcoatFactor\": 0.8"));
    expect_halves(roughness("KHR_materials_sheen", "sheenRoughnessFactor", "sheenRoughnessTexture",
                            ", \"sheenColorFactor\": [0.5, 0.7, 0.9]"));
}

TEST(GltfExtensionTextures, Colours) {
    expect_halves(color("KHR_materials_specular", "specularColorFactor", "specularColorTexture"));
    expect_halves(
        color("KHR_materials_sheen", "sheenColorFactor", "sheenColorTexture", ", \"sheenRoughnessFactor\": 0.5"));
    expect_halves(color("KHR_materials_diffuse_transmission", "diffuseTransmissionColorFactor",
                        "diffuseTransmissionColorTexture", ", \"diffuseTransmissionFactor\": 0.7"));
}

/// Each plane of the picture is read where the extension says so.
TEST(GltfExtensionTextures, Channels) {
    const LoadedScene loaded = wall(
        "\"extensions\": {\"KHR_materials_clearcoat\": {\"clearcoatFactor\": 1, \"clearcoatTexture\": {\"index\": 1}, "
        "\"clearcoatRoughnessFactor\": 1, \"clearcoatRoughnessTexture\": {\"index\": 1}}, \"KHR_materials_sheen\": "
        "{\"sheenColorFactor\": [1, 1, 1], \"sheenRoughnessTexture\": {\"index\": 1}}}");
    const Scene& scene = loaded.scene;
    const auto& mix = std::get<MixMaterial>(scene.materials[index(scene.instances.at(0).material)]);
    const auto& with = std::get<OpenPbrMaterial>(scene.materials[index(mix.second)]);
    EXPECT_EQ(std::get<OpenPbrMaterial>(scene.materials[index(mix.first)]).coat_weight, 0);
    EXPECT_EQ(with.coat_weight, 1);
    const auto image_of = [&](TextureId id) {
        const auto& texture = std::get<ImageTexture>(scene.textures[index(id)]);
        EXPECT_EQ(texture.color_space, ColorSpace::linear);
        return scene.images[index(texture.image)].data;
    };
    const auto bytes = [](int a, int b) { return std::vector{std::byte(a), std::byte(b)}; };
    EXPECT_EQ(image_of(*mix.weight.texture), bytes(255, 255));         // red
    EXPECT_EQ(image_of(*with.coat_roughness.texture), bytes(0, 255));  // green
    // A picture without alpha is opaque.
    const auto& squared = std::get<ProductTexture>(scene.textures[index(*with.fuzz_roughness.texture)]);
    EXPECT_EQ(squared.first, squared.second);
    EXPECT_EQ(image_of(squared.first), std::vector{std::byte(255)});
}

TEST(GltfExtensionTextures, TwoWeightsAtMost) {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle);
    const std::string weight = "\"index\": 0}}";
    const LoadedScene loaded = good_gltf(
        b.text(one_mesh(p, ", \"material\": 0") +
               ", \"materials\": [{\"normalTexture\": {\"index\": 1}, \"extensions\": {\"KHR_materials_specular\": "
               "{\"specularTexture\": {" +
               weight + ", \"KHR_materials_clearcoat\": {\"clearcoatFactor\": 1, \"clearcoatTexture\": {" + weight +
               ", \"KHR_materials_iridescence\": {\"iridescenceFactor\": 1, \"iridescenceTexture\": {" + weight +
               "}}], " + kTextures));
    EXPECT_TRUE(has(loaded.fidelity, "'iridescenceTexture' has no effect"));
    EXPECT_EQ(loaded.fidelity.warnings().size(), 1u);
    EXPECT_EQ(loaded.scene.materials.size(), 7u);  // four and the mixes
    ASSERT_EQ(loaded.scene.reliefs.size(), 4u);    // each has its own
    for (const Relief& r : loaded.scene.reliefs)
        EXPECT_TRUE(std::holds_alternative<OpenPbrMaterial>(loaded.scene.materials[index(r.material)]));
}

}  // namespace
}  // namespace steradian
