// Morph targets and skins: where vertices, normals and tangents are, in closed form.
#include <cmath>
#include <limits>

#include "gltf_builder.h"
#include "math/transform.h"

namespace steradian {
namespace {

using namespace test;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// `"KEY": 3` with a comma before it.
std::string entry(const std::string& key, int accessor) { return ", \"" + key + "\": " + std::to_string(accessor); }

void expect_vertices(const Mesh& mesh, const std::vector<Vec3>& expected, double bound = 0) {
    ASSERT_EQ(mesh.positions.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i)
        for (int a = 0; a < 3; ++a) EXPECT_NEAR(mesh.positions[i][a], expected[i][a], bound) << i << " " << a;
}

// --- Morph targets ---

/// A triangle whose targets have these members.
std::string morphed(GltfBuilder& b, const std::string& targets, const std::string& mesh = {},
                    const std::string& node = {}, const std::string& attributes = {}, const std::string& more = {}) {
    const int p = b.floats("VEC3", 3, kTriangle);
    return b.text("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + std::to_string(p) + attributes +
                  "}, \"targets\": [" + targets + "]}]" + mesh + "}], \"nodes\": [{\"mesh\": 0" + node + "}]" + more);
}
std::string target(int positions) { return "{\"POSITION\": " + std::to_string(positions) + "}"; }

TEST(GltfMorph, TargetsAddUpByTheirWeights) {
    GltfBuilder b;
    const int first = b.floats("VEC3", 3, {2, 0, 0, 0, 4, 0, 0, 0, 8}),
              second = b.floats("VEC3", 3, {1, 1, 1, 1, 1, 1, 0, 0, 0});
    const std::string targets = target(first) + "," + target(second);
    const auto mesh = [&](const std::string& of_mesh, const std::string& of_node) {
        GltfBuilder copy = b;
        return good_gltf(morphed(copy, targets, of_mesh, of_node)).scene.meshes.at(0);
    };
    expect_vertices(mesh("", ""), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    expect_vertices(mesh(", \"weights\": [0.5, 0]", ""), {{1, 0, 0}, {1, 2, 0}, {0, 1, 4}});
    expect_vertices(mesh(", \"weights\": [0.5, 2]", ""), {{3, 2, 2}, {3, 4, 2}, {0, 1, 4}});
    // Weights of the node come before those of the mesh; they may be negative.
    expect_vertices(mesh(", \"weights\": [0.5, 2]", ", \"weights\": [0, -1]"), {{-1, -1, -1}, {0, -1, -1}, {0, 1, 0}});
    expect_vertices(mesh(", \"weights\": [0.5, 2]", ", \"weights\": [0, 0]"), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST(GltfMorph, NodesShareAMeshUnlessTheirWeightsDiffer) {
    GltfBuilder b;
    const std::string one = target(b.floats("VEC3", 3, {2, 0, 0, 0, 4, 0, 0, 0, 8}));
    const LoadedScene loaded = good_gltf(morphed(b, one, ", \"weights\": [1]",
                                                 ", \"weights\": [0.5]}, {\"mesh\": 0}, "
                                                 "{\"mesh\": 0, \"weights\": [0.5]"));
    EXPECT_EQ(loaded.scene.instances.size(), 3u);
    ASSERT_EQ(loaded.scene.meshes.size(), 2u);
    EXPECT_EQ(loaded.scene.instances[0].shape, loaded.scene.instances[2].shape);
    EXPECT_EQ(loaded.scene.meshes[0].positions[0].x, 1);
    EXPECT_EQ(loaded.scene.meshes[1].positions[0].x, 2);
}

TEST(GltfMorph, SparseAndQuantisedDifferences) {
    GltfBuilder b;
    const std::vector<float> moved{10, 20, 30};
    const int index = b.view(std::string("\1", 1)), value = b.view({reinterpret_cast<const char*>(moved.data()), 12});
    const int sparse = b.raw_accessor(
        "\"componentType\": 5126, \"type\": \"VEC3\", \"count\": 3, \"sparse\": {\"count\": 1, \"indices\": "
        "{\"bufferView\": " +
        std::to_string(index) + ", \"componentType\": 5121}, \"values\": {\"bufferView\": " + std::to_string(value) +
        "}}");
    const int bytes = b.accessor<int8_t>("VEC3", 5120, 3, {127, 0, -127, 0, 0, 0, 0, 127, 0}, ", \"normalized\": true");
    const int shorts = b.accessor<int16_t>("VEC3", 5122, 3, {1, 2, 3, -4, 5, 6, 7, 8, 9});
    const std::string targets = target(sparse) + "," + target(bytes) + "," + target(shorts);
    expect_vertices(good_gltf(morphed(b, targets, ", \"weights\": [0.5, 0.25, 1]")).scene.meshes.at(0),
                    {{1.25f, 2, 2.75f}, {2, 15, 21}, {7, 9.25f, 9}});
    // Sparse elements over others replace them.
    GltfBuilder c;
    const std::vector<float> dense{1, 1, 1, 2, 2, 2, 3, 3, 3};
    const int i = c.view(std::string("\1", 1)), v = c.view({reinterpret_cast<const char*>(moved.data()), 12});
    const int under = c.view({reinterpret_cast<const char*>(dense.data()), 36});
    const int both = c.raw_accessor(
        "\"bufferView\": " + std::to_string(under) +
        ", \"componentType\": 5126, \"type\": \"VEC3\", \"count\": 3, "
        "\"sparse\": {\"count\": 1, \"indices\": {\"bufferView\": " +
        std::to_string(i) + ", \"componentType\": 5121}, \"values\": {\"bufferView\": " + std::to_string(v) + "}}");
    expect_vertices(good_gltf(morphed(c, target(both), ", \"weights\": [1]")).scene.meshes.at(0),
                    {{1, 1, 1}, {11, 20, 30}, {3, 4, 3}});
}

TEST(GltfMorph, NormalsTangentsCoordinatesAndColours) {
    GltfBuilder b;
    const int n = b.floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
    const int t = b.floats("VEC4", 4, {1, 0, 0, -1, 1, 0, 0, 1, 1, 0, 0, 1});
    const int uv = b.floats("VEC2", 2, {0, 0, 1, 0, 0, 1}), color = b.floats("VEC4", 4, std::vector<float>(12, 0.5f));
    const int dn = b.floats("VEC3", 3, {6, 0, 7, 0, 0, 0, 0, 0, 0}),
              dt = b.floats("VEC3", 3, {5, 8, 0, 0, 0, 0, 0, 0, 0});
    const int duv = b.floats("VEC2", 2, {1, 2, 0, 0, 0, 0});
    const int dc = b.floats("VEC4", 4, {0.5f, -0.5f, 2, -0.25f, 0, 0, 0, 0, 0, 0, 0, 0});
    const LoadedScene loaded = good_gltf(
        morphed(b,
                "{\"NORMAL\": " + std::to_string(dn) + entry("TANGENT", dt) + entry("TEXCOORD_0", duv) +
                    entry("COLOR_0", dc) + "}",
                ", \"weights\": [0.5]", "",
                entry("NORMAL", n) + entry("TANGENT", t) + entry("TEXCOORD_0", uv) + entry("COLOR_0", color) +
                    "}, \"material\": 0, \"extras\": {",
                ", \"materials\": [{\"pbrMetallicRoughness\": {\"roughnessFactor\": 0.5}, \"alphaMode\": \"BLEND\", "
                "\"extensions\": {\"KHR_materials_anisotropy\": {\"anisotropyStrength\": 0.5}}}]"));
    const Mesh& m = loaded.scene.meshes.at(0);
    // (3, 0, 1 + 3.5) and (1 + 2.5, 4, 0), as unit vectors.
    const double ln = std::hypot(3, 4.5), lt = std::hypot(3.5, 4);
    EXPECT_NEAR(m.normals[0].x, 3 / ln, 1e-7);
    EXPECT_NEAR(m.normals[0].z, 4.5 / ln, 1e-7);
    EXPECT_EQ(m.normals[1], (Vec3{0, 0, 1}));
    ASSERT_EQ(m.tangents.size(), 3u);
    EXPECT_NEAR(m.tangents[0].direction.x, 3.5 / lt, 1e-7);
    EXPECT_NEAR(m.tangents[0].direction.y, 4 / lt, 1e-7);
    EXPECT_EQ(m.tangents[0].side, -1);
    EXPECT_EQ(m.uvs[0], (Vec2{0.5f, 1}));
    EXPECT_EQ(m.uvs[1], (Vec2{1, 0}));
    EXPECT_EQ(m.colors[0], (Rgb{0.75f, 0.25f, 1}));
    EXPECT_EQ(m.alphas[0], 0.375f);
    EXPECT_EQ(m.colors[1], (Rgb{0.5f, 0.5f, 0.5f}));
}

TEST(GltfMorph, AnimatedWeights) {
    GltfBuilder b;
    const int first = b.floats("VEC3", 3, {2, 0, 0, 0, 4, 0, 0, 0, 8}),
              second = b.floats("VEC3", 3, {1, 1, 1, 1, 1, 1, 0, 0, 0});
    const int t = b.floats("SCALAR", 1, {0, 1});
    const int linear = b.floats("SCALAR", 1, {0, 1, 1, 3});
    // Tangents towards the keyframe, values, tangents away from it; for both weights each.
    const int cubic = b.floats("SCALAR", 1, {9, 9, 0, 2, 4, 0, 0, 8, 1, 2, 9, 9});
    const int shorts = b.accessor<uint16_t>("SCALAR", 5123, 1, {0, 65535, 65535, 0}, ", \"normalized\": true");
    const auto animation = [&](int values, const std::string& interpolation) {
        return "{\"samplers\": [{\"input\": " + std::to_string(t) + ", \"output\": " + std::to_string(values) +
               ", \"interpolation\": \"" + interpolation +
               "\"}], \"channels\": [{\"sampler\": 0, \"target\": {\"node\": "
               "0, \"path\": \"weights\"}}]}";
    };
    const std::string file = morphed(b, target(first) + "," + target(second), "", ", \"weights\": [7, 7]", "",
                                     ", \"animations\": [" + animation(linear, "LINEAR") + "," +
                                         animation(cubic, "CUBICSPLINE") + "," + animation(shorts, "STEP") + "]");
    const auto at = [&](const std::string& number, double seconds) {
        LoadOptions options;
        options.animation = number;
        options.frame_time = seconds;
        return good_gltf(file, options).scene.meshes.at(0);
    };
    // Weights 0.5 and 2.
    expect_vertices(at("0", 0.5), {{3, 2, 2}, {3, 4, 2}, {0, 1, 4}});
    // (1 / 2) (0 + 1) + (4 - 0) / 8 = 1 and (1 / 2) (2 + 2) + (0 - 8) / 8 = 1.
    expect_vertices(at("1", 0.5), {{3, 1, 1}, {2, 5, 1}, {0, 1, 8}});
    expect_vertices(at("2", 0.5), {{1, 1, 1}, {2, 1, 1}, {0, 1, 0}});
    expect_vertices(at("2", 1), {{2, 0, 0}, {1, 4, 0}, {0, 1, 8}});
}

TEST(GltfMorph, MissingNormalsAreThoseOfTheMorphedTriangles) {
    GltfBuilder b;
    const LoadedScene loaded =
        good_gltf(morphed(b, target(b.floats("VEC3", 3, {0, 0, 1, 0, 0, 0, 0, 0, 0})), ", \"weights\": [1]"));
    EXPECT_TRUE(loaded.scene.meshes.at(0).normals.empty());
}

TEST(GltfMorph, FaultsAreRefusedOrReported) {
    const auto with = [](const std::string& kind, size_t components, const std::vector<float>& values,
                         const std::string& name) {
        GltfBuilder b;
        const int a = b.floats(kind, components, values);
        return morphed(b, "{\"" + name + "\": " + std::to_string(a) + "}", ", \"weights\": [1]");
    };
    const std::string place = "/meshes/0/primitives/0/targets/0";
    expect_refused(with("VEC3", 3, {0, 0, 0}, "POSITION"), place, "has 1 elements, but there are 3 positions");
    expect_refused(with("VEC2", 2, {0, 0, 0, 0, 0, 0}, "POSITION"), place, "vectors of 3");
    GltfBuilder b;
    const int d = b.floats("VEC3", 3, kTriangle);
    expect_refused(morphed(b, "{\"POSITION\": 9}", ", \"weights\": [1]"), place + "/POSITION", "accessor 9");
    expect_refused(morphed(b, target(d), ", \"weights\": [\"a\"]"), "/meshes/0/weights/0", "weights");
    EXPECT_TRUE(has(good_gltf(morphed(b, target(d), ", \"weights\": [1, 2]")).fidelity, "not as many weights"));
    EXPECT_TRUE(
        has(good_gltf(morphed(b, target(d) + "," + target(d), ", \"weights\": [1]")).fidelity, "not as many weights"));
    // Differences that are not finite make positions that are not: their triangles are dropped later.
    EXPECT_TRUE(load_gltf(with("VEC3", 3, {kNan, 0, 0, 0, 0, 0, 0, 0, 0}, "POSITION")).ok());
}

// --- Skins ---

/// A square in the plane z = 0 from (0, 0) to (1, 2) with a vertex in the middle of each long side, on nodes 1 and 2.
struct Rig {
    std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0};
    std::vector<uint8_t> joints{0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    std::vector<float> weights{1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    /// Of the upper joint, column by column: what takes the height of 1 to its origin.
    std::vector<float> inverse{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                               1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
    std::string mesh_node = ", \"translation\": [100, 0, 0]";
    std::string lower = "\"children\": [2]", upper = "\"translation\": [0, 1, 0]";
    std::string joint_list = "[1, 2]", scene = "[0, 1]", more{}, attributes{}, primitive{}, mesh{};
    GltfBuilder b{};

    std::string text() {
        const int p = b.floats("VEC3", 3, positions), w = b.floats("VEC4", 4, weights),
                  m = b.floats("MAT4", 16, inverse);
        const int j = b.accessor<uint8_t>("VEC4", 5121, 4, joints);
        const int i = b.accessor<uint16_t>("SCALAR", 5123, 1, {0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4});
        return b.text("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + std::to_string(p) +
                      entry("JOINTS_0", j) + entry("WEIGHTS_0", w) + attributes +
                      "}, \"indices\": " + std::to_string(i) + primitive + "}]" + mesh +
                      "}], \"nodes\": [{\"mesh\": 0, \"skin\": 0" + mesh_node + "}, {" + lower + "}, {" + upper +
                      "}], \"scenes\": [{\"nodes\": " + scene + "}], \"skins\": [{\"joints\": " + joint_list +
                      ", \"inverseBindMatrices\": " + std::to_string(m) + "}]" + more);
    }
};

TEST(GltfSkin, InItsBindPoseTheMeshIsWhereItWasBound) {
    const LoadedScene loaded = good_gltf(Rig{}.text());
    expect_vertices(loaded.scene.meshes.at(0), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}, {1, 2, 0}});
    // The node of the mesh has no say.
    EXPECT_TRUE(is_identity(loaded.scene.instances.at(0).world_from_object));
    EXPECT_TRUE(loaded.fidelity.empty());
    EXPECT_TRUE(loaded.diagnostics.empty());
}

TEST(GltfSkin, ATwoJointBend) {
    // The upper joint turned by 90 degrees about z at (0, 1): (x, y) goes to (1 - y, 1 + x); the middle is halfway
    // between where both joints take it.
    Rig rig{.upper = "\"translation\": [0, 1, 0], \"rotation\": [0, 0, 0.70710678118654752, 0.70710678118654752]"};
    expect_vertices(good_gltf(rig.text()).scene.meshes.at(0),
                    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5f, 1.5f, 0}, {-1, 1, 0}, {-1, 2, 0}}, 1e-7);
    // The whole rig moved and turned by 180 degrees about z.
    Rig moved{.lower = "\"children\": [2], \"translation\": [5, 0, 3], \"rotation\": [0, 0, 1, 0]",
              .upper = "\"translation\": [0, 1, 0], \"rotation\": [0, 0, 0.70710678118654752, 0.70710678118654752]"};
    expect_vertices(good_gltf(moved.text()).scene.meshes.at(0),
                    {{5, 0, 3}, {4, 0, 3}, {5, -1, 3}, {4.5f, -1.5f, 3}, {6, -1, 3}, {6, -2, 3}}, 1e-6);
}

TEST(GltfSkin, JointsAreAnimatedAndMorphsComeFirst) {
    Rig rig;
    const float c = std::sqrt(0.5f);
    const int t = rig.b.floats("SCALAR", 1, {0, 1}), q = rig.b.floats("VEC4", 4, {0, 0, 0, 1, 0, 0, c, c});
    std::vector<float> lifted(18, 0.0f);
    lifted[17] = 4;  // the last vertex, along z
    lifted[16] = 2;  // and y
    const int d = rig.b.floats("VEC3", 3, lifted);
    rig.primitive = ", \"targets\": [" + target(d) + "]";
    rig.mesh = ", \"weights\": [0.5]";
    rig.more = ", \"animations\": [{\"samplers\": [{\"input\": " + std::to_string(t) +
               ", \"output\": " + std::to_string(q) +
               "}], \"channels\": [{\"sampler\": 0, \"target\": {\"node\": 2, \"path\": \"rotation\"}}]}]";
    LoadOptions options;
    options.frame_time = 1;
    // (1, 2, 0) is (1, 3, 2) after the morph, and the joint turns that.
    expect_vertices(good_gltf(rig.text(), options).scene.meshes.at(0),
                    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5f, 1.5f, 0}, {-1, 1, 0}, {-2, 2, 2}}, 1e-6);
}

TEST(GltfSkin, NormalsTangentsAndSides) {
    // Joints that scale x by 4 and mirror y. A normal (1, 1, 0) / sqrt 2 becomes (1/4, -1, 0), a tangent (1, -1, 0) /
    // sqrt 2 becomes (4, 1, 0); the bitangent's side changes, and so does the order of corners.
    Rig rig{.lower = "\"children\": [2], \"scale\": [4, -1, 1]"};
    const float h = std::sqrt(0.5f);
    std::vector<float> normals, tangents;
    for (int i = 0; i < 6; ++i)
        normals.insert(normals.end(), {h, h, 0}), tangents.insert(tangents.end(), {h, -h, 0, 1});
    rig.attributes = entry("NORMAL", rig.b.floats("VEC3", 3, normals)) +
                     entry("TANGENT", rig.b.floats("VEC4", 4, tangents)) +
                     entry("TEXCOORD_0", rig.b.floats("VEC2", 2, std::vector<float>(12, 0.5f)));
    rig.primitive = ", \"material\": 0";
    rig.more =
        ", \"materials\": [{\"pbrMetallicRoughness\": {\"roughnessFactor\": 0.5}, \"extensions\": "
        "{\"KHR_materials_anisotropy\": {\"anisotropyStrength\": 0.5}}}]";
    const LoadedScene loaded = good_gltf(rig.text());
    const Mesh& m = loaded.scene.meshes.at(0);
    const double ln = std::hypot(0.25, 1), lt = std::hypot(4, 1);
    EXPECT_NEAR(m.normals[0].x, 0.25 / ln, 1e-7);
    EXPECT_NEAR(m.normals[0].y, -1 / ln, 1e-7);
    ASSERT_EQ(m.tangents.size(), 6u);
    EXPECT_NEAR(m.tangents[0].direction.x, 4 / lt, 1e-7);
    EXPECT_NEAR(m.tangents[0].direction.y, 1 / lt, 1e-7);
    EXPECT_EQ(m.tangents[0].side, -1);
    EXPECT_EQ(m.indices, (std::vector<uint32_t>{0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5}));
    expect_vertices(m, {{0, 0, 0}, {4, 0, 0}, {0, -1, 0}, {4, -1, 0}, {0, -2, 0}, {4, -2, 0}});
}

TEST(GltfSkin, WeightsAreTakenAsPartsOfTheirSum) {
    Rig rig{.upper = "\"translation\": [0, 3, 0]"};  // 2 above where it was bound
    for (float& w : rig.weights) w *= 3;
    const LoadedScene loaded = good_gltf(rig.text());
    expect_vertices(loaded.scene.meshes.at(0), {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {1, 2, 0}, {0, 4, 0}, {1, 4, 0}},
                    1e-6);
    EXPECT_TRUE(has(loaded.fidelity, "parts of their sum"));
    Rig none{.lower = "\"children\": [2], \"translation\": [0, 0, 1]"};
    std::fill(none.weights.begin(), none.weights.end(), 0.0f);
    const LoadedScene lost = good_gltf(none.text());
    EXPECT_EQ(lost.scene.meshes.at(0).positions[1], (Vec3{1, 0, 1}));
    EXPECT_TRUE(has(lost.fidelity, "without a weight"));
}

TEST(GltfSkin, SeveralSetsAndIntegers) {
    // A second set adds what the first one lacks: 1/4 of the lower joint, 3/4 of the upper one.
    Rig rig{.upper = "\"translation\": [0, 1, 8]"};
    std::fill(rig.joints.begin(), rig.joints.end(), uint8_t(0));
    std::fill(rig.weights.begin(), rig.weights.end(), 0.0f);
    for (size_t i = 0; i < 6; ++i) rig.weights[4 * i] = 0.2f;
    std::vector<uint16_t> joints(24, 1), weights(24, 0);
    for (size_t i = 0; i < 6; ++i) weights[4 * i + 3] = 65535 / 5 * 3;
    rig.attributes = entry("JOINTS_1", rig.b.accessor<uint16_t>("VEC4", 5123, 4, joints)) +
                     entry("WEIGHTS_1", rig.b.accessor<uint16_t>("VEC4", 5123, 4, weights, ", \"normalized\": true"));
    const LoadedScene loaded = good_gltf(rig.text());
    EXPECT_NEAR(loaded.scene.meshes.at(0).positions[5].z, 6, 1e-6);
    EXPECT_TRUE(has(loaded.fidelity, "parts of their sum"));
}

TEST(GltfSkin, WithoutMatricesJointsAreWhereTheMeshIs) {
    Rig rig{.lower = "\"children\": [2], \"translation\": [0, 0, 7]"};
    std::string text = rig.text();
    const size_t at = text.find(", \"inverseBindMatrices\"");
    text.erase(at, text.find('}', at) - at);
    EXPECT_EQ(good_gltf(text).scene.meshes.at(0).positions[5], (Vec3{1, 3, 7}));
}

TEST(GltfSkin, TwoSkinsMakeTwoMeshesOfOne) {
    Rig rig;
    rig.more = "";
    std::string text = rig.text();
    const auto replace = [&](const std::string& a, const std::string& b) {
        ASSERT_NE(text.find(a), std::string::npos) << a;
        text.replace(text.find(a), a.size(), b);
    };
    replace("\"nodes\": [{\"mesh\": 0", "\"nodes\": [{\"mesh\": 0, \"name\": \"a\"");
    replace("}], \"scenes\": [{\"nodes\": [0, 1]",
            "}, {\"mesh\": 0, \"skin\": 1}, {\"mesh\": 0}, {\"translation\": [0, 0, 5], "
            "\"children\": [6]}, {\"translation\": [0, 1, 0]}], \"scenes\": [{\"nodes\": [0, 1, 3, 4, 5]");
    replace("\"skins\": [", "\"skins\": [{\"joints\": [1, 2]}, {\"joints\": [5, 6]}, ");
    const LoadedScene loaded = good_gltf(text);
    ASSERT_EQ(loaded.scene.meshes.size(), 3u);
    EXPECT_EQ(loaded.scene.meshes[0].positions[5], (Vec3{1, 3, 0}));
    EXPECT_EQ(loaded.scene.meshes[1].positions[5], (Vec3{1, 3, 5}));
    EXPECT_EQ(loaded.scene.meshes[2].positions[5], (Vec3{1, 2, 0}));
}

TEST(GltfSkin, WhatCannotBeAppliedIsReported) {
    Rig empty{.joint_list = "[]"}, elsewhere{.scene = "[0]"};
    for (Rig* rig : {&empty, &elsewhere}) {
        const LoadedScene loaded = good_gltf(rig->text());
        // As if there were no skin: where its node is.
        EXPECT_EQ(loaded.scene.instances.at(0).world_from_object.m[0][3], 100);
        EXPECT_FALSE(loaded.fidelity.empty());
    }
    Rig last_row;
    last_row.inverse[3] = 0.5f;
    EXPECT_TRUE(has(good_gltf(last_row.text()).diagnostics, "last row"));
    // Nothing is left of the mesh's own node, which does not matter.
    Rig flat{.mesh_node = ", \"scale\": [0, 0, 0]"};
    EXPECT_EQ(good_gltf(flat.text()).scene.instances.size(), 1u);
}

TEST(GltfSkin, FaultsAreRefusedWithTheirPlace) {
    const std::string attributes = "/meshes/0/primitives/0/attributes";
    Rig joint;
    joint.joints[16] = 2;
    expect_refused(joint.text(), attributes + "/JOINTS_0", "vertex 4 follows joint 2, but the skin has 2");
    Rig unused;
    unused.joints[1] = 200;  // its weight is 0
    EXPECT_TRUE(load_gltf(unused.text()).ok());
    for (const float bad : {kNan, -0.5f, std::numeric_limits<float>::infinity()}) {
        Rig weight;
        weight.weights[4] = bad;
        expect_refused(weight.text(), attributes + "/WEIGHTS_0", "weights of vertex 1");
    }
    Rig matrix;
    matrix.inverse[20] = kNan;
    expect_refused(matrix.text(), "/accessors/2", "matrix 1 is not finite");
    Rig few;
    few.inverse.resize(16);
    expect_refused(few.text(), "/skins/0/inverseBindMatrices", "1 inverse bind matrices, but 2 joints");
    Rig range{.joint_list = "[1, 3]"};
    expect_refused(range.text(), "/skins/0/joints/1", "node 3");
    Rig cycle{.upper = "\"children\": [1]"};
    expect_refused(cycle.text(), "/nodes/2/children/0", "reached before");
    Rig half;
    half.attributes = ", \"JOINTS_1\": 0";
    expect_refused(half.text(), attributes, "no 'WEIGHTS_1'");
    Rig counts;
    counts.weights.resize(20);
    expect_refused(counts.text(), attributes + "/WEIGHTS_0", "5 of 6 vertices");
}

}  // namespace
}  // namespace steradian
