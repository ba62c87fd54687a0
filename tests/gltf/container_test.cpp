// What a file is made of: binary files, URIs, JSON pointers in messages.
#include "formats/gltf/container.h"

#include "formats/gltf/uri.h"
#include "gltf_builder.h"

namespace steradian {
namespace {

using namespace test;

std::string triangle_file(bool binary) {
    GltfBuilder b;
    const int positions = b.floats("VEC3", 3, kTriangle);
    return binary ? b.binary(one_mesh(positions)) : b.text(one_mesh(positions));
}

TEST(GltfContainer, TextAndBinaryFilesSayTheSame) {
    const LoadedScene text = good_gltf(triangle_file(false)), binary = good_gltf(triangle_file(true));
    EXPECT_EQ(scene_hash(text.scene), scene_hash(binary.scene));
    ASSERT_EQ(binary.scene.meshes.size(), 1u);
    EXPECT_EQ(binary.scene.meshes[0].positions[1], (Vec3{1, 0, 0}));
}

TEST(GltfContainer, CutOffBinaryFilesAreRefused) {
    const std::string whole = triangle_file(true);
    for (size_t size = 4; size < whole.size(); ++size) {
        const auto loaded = load_gltf(whole.substr(0, size));
        ASSERT_FALSE(loaded.ok()) << size;
        EXPECT_TRUE(loaded.error().where.byte.has_value()) << loaded.error().str();
    }
}

TEST(GltfContainer, LiesInTheHeaderAreRefusedAtTheirByte) {
    const auto at = [](size_t offset, uint32_t value) {
        std::string bytes = triangle_file(true);
        std::memcpy(bytes.data() + offset, &value, 4);
        const auto loaded = load_gltf(bytes);
        return loaded ? std::string("loads") : loaded.error().where.str();
    };
    EXPECT_EQ(at(4, 1), "test.gltf: byte 4");            // version
    EXPECT_EQ(at(8, 0xffffffffu), "test.gltf: byte 8");  // length of the file
    EXPECT_EQ(at(8, 3), "test.gltf: byte 8");
    EXPECT_EQ(at(12, 0xfffffff0u), "test.gltf: byte 12");  // length of the first chunk
    EXPECT_EQ(at(16, 0x004e4942), "test.gltf: byte 12");   // a binary chunk first
}

TEST(GltfContainer, BytesBehindTheEndAreAWarning) {
    const LoadedScene loaded = good_gltf(triangle_file(true) + "more");
    EXPECT_TRUE(has(loaded.diagnostics, "behind the end"));
}

TEST(GltfUri, PercentSigns) {
    EXPECT_EQ(gltf::percent_decoded("a%20b%2fc"), "a b/c");
    EXPECT_EQ(gltf::percent_decoded("%2e%2E/x"), "../x");
    for (const char* wrong : {"%", "%2", "a%zz", "100%"})
        EXPECT_EQ(gltf::percent_decoded(wrong), std::nullopt) << wrong;
}

TEST(GltfUri, Base64OfAllLengths) {
    std::string bytes;
    for (int n = 0; n < 70; ++n) {
        EXPECT_EQ(gltf::decode_base64(base64(bytes)), bytes);
        std::string bare = base64(bytes);
        while (bare.ends_with('=')) bare.pop_back();
        EXPECT_EQ(gltf::decode_base64(bare), bytes);
        bytes += static_cast<char>(37 * n + 200);
    }
    for (const char* wrong : {"A", "AB CD", "AAA*", "AAAAA", "=AAA"})
        EXPECT_EQ(gltf::decode_base64(wrong), std::nullopt) << wrong;
}

TEST(GltfUri, DataUris) {
    const auto data = gltf::parse_data_uri("data:image/png;base64,QUJD");
    ASSERT_TRUE(data);
    EXPECT_EQ(data->media_type, "image/png");
    EXPECT_TRUE(data->base64);
    EXPECT_EQ(data->payload, "QUJD");
    EXPECT_FALSE(gltf::parse_data_uri("data:text/plain,hello")->base64);
    EXPECT_FALSE(gltf::parse_data_uri("data.bin"));
}

TEST(GltfErrors, NameThePlaceAndThePointer) {
    const std::string text = "{\"asset\": {\"version\": \"2.0\"},\n \"nodes\": [{}, {\"mesh\": 3}]}";
    const auto loaded = load_gltf(text);
    ASSERT_FALSE(loaded.ok());
    EXPECT_EQ(loaded.error().where.str(), "test.gltf:2:25 (/nodes/1/mesh)");
    EXPECT_EQ(loaded.error().message, "'mesh' refers to mesh 3, but the file has 0 of them, counted from 0");
    EXPECT_FALSE(loaded.error().excerpt.empty());
}

TEST(GltfErrors, KeysInPointersAreEscaped) {
    expect_refused("{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [{\"extensions\": {\"KHR_lights_punctual\": 1}}]}",
                   "/nodes/0/extensions/KHR_lights_punctual", "must be an object");
    const std::string text = "{\"a/b~c\": [1, {\"x\": 2}]}";
    const auto document = json::Document::parse(text, "t", 8);
    ASSERT_TRUE(document.ok());
    EXPECT_EQ(document->pointer(text.find('2')), "/a~1b~0c/1/x");
    EXPECT_EQ(document->pointer(text.find("\"x\"")), "/a~1b~0c/1/x");
    EXPECT_EQ(document->pointer(text.find('[')), "/a~1b~0c");
    EXPECT_EQ(document->pointer(0), "");
}

TEST(GltfErrors, AssetAndExtensions) {
    expect_refused("{}", "", "missing key 'asset'");
    expect_refused("{\"asset\": {\"version\": \"1.0\"}}", "/asset/version", "glTF 1.0");
    expect_refused("{\"asset\": {\"version\": \"2.0\", \"minVersion\": \"2.1\"}}", "/asset/minVersion", "beyond");
    expect_refused("{\"asset\": {\"version\": \"2.0\"}, \"extensionsRequired\": [\"KHR_texture_basisu\"]}",
                   "/extensionsRequired/0", "'KHR_texture_basisu'");
    const LoadedScene loaded = good_gltf(
        "{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": [\"X_y\"], \"nodes\": [{\"extensions\": {\"X_y\": "
        "{}}},"
        " {\"extras\": {\"extensions\": {\"Z_z\": {}}}}]}");
    ASSERT_EQ(loaded.fidelity.warnings().size(), 1u);
    EXPECT_EQ(loaded.fidelity.warnings()[0].where.pointer, "/nodes/0/extensions/X_y");
}

}  // namespace
}  // namespace steradian
