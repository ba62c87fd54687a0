// KHR_draco_mesh_compression, against data that the library's encoder makes.
#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

#include <random>

#include "gltf_builder.h"
#include "image/samples.h"
#include "math/vector.h"

namespace steradian {
namespace {

using namespace test;

constexpr int kSide = 17;

struct Ids {
    int position = 0, normal = 0, uv = 0;
};

/// A bumpy square with normals and a seam in its texture coordinates.
std::unique_ptr<draco::Mesh> bumpy(Ids& ids) {
    draco::TriangleSoupMeshBuilder b;
    b.Start(2 * kSide * kSide);
    ids.position = b.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    ids.normal = b.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
    ids.uv = b.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    uint32_t face = 0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            for (const auto& corners : {std::array<int, 6>{0, 0, 1, 0, 0, 1}, {1, 0, 1, 1, 0, 1}}) {
                std::array<Vec3, 3> p, n;
                std::array<Vec2, 3> uv;
                for (size_t c = 0; c < 3; ++c) {
                    const int i = x + corners[2 * c], j = y + corners[2 * c + 1];
                    p[c] = {static_cast<float>(i) * 0.1f, static_cast<float>(j) * 0.1f,
                            static_cast<float>(i * j % 7) * 0.05f};
                    n[c] = normalize(Vec3{static_cast<float>(i - 6), static_cast<float>(j - 6), j % 2 ? 5.0f : -2.0f});
                    uv[c] = {static_cast<float>(i) / kSide + (x < kSide / 2 ? 0.0f : 1.5f),
                             static_cast<float>(j) / kSide};
                }
                const draco::FaceIndex f(face++);
                b.SetAttributeValuesForFace(ids.position, f, &p[0], &p[1], &p[2]);
                b.SetAttributeValuesForFace(ids.normal, f, &n[0], &n[1], &n[2]);
                b.SetAttributeValuesForFace(ids.uv, f, &uv[0], &uv[1], &uv[2]);
            }
    return b.Finalize();
}

struct Compressed {
    std::string bytes;
    size_t points = 0, faces = 0;
    Ids ids;
};

/// `bits` of quantisation, 0: none.
Compressed compress(int method, int bits) {
    Compressed out;
    const auto mesh = bumpy(out.ids);
    draco::ExpertEncoder encoder(*mesh);
    encoder.SetEncodingMethod(method);
    if (bits)
        for (const int id : {out.ids.position, out.ids.normal, out.ids.uv}) encoder.SetAttributeQuantization(id, bits);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeToBuffer(&buffer).ok()) throw std::runtime_error("cannot encode");
    out.bytes.assign(buffer.data(), buffer.size());
    out.points = encoder.num_encoded_points(), out.faces = encoder.num_encoded_faces();
    if (out.points == 0) {  // counted on request only
        draco::DecoderBuffer in;
        in.Init(out.bytes.data(), out.bytes.size());
        const auto decoded = draco::Decoder().DecodeMeshFromBuffer(&in);
        out.points = decoded.value()->num_points(), out.faces = decoded.value()->num_faces();
    }
    return out;
}

std::string file(const Compressed& c, const std::string& index_type = "5123", const std::string& more = {},
                 size_t copies = 1) {
    GltfBuilder b;
    const std::string view = std::to_string(b.view(c.bytes)), count = std::to_string(c.points);
    std::string primitives;
    for (size_t i = 0; i < copies; ++i) {
        const auto number = [](int n) { return std::to_string(n); };
        const int p = b.raw_accessor("\"componentType\": 5126, \"type\": \"VEC3\", \"count\": " + count);
        const int n = b.raw_accessor("\"componentType\": 5126, \"type\": \"VEC3\", \"count\": " + count);
        const int t = b.raw_accessor("\"componentType\": 5126, \"type\": \"VEC2\", \"count\": " + count);
        const int k = b.raw_accessor("\"componentType\": " + index_type +
                                     ", \"type\": \"SCALAR\", \"count\": " + std::to_string(3 * c.faces));
        primitives += std::string(i ? "," : "") + "{\"attributes\": {\"POSITION\": " + number(p) +
                      ", \"NORMAL\": " + number(n) + ", \"TEXCOORD_0\": " + number(t) + "}, \"indices\": " + number(k) +
                      more + ", \"extensions\": {\"KHR_draco_mesh_compression\": {\"bufferView\": " + view +
                      ", \"attributes\": {\"POSITION\": " + number(c.ids.position) +
                      ", \"NORMAL\": " + number(c.ids.normal) + ", \"TEXCOORD_0\": " + number(c.ids.uv) +
                      "}}}, \"material\": 0}";
    }
    // A texture, so that the coordinates are read.
    const int picture = b.view(png_file(1, 1, 8, 0, std::string(2, '\0')));
    return b.binary(
        "\"materials\": [{\"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": 0}}}], \"textures\": "
        "[{\"source\": 0}], \"images\": [{\"bufferView\": " +
        std::to_string(picture) +
        "}], \"extensionsRequired\": [\"KHR_draco_mesh_compression\"], \"meshes\": [{\"primitives\": [" + primitives +
        "]}], \"nodes\": [{\"mesh\": 0}]");
}

TEST(GltfDraco, ManyAttributesAreNotLookedUpOneByOne) {
    constexpr int kMany = 2000;
    const Compressed c = compress(draco::MESH_EDGEBREAKER_ENCODING, 11);
    GltfBuilder b;
    const std::string view = std::to_string(b.view(c.bytes)), count = std::to_string(c.points);
    b.raw_accessor("\"componentType\": 5126, \"type\": \"VEC3\", \"count\": " + count);
    b.raw_accessor("\"componentType\": 5125, \"type\": \"SCALAR\", \"count\": " + std::to_string(3 * c.faces));
    std::string here, there;
    for (int i = 0; i < kMany; ++i) {
        here += "\"_A" + std::to_string(i) + "\": 0, ";
        there += "\"_B" + std::to_string(i) + "\": 0, ";
    }
    const std::string text = b.text(
        "\"meshes\": [{\"primitives\": [{\"attributes\": {" + here +
        "\"POSITION\": 0}, \"indices\": 1, \"extensions\": {\"KHR_draco_mesh_compression\": {\"bufferView\": " + view +
        ", \"attributes\": {" + there + "\"POSITION\": " + std::to_string(c.ids.position) +
        "}}}}]}], \"nodes\": [{\"mesh\": 0}]");
    uint64_t steps = 0;
    const LoadedScene loaded = gltf::load(text, "test.gltf", "/nonexistent", {}, &steps);
    EXPECT_EQ(loaded.scene.meshes.at(0).indices.size(), 3 * c.faces);
    EXPECT_LT(steps, uint64_t(kMany) * kMany / 10);
}

/// What the library makes of the data by itself.
std::unique_ptr<draco::Mesh> decoded_by_library(const Compressed& c) {
    draco::DecoderBuffer buffer;
    buffer.Init(c.bytes.data(), c.bytes.size());
    return draco::Decoder().DecodeMeshFromBuffer(&buffer).value();
}

void expect_same(const Compressed& c, float tolerance) {
    const LoadedScene loaded = good_gltf(file(c));
    EXPECT_TRUE(loaded.fidelity.empty());
    const Mesh& mesh = loaded.scene.meshes.at(0);
    const auto theirs = decoded_by_library(c);
    ASSERT_EQ(mesh.positions.size(), theirs->num_points());
    ASSERT_EQ(mesh.normals.size(), theirs->num_points());
    ASSERT_EQ(mesh.uvs.size(), theirs->num_points());
    ASSERT_EQ(mesh.indices.size(), size_t(3) * theirs->num_faces());
    for (uint32_t f = 0; f < theirs->num_faces(); ++f)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(mesh.indices[3 * f + static_cast<uint32_t>(k)], theirs->face(draco::FaceIndex(f))[k].value());
    const auto value = [&](int id, uint32_t point, int component) {
        std::array<float, 4> v{};
        const auto* a = theirs->GetAttributeByUniqueId(static_cast<uint32_t>(id));
        a->GetMappedValue(draco::PointIndex(point), v.data());
        return v[static_cast<size_t>(component)];
    };
    for (uint32_t i = 0; i < theirs->num_points(); ++i)
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(mesh.positions[i][k], value(c.ids.position, i, k), tolerance);
            EXPECT_NEAR(mesh.normals[i][k], value(c.ids.normal, i, k), tolerance);
            const float uv = k ? mesh.uvs[i].y : mesh.uvs[i].x;
            EXPECT_NEAR(k < 2 ? uv : 0, k < 2 ? value(c.ids.uv, i, k) : 0, tolerance);
        }
}

TEST(GltfDraco, WithoutLossToTheBit) {
    expect_same(compress(draco::MESH_SEQUENTIAL_ENCODING, 0), 0);
    expect_same(compress(draco::MESH_EDGEBREAKER_ENCODING, 0), 0);
}

TEST(GltfDraco, Quantised) {
    for (const int bits : {6, 11, 14}) {
        expect_same(compress(draco::MESH_SEQUENTIAL_ENCODING, bits), 1e-6f);
        expect_same(compress(draco::MESH_EDGEBREAKER_ENCODING, bits), 1e-6f);
    }
}

TEST(GltfDraco, IsTheMeshThatWasCompressed) {
    const Compressed c = compress(draco::MESH_EDGEBREAKER_ENCODING, 14);
    const Mesh mesh = good_gltf(file(c)).scene.meshes.at(0);
    EXPECT_EQ(mesh.indices.size(), size_t(6) * kSide * kSide);
    double area = 0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                   d = mesh.positions[mesh.indices[i + 2]];
        area += double(cross(b - a, d - a).z) / 2;  // projected: the square, whatever the bumps
    }
    EXPECT_NEAR(area, 0.01 * kSide * kSide, 1e-3);
    for (const Vec3 n : mesh.normals) EXPECT_NEAR(length(n), 1, 1e-6);
}

TEST(GltfDraco, PrimitivesMayShareWhatIsCompressed) {
    const LoadedScene loaded = good_gltf(file(compress(draco::MESH_EDGEBREAKER_ENCODING, 10), "5125", "", 3));
    ASSERT_EQ(loaded.scene.meshes.size(), 3u);
    EXPECT_EQ(loaded.scene.meshes[0].positions, loaded.scene.meshes[2].positions);
}

TEST(GltfDraco, LiesAreRefused) {
    const Compressed good = compress(draco::MESH_EDGEBREAKER_ENCODING, 10);
    const std::string extension = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    const auto with = [&](auto change) {
        Compressed c = good;
        change(c);
        return file(c);
    };
    expect_refused(with([](Compressed& c) { ++c.points; }), "/accessors/0", "its Draco data");
    expect_refused(with([](Compressed& c) { ++c.faces; }), "/accessors/3", "its Draco data");
    expect_refused(with([](Compressed& c) { c.ids.normal = 9; }), extension + "/attributes/NORMAL", "no attribute 9");
    expect_refused(with([](Compressed& c) { c.ids.normal = c.ids.uv; }), extension + "/attributes/NORMAL",
                   "3 times FLOAT");
    expect_refused(with([](Compressed& c) { c.bytes[0] = 'd'; }), extension, "does not hold Draco");
    expect_refused(with([](Compressed& c) { c.bytes[6] = 1; }), extension, "version 2.1");
    expect_refused(with([](Compressed& c) { c.bytes[7] = 0; }), extension, "point cloud");
    expect_refused(with([](Compressed& c) { c.bytes[8] = 5; }), extension, "unknown kind");
    expect_refused(with([](Compressed& c) { c.bytes.resize(c.bytes.size() / 2); }), extension, "cannot be decoded");
    expect_refused(file(good, "5121"), "/accessors/3", "beyond the accessor's type");
    expect_refused(file(good, "5126"), "/accessors/3", "whole numbers");
    expect_refused(file(good, "5125", ", \"mode\": 5"), "/meshes/0/primitives/0/mode", "mode 4");
}

TEST(GltfDraco, CountsThatLieTakeNoMemory) {
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        Compressed c = compress(method, 10);
        // The counts stand behind the header (11 bytes), for edgebreaker behind one byte more: 1 431 655 765 faces of
        // as many vertices.
        const std::string most = "\xd5\xaa\xd5\xaa\x05";
        c.bytes.replace(method == draco::MESH_EDGEBREAKER_ENCODING ? 12 : 11, 4, most + most);
        expect_refused(file(c), "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression", "MiB",
                       ErrorCode::resources);
    }
}

TEST(GltfDraco, DamagedDataAreRefusedOrDecoded) {
    std::mt19937 random(6);
    LoadOptions options;
    options.gltf_free_bytes = 1 << 20;
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const Compressed good = compress(method, 9);
        size_t refused = 0;
        for (int i = 0; i < 1000; ++i) {
            Compressed bad = good;
            bad.bytes[random() % bad.bytes.size()] ^= static_cast<char>(1u << random() % 8);
            refused += load_gltf(file(bad), options).ok() ? 0 : 1;
        }
        EXPECT_GT(refused, 100u);
    }
}

}  // namespace
}  // namespace steradian
