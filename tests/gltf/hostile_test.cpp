// Files that are damaged, lie, or point at what is no file: refused with a place, or loaded; never a crash. What such
// files may cost is tests/cli/hostile_models_test.cpp.
#include <sys/stat.h>

#include <filesystem>
#include <limits>
#include <random>

#include "gltf_builder.h"
#include "scene/validate.h"
#include "support/support.h"

namespace steradian {
namespace {

using namespace test;

/// The seeds of the fuzz target: small files that together use every part of the reader.
std::vector<std::pair<std::string, std::string>> seeds() {
    std::vector<std::pair<std::string, std::string>> out;
    for (const auto& entry : std::filesystem::directory_iterator(source_folder() / "fuzz/corpus/gltf"))
        out.emplace_back(entry.path().filename().string(), slurp(entry.path()));
    return out;
}

/// True when it was accepted; a refusal must name the file and a place, on one line.
bool check(std::string_view bytes) {
    LoadOptions options;
    options.images.max_pixels = 1 << 16;
    options.gltf_free_bytes = 1 << 20;
    auto loaded = load_gltf(bytes, options);
    if (loaded && !loaded->animations.empty()) {
        options.frame_time = 0.5;
        loaded = load_gltf(bytes, options);
    }
    if (loaded) return true;
    const Error& error = loaded.error();
    EXPECT_EQ(error.where.file, "test.gltf");
    EXPECT_TRUE(error.where.byte || error.where.line > 0) << error.str();
    EXPECT_FALSE(error.message.empty());
    for (const char c : error.message) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << error.message;
    return false;
}

/// A triangle whose positions are in a buffer with this member: a URI.
std::string with_uri(const std::string& uri) {
    return "{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{\"byteLength\": 36, \"uri\": \"" + uri +
           "\"}], \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}], \"accessors\": [{\"bufferView\": 0, "
           "\"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}], " +
           one_mesh(0) + "}";
}

TEST(GltfHostile, SeedsLoad) {
    EXPECT_GE(seeds().size(), 17u);
    for (const auto& [name, bytes] : seeds()) {
        const auto loaded = load_gltf(bytes);
        ASSERT_TRUE(loaded.ok()) << name << ": " << loaded.error().str();
        if (loaded->animations.empty()) continue;
        LoadOptions moving;
        moving.frame_time = 0.5;
        const auto moved = load_gltf(bytes, moving);
        EXPECT_TRUE(moved.ok()) << name << ": " << moved.error().str();
    }
}

TEST(GltfHostile, TruncatedFilesAreRefused) {
    for (const auto& [name, bytes] : seeds())
        for (size_t i = 0; i < 256; ++i)
            EXPECT_FALSE(check(std::string_view(bytes).substr(0, i * bytes.size() / 256))) << name << " " << i;
}

TEST(GltfHostile, FlippedBitsDoNoHarm) {
    std::mt19937 random(5);
    const int rounds = by_tier(300, 10'000);
    size_t accepted = 0, refused = 0;
    for (const auto& [name, bytes] : seeds())
        for (int round = 0; round < rounds; ++round) {
            std::string damaged = bytes;
            for (uint32_t k = random() % 4 + 1; k > 0; --k)
                damaged[random() % damaged.size()] ^= static_cast<char>(1u << random() % 8);
            ++(check(damaged) ? accepted : refused);
        }
    EXPECT_GT(accepted, 0u);
    EXPECT_GT(refused, 0u);
}

TEST(GltfHostile, Encodings) {
    GltfBuilder b;
    const std::string text = b.text(one_mesh(b.floats("VEC3", 3, kTriangle)));
    EXPECT_TRUE(check("\xef\xbb\xbf" + text));
    std::string crlf;
    for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_TRUE(check(crlf));
    std::string wide = "\xff\xfe";
    for (const char c : text) wide += c, wide += '\0';
    EXPECT_FALSE(check(wide));
    EXPECT_FALSE(check(text + '\0'));
    EXPECT_FALSE(check(""));
    EXPECT_FALSE(check(std::string("glTF")));
}

TEST(GltfHostile, WhatForeignNamesSayIsEscaped) {
    const std::string evil = "\\u001b[31m\\u0007\\u009b\\u202e", start = "{\"asset\": {\"version\": \"2.0\"}, ";
    for (const std::string& text : {start + "\"extensionsRequired\": [\"" + evil + "\"]}", with_uri(evil),
                                    start + "\"scenes\": [{\"" + evil + "\": 1, \"nodes\": [\"" + evil + "\"]}]}"}) {
        const auto loaded = load_gltf(text);
        ASSERT_FALSE(loaded.ok());
        std::string shown = loaded.error().str();
        for (const char c : shown) EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n') << shown;
        EXPECT_EQ(shown.find("\xc2\x9b"), std::string::npos) << shown;
    }
}

TEST(GltfHostile, Numbers) {
    const auto scaled = [](const std::string& number) {
        GltfBuilder b;
        const int p = b.floats("VEC3", 3, kTriangle);
        return b.text("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + std::to_string(p) +
                      "}}]}], \"nodes\": [{\"mesh\": 0, \"translation\": [" + number + ", 0, 0]}]");
    };
    for (const char* bad : {"nan", "NaN", "Infinity", "-inf", "1e999", "0x10", "1.2.3", "1e31", "\"1\"", "null"})
        EXPECT_FALSE(check(scaled(bad))) << bad;
    for (const char* good : {"1e-999", "-0", "1E2", "0.0000000000000000000000000000001"})
        EXPECT_TRUE(check(scaled(good))) << good;
    EXPECT_TRUE(check(scaled("0." + std::string(1'000'000, '3'))));
}

TEST(GltfHostile, PositionsThatAreNotFiniteAreDroppedWithACount) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0, kNan, 0, 0, 0, kInf, 0, 1, 1, 1});
    LoadedScene loaded = good_gltf(b.text(one_mesh(p)));
    sanitize(loaded.scene, loaded.diagnostics);
    EXPECT_EQ(loaded.scene.meshes.at(0).indices, (std::vector<uint32_t>{0, 1, 2}));
    EXPECT_FALSE(loaded.diagnostics.empty());
}

// --- Offsets and counts that lie ---

std::string with_view(const std::string& view, const std::string& buffer = "\"byteLength\": 36") {
    return "{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{" + buffer + ", \"uri\": \"data:;base64," +
           base64(std::string(36, '\1')) + "\"}], \"bufferViews\": [{\"buffer\": 0, " + view +
           "}], \"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}], " +
           one_mesh(0) + "}";
}

TEST(GltfHostile, ViewsThatLeaveTheirBuffer) {
    EXPECT_TRUE(load_gltf(with_view("\"byteLength\": 36")).ok());
    expect_refused(with_view("\"byteLength\": 37"), "/bufferViews/0", "bytes 0 to 37");
    expect_refused(with_view("\"byteOffset\": 4, \"byteLength\": 36"), "/bufferViews/0", "bytes 4 to 40");
    expect_refused(with_view("\"byteOffset\": 4294967295, \"byteLength\": 36"), "/bufferViews/0", "4294967331");
    expect_refused(with_view("\"byteOffset\": 9007199254740992, \"byteLength\": 9007199254740992"), "/bufferViews/0",
                   "buffer with 36");
    expect_refused(with_view("\"byteOffset\": 18446744073709551580, \"byteLength\": 36"), "/bufferViews/0/byteOffset",
                   "whole number");
    expect_refused(with_view("\"byteLength\": 18446744073709551652"), "/bufferViews/0/byteLength", "whole number");
    expect_refused(with_view("\"byteLength\": 0"), "/bufferViews/0/byteLength", "whole number");
    expect_refused(with_view("\"byteLength\": -1"), "/bufferViews/0/byteLength", "whole number");
    expect_refused(with_view("\"byteLength\": 36, \"byteStride\": 0"), "/bufferViews/0/byteStride", "from 4 to 252");
    expect_refused(with_view("\"byteLength\": 36, \"byteStride\": 8"), "/accessors/0", "overlap");
    expect_refused(with_view("\"byteLength\": 36, \"byteStride\": 16"), "/accessors/0", "needs 44 bytes");
    expect_refused(with_view("\"byteLength\": 36", "\"byteLength\": 37"), "/buffers/0/byteLength", "claims 37");
}

// --- What is no file ---

class GltfSpecialFiles : public ::testing::Test {
protected:
    GltfSpecialFiles() {
        spit(folder_.file("empty"), "");
        spit(folder_.file("secret"), "TOP SECRET, not a buffer");
        std::filesystem::create_directory(folder_.path() / "folder");
        EXPECT_EQ(::mkfifo(folder_.file("pipe").c_str(), 0600), 0);
    }
    static void expect_no_secret(const Error& error) {
        EXPECT_EQ(error.str().find("SECRET"), std::string::npos) << error.str();
    }
    TemporaryFolder folder_;
};

TEST_F(GltfSpecialFiles, AsScenes) {
    for (const char* kind : {"empty", "folder", "pipe"}) {
        std::filesystem::create_symlink(kind, folder_.path() / (std::string(kind) + ".gltf"));
        EXPECT_FALSE(load_scene(folder_.file(std::string(kind) + ".gltf")).ok()) << kind;
    }
    std::filesystem::create_symlink("/dev/zero", folder_.path() / "zero.glb");
    std::filesystem::create_symlink("nothing", folder_.path() / "dangling.glb");
    EXPECT_FALSE(load_scene(folder_.file("zero.glb")).ok());
    EXPECT_FALSE(load_scene(folder_.file("dangling.glb")).ok());
    EXPECT_FALSE(load_scene(folder_.file("missing.glb")).ok());
}

TEST_F(GltfSpecialFiles, AsBuffersAndImages) {
    for (const char* name : {"empty", "folder", "pipe", "missing", "secret"}) {
        spit(folder_.file("b.gltf"), with_uri(name));
        const auto buffer = load_scene(folder_.file("b.gltf"));
        ASSERT_FALSE(buffer.ok()) << name;
        EXPECT_TRUE(buffer.error().where.pointer.starts_with("/buffers/0")) << buffer.error().str();
        expect_no_secret(buffer.error());

        GltfBuilder b;
        spit(folder_.file("i.gltf"),
             b.text("\"images\": [{\"uri\": \"" + std::string(name) +
                    "\"}], \"textures\": [{\"source\": 0}], \"materials\": [{\"pbrMetallicRoughness\": "
                    "{\"baseColorTexture\": {\"index\": 0}}}], " +
                    one_mesh(b.floats("VEC3", 3, kTriangle), ", \"material\": 0")));
        const auto image = load_scene(folder_.file("i.gltf"));
        ASSERT_FALSE(image.ok()) << name;
        EXPECT_TRUE(image.error().where.pointer.starts_with("/images/0")) << image.error().str();
        expect_no_secret(image.error());
    }
}

TEST_F(GltfSpecialFiles, NamesOfEveryKind) {
    const std::string buffer(reinterpret_cast<const char*>(kTriangle.data()), 36);
    const std::pair<const char*, const char*> names[] = {{"a b.bin", "a%20b.bin"},
                                                         {"-o.bin", "-o.bin"},
                                                         {"\xf0\x9f\x90\x87.bin", "%F0%9F%90%87.bin"},
                                                         {"100%.bin", "100%25.bin"}};
    for (const auto& [name, uri] : names) {
        spit(folder_.file(name), buffer);
        spit(folder_.file("n.gltf"), with_uri(uri));
        const auto loaded = load_scene(folder_.file("n.gltf"));
        EXPECT_TRUE(loaded.ok()) << loaded.error().str();
    }
    for (const std::string& uri :
         {std::string("C:\\\\x.bin"), std::string("\\\\\\\\host\\\\x"), std::string(4096, 'x'), std::string("%00")}) {
        spit(folder_.file("n.gltf"), with_uri(uri));
        const auto loaded = load_scene(folder_.file("n.gltf"));
        ASSERT_FALSE(loaded.ok()) << uri;
        EXPECT_EQ(loaded.error().where.pointer, "/buffers/0/uri") << loaded.error().str();
    }
}

}  // namespace
}  // namespace steradian
