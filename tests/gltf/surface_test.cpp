// What turns and colours the surface of a primitive: normal maps, tangents, colours of vertices, sets of coordinates.
#include <cmath>

#include "gltf_builder.h"

namespace steradian {
namespace {

using namespace test;

/// A PNG of one grey texel, to be named by textures.
constexpr std::string_view kPng =
    "\"images\": [{\"uri\": \"data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mNoAAAAggCB2kUIOwAAAABJRU5ErkJggg==\"}], "
    "\"textures\": [{\"source\": 0}]";

/// A square in the plane z = 0 with normals; u to the right, v downwards.
class Square {
public:
    Square() {
        add("POSITION", builder.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}));
        add("TEXCOORD_0", builder.floats("VEC2", 2, {0, 1, 1, 1, 1, 0, 0, 0}));
        indices = builder.accessor<uint16_t>("SCALAR", 5123, 1, {0, 1, 2, 0, 2, 3});
    }
    void add(const std::string& name, int accessor) {
        attributes += (attributes.empty() ? "" : ", ") + ("\"" + name + "\": ") + std::to_string(accessor);
    }
    void add_normals() { add("NORMAL", builder.floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})); }
    LoadedScene load(const std::string& material) const { return good_gltf(text(material)); }
    std::string text(const std::string& material) const {
        return builder.text("\"meshes\": [{\"primitives\": [{\"attributes\": {" + attributes + "}, \"indices\": " +
                            std::to_string(indices) + ", \"material\": 0}]}], \"nodes\": [{\"mesh\": 0}], " +
                            "\"materials\": [{" + material + "}], " + std::string(kPng));
    }
    GltfBuilder builder;
    std::string attributes;
    int indices = 0;
};

template <class M>
M material_of(const LoadedScene& loaded) {
    return std::get<M>(loaded.scene.materials[index(loaded.scene.instances.at(0).material)]);
}

TEST(GltfNormalMap, MakesTangentsWhereThereAreNone) {
    Square square;
    square.add_normals();
    const LoadedScene loaded = square.load("\"normalTexture\": {\"index\": 0, \"scale\": -0.5}");
    ASSERT_EQ(loaded.scene.reliefs.size(), 1u);
    EXPECT_EQ(loaded.scene.reliefs[0].material, loaded.scene.instances.at(0).material);
    const auto& map = std::get<NormalMap>(loaded.scene.reliefs[0].map);
    EXPECT_EQ(map.strength, -0.5f);
    EXPECT_FALSE(map.flip_y);
    EXPECT_EQ(std::get<ImageTexture>(loaded.scene.textures[index(map.texture)]).color_space, ColorSpace::linear);
    ASSERT_EQ(loaded.scene.meshes.at(0).tangents.size(), 4u);
    for (const Tangent& t : loaded.scene.meshes[0].tangents) EXPECT_EQ(t, (Tangent{{1, 0, 0}, 1}));
    EXPECT_TRUE(loaded.fidelity.empty());
}

TEST(GltfNormalMap, TakesTangentsThatAreGiven) {
    Square square;
    square.add_normals();
    square.add("TANGENT", square.builder.floats("VEC4", 4, {0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, 1, 0, 1, 0, 1}));
    const LoadedScene loaded = square.load("\"normalTexture\": {\"index\": 0}");
    EXPECT_EQ(loaded.scene.meshes.at(0).tangents.at(0), (Tangent{{0, 1, 0}, -1}));
    EXPECT_EQ(loaded.scene.meshes.at(0).tangents.at(3), (Tangent{{0, 1, 0}, 1}));
    // Nobody looks at them without a map, and a flat surface has no use for them.
    EXPECT_TRUE(square.load("").scene.meshes.at(0).tangents.empty());
    Square flat;
    flat.add("TANGENT", flat.builder.floats("VEC4", 4, std::vector<float>(16, 1)));
    const LoadedScene loaded_flat = flat.load("\"normalTexture\": {\"index\": 0}");
    EXPECT_TRUE(loaded_flat.scene.meshes.at(0).tangents.empty());
    EXPECT_EQ(loaded_flat.scene.reliefs.size(), 1u);
}

TEST(GltfNormalMap, SurfacesWithAGrainHaveTangents) {
    Square square;
    square.add_normals();
    const LoadedScene loaded = square.load(
        "\"pbrMetallicRoughness\": {\"roughnessFactor\": 0.5}, \"extensions\": {\"KHR_materials_anisotropy\": "
        "{\"anisotropyStrength\": 0.5}}");
    EXPECT_EQ(loaded.scene.meshes.at(0).tangents.size(), 4u);
    EXPECT_TRUE(loaded.scene.reliefs.empty());
}

TEST(GltfTexture, SetsOfCoordinatesAndTransforms) {
    Square square;
    square.add("TEXCOORD_2", square.builder.floats("VEC2", 2, {5, 6, 0, 0, 0, 0, 0, 0}));
    const LoadedScene loaded = square.load(
        "\"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": 0, \"texCoord\": 1, \"extensions\": "
        "{\"KHR_texture_transform\": {\"texCoord\": 2, \"rotation\": 1.5707963267948966, \"scale\": [2, 3], "
        "\"offset\": [4, 5]}}}, \"metallicRoughnessTexture\": {\"index\": 0}}");
    const auto m = material_of<OpenPbrMaterial>(loaded);
    const auto& color = std::get<ImageTexture>(loaded.scene.textures[index(*m.base_color.texture)]);
    EXPECT_EQ(color.uv_set, 2u);
    EXPECT_EQ(color.rotation, 90);
    EXPECT_EQ(color.scale, (Vec2{2, 3}));
    EXPECT_EQ(color.offset, (Vec2{4, 5}));
    EXPECT_EQ(std::get<ImageTexture>(loaded.scene.textures[index(*m.base_metalness.texture)]).uv_set, 0u);
    const Mesh& mesh = loaded.scene.meshes.at(0);
    EXPECT_EQ(mesh.uvs.at(0), (Vec2{0, 1}));
    ASSERT_EQ(mesh.more_uvs.size(), 2u);
    EXPECT_TRUE(mesh.more_uvs[0].empty());
    EXPECT_EQ(mesh.more_uvs[1].at(0), (Vec2{5, 6}));
    EXPECT_TRUE(loaded.fidelity.empty());
    // The first set is always there, others where somebody reads them.
    const Mesh unread = square.load("").scene.meshes.at(0);
    EXPECT_EQ(unread.uvs.size(), 4u);
    EXPECT_TRUE(unread.more_uvs.empty());
}

TEST(GltfTexture, SetsThatAreNotThere) {
    const LoadedScene missing =
        Square().load("\"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": 0, \"texCoord\": 3}}");
    EXPECT_TRUE(has(missing.diagnostics, "lacks texture coordinates"));
    EXPECT_EQ(missing.scene.meshes.at(0).more_uvs.at(2), std::vector<Vec2>(4));
    const LoadedScene beyond =
        Square().load("\"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": 0, \"texCoord\": 8}}");
    EXPECT_TRUE(has(beyond.fidelity, "beyond number 7"));
    EXPECT_EQ(beyond.scene.meshes.at(0).uvs.size(), 4u);
}

/// One colour for all vertices.
template <class T>
Rgb color_of(int component, const std::vector<T>& color, bool normalized) {
    Square square;
    std::vector<T> values;
    for (int i = 0; i < 4; ++i) values.insert(values.end(), color.begin(), color.end());
    square.add("COLOR_0", square.builder.accessor<T>(color.size() == 3 ? "VEC3" : "VEC4", component, color.size(),
                                                     values, normalized ? ", \"normalized\": true" : ""));
    return square.load("").scene.meshes.at(0).colors.at(3);
}

TEST(GltfVertexColors, EveryComponentType) {
    EXPECT_EQ((color_of<float>(5126, {0.25f, 0.5f, 1}, false)), (Rgb{0.25f, 0.5f, 1}));
    EXPECT_EQ((color_of<float>(5126, {0.25f, 0.5f, 1, 0.5f}, false)), (Rgb{0.25f, 0.5f, 1}));
    EXPECT_EQ((color_of<uint8_t>(5121, {0, 51, 255, 255}, true)), (Rgb{0, 0.2f, 1}));
    EXPECT_EQ((color_of<uint16_t>(5123, {0, 13107, 65535, 65535}, true)), (Rgb{0, 0.2f, 1}));
    EXPECT_EQ((color_of<float>(5126, {-1, 2, std::nanf("")}, false)), (Rgb{0, 1, 0}));  // clamped
}

TEST(GltfVertexColors, OtherTypesAreRefused) {
    for (const auto& [type, component] : {std::pair("VEC2", 5126), {"VEC3", 5125}, {"VEC4", 5121}, {"VEC3", 5122}}) {
        Square square;
        square.add("COLOR_0", square.builder.raw_accessor("\"componentType\": " + std::to_string(component) +
                                                          ", \"count\": 4, \"type\": \"" + type + "\""));
        expect_refused(square.text(""), "/meshes/0/primitives/0/attributes/COLOR_0", "'COLOR_0' must be");
    }
}

TEST(GltfVertexColors, MultiplyColourAndAlpha) {
    Square square;
    square.add("COLOR_0", square.builder.floats("VEC4", 4, std::vector<float>(16, 0.5f)));
    const LoadedScene plain = square.load("\"alphaMode\": \"BLEND\"");
    const auto m = material_of<OpenPbrMaterial>(plain);
    EXPECT_FALSE(std::get<VertexColorTexture>(plain.scene.textures[index(*m.base_color.texture)]).alpha);
    EXPECT_TRUE(std::get<VertexColorTexture>(plain.scene.textures[index(*m.geometry_opacity.texture)]).alpha);
    EXPECT_EQ(plain.scene.meshes.at(0).alphas, std::vector<float>(4, 0.5f));
    // Opaque: alpha says nothing.
    EXPECT_FALSE(material_of<OpenPbrMaterial>(square.load("")).geometry_opacity.texture);
    const LoadedScene textured =
        square.load("\"alphaMode\": \"MASK\", \"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": 0}}");
    const auto t = material_of<OpenPbrMaterial>(textured);
    for (const auto& [texture, alpha] : {std::pair(t.base_color.texture, false), {t.geometry_opacity.texture, true}}) {
        const auto& product = std::get<ProductTexture>(textured.scene.textures[index(*texture)]);
        EXPECT_TRUE(std::holds_alternative<ImageTexture>(textured.scene.textures[index(product.first)]));
        EXPECT_EQ(std::get<VertexColorTexture>(textured.scene.textures[index(product.second)]).alpha, alpha);
    }
}

/// Primitives with colours and without share a material in the file, not in the scene.
TEST(GltfVertexColors, BelongToThePrimitive) {
    GltfBuilder b;
    const std::string p = std::to_string(b.floats("VEC3", 3, kTriangle));
    const std::string with = ", \"COLOR_0\": " + std::to_string(b.floats("VEC3", 3, std::vector<float>(9, 0.5f)));
    const auto primitive = [&](const std::string& more) {
        return "{\"attributes\": {\"POSITION\": " + p + more + "}}";
    };
    const LoadedScene loaded = good_gltf(b.text("\"meshes\": [{\"primitives\": [" + primitive(with) + ", " +
                                                primitive("") + "]}], \"nodes\": [{\"mesh\": 0}]"));
    ASSERT_EQ(loaded.scene.instances.size(), 2u);
    EXPECT_EQ(loaded.scene.meshes.at(0).colors.size(), 3u);
    EXPECT_TRUE(loaded.scene.meshes.at(1).colors.empty());
    const auto has_texture = [&](size_t instance) {
        const Material& m = loaded.scene.materials[index(loaded.scene.instances[instance].material)];
        return std::get<OpenPbrMaterial>(m).base_color.texture.has_value();
    };
    EXPECT_TRUE(has_texture(0));
    EXPECT_FALSE(has_texture(1));
}

}  // namespace
}  // namespace steradian
