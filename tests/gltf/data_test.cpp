// Accessors and primitives: the numbers of a mesh.
#include "formats/gltf/meshes.h"
#include "gltf_builder.h"

namespace steradian {
namespace {

using namespace test;

const Mesh& only_mesh(const LoadedScene& loaded) {
    if (loaded.scene.meshes.size() != 1) throw std::runtime_error("expected one mesh");
    return loaded.scene.meshes[0];
}

/// Positions that are (code, 0, 0), (0, code, 0), (0, 0, 0) of a component type.
template <class T>
Mesh mesh_of(int component, T code, bool normalized) {
    GltfBuilder b;
    const int a = b.accessor<T>("VEC3", component, 3, {code, 0, 0, 0, code, 0, 0, 0, 0},
                                normalized ? ", \"normalized\": true" : "");
    return only_mesh(good_gltf(b.text(one_mesh(a))));
}

TEST(GltfAccessor, EveryComponentType) {
    EXPECT_EQ((mesh_of<int8_t>(5120, -128, false).positions[0].x), -128.0f);
    EXPECT_EQ((mesh_of<int8_t>(5120, -128, true).positions[0].x), -1.0f);
    EXPECT_EQ((mesh_of<int8_t>(5120, 127, true).positions[0].x), 1.0f);
    EXPECT_EQ((mesh_of<uint8_t>(5121, 51, true).positions[1].y), 0.2f);
    EXPECT_EQ((mesh_of<int16_t>(5122, -32768, true).positions[0].x), -1.0f);
    EXPECT_EQ((mesh_of<int16_t>(5122, 300, false).positions[1].y), 300.0f);
    EXPECT_EQ((mesh_of<uint16_t>(5123, 65535, true).positions[0].x), 1.0f);
    EXPECT_EQ((mesh_of<float>(5126, 0.3f, false).positions[1].y), 0.3f);
}

TEST(GltfAccessor, InterleavedWithAnOffset) {
    GltfBuilder b;
    const std::vector<float> mixed{9, 0, 0, 0, 9, 9, 1, 0, 0, 9, 9, 0, 1, 0, 9};
    const int view = b.view({reinterpret_cast<const char*>(mixed.data()), mixed.size() * 4}, ", \"byteStride\": 20");
    const int a = b.raw_accessor("\"bufferView\": " + std::to_string(view) +
                                 ", \"byteOffset\": 4, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"");
    const LoadedScene loaded = good_gltf(b.text(one_mesh(a)));
    EXPECT_EQ(only_mesh(loaded).positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

std::string sparse_file(const std::vector<uint16_t>& indices, bool with_base) {
    GltfBuilder b;
    const int i = b.view({reinterpret_cast<const char*>(indices.data()), indices.size() * 2});
    const std::vector<float> values{5, 6, 7, 8, 9, 10};
    const int v = b.view({reinterpret_cast<const char*>(values.data()), values.size() * 4});
    std::string base = "\"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\", ";
    if (with_base)
        base += "\"bufferView\": " +
                std::to_string(b.view({reinterpret_cast<const char*>(kTriangle.data()), kTriangle.size() * 4})) + ", ";
    const int a =
        b.raw_accessor(base + "\"sparse\": {\"count\": 2, \"indices\": {\"bufferView\": " + std::to_string(i) +
                       ", \"componentType\": 5123}, \"values\": {\"bufferView\": " + std::to_string(v) + "}}");
    return b.text(one_mesh(a));
}

TEST(GltfAccessor, SparseElementsReplaceOthersOrZeros) {
    EXPECT_EQ(only_mesh(good_gltf(sparse_file({0, 2}, true))).positions,
              (std::vector<Vec3>{{5, 6, 7}, {1, 0, 0}, {8, 9, 10}}));
    EXPECT_EQ(only_mesh(good_gltf(sparse_file({1, 2}, false))).positions,
              (std::vector<Vec3>{{0, 0, 0}, {5, 6, 7}, {8, 9, 10}}));
    expect_refused(sparse_file({0, 3}, true), "/accessors/0/sparse/indices", "sparse index 1 is 3");
    expect_refused(sparse_file({1, 1}, true), "/accessors/0/sparse/indices", "must increase");
}

std::string with_accessor(const std::string& members) {
    GltfBuilder b;
    b.view({reinterpret_cast<const char*>(kTriangle.data()), kTriangle.size() * 4});
    return b.text(one_mesh(b.raw_accessor(members)));
}

TEST(GltfAccessor, WhatLeavesTheBufferIsRefused) {
    const std::string vec3 = "\"componentType\": 5126, \"type\": \"VEC3\", \"bufferView\": 0, ";
    expect_refused(with_accessor(vec3 + "\"count\": 4"), "/accessors/0", "needs 48 bytes");
    expect_refused(with_accessor(vec3 + "\"count\": 4294967295"), "/accessors/0", "needs 51539607540 bytes");
    expect_refused(with_accessor(vec3 + "\"count\": 4294967296"), "/accessors/0/count", "whole number");
    expect_refused(with_accessor(vec3 + "\"count\": 3, \"byteOffset\": 4"), "/accessors/0", "from byte 4");
    expect_refused(with_accessor(vec3 + "\"count\": 3, \"byteOffset\": 9007199254740992"), "/accessors/0", "from byte");
    expect_refused(with_accessor(vec3 + "\"count\": 3, \"byteOffset\": 18446744073709551615"),
                   "/accessors/0/byteOffset", "whole number");
    expect_refused(with_accessor("\"componentType\": 5127, \"type\": \"VEC3\", \"count\": 3"),
                   "/accessors/0/componentType", "5127");
    expect_refused(with_accessor("\"componentType\": 5126, \"type\": \"VEC5\", \"count\": 3"), "/accessors/0/type",
                   "VEC5");
}

TEST(GltfAccessor, ZerosThatNobodyStoredAreCountedBeforeTheyAreMade) {
    expect_refused(with_accessor("\"componentType\": 5126, \"type\": \"VEC3\", \"count\": 4000000000"),
                   "/meshes/0/primitives/0", "MiB", ErrorCode::resources);
}

TEST(GltfMesh, StripsAndFansAsTheSpecificationHasThem) {
    using gltf::as_triangles;
    using Corners = std::vector<uint32_t>;
    EXPECT_EQ(as_triangles({7, 8, 9, 1, 2}, 4), (Corners{7, 8, 9}));
    EXPECT_EQ(as_triangles({0, 1, 2, 3, 4}, 5), (Corners{0, 1, 2, 1, 3, 2, 2, 3, 4}));
    EXPECT_EQ(as_triangles({0, 1, 2, 3}, 6), (Corners{1, 2, 0, 2, 3, 0}));
    EXPECT_TRUE(as_triangles({0, 1}, 5).empty());
}

TEST(GltfMesh, IndicesOfAllWidthsAndTheirFaults) {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle);
    const int narrow = b.accessor<uint8_t>("SCALAR", 5121, 1, {2, 1, 0});
    const int middle = b.accessor<uint16_t>("SCALAR", 5123, 1, {2, 1, 0});
    const int wide = b.accessor<uint32_t>("SCALAR", 5125, 1, {2, 1, 0});
    for (const int i : {narrow, middle, wide}) {
        const LoadedScene loaded = good_gltf(b.text(one_mesh(p, ", \"indices\": " + std::to_string(i))));
        EXPECT_EQ(only_mesh(loaded).indices, (std::vector<uint32_t>{2, 1, 0}));
    }
    const int out = b.accessor<uint16_t>("SCALAR", 5123, 1, {0, 1, 3}),
              restart = b.accessor<uint16_t>("SCALAR", 5123, 1, {0, 1, 65535});
    const std::string pointer = "/meshes/0/primitives/0/indices";
    expect_refused(b.text(one_mesh(p, ", \"indices\": " + std::to_string(out))), pointer, "is 3");
    expect_refused(b.text(one_mesh(p, ", \"indices\": " + std::to_string(restart))), pointer, "is 65535");
    expect_refused(b.text(one_mesh(p, ", \"indices\": " + std::to_string(p))), "/accessors/0", "must be scalars");
}

TEST(GltfMesh, AttributesMustFitTogether) {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle), n = b.floats("VEC3", 3, {0, 0, 1, 0, 0, 1});
    expect_refused(b.text("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + std::to_string(p) +
                          ", \"NORMAL\": " + std::to_string(n) + "}}]}], \"nodes\": [{\"mesh\": 0}]"),
                   "/meshes/0/primitives/0/attributes/NORMAL", "2 elements");
}

TEST(GltfMesh, MatricesAreNoVectors) {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle), n = b.floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
    // Of four components each: MAT2 of bytes has columns of two, each on four bytes.
    const int floats = b.floats("MAT2", 4, std::vector<float>(12, 0.5f));
    const int bytes = b.accessor<uint8_t>("MAT2", 5121, 8, std::vector<uint8_t>(24, 255), ", \"normalized\": true");
    const auto file = [&](const std::string& attribute, int accessor) {
        return b.text("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + std::to_string(p) +
                      ", \"NORMAL\": " + std::to_string(n) + ", \"" + attribute + "\": " + std::to_string(accessor) +
                      "}, \"material\": 0}]}], \"materials\": [{\"pbrMetallicRoughness\": {\"roughnessFactor\": 0.5}, "
                      "\"extensions\": {\"KHR_materials_anisotropy\": {\"anisotropyStrength\": 0.5}}}], "
                      "\"nodes\": [{\"mesh\": 0}]");
    };
    for (const int matrices : {floats, bytes}) {
        expect_refused(file("COLOR_0", matrices), "/meshes/0/primitives/0/attributes/COLOR_0", "vectors of 3 or 4");
        expect_refused(file("TANGENT", matrices), "/meshes/0/primitives/0/attributes/TANGENT", "vectors of 4");
    }
}

TEST(GltfMesh, NodesAndPrimitivesShareWhatTheyUse) {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle);
    const std::string primitive = "{\"attributes\": {\"POSITION\": " + std::to_string(p) + "}}";
    const LoadedScene loaded = good_gltf(b.text("\"meshes\": [{\"primitives\": [" + primitive + "," + primitive +
                                                "]}], \"nodes\": [{\"mesh\": 0}, {\"mesh\": 0}, {\"mesh\": 0}]"));
    EXPECT_EQ(loaded.scene.instances.size(), 6u);
    EXPECT_EQ(loaded.scene.meshes.size(), 1u);
    EXPECT_TRUE(only_mesh(loaded).normals.empty());  // without normals it is flat
}

TEST(GltfMesh, PointsAndLinesAreReported) {
    GltfBuilder b;
    const LoadedScene loaded = good_gltf(b.text(one_mesh(b.floats("VEC3", 3, kTriangle), ", \"mode\": 1")));
    EXPECT_TRUE(loaded.scene.instances.empty());
    EXPECT_TRUE(has(loaded.fidelity, "points and lines"));
}

}  // namespace
}  // namespace steradian
