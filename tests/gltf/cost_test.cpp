// What files cost that let many things refer to one large object, counted in members that lookups pass: in proportion
// to the file, not to the product of both.
#include "gltf_builder.h"

namespace steradian {
namespace {

using namespace test;

constexpr int kKeys = 4000, kUses = 4000;

/// "k0": 0, "k1": 0, …
std::string junk() {
    std::string out;
    for (int i = 0; i < kKeys; ++i) out += "\"k" + std::to_string(i) + "\": 0, ";
    return out;
}

/// `element(i)` for every use, between commas.
template <class Element>
std::string repeated(Element element) {
    std::string out;
    for (int i = 0; i < kUses; ++i) out += (i ? "," : "") + element(std::to_string(i));
    return "[" + out + "]";
}

constexpr std::string_view kImage =
    "\"uri\": \"data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mNoAAAAggCB2kUIOwAAAABJRU5ErkJggg==\"";

/// A triangle of its own for each material, so that all are read.
std::string with_materials(const std::string& materials, const std::string& more) {
    GltfBuilder b;
    const std::string p = std::to_string(b.floats("VEC3", 3, kTriangle)),
                      t = std::to_string(b.floats("VEC2", 2, {0, 0, 1, 0, 0, 1}));
    return b.text("\"meshes\": [{\"primitives\": " + repeated([&](const std::string& i) {
                      return "{\"attributes\": {\"POSITION\": " + p + ", \"TEXCOORD_0\": " + t +
                             "}, \"material\": " + i + "}";
                  }) +
                  "}], \"nodes\": [{\"mesh\": 0}], \"materials\": " + materials + more);
}

void expect_proportional(const std::string& what, const std::string& text, size_t instances) {
    uint64_t steps = 0;
    const LoadedScene loaded = gltf::load(text, "test.gltf", "/nonexistent", {}, &steps);
    EXPECT_EQ(loaded.scene.instances.size(), instances) << what;
    EXPECT_GT(steps, uint64_t(kKeys)) << what;
    // No member is shorter than `"k":0,`, and none needs to be passed more often than there are keys to look for.
    EXPECT_LT(steps, 4 * text.size()) << what;
    EXPECT_LT(4 * text.size(), uint64_t(kKeys) * kUses) << what;
}

TEST(GltfCost, ALargeAccessorAndItsView) {
    std::string primitives, accessors;
    for (int i = 1; i <= kUses; ++i) {
        accessors += ", {\"componentType\": 5121, \"count\": 3, \"type\": \"SCALAR\"}";
        primitives += std::string(i > 1 ? "," : "") +
                      "{\"attributes\": {\"POSITION\": 0}, \"indices\": " + std::to_string(i) + "}";
    }
    const std::string text =
        "{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{" + junk() +
        "\"byteLength\": 36, \"uri\": \"data:;base64," + base64(std::string(36, '\0')) + "\"}], \"bufferViews\": [{" +
        junk() + "\"buffer\": 0, \"byteLength\": 36}], \"accessors\": [{" + junk() +
        "\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}" + accessors +
        "], \"meshes\": [{\"primitives\": [" + primitives + "]}], \"nodes\": [{\"mesh\": 0}]}";
    expect_proportional("accessor", text, kUses);
}

TEST(GltfCost, ALargeMeshAndMaterial) {
    GltfBuilder b;
    const std::string p = std::to_string(b.floats("VEC3", 3, kTriangle));
    const std::string text =
        b.text("\"materials\": [{" + junk() + "\"doubleSided\": true}], \"meshes\": [{" + junk() +
               "\"primitives\": [{\"attributes\": {\"POSITION\": " + p + "}, \"material\": 0}]}], \"nodes\": " +
               repeated([](const std::string&) { return std::string("{\"mesh\": 0}"); }));
    expect_proportional("mesh", text, kUses);
    expect_proportional("material",
                        with_materials(repeated([](const std::string& i) {
                                           return i == "0" ? "{" + junk() + "\"doubleSided\": true}"
                                                           : std::string("{}");
                                       }),
                                       ""),
                        kUses);
}

TEST(GltfCost, ALargeCameraAndLight) {
    const auto file = [](const std::string& node, const std::string& more) {
        GltfBuilder b;
        return b.text(repeated([&](const std::string&) { return node; }).insert(0, "\"nodes\": ") + ", " + more);
    };
    expect_proportional(
        "camera",
        file("{\"camera\": 0}",
             "\"cameras\": [{" + junk() + "\"type\": \"perspective\", \"perspective\": {" + junk() + "\"yfov\": 1}}]"),
        0);
    expect_proportional(
        "light",
        file("{\"extensions\": {\"KHR_lights_punctual\": {\"light\": 0}}}",
             "\"extensions\": {\"KHR_lights_punctual\": {\"lights\": [{" + junk() + "\"type\": \"point\"}]}}"),
        0);
}

TEST(GltfCost, ALargeTextureSamplerAndImage) {
    const std::string image = "[{" + junk() + std::string(kImage) + "}]";
    // One texture, which each material places differently.
    const std::string placed = repeated([](const std::string& i) {
        return "{\"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": 0, \"extensions\": "
               "{\"KHR_texture_transform\": {\"offset\": [" +
               i + ", 0]}}}}}";
    });
    expect_proportional(
        "texture", with_materials(placed, ", \"images\": " + image + ", \"textures\": [{" + junk() + "\"source\": 0}]"),
        kUses);
    // Textures that share their sampler and their image.
    const std::string each = repeated([](const std::string& i) {
        return "{\"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": " + i + "}}}";
    });
    const std::string textures =
        repeated([](const std::string&) { return std::string("{\"source\": 0, \"sampler\": 0}"); });
    expect_proportional("sampler",
                        with_materials(each, ", \"images\": " + image + ", \"textures\": " + textures +
                                                 ", \"samplers\": [{" + junk() + "\"wrapS\": 33071}]"),
                        kUses);
}

// --- Memory, by what it is made of ---

LoadOptions with_free_bytes(uint64_t bytes) {
    LoadOptions options;
    options.gltf_free_bytes = bytes;
    return options;
}

void expect_too_much(const std::string& text, uint64_t free_bytes, std::string_view message) {
    const auto loaded = load_gltf(text, with_free_bytes(free_bytes));
    ASSERT_FALSE(loaded.ok()) << message;
    EXPECT_EQ(loaded.error().code, ErrorCode::resources) << loaded.error().str();
    EXPECT_NE(loaded.error().message.find(message), std::string::npos) << loaded.error().str();
}

/// Primitives of one accessor of positions, each with indices of its own, which are three bytes that they share.
std::string with_primitives(GltfBuilder& b, const std::string& positions, int primitives) {
    const std::string view = std::to_string(b.view(std::string("\0\1\2", 3)));
    std::string list;
    for (int i = 0; i < primitives; ++i) {
        const int indices =
            b.raw_accessor("\"bufferView\": " + view + ", \"componentType\": 5121, \"count\": 3, \"type\": \"SCALAR\"");
        list += (i ? "," : "") + ("{\"attributes\": {\"POSITION\": " + positions + "}, \"indices\": ") +
                std::to_string(indices) + "}";
    }
    return "\"meshes\": [{\"primitives\": [" + list + "]}], \"nodes\": [{\"mesh\": 0}]";
}

TEST(GltfBudget, BytesThatAreUsedCountOnceAndOthersDoNot) {
    const auto file = [](int primitives) {
        GltfBuilder b;
        const std::string p = std::to_string(b.floats("VEC3", 3, kTriangle));
        b.view(std::string(1'000'000, 'x'));  // nobody refers to it
        return b.text(with_primitives(b, p, primitives) + std::string(1'000'000, ' '));
    };
    EXPECT_TRUE(load_gltf(file(1), with_free_bytes(0)).ok());  // 39 bytes and a node
    expect_too_much(file(1000), 0, "of 41 bytes");
    EXPECT_TRUE(load_gltf(file(1000), with_free_bytes(1 << 20)).ok());
}

TEST(GltfBudget, WhatStandsInNoFileIsOnlyFree) {
    // As much again is used and therefore free: the zeros stay zeros.
    const auto file = [](const std::string& zeros) {
        GltfBuilder b;
        const std::string z =
            std::to_string(b.raw_accessor("\"componentType\": 5126, \"type\": \"VEC3\", \"count\": " + zeros));
        const std::string p = std::to_string(b.floats("VEC3", 3, std::vector<float>(30'000, 1.0f)));
        return b.text("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + p +
                      "}}, {\"attributes\": {\"POSITION\": " + z + "}}]}], \"nodes\": [{\"mesh\": 0}]");
    };
    EXPECT_TRUE(load_gltf(file("80000"), with_free_bytes(1 << 20)).ok());
    expect_too_much(file("90000"), 1 << 20, "1 MiB of what stands in no file");
}

TEST(GltfBudget, WhatIsMadeIsNoCredit) {
    // A buffer without data, which is zeros, read over and over.
    GltfBuilder b;
    const std::string p = std::to_string(
        b.raw_accessor("\"bufferView\": 0, \"componentType\": 5126, \"type\": \"VEC3\", \"count\": 10000"));
    const std::string text = b.text(
        "\"buffers\": [{\"byteLength\": 120000}], \"bufferViews\": [{\"buffer\": 0, "
        "\"byteLength\": 120000}], \"meshes\": [{\"primitives\": " +
        repeated([&](const std::string& i) {
            return "{\"mode\": " + std::to_string(4 + std::stoi(i) % 3) + ", \"attributes\": {\"POSITION\": " + p +
                   "}}";
        }) +
        "}], \"nodes\": [{\"mesh\": 0}]");
    expect_too_much(text, 500'000, "MiB of 2 bytes");
    EXPECT_TRUE(load_gltf(text, with_free_bytes(2'000'000)).ok());
}

// --- Names, which the scene keeps with everything that has one ---

TEST(GltfCost, LongNamesOfWhatIsSharedAreCounted) {
    const std::string name = "\"name\": \"" + std::string(100'000, 'n') + "\"";
    const auto refused = [](const std::string& text) {
        const auto loaded = load_gltf(text, with_free_bytes(1 << 20));
        return !loaded.ok() && loaded.error().code == ErrorCode::resources;
    };
    const auto nodes = [](const std::string& node) {
        return "\"nodes\": " + repeated([&](const std::string&) { return node; }) + ", ";
    };
    GltfBuilder b;
    const std::string p = std::to_string(b.floats("VEC3", 3, kTriangle));
    EXPECT_TRUE(refused(b.text(nodes("{\"camera\": 0}") + "\"cameras\": [{" + name +
                               ", \"type\": \"perspective\", \"perspective\": {\"yfov\": 1}}]")));
    EXPECT_TRUE(refused(b.text(nodes("{\"extensions\": {\"KHR_lights_punctual\": {\"light\": 0}}}") +
                               "\"extensions\": {\"KHR_lights_punctual\": {\"lights\": [{" + name +
                               ", \"type\": \"point\"}]}}")));
    for (int i = 0; i < kUses; ++i) b.raw_accessor("\"componentType\": 5121, \"count\": 3, \"type\": \"SCALAR\"");
    EXPECT_TRUE(refused(b.text("\"nodes\": [{\"mesh\": 0}], \"meshes\": [{" + name +
                               ", \"primitives\": " + repeated([&](const std::string& i) {
                                   return "{\"attributes\": {\"POSITION\": " + p +
                                          "}, \"indices\": " + std::to_string(std::stoi(i) + 1) + "}";
                               }) +
                               "}]")));
}

}  // namespace
}  // namespace steradian
