// What a file is made of: binary files, URIs, JSON pointers in messages.
#include "formats/gltf/container.h"

#include <tuple>
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

TEST(GltfContainer, OtherFilesThatAreCalledBinary) {
    const auto load = [](const std::string& bytes, const std::string& name) -> Result<LoadedScene> {
        try {
            return gltf::load(bytes, name, "/nonexistent", {});
        } catch (json::ReadFailure& failure) {
            return std::move(failure.error);
        }
    };
    std::string damaged = triangle_file(true);
    damaged[0] = 'G';
    for (const std::string& bytes : {damaged, std::string(), std::string("\x1f\x8b\x08 zipped"), std::string("  [1]")})
        for (const char* name : {"a.glb", "a.GLB"}) {
            const auto loaded = load(bytes, name);
            ASSERT_FALSE(loaded.ok());
            EXPECT_EQ(loaded.error().where.byte, 0u);
            EXPECT_NE(loaded.error().message.find("no binary glTF"), std::string::npos) << loaded.error().str();
        }
    // Text by that name is read, and a text file that is none has a place in its text.
    EXPECT_TRUE(load("\xef\xbb\xbf \n" + triangle_file(false), "a.glb").ok());
    EXPECT_EQ(load(damaged, "a.gltf").error().where.line, 1u);
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

TEST(GltfErrors, InsideBinaryFilesBytesAreThoseOfTheFile) {
    const auto binary = [](std::string json) {
        json.resize((json.size() + 3) / 4 * 4, ' ');
        const auto word = [](size_t value) {
            const auto v = static_cast<uint32_t>(value);
            return std::string(reinterpret_cast<const char*>(&v), 4);
        };
        return "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json;
    };
    const std::string mark = "\xef\xbb\xbf";
    // What is wrong, and the character at which it is.
    const std::tuple<std::string, char, size_t> faults[] = {
        {"{\n\"asset\": {\"version\": \"2.0\"},\n\"nodes\": [{]}", ']', 0},
        {"{\"asset\":\n{\"version\": \"1.0\"}}", '1', 1},
        {std::string("{\"asset\": \0}", 12), '\0', 0},
        {"{\"asset\": {\"version\": \"2.0\"}, \"asset\": 7}", '7', 9}};
    for (const auto& [json, at, before] : faults)
        for (const std::string& begin : {std::string(), mark}) {
            const std::string file = binary(begin + json);
            const auto loaded = load_gltf(file);
            ASSERT_FALSE(loaded.ok()) << json;
            const SourceLocation& where = loaded.error().where;
            EXPECT_EQ(where.line, 0u) << loaded.error().str();
            ASSERT_TRUE(where.byte) << loaded.error().str();
            EXPECT_EQ(*where.byte, file.find(at, 20) - before) << loaded.error().str();
        }
}

TEST(GltfErrors, AssetAndExtensions) {
    expect_refused("{}", "", "missing key 'asset'");
    expect_refused("{\"asset\": {\"version\": \"1.0\"}}", "/asset/version", "glTF 1.0");
    expect_refused("{\"asset\": {\"version\": \"2.0\", \"minVersion\": \"2.1\"}}", "/asset/minVersion", "beyond");
    const auto asset = [](const std::string& version, const std::string& needed) {
        return "{\"asset\": {\"version\": \"" + version + "\"" +
               (needed.empty() ? "" : ", \"minVersion\": \"" + needed + "\"") + "}}";
    };
    for (const auto& [version, needed] :
         {std::pair("2.0", ""), {"2.1", ""}, {"2.10", "2.0"}, {"3.1", "2.0"}, {"2.0", "1.0"}})
        EXPECT_TRUE(load_gltf(asset(version, needed)).ok()) << version << " " << needed;
    expect_refused(asset("3.0", ""), "/asset/version", "glTF 3.0");
    expect_refused(asset("2.1", "2.1"), "/asset/minVersion", "takes glTF 2.1");
    expect_refused(asset("2.10", "2.9"), "/asset/minVersion", "takes glTF 2.9");  // 9 is before 10
    expect_refused(asset("2.9", "2.10"), "/asset/minVersion", "beyond");
    for (const char* bad : {"2", "2.", ".0", "2.0.0", "2.x", " 2.0", "+2.0", "-2.0", "2,0", "2e0.0", ""})
        expect_refused(asset(bad, ""), "/asset/version", "two numbers");
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
