#include <cmath>

#include "formats/mesh/parse_failure.h"
#include "formats/obj/records.h"
#include "meshes/mesh_test.h"
#include "support/support.h"

namespace steradian {
namespace {

using Positions = std::vector<Vec3>;

constexpr std::string_view kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

std::string triangle_and(std::string_view lines) { return std::string(kTriangle) + std::string(lines); }

// --- Faces -----------------------------------------------------------------------------------------------------

TEST(Obj, EveryFormOfCorner) {
    const std::string attributes =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.75\nvt 0.5 0.5\nvt 1 0\nvn 0 0 1\nvn 0 1 0\nvn 1 0 0\n";
    const Positions corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<Vec2> uvs{{0.25f, 0.25f}, {0.5f, 0.5f}, {1, 1}};  // v downwards
    const Positions normals{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
    struct Case {
        const char* face;
        bool uvs, normals;
    };
    for (const Case& c : {Case{"f 1 2 3", false, false},
                          {"f 1/1 2/2 3/3", true, false},
                          {"f 1//1 2//2 3//3", false, true},
                          {"f 1/1/1 2/2/2 3/3/3", true, true},
                          {"f -3 -2 -1", false, false},
                          {"f -3/-3/-3 -2/-2/-2 -1/-1/-1", true, true},
                          {"f 1/ 2/ 3/", false, false},
                          {"f 1// 2// 3//", false, false},
                          {"f 1/1/ 2/2/ 3/3/", true, false},
                          {"f +1 +2 +3", false, false},
                          {"fo 1 2 3", false, false}}) {
        const Mesh mesh = only_mesh(read_obj(attributes + c.face));
        EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2})) << c.face;
        EXPECT_EQ(mesh.positions, corners) << c.face;
        EXPECT_EQ(mesh.uvs, c.uvs ? uvs : std::vector<Vec2>{}) << c.face;
        EXPECT_EQ(mesh.normals, c.normals ? normals : Positions{}) << c.face;
    }
}

TEST(Obj, NegativeIndicesCountFromTheirLinePositiveOnesFromTheStart) {
    const Mesh mesh = only_mesh(
        read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\nf 1 2 7\nv 9 9 9\n"));
    EXPECT_EQ(
        corner_positions(mesh),
        (Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {0, 0, 0}, {1, 0, 0}, {9, 9, 9}}));
}

TEST(Obj, PolygonsBecomeTriangles) {
    const Mesh quad = only_mesh(read_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"));
    EXPECT_EQ(quad.indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
    // Concave, in a plane that faces -Y: the area must be exact, so no triangle lies outside.
    const Mesh l = only_mesh(read_obj("v 0 7 0\nv 2 7 0\nv 2 7 1\nv 1 7 1\nv 1 7 2\nv 0 7 2\nf 1 2 3 4 5 6\n"));
    const Positions p = corner_positions(l);
    ASSERT_EQ(p.size(), 12u);
    float area = 0;
    for (size_t i = 0; i < p.size(); i += 3) {
        const Vec3 n = cross(p[i + 1] - p[i], p[i + 2] - p[i]);
        EXPECT_LT(n.y, 0);
        area -= n.y / 2;
    }
    EXPECT_EQ(area, 3);
}

TEST(Obj, VerticesAreSharedByEqualCornersOnly) {
    const Mesh mesh = only_mesh(
        read_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\nf 1/2 3/1 4/1\n"));
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3, 4, 2, 3}));
    EXPECT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.positions[4], mesh.positions[0]);
    EXPECT_EQ(mesh.uvs[4], (Vec2{1, 0}));
}

TEST(Obj, CubesStayClosed) {
    const std::string corners = "v 0 0 0\nv 0 0 1\nv 0 1 0\nv 0 1 1\nv 1 0 0\nv 1 0 1\nv 1 1 0\nv 1 1 1\n";
    const std::string faces = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
    for (const std::string& text : {corners + faces, corners + "s 1\n" + faces,
                                    corners + "usemtl a\n" + faces.substr(0, 20) + "usemtl b\n" + faces.substr(20)}) {
        const MeshFile file = expect_ok(read_obj(text));
        expect_consistent(file);
        EXPECT_EQ(open_edges(file), 0u);
    }
    EXPECT_NE(open_edges(expect_ok(read_obj(corners + faces.substr(10)))), 0u) << "the test itself must see a hole";
}

// --- Normals ---------------------------------------------------------------------------------------------------

TEST(Obj, FlatWithoutSmoothingAndNormals) {
    EXPECT_TRUE(only_mesh(read_obj(triangle_and("f 1 2 3\n"))).normals.empty());
    EXPECT_TRUE(only_mesh(read_obj(triangle_and("s off\nf 1 2 3\ns 0\nf 1 2 3\n"))).normals.empty());
}

TEST(Obj, SmoothingGroupsWeighNormalsByAngle) {
    // Two faces of a roof over the edge from (0,0,0) to (0,0,1): a square and a triangle of very different size, with
    // right angles at both ends of the edge in the square, 90 and 45 degrees in the triangle.
    const std::string roof = "v 0 0 0\nv 0 0 1\nv -1 0 1\nv -1 0 0\nv 0 1 0\n";
    const Mesh mesh = only_mesh(read_obj(roof + "s 1\nf 1 4 3 2\nf 1 2 5\n"));
    // The square's normal is (0,1,0) up to sign, the triangle's (-1,0,0).
    ASSERT_EQ(mesh.positions.size(), 5u);
    ASSERT_EQ(mesh.normals.size(), 5u);
    const auto at = [&](Vec3 p) {
        for (size_t i = 0; i < mesh.positions.size(); ++i)
            if (mesh.positions[i] == p) return mesh.normals[i];
        return Vec3{};
    };
    const Vec3 square = at({-1, 0, 0}), triangle = at({0, 1, 0});
    EXPECT_EQ(std::fabs(square.y), 1);
    EXPECT_EQ(std::fabs(triangle.x), 1);
    const double half = std::sqrt(0.5);
    EXPECT_NEAR(dot(at({0, 0, 0}), square), half, 1e-7);
    EXPECT_NEAR(dot(at({0, 0, 0}), triangle), half, 1e-7);
    EXPECT_NEAR(dot(at({0, 0, 1}), square), 2 / std::sqrt(5.0), 1e-7);
    EXPECT_NEAR(dot(at({0, 0, 1}), triangle), 1 / std::sqrt(5.0), 1e-7);
}

TEST(Obj, SmoothingStopsBetweenGroups) {
    const std::string roof = "v 0 0 0\nv 0 0 1\nv -1 0 1\nv -1 0 0\nv 0 1 0\n";
    const Mesh mesh = only_mesh(read_obj(roof + "s 1\nf 1 4 3 2\ns 2\nf 1 2 5\n"));
    ASSERT_EQ(mesh.positions.size(), 7u);
    for (size_t i = 0; i < 4; ++i) EXPECT_EQ(std::fabs(mesh.normals[i].y), 1);
    for (size_t i = 4; i < 7; ++i) EXPECT_EQ(std::fabs(mesh.normals[i].x), 1);
}

TEST(Obj, SmoothingGoesOverPartsAndDoesNotDependOnHowAPolygonIsCut) {
    const std::string cube = "v 0 0 0\nv 0 0 1\nv 0 1 0\nv 0 1 1\nv 1 0 0\nv 1 0 1\nv 1 1 0\nv 1 1 1\ns 1\n";
    const MeshFile file = expect_ok(
        read_obj(cube + "usemtl a\nf 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nusemtl b\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"));
    ASSERT_EQ(file.parts.size(), 2u);
    const double corner = 1 / std::sqrt(3.0);
    for (const MeshPart& part : file.parts) {
        ASSERT_EQ(part.mesh.normals.size(), part.mesh.positions.size());
        for (size_t i = 0; i < part.mesh.normals.size(); ++i)
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_NEAR(part.mesh.normals[i][axis], part.mesh.positions[i][axis] > 0 ? corner : -corner, 1e-7);
    }
}

TEST(Obj, NormalsOfTheFileWinAndTheRestIsFlat) {
    const Mesh mesh = only_mesh(
        read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 1\nvn 0.6 0 0.8\ns 1\nf 1//1 2//1 3//1\ns off\nf 1 4 2\n"));
    ASSERT_EQ(mesh.normals.size(), 6u);
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(mesh.normals[i], (Vec3{0.6f, 0, 0.8f}));
    for (size_t i = 3; i < 6; ++i) EXPECT_EQ(std::fabs(mesh.normals[i].y), 1);
}

TEST(Obj, FacesThatCancelEachOtherFallBackToTheirOwnNormal) {
    const Mesh mesh = only_mesh(read_obj(triangle_and("s 1\nf 1 2 3\nf 3 2 1\n")));
    ASSERT_EQ(mesh.normals.size(), 6u);
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(mesh.normals[i], (Vec3{0, 0, 1}));
    for (size_t i = 3; i < 6; ++i) EXPECT_EQ(mesh.normals[i], (Vec3{0, 0, -1}));
}

// --- Parts and materials ---------------------------------------------------------------------------------------

TEST(Obj, PartsByMaterialInOrderOfFirstUse) {
    const MeshFile file = expect_ok(read_obj(
        triangle_and("o thing\nf 1 2 3\nusemtl b c\ng x\nf 1 2 3\nusemtl a\nf 1 2 3\nusemtl  b c \nf 3 2 1\n")));
    ASSERT_EQ(file.parts.size(), 3u);
    EXPECT_EQ(file.parts[0].name, "thing");
    EXPECT_EQ(file.parts[1].name, "b c");
    EXPECT_EQ(file.parts[1].mesh.indices.size(), 6u);
    EXPECT_EQ(file.parts[2].name, "a");
    for (const MeshPart& part : file.parts) EXPECT_EQ(part.material, -1);
    EXPECT_EQ(warning_count(file.diagnostics, "is not defined"), 2u) << all_warnings(file.diagnostics);
}

TEST(Obj, MaterialLibraries) {
    const test::TemporaryFolder folder;
    test::spit(folder.file("one.mtl"), "newmtl red\nKd 1 0 0\nnewmtl unused\nKd 0 1 0\n");
    test::spit(folder.file("two words.mtl"), "newmtl blue\nKd 0 0 1\nmap_Kd sub/a b.png\nnewmtl red\nKd 0 1 1\n");
    const std::string faces = "usemtl blue\nf 1 2 3\nusemtl red\nf 1 2 3\n";
    for (const char* line : {"mtllib one.mtl two\\ words.mtl\n", "mtllib one.mtl\nmtllib two words.mtl\n",
                             "mtllib one.mtl \\\n  two\\ words.mtl\n"}) {
        const MeshFile file = expect_ok(read_obj(line + triangle_and(faces), folder.path().string()));
        EXPECT_TRUE(file.diagnostics.empty()) << line << all_warnings(file.diagnostics);
        ASSERT_EQ(file.materials.size(), 2u);
        EXPECT_EQ(file.materials[0].name, "blue");
        EXPECT_EQ(file.materials[0].diffuse_map, folder.file("sub/a b.png"));
        EXPECT_EQ(file.materials[1].diffuse, (Rgb{1, 0, 0})) << "the first library that defines it counts";
        EXPECT_EQ(file.parts[0].material, 0);
        EXPECT_EQ(file.parts[1].material, 1);
    }
}

TEST(Obj, MissingLibraryIsAWarningWithItsPlace) {
    const MeshFile file = expect_ok(read_obj(triangle_and("  mtllib  no\x1b[31m.mtl\nf 1 2 3\n")));
    ASSERT_EQ(file.diagnostics.warnings().size(), 1u);
    const Warning& w = file.diagnostics.warnings()[0];
    EXPECT_EQ(w.where.line, 4u);
    EXPECT_EQ(w.where.column, 11u);
    EXPECT_NE(w.message.find("'no\\x1b[31m.mtl'"), std::string::npos) << w.message;
}

TEST(Obj, LibrariesOutsideOfTheFolder) {
    LoadOptions options;
    options.allow_outside_paths = false;
    for (const char* name :
         {"../x.mtl", "/etc/passwd", "a/../../x.mtl", "a b/../../../x.mtl", "C:\\x.mtl", "..\\x.mtl"}) {
        const auto refused = parse_obj(std::string("mtllib ") + name + "\n", "t.obj", "no-such-folder", options);
        ASSERT_FALSE(refused.ok()) << name;
        EXPECT_EQ(refused.error().where.line, 1u);
    }
    EXPECT_TRUE(parse_obj("mtllib a/../x.mtl\n", "t.obj", "no-such-folder", options).ok());
}

// --- Text ------------------------------------------------------------------------------------------------------

TEST(Obj, LineEndsContinuationsAndComments) {
    const Positions expected{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (const char* text :
         {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
          "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r", "\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3",
          "v 0 \\\n 0 0\nv 1\\\r\n0 0\nv 0 1\\\r 0\nf 1 2 \\\n\\\n3\n",
          "  v\t0 0  0 \t\nv 1 0 0 # comment\n# v 7 7 7 \\\nv 0 1 0\n\n   \n\tf 1 2 3 #x\n#",
          "v 0 0 0 1\nv 1 0 0 0.5\nv 0 1 0 2\nf 1 2 3", "v +0 -0. .0\nv 1e+000 0E5 0\nv 0 .1e1 0\nf 1 2 3"})
        EXPECT_EQ(corner_positions(only_mesh(read_obj(text))), expected) << text;
}

TEST(Obj, AContinuationMayBeginALine) {
    const Mesh mesh = only_mesh(read_obj("\\\nv 0 0 0\n \\\r\n\\\r v 1 0 0\n\\\n# v 7 7 7\nv 0 1 0\n\\\nf 1 2 3\n"));
    EXPECT_EQ(corner_positions(mesh), (Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

/// Also after a weight; vertices without one are white. Faces have their corners' colours whatever else tells them
/// apart.
TEST(Obj, VerticesHaveColours) {
    const Mesh mesh =
        only_mesh(read_obj("v 0 0 0 1 0.5 0.25\nv 1 0 0\nv 0 1 0 1 0.1 0.2 0.3\nv 0 0 1 0 0 -1\n"
                           "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/2 3/1 4/1\n"));
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3 p = mesh.positions[i];
        const Rgb expected = p.x == 1   ? Rgb{1, 1, 1}
                             : p.y == 1 ? Rgb{0.1f, 0.2f, 0.3f}
                             : p.z == 1 ? Rgb{0, 0, 0}
                                        : Rgb{1, 0.5f, 0.25f};
        EXPECT_EQ(mesh.colors[i], expected) << i;
    }
    EXPECT_TRUE(only_mesh(read_obj("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n")).colors.empty());
    // In small chunks as in one.
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0 0.5 0.6 0.7\n";
    for (int i = 0; i < 50; ++i) text += "# a line to make the chunks fall apart\n";
    text += "v 0 0 2\nv 0 0 1 0.2 0.3 0.4\nf 1 3 5\nf 1 2 4\n";
    for (const size_t chunk : {size_t(20), size_t(300), size_t(100000)}) {
        const std::vector<Rgb> colors = obj::read_records(text, chunk).colors;
        EXPECT_EQ(colors, (std::vector<Rgb>{{1, 1, 1}, {1, 1, 1}, {0.5f, 0.6f, 0.7f}, {1, 1, 1}, {0.2f, 0.3f, 0.4f}}));
    }
}

TEST(Obj, WhatIsNotUsedIsCounted) {
    const MeshFile file =
        expect_ok(read_obj(triangle_and("v 0 0 0 1 0 0\nv 0 0 0 1 0 0\np 1 2\nl 1 2 3\nl 1 2\ncurv 0 1 1 2\nvp 1\nfoo "
                                        "3\nbar\nfoo\nlod 3\nbevel on\ns x\nf 1 2 3\n")));
    const Diagnostics& d = file.diagnostics;
    EXPECT_EQ(warning_count(d, "points"), 1u);
    EXPECT_EQ(warning_count(d, "lines (l)"), 2u);
    EXPECT_EQ(warning_count(d, "free-form"), 2u);
    EXPECT_EQ(warning_count(d, "'foo'"), 2u);
    EXPECT_EQ(warning_count(d, "'bar'"), 1u);
    EXPECT_EQ(warning_count(d, "smoothing group"), 1u);
    EXPECT_EQ(d.warnings().size(), 6u) << all_warnings(d);
    for (const Warning& w : d.warnings()) EXPECT_GT(w.where.line, 3u);
}

TEST(Obj, UnknownKeywordsAreBounded) {
    std::string text;
    for (int i = 0; i < 20000; ++i) {
        const std::string n = std::to_string(i);
        text.append("k").append(n).append(" 1\nusemtl m").append(n).append("\n");
        text += i ? "f 1 2 3\n" : kTriangle;
    }
    const MeshFile file = expect_ok(read_obj(text));
    EXPECT_LT(file.diagnostics.warnings().size(), 80u);
    EXPECT_EQ(warning_count(file.diagnostics, "unknown keyword"), 20000u);
    EXPECT_EQ(warning_count(file.diagnostics, "not defined"), 19999u);
    EXPECT_EQ(file.parts.size(), 19999u);
}

TEST(Obj, NumbersThatAreNotFiniteDropTheirFaces) {
    for (const char* number :
         {"nan", "-NaN", "inf", "-Infinity", "1e999", "-1e39", "1.#INF", "-1.#IND", "1.#QNAN0", "nan(ind)"}) {
        const MeshFile file = expect_ok(read_obj(
            triangle_and("v 1 " + std::string(number) + " 1\nf 1 2 3\nf 1 2 4\nf 4 2 1\nusemtl x\nf 4 4 4\n")));
        ASSERT_EQ(file.parts.size(), 1u) << number;
        EXPECT_EQ(file.parts[0].mesh.indices.size(), 3u);
        EXPECT_EQ(warning_count(file.diagnostics, "not finite"), 3u);
    }
}

TEST(Obj, NumbersAreRoundedCorrectly) {
    const Mesh mesh = only_mesh(
        read_obj("v 0.1 16777217 1e-46\nv -1e-999 1e-45 0\nvn 3.4028235e38 0 0\nv 0.30000001192092895507812500001 " +
                 std::string(100000, '1') + "e-99999 0." + std::string(1000000, '0') + "1\nf 1//1 2//1 3//1\n"));
    EXPECT_EQ(mesh.positions[0], (Vec3{0.1f, 16777216.0f, 0.0f}));
    EXPECT_TRUE(std::signbit(mesh.positions[1].x));
    EXPECT_EQ(mesh.positions[1].y, 0x1p-149f);
    EXPECT_EQ(mesh.normals[0].x, 0x1.fffffep127f);
    EXPECT_EQ(mesh.positions[2], (Vec3{0.3f, 1.1111111111111111f, 0}));
}

TEST(Obj, EmptyFilesHaveNoParts) {
    for (const char* text : {"", "\n", "#", "\\", "\\\n", "v 1 2 3", "v 1 2 3\nvn 0 0 1\nusemtl x\n"}) {
        const auto file = read_obj(text);
        if (std::string_view(text) == "\\") continue;  // an unknown keyword, as good as any
        EXPECT_TRUE(expect_ok(file).parts.empty()) << text;
    }
}

// --- Errors ----------------------------------------------------------------------------------------------------

struct Refusal {
    const char* line;
    uint32_t column;
    const char* message;
};
class ObjRefusals : public testing::TestWithParam<Refusal> {};

TEST_P(ObjRefusals, PointAtTheFault) {
    const Refusal& c = GetParam();
    const auto result =
        read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n" + std::string(c.line) + "\nf 0 broken too\n");
    ASSERT_FALSE(result.ok()) << c.line;
    const Error& error = result.error();
    EXPECT_EQ(error.code, ErrorCode::bad_input);
    EXPECT_EQ(error.where.file, "test.obj");
    EXPECT_EQ(error.where.line, 6u);
    EXPECT_EQ(error.where.column, c.column);
    EXPECT_EQ(error.excerpt, c.line);
    EXPECT_NE(error.message.find(c.message), std::string::npos) << error.str();
}

INSTANTIATE_TEST_SUITE_P(
    All, ObjRefusals,
    testing::Values(Refusal{"f 0 1 2", 3, "vertex index 0 is out of range: expected 1 to 3, or -3 to -1"},
                    Refusal{"f 1 2 4", 7, "vertex index 4"}, Refusal{"f 1 -4 2", 5, "vertex index -4"},
                    Refusal{"f 1 2 -1000000000", 7, "-1000000000 is out of range"},
                    Refusal{"f 1 2 100000000000000000000", 7, "out of range"},
                    Refusal{"f 1 2 -9223372036854775808", 7, "out of range"},
                    Refusal{"f 1 2 -9223372036854775809", 7, "out of range"},
                    Refusal{"f 1/1 2/2 3/1", 9, "texture index 2 is out of range: expected 1 to 1"},
                    Refusal{"f 1//1 2//-2 3//1", 11, "normal index -2"}, Refusal{"f 1/0 2 3", 5, "texture index 0"},
                    Refusal{"f 1/1/0 2 3", 7, "normal index 0"}, Refusal{"f 1/1/1/1 2 3", 8, "not a corner"},
                    Refusal{"f 1 2 x", 7, "'x' is not a corner"}, Refusal{"f 1 2 3.5", 7, "'3.5' is not a corner"},
                    Refusal{"f 1 2 3 4x", 9, "'4x' is not a corner"}, Refusal{"f /1 2 3", 3, "not a corner"},
                    Refusal{"f", 1, "a face of 0 corners, expected at least 3"},
                    Refusal{"f 1", 1, "a face of 1 corner,"}, Refusal{"  f 1 2", 3, "a face of 2 corners"},
                    Refusal{"v 1 2", 6, "the line ends here, expected three coordinates"},
                    Refusal{"v 1 2 x", 7, "'x' is not a number"}, Refusal{"v 1,5 2 3", 3, "'1,5' is not a number"},
                    Refusal{"v 1.2.3 2 3", 3, "'1.2.3'"}, Refusal{"v 0x1p3 2 3", 3, "'0x1p3'"},
                    Refusal{"v 1 2 +-3", 7, "'+-3'"}, Refusal{"v 1 2 3 4 5 6 7 8", 9, "too many numbers"},
                    Refusal{"v 1 2 3 red", 9, "'red' is not a number"},
                    Refusal{"vt", 3, "expected one to three texture"}, Refusal{"vt 1 2 3 4", 10, "too many"},
                    Refusal{"vn 0 1", 7, "normal"}, Refusal{"vn 0 1 0 0", 10, "too many"},
                    Refusal{"mtllib  ", 1, "without a file name"}));

TEST(Obj, ErrorsShowTheLineWithACaret) {
    const auto result = read_obj("v 0 0 0\nf 1 1 2 # oops\n");
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().str(),
              "test.obj:2:7: error: vertex index 2 is out of range: expected 1 to 1, or -1 to -1\n  f 1 1 2 # oops\n   "
              "     ^");
}

TEST(Obj, NulBytesAndUtf16AreRefused) {
    EXPECT_FALSE(read_obj(std::string_view("v 1 2 3\0 4\n", 11)).ok());
    EXPECT_FALSE(read_obj("\xff\xfev").ok());
    EXPECT_FALSE(read_obj("\xfe\xffv").ok());
}

TEST(Obj, AVeryLongLineIsShortInTheMessage) {
    const auto result = read_obj(triangle_and("f 1 2 " + std::string(3000000, '9') + "\n"));
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().where.column, 7u);
    EXPECT_LT(result.error().str().size(), 1000u);
}

TEST(Obj, TheFirstFaultIsReportedWhateverTheChunks) {
    std::string text;
    for (int i = 0; i < 300; ++i) text.append("v ").append(std::to_string(i)).append(" 0 0\n");
    for (int i = 0; i < 300; ++i) text += i == 100 || i == 250 ? "f 1 2 999\n" : "f 1 2 3\n";
    for (const size_t chunk : {1, 7, 64, 1000, 100000}) {
        try {
            obj::read_records(text, chunk);
            FAIL() << "accepted";
        } catch (const ParseFailure& failure) {
            EXPECT_EQ(text_location(text, "", failure.offset).line, 401u) << chunk;
        }
    }
}

TEST(Obj, ChunksDoNotChangeTheRecords) {
    std::string text = "mtllib a.mtl\r\n# odd \\\r\n";
    for (int i = 0; i < 200; ++i) {
        text += "v " + std::to_string(i) + (i % 3 ? " 1 2\r\n" : " \\\r\n 1 2\n");
        if (i % 5 == 0) text += "vt 0." + std::to_string(i) + "\rvn 0 0 1\r";
        if (i % 17 == 0) text += "usemtl m" + std::to_string(i % 4) + "\n";
        if (i % 11 == 0) text += "s " + std::to_string(i % 3) + "\ng part" + std::to_string(i) + "\n";
        if (i >= 3) text += "f -1/-1/-1 -2//-1 \\\n 1\n";
        if (i % 40 == 0) text += "zzz\n";
    }
    const obj::Records whole = obj::read_records(text, text.size());
    const auto flat = [](const obj::Records& records) {
        std::vector<std::string> out;
        for (const obj::Run& run : records.runs) {
            size_t at = 0;
            for (const uint32_t size : run.sizes) {
                std::string line(run.state.material.value_or("-"));
                line.append("|").append(run.state.group.value_or("-")).append("|");
                line.append(std::to_string(run.state.smoothing.value_or(99)));
                for (uint32_t i = 0; i < size; ++i, ++at)
                    for (const int32_t n : {run.corners[at].position, run.corners[at].uv, run.corners[at].normal})
                        line.append(" ").append(std::to_string(n));
                out.push_back(line);
            }
        }
        return out;
    };
    ASSERT_EQ(flat(whole).size(), 197u);
    for (size_t chunk = 1; chunk < 200; chunk += 3) {
        const obj::Records parts = obj::read_records(text, chunk);
        EXPECT_EQ(parts.positions, whole.positions);
        EXPECT_EQ(parts.uvs, whole.uvs);
        EXPECT_EQ(parts.normals, whole.normals);
        EXPECT_EQ(flat(parts), flat(whole)) << chunk;
        EXPECT_EQ(parts.libraries.size(), 1u);
        ASSERT_EQ(parts.notes.all().size(), whole.notes.all().size());
        EXPECT_EQ(parts.notes.all()[0].count, 5u);
        EXPECT_EQ(parts.notes.all()[0].offset, whole.notes.all()[0].offset);
    }
}

}  // namespace
}  // namespace steradian
