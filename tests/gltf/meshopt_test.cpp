// EXT_meshopt_compression, against data that the library's encoders make.
#include "formats/gltf/meshopt.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "gltf_builder.h"

namespace steradian {
namespace {

using namespace test;
using gltf::meshopt::Filter;

template <class T>
std::string encoded_vertices(const std::vector<T>& vertices) {
    std::string out(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(T)), '\0');
    out.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), vertices.data(),
                                          vertices.size(), sizeof(T)));
    return out;
}
std::string encoded_triangles(const std::vector<uint32_t>& indices, size_t vertices) {
    std::string out(meshopt_encodeIndexBufferBound(indices.size(), vertices), '\0');
    out.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), indices.data(),
                                         indices.size()));
    return out;
}
std::string encoded_sequence(const std::vector<uint32_t>& indices, size_t vertices) {
    std::string out(meshopt_encodeIndexSequenceBound(indices.size(), vertices), '\0');
    out.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(out.data()), out.size(), indices.data(),
                                           indices.size()));
    return out;
}

struct Grid {
    std::vector<Vec3> positions;
    std::vector<uint32_t> indices;
};
Grid grid(uint32_t n) {
    Grid out;
    for (uint32_t i = 0; i < n * n; ++i)
        out.positions.push_back(
            {static_cast<float>(i % n), static_cast<float>(i / n) * 0.3f, static_cast<float>(i * 7 % 5)});
    for (uint32_t y = 0; y + 1 < n; ++y)
        for (uint32_t x = 0; x + 1 < n; ++x) {
            const uint32_t a = y * n + x;
            for (const uint32_t i : {a, a + 1, a + n, a + 1, a + n + 1, a + n}) out.indices.push_back(i);
        }
    return out;
}

/// The encoder may begin a triangle at another corner.
std::vector<uint32_t> from_smallest(std::vector<uint32_t> indices) {
    for (auto at = indices.begin(); at != indices.end(); at += 3) std::rotate(at, std::min_element(at, at + 3), at + 3);
    return indices;
}

std::string members_of_compressed_grid(GltfBuilder& b, const Grid& g, bool sequence, bool narrow) {
    const std::string indices =
        sequence ? encoded_sequence(g.indices, g.positions.size()) : encoded_triangles(g.indices, g.positions.size());
    const int p = b.compressed_view(encoded_vertices(g.positions), "ATTRIBUTES", g.positions.size(), 12);
    const int i = b.compressed_view(indices, sequence ? "INDICES" : "TRIANGLES", g.indices.size(), narrow ? 2 : 4);
    const int positions = b.raw_accessor(
        "\"bufferView\": " + std::to_string(p) +
        ", \"componentType\": 5126, \"type\": \"VEC3\", \"count\": " + std::to_string(g.positions.size()));
    const int corners =
        b.raw_accessor("\"bufferView\": " + std::to_string(i) + ", \"componentType\": " + (narrow ? "5123" : "5125") +
                       ", \"type\": \"SCALAR\", \"count\": " + std::to_string(g.indices.size()));
    return one_mesh(positions, ", \"indices\": " + std::to_string(corners)) +
           ", \"extensionsRequired\": [\"EXT_meshopt_compression\"]";
}
std::string compressed_grid(const Grid& g, bool sequence, bool narrow) {
    GltfBuilder b;
    const std::string members = members_of_compressed_grid(b, g, sequence, narrow);
    return b.binary(members);
}

void replace_all(std::string& text, const std::string& from, const std::string& to, size_t times) {
    for (size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()), --times) {
        ASSERT_GT(times, 0u) << from;
        text.replace(at, from.size(), to);
    }
    ASSERT_EQ(times, 0u) << from;
}

TEST(GltfMeshopt, AttributesTrianglesAndIndices) {
    const Grid g = grid(40);  // more than one block of vertices
    for (const bool sequence : {false, true})
        for (const bool narrow : {false, true}) {
            const LoadedScene loaded = good_gltf(compressed_grid(g, sequence, narrow));
            EXPECT_TRUE(loaded.fidelity.empty());
            ASSERT_EQ(loaded.scene.meshes.size(), 1u);
            const Mesh& mesh = loaded.scene.meshes[0];
            EXPECT_EQ(mesh.positions, g.positions);
            EXPECT_EQ(from_smallest(mesh.indices), from_smallest(g.indices));
            EXPECT_TRUE(!sequence || mesh.indices == g.indices);
        }
}

TEST(GltfMeshopt, ABufferForOthersNeedsNoData) {
    // As the extension writes it for readers that lack it: the views refer to a second buffer, which has no data.
    const Grid g = grid(3);
    GltfBuilder b;
    std::string text = b.text(members_of_compressed_grid(b, g, false, false));
    replace_all(text, "{\"buffer\": 0, \"byteLength\"", "{\"buffer\": 1, \"byteLength\"", 2);
    replace_all(text, "\"}],\n\"meshes\"",
                "\"}, {\"byteLength\": 1000, \"extensions\": {\"EXT_meshopt_compression\": {\"fallback\": "
                "true}}}],\n\"meshes\"",
                1);
    const LoadedScene loaded = good_gltf(text);
    EXPECT_EQ(loaded.scene.meshes.at(0).positions, g.positions);
    EXPECT_TRUE(loaded.diagnostics.empty());  // that the second buffer has no data
    EXPECT_TRUE(loaded.fidelity.empty());
    // Views that are not compressed do read it.
    replace_all(text, "\"EXT_meshopt_compression\": {\"buffer\"", "\"X\": {\"buffer\"", 2);
    const LoadedScene zeros = good_gltf(text);
    EXPECT_TRUE(has(zeros.diagnostics, "a buffer has no data"));
    EXPECT_EQ(zeros.scene.meshes.at(0).positions, std::vector<Vec3>(9, Vec3{0, 0, 0}));
}

void expect_fault(std::string from, std::string to, std::string_view pointer, std::string_view message) {
    std::string text = compressed_grid(grid(5), false, false);
    const size_t at = text.find(from);
    ASSERT_NE(at, text.npos) << from;
    to.resize(from.size(), ' ');  // the lengths of the chunks stay
    expect_refused(text.replace(at, from.size(), to), pointer, message);
}

TEST(GltfMeshopt, LiesAreRefused) {
    const std::string extension = "/bufferViews/0/extensions/EXT_meshopt_compression";
    expect_fault("\"byteLength\": 300", "\"byteLength\": 299", "/bufferViews/0/byteLength", "300 when decompressed");
    expect_fault("\"count\": 25, \"mode", "\"count\": 24, \"mode", "/bufferViews/0/byteLength",
                 "288 when decompressed");
    expect_fault("\"byteStride\": 12, \"count", "\"byteStride\": 10, \"count", extension + "/byteStride",
                 "multiple of 4");
    expect_fault("\"mode\": \"ATTRIBUTES\"", "\"mode\": \"INDICES\"", extension + "/byteStride", "2 or 4");
    expect_fault("\"mode\": \"ATTRIBUTES\"", "\"mode\": \"LIES\"", extension + "/mode", "LIES");
    expect_fault("\"count\": 96, \"mode", "\"count\": 95, \"mode",
                 "/bufferViews/1/extensions/EXT_meshopt_compression/count", "multiple of 3");
    expect_fault("\"filter\": \"NONE\"", "\"filter\": \"NO\"", extension + "/filter", "NO");
    GltfBuilder b;
    const int v = b.compressed_view("", "ATTRIBUTES", 3, 12, "OCTAHEDRAL");
    expect_refused(b.text(one_mesh(b.raw_accessor("\"bufferView\": " + std::to_string(v) +
                                                  ", \"componentType\": 5126, \"type\": \"VEC3\", \"count\": 3")) +
                          ", \"buffers\": [{\"byteLength\": 1}]"),
                   extension + "/byteStride", "4 or 8");
}

TEST(GltfMeshopt, DamagedDataAreRefusedOrDecoded) {
    const std::string good = compressed_grid(grid(9), false, true);
    const size_t data = good.find("BIN");
    std::mt19937 random(8);
    size_t refused = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string bad = good;
        bad[data + 4 + random() % (bad.size() - data - 4)] ^= static_cast<char>(1u << random() % 8);
        refused += load_gltf(bad).ok() ? 0 : 1;
    }
    EXPECT_GT(refused, 100u);
}

TEST(GltfMeshopt, CountsThatLieTakeNoMemory) {
    GltfBuilder b;
    const int v = b.compressed_view("no data at all", "ATTRIBUTES", 0xffffffffu, 256);
    expect_refused(b.text(one_mesh(b.raw_accessor("\"bufferView\": " + std::to_string(v) +
                                                  ", \"componentType\": 5126, \"type\": \"VEC3\", \"count\": 3"))),
                   "/bufferViews/0/extensions/EXT_meshopt_compression", "MiB", ErrorCode::resources);
}

// --- Filters ---

std::vector<std::array<float, 4>> directions(bool quaternions) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> u(-1, 1);
    std::vector<std::array<float, 4>> out{{1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 0}, {0, 0, 1, 0}};
    while (out.size() < 2000) {
        std::array<float, 4> v{u(random), u(random), u(random), quaternions ? u(random) : 0};
        float length = 0;
        for (const float x : v) length += x * x;
        if (length < 0.01f || length > 1) continue;
        for (float& x : v) x /= std::sqrt(length);
        out.push_back(v);
    }
    return out;
}

template <class T>
void expect_octahedral(int bits, float tolerance) {
    const auto vectors = directions(false);
    std::vector<T> ours(4 * vectors.size());
    meshopt_encodeFilterOct(ours.data(), vectors.size(), 4 * sizeof(T), bits, vectors[0].data());
    std::vector<T> theirs = ours;
    meshopt_decodeFilterOct(theirs.data(), vectors.size(), 4 * sizeof(T));
    gltf::meshopt::undo_filter(Filter::octahedral, 4 * sizeof(T), std::as_writable_bytes(std::span(ours)));
    for (size_t i = 0; i < vectors.size(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(ours[4 * i + c], theirs[4 * i + c], 1) << i;
            EXPECT_NEAR(ours[4 * i + c] / (sizeof(T) == 1 ? 127.0f : 32767.0f), vectors[i][c], tolerance) << i;
        }
}

TEST(GltfMeshopt, OctahedralFilter) {
    expect_octahedral<int8_t>(8, 0.016f);
    expect_octahedral<int16_t>(16, 1e-4f);
    expect_octahedral<int16_t>(12, 1.5e-3f);
}

TEST(GltfMeshopt, QuaternionFilter) {
    const auto rotations = directions(true);
    std::vector<int16_t> ours(4 * rotations.size());
    meshopt_encodeFilterQuat(ours.data(), rotations.size(), 8, 14, rotations[0].data());
    std::vector<int16_t> theirs = ours;
    meshopt_decodeFilterQuat(theirs.data(), rotations.size(), 8);
    gltf::meshopt::undo_filter(Filter::quaternion, 8, std::as_writable_bytes(std::span(ours)));
    for (size_t i = 0; i < rotations.size(); ++i) {
        double cosine = 0;  // q and -q are the same rotation
        for (size_t c = 0; c < 4; ++c) {
            EXPECT_NEAR(ours[4 * i + c], theirs[4 * i + c], 1) << i;
            cosine += ours[4 * i + c] / 32767.0 * double(rotations[i][c]);
        }
        EXPECT_NEAR(std::fabs(cosine), 1, 1e-4) << i;
    }
}

TEST(GltfMeshopt, ExponentialFilter) {
    std::mt19937 random(3);
    std::vector<float> values{0, 1, -1, 0.5f, -3.75f, 1e-20f, 1e20f};
    for (int i = 0; i < 2000; ++i)
        values.push_back(
            std::ldexp(static_cast<float>(random() % 2001) / 1000 - 1, static_cast<int>(random() % 40) - 20));
    while (values.size() % 3) values.push_back(0);
    std::vector<uint32_t> ours(values.size());
    meshopt_encodeFilterExp(ours.data(), values.size() / 3, 12, 20, values.data());
    std::vector<uint32_t> theirs = ours;
    meshopt_decodeFilterExp(theirs.data(), values.size() / 3, 12);
    gltf::meshopt::undo_filter(Filter::exponential, 12, std::as_writable_bytes(std::span(ours)));
    EXPECT_EQ(ours, theirs);
    // What no encoder writes: the largest exponent overflows to the largest float, the smallest one is exact.
    std::vector<uint32_t> edges{0x7f7fffffu, 0x7f800000u, 0x80000001u};
    gltf::meshopt::undo_filter(Filter::exponential, 4, std::as_writable_bytes(std::span(edges)));
    EXPECT_EQ(std::bit_cast<float>(edges[0]), std::numeric_limits<float>::max());
    EXPECT_EQ(std::bit_cast<float>(edges[1]), -std::numeric_limits<float>::max());
    EXPECT_EQ(std::bit_cast<float>(edges[2]), std::ldexp(1.0f, -128));
}

TEST(GltfMeshopt, FiltersStandEverything) {
    std::mt19937 random(4);
    for (const auto& [filter, stride] : {std::pair(Filter::octahedral, 4u),
                                         {Filter::octahedral, 8u},
                                         {Filter::quaternion, 8u},
                                         {Filter::exponential, 16u}}) {
        std::vector<uint32_t> noise(4096);
        for (uint32_t& x : noise) x = random() % 4 ? static_cast<uint32_t>(random()) : 0;
        gltf::meshopt::undo_filter(filter, stride, std::as_writable_bytes(std::span(noise)));
        for (const uint32_t x : noise)
            EXPECT_TRUE(filter != Filter::exponential || std::isfinite(std::bit_cast<float>(x)));
    }
}

}  // namespace
}  // namespace steradian
