// Model files of others, which are not part of the project: skipped where they are missing.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>

#include "meshes/mesh_test.h"
#include "support/support.h"

namespace steradian {
namespace {

/// Files of the tinyobjloader collection that must be refused: the line, and a part of the reason. All others must
/// load.
struct Refused {
    uint32_t line;
    const char* message;
};
const std::map<std::string, Refused> kRefused{
    {"invalid-face-definition.obj", {15, "a face of 1 corner, expected at least 3"}},
    {"invalid-relative-texture-index.obj", {2, "vertex index 1 is out of range: the file has no v lines"}},
    {"invalid-relative-vertex-index.obj", {1, "vertex index -4 is out of range: the file has no v lines"}},
    {"issue-140-zero-face-idx.obj", {16, "vertex index 0 is out of range: expected 1 to 4"}},
};

/// Triangles expected of files that are easy to count by hand, and a part of a warning that they must give.
struct Loaded {
    size_t parts, triangles, materials;
    const char* warning;  ///< empty: none at all
};
const std::map<std::string, Loaded> kLoaded{
    {"cornell_box.obj", {4, 36, 4, ""}},
    {"cornell_box_multimaterial.obj", {4, 36, 4, ""}},
    {"cube.obj", {3, 12, 3, ""}},
    {"cube-vertex-w-component.obj", {3, 12, 3, ""}},
    {"cube-vertexcol.obj", {3, 12, 3, ""}},
    {"issue-138.obj", {2, 12, 2, ""}},
    {"issue-161-inconsistent-f.obj", {1, 12, 0, "'cube' is not defined"}},
    {"issue-162-smoothing-group.obj", {2, 12, 2, ""}},
    {"issue-235-usemtl-then-o.obj", {2, 2, 2, ""}},
    {"issue-244-mtl-searchpaths.obj", {2, 2, 0, "material library 'issue-244.mtl'"}},
    {"issue-246-usemtl-whitespace.obj", {1, 1, 1, ""}},
    {"issue-295-trianguation-failure.obj", {1, 28, 0, ""}},
    {"issue-319-002.obj", {1, 14, 0, ""}},
    {"issue-319-003.obj", {1, 8, 0, ""}},
    {"issue-330.obj", {1, 3, 0, ""}},
    {"issue-356-leading-spaces-newmtl.obj", {0, 0, 0, ""}},
    {"line-prim.obj", {0, 0, 0, "lines (l)"}},
    {"mtl filename with whitespace issue46.obj", {1, 12, 1, "material library 'invalid file with spaces.mtl'"}},
    {"mtllib-multiple-files-issue-112.obj", {1, 1, 1, "material library 'invalid-file-aaa.mtl'"}},
    {"points-prim.obj", {0, 0, 0, "points (p)"}},
    {"skin-weight.obj", {3, 12, 3, "unknown keyword 'vw'"}},
    {"smoothing-group-two-squares.obj", {1, 3, 0, "no vn lines"}},
    {"smoothing-normal.obj", {1, 6, 1, ""}},
    {"test-nan.obj", {4, 34, 4, "not finite"}},
    {"usemtl-issue-104.obj", {1, 6, 0, ""}},
};

TEST(Corpus, TinyObjModels) {
    const auto shared = test::shared_folder();
    if (!shared) GTEST_SKIP() << "the folder of outside files is missing";
    size_t loaded = 0, refused = 0;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(*shared / "suites/tinyobj_models/models"))
        if (entry.path().extension() == ".obj") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const auto& path : files) {
        const std::string name = path.filename().string();
        const auto result = load_mesh_file(path.string());
        if (const auto expected = kRefused.find(name); expected != kRefused.end()) {
            ++refused;
            ASSERT_FALSE(result.ok()) << name;
            EXPECT_EQ(result.error().where.line, expected->second.line) << result.error().str();
            EXPECT_NE(result.error().message.find(expected->second.message), std::string::npos) << result.error().str();
            continue;
        }
        ASSERT_TRUE(result.ok()) << result.error().str();
        ++loaded;
        expect_consistent(*result);
        const auto expected = kLoaded.find(name);
        if (expected == kLoaded.end()) continue;
        size_t triangles = 0;
        for (const MeshPart& part : result->parts) triangles += part.mesh.indices.size() / 3;
        EXPECT_EQ(result->parts.size(), expected->second.parts) << name;
        EXPECT_EQ(triangles, expected->second.triangles) << name;
        EXPECT_EQ(result->materials.size(), expected->second.materials) << name;
        const std::string warnings = all_warnings(result->diagnostics);
        const std::string_view expected_warning = expected->second.warning;
        EXPECT_EQ(warnings.empty(), expected_warning.empty()) << name << "\n" << warnings;
        EXPECT_NE(warnings.find(expected_warning), std::string::npos) << name << "\n" << warnings;
    }
    EXPECT_EQ(refused, kRefused.size());
    EXPECT_GE(loaded, kLoaded.size());
}

TEST(Corpus, FuzzerRegressionsOfOthers) {
    const auto shared = test::shared_folder();
    if (!shared) GTEST_SKIP() << "the folder of outside files is missing";
    for (const auto& entry :
         std::filesystem::directory_iterator(*shared / "suites/tinyobj_models/fuzzer/regressions")) {
        const auto result = read_obj(test::slurp(entry.path()));
        ASSERT_FALSE(result.ok());
        EXPECT_EQ(result.error().where.line, 1u) << result.error().str();
    }
}

TEST(Corpus, ScannedModels) {
    const auto shared = test::shared_folder();
    if (!shared) GTEST_SKIP() << "the folder of outside files is missing";
    struct Model {
        const char* name;
        size_t vertices, faces;
    };
    for (const Model& model :
         {Model{"bunny.ply", 35947, 69451}, {"dragon.ply", 437645, 871414}, {"sponza66k.ply", 66350, 66445}}) {
        const std::filesystem::path path = *shared / "meshes" / model.name;
        const auto start = std::chrono::steady_clock::now();
        const auto result = load_mesh_file(path.string());
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        ASSERT_TRUE(result.ok()) << result.error().str();
        ASSERT_EQ(result->parts.size(), 1u);
        EXPECT_EQ(result->parts[0].mesh.positions.size(), model.vertices);
        EXPECT_EQ(result->parts[0].mesh.indices.size(), 3 * model.faces);
        expect_consistent(*result);
        EXPECT_TRUE(result->diagnostics.empty()) << all_warnings(result->diagnostics);
        std::printf("%s: %.1f ms, %.0f MB/s\n", model.name, seconds * 1e3,
                    double(std::filesystem::file_size(path)) / seconds / 1e6);
    }
}

}  // namespace
}  // namespace steradian
