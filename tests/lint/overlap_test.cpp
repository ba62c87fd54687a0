// Rules about surfaces in one plane, lights on walls, repeated triangles, and pictures that are of something else:
// each with near misses.
#include <cmath>

#include "lint_scene.h"

namespace steradian::test {
namespace {

Affine at(double x, double y, double z) { return translation(x, y, z); }
Shape floor_of(float half, float y = -1.5f) { return Rectangle{{0, y, 0}, {half, 0, 0}, {0, 0, -half}}; }

/// A rectangle that is seen from the camera, at a distance z from it.
Shape facing(Vec3 center, float half_u, float half_v) { return Rectangle{center, {half_u, 0, 0}, {0, half_v, 0}}; }

OpenPbrMaterial half_there() {
    OpenPbrMaterial m;
    m.geometry_opacity = {0.5f};
    return m;
}

/// Ice on water, with the upper one's floor in the lower one's top.
void stack(LintScene& t, Priority of_ice) {
    GlassMaterial water{1.33f}, ice{1.31f};
    water.priority = 1, ice.priority = of_ice;
    t.place(cube(0.5f), t.material(water), at(2, 0, 0)), t.place(cube(0.25f), t.material(ice), at(2, 0.75, 0));
}

const Case kPlanes[] = {
    {"TwoRectangles", "overlapping-surfaces",
     [](LintScene& t) {
         t.place(facing({2, 0, 0}, 0.5f, 0.5f), MaterialId{0}), t.place(facing({2.5f, 0, 0}, 0.5f, 0.25f), t.grey());
     }},
    {"TwoRectanglesAPartOfAMillimetreApart", "",
     [](LintScene& t) {
         t.place(facing({2, 0, 0}, 0.5f, 0.5f), MaterialId{0});
         t.place(facing({2.5f, 0, 1e-5f}, 0.5f, 0.25f), t.grey());
     }},
    {"TwoRectanglesSideBySide", "",
     [](LintScene& t) {
         t.place(facing({2, 0, 0}, 0.5f, 0.5f), MaterialId{0}), t.place(facing({3, 0, 0}, 0.5f, 0.5f), t.grey());
     }},
    {"TwoRectanglesOfOneMaterial", "",
     [](LintScene& t) {
         t.place(facing({2, 0, 0}, 0.5f, 0.5f), MaterialId{0});
         t.place(facing({2.5f, 0, 0}, 0.5f, 0.25f), MaterialId{0});
     }},
    {"SmallRectangleOnALargeOne", "overlapping-surfaces",
     [](LintScene& t) {
         t.place(facing({2.5f, 0, 0}, 1, 1), MaterialId{0}), t.place(facing({2.6f, 0, 0}, 0.05f, 0.05f), t.grey());
     }},
    {"TwoCrossedRectangles", "",
     [](LintScene& t) {
         t.place(facing({2, 0, 0}, 0.5f, 0.5f), MaterialId{0});
         t.place(Shape(Rectangle{{2, 0, 0}, {0.5f, 0, 0}, {0, 0, -0.5f}}), t.grey());
     }},
    {"TriangleOnARectangleThatIsTurned", "overlapping-surfaces",
     [](LintScene& t) {
         const Affine turned = at(2, 0, 0) * rotation_degrees(33, {1, 2, 0.5});
         t.place(facing({0, 0, 0}, 0.5f, 0.5f), MaterialId{0}, turned);
         t.place(triangle(), t.grey(), turned * scaling(0.3, 0.3, 0.3));
     }},
    {"DiskOnARectangle", "overlapping-surfaces",
     [](LintScene& t) {
         t.place(facing({2, 0, 0}, 0.5f, 0.5f), MaterialId{0});
         t.place(Shape(Disk{{2.6f, 0, 0}, {0, 0, 1}, 0.3f}), t.grey());
     }},
    {"DiskBesideARectangle", "",
     [](LintScene& t) {
         t.place(facing({2, 0, 0}, 0.5f, 0.5f), MaterialId{0});
         t.place(Shape(Disk{{2.85f, 0, 0}, {0, 0, 1}, 0.3f}), t.grey());
     }},
    {"BoxOnAFloor", "",
     [](LintScene& t) {
         t.place(floor_of(3), MaterialId{0}), t.place(box({1, -1.5f, -0.5f}, {2, -0.5f, 0.5f}), t.grey());
     }},
    {"BoxWithoutALidOnAFloor", "overlapping-surfaces",
     [](LintScene& t) {
         // The first two triangles, at -x, and the two at +y are left out: one looks in.
         Mesh m = box({1, -1.5f, -0.5f}, {2, -0.5f, 0.5f});
         m.indices.erase(m.indices.begin() + 18, m.indices.begin() + 24);
         t.place(floor_of(3), MaterialId{0}), t.place(m, t.grey());
         t.s.cameras = {PerspectiveCamera{{1.5f, 5, 1}, {1.5f, 0, 0}}};
     }},
    {"BoxWithoutALidOnAFloorSeenFromAside", "",
     [](LintScene& t) {
         Mesh m = box({1, -1.5f, -0.5f}, {2, -0.5f, 0.5f});
         m.indices.erase(m.indices.begin() + 18, m.indices.begin() + 24);
         t.place(floor_of(3), MaterialId{0}), t.place(m, t.grey());
         t.s.cameras = {PerspectiveCamera{{1.5f, -1.2f, 6}, {0, 0, 0}}};
     }},
    {"OverlapSeenThroughAWindow", "overlapping-surfaces",
     [](LintScene& t) {
         t.place(facing({2, 0, 0}, 0.5f, 0.5f), MaterialId{0}), t.place(facing({2.5f, 0, 0}, 0.5f, 0.25f), t.grey());
         t.place(facing({2, 0, 1}, 2, 2), t.material(half_there()));
     }},
    {"BodiesThatStandOnEachOther", "overlapping-surfaces", [](LintScene& t) { stack(t, std::nullopt); }},
    {"BodiesWithPrioritiesThatStandOnEachOther", "", [](LintScene& t) { stack(t, 2); }},
    {"OverlapBehindAWall", "",
     [](LintScene& t) {
         t.place(facing({2, 0, 0}, 0.5f, 0.5f), MaterialId{0}), t.place(facing({2.5f, 0, 0}, 0.5f, 0.25f), t.grey());
         t.place(facing({2, 0, 1}, 2, 2), MaterialId{0});
     }},
    {"OverlapBehindABall", "",
     [](LintScene& t) {
         t.place(facing({0, 0, -2}, 0.1f, 0.1f), MaterialId{0}), t.place(facing({0.1f, 0, -2}, 0.1f, 0.05f), t.grey());
     }},
    {"OverlapSeenPastATriangle", "overlapping-surfaces",
     [](LintScene& t) {
         t.place(facing({2, 0, 0}, 0.5f, 0.5f), MaterialId{0}), t.place(facing({2.5f, 0, 0}, 0.5f, 0.25f), t.grey());
         // Only the other half of its parallelogram would be in the way.
         t.place(Mesh{{{0.5f, -2, 1}, {2.5f, -2, 1}, {0.5f, 0.5f, 1}}, {}, {}, {0, 1, 2}}, MaterialId{0});
     }},
    {"OverlapSeenByAParallelCamera", "overlapping-surfaces",
     [](LintScene& t) {
         t.place(facing({2, 0, 0}, 0.5f, 0.5f), MaterialId{0}), t.place(facing({2.5f, 0, 0}, 0.5f, 0.25f), t.grey());
         // Between the place and the camera's own position, but not on the way of the ray.
         t.place(facing({1.25f, 0, 3}, 0.3f, 2), MaterialId{0});
         t.s.cameras = {OrthographicCamera{{0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 8}};
     }},
    {"WhereTheyTouchOnly", "",
     [](LintScene& t) {
         t.place(triangle(), MaterialId{0}, at(2.5, 0, 0)), t.place(facing({2.5f, -1.5f, 0}, 0.5f, 0.5001f), t.grey());
     }},
    {"TriangleTwice", "duplicate-triangles",
     [](LintScene& t) {
         Mesh m = triangle();
         m.indices.insert(m.indices.end(), {1, 2, 0});
         t.place(m, MaterialId{0}, at(2.5, 0, 0));
     }},
    {"TriangleTwiceWithItsOwnVertices", "duplicate-triangles",
     [](LintScene& t) { t.place(joined(triangle(), triangle()), MaterialId{0}, at(2.5, 0, 0)); }},
    {"CardOfTwoSides", "",
     [](LintScene& t) {
         Mesh m = triangle();
         m.indices.insert(m.indices.end(), {1, 0, 2});
         t.place(m, MaterialId{0}, at(2.5, 0, 0));
     }},
    {"DegenerateTwice", "degenerate-triangles",
     [](LintScene& t) {
         Mesh m = triangle();
         m.indices.insert(m.indices.end(), {0, 1, 1, 0, 1, 1});
         t.place(m, MaterialId{0}, at(2.5, 0, 0));
     }},
    {"OneVertexMoved", "",
     [](LintScene& t) {
         Mesh other = triangle();
         other.positions[2].y = std::nextafter(1.0f, 2.0f);
         t.place(joined(triangle(), other), MaterialId{0}, at(2.5, 0, 0));
     }},
};

/// A lamp that shines down from below a ceiling at y = 2.
void lamp(LintScene& t, float y, bool two_sided = false, float scale = 1) {
    t.place(Shape(Rectangle{{0, 2, 0}, {3, 0, 0}, {0, 0, 3}}), MaterialId{0});
    const InstanceId id = t.place(Shape(Rectangle{{2.2f, y, 0}, {scale, 0, 0}, {0, 0, scale}}), t.grey());
    t.s.lights.push_back(AreaLight{id, {5, 5, 5}, two_sided});
}

const Case kLights[] = {
    {"LampInTheCeiling", "light-in-wall", [](LintScene& t) { lamp(t, 2, false, 0.5f); }},
    {"LampInTheCeilingThatShinesBothWays", "light-in-wall", [](LintScene& t) { lamp(t, 2, true, 0.5f); }},
    {"LampBelowTheCeiling", "", [](LintScene& t) { lamp(t, 1.999f, false, 0.5f); }},
    {"LampBelowTheCeilingThatShinesBothWays", "", [](LintScene& t) { lamp(t, 1.999f, true, 0.5f); }},
    {"LampJustAboveTheCeiling", "light-in-wall", [](LintScene& t) { lamp(t, 2.001f, false, 0.5f); }},
    {"LampJustAboveTheCeilingThatShinesBothWays", "", [](LintScene& t) { lamp(t, 2.001f, true, 0.5f); }},
    {"LampAboveTheCeiling", "", [](LintScene& t) { lamp(t, 2.1f, false, 0.5f); }},
    {"LampThatReachesBeyondTheCeiling", "", [](LintScene& t) { lamp(t, 2, false, 1); }},
    {"LampInAGlassCeiling", "",
     [](LintScene& t) {
         lamp(t, 2, false, 0.5f);
         t.s.instances[1].material = t.material(ThinGlassMaterial{});
     }},
    {"LampOfTriangles", "light-in-wall",
     [](LintScene& t) {
         t.place(facing({2.5f, 0, 0}, 1.2f, 1.2f), MaterialId{0});
         t.s.lights.push_back(AreaLight{t.place(triangle(), t.grey(), at(2.5, 0, 0))});
     }},
    {"LampOfTrianglesBeforeItsWall", "",
     [](LintScene& t) {
         t.place(facing({2.5f, 0, 0}, 1.2f, 1.2f), MaterialId{0});
         t.s.lights.push_back(AreaLight{t.place(triangle(), t.grey(), at(2.5, 0, 0.001))});
     }},
    {"BentLampInABentCeiling", "",
     [](LintScene& t) {
         // What is not flat is not looked at.
         Mesh m{{{1.7f, 2, -0.5f},
                 {1.7f, 2, 0.5f},
                 {2.2f, 2.1f, -0.5f},
                 {2.2f, 2.1f, 0.5f},
                 {2.7f, 2, -0.5f},
                 {2.7f, 2, 0.5f}},
                {},
                {},
                {0, 2, 3, 0, 3, 1, 2, 4, 5, 2, 5, 3}};
         t.place(m, MaterialId{0}, at(0, -0.001, 0));
         t.s.lights.push_back(AreaLight{t.place(m, t.grey())});
     }},
    {"MirroredLampBehindItsWall", "",
     [](LintScene& t) {
         // Mirrored at x the triangle still shines to +z: to the wall's other side.
         t.place(facing({2.5f, 0, -0.001f}, 1.2f, 1.2f), MaterialId{0});
         t.s.lights.push_back(AreaLight{t.place(triangle(), t.grey(), at(2.5, 0, 0) * scaling(-1, 1, 1))});
     }},
    {"LampThatStandsOnAFloor", "",
     [](LintScene& t) {
         t.place(floor_of(3), MaterialId{0});
         t.s.lights.push_back(AreaLight{t.place(box({1, -1.5f, -0.5f}, {2, -0.5f, 0.5f}), t.grey())});
     }},
};

/// Texels of a sphere of normals, as a map has them; `code` makes a byte of a number in [0, 1].
template <class Code>
std::vector<int> normals(const Code& code, double tilt) {
    std::vector<int> out;
    for (int i = 0; i < 64; ++i) {
        const double t = tilt * (i % 8) / 7, phi = 6.28 * (i / 8) / 8;
        for (const double x : {std::sin(t) * std::cos(phi), std::sin(t) * std::sin(phi), std::cos(t)})
            out.push_back(code((x + 1) / 2));
    }
    return out;
}
int plain(double x) { return int(x * 255 + 0.5); }
int srgb_coded(double x) { return int((x < 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055) * 255 + 0.5); }

void map_normals(LintScene& t, const std::vector<int>& texels) {
    t.s.reliefs.push_back({MaterialId{0}, NormalMap{t.texture(t.bytes(texels), ColorSpace::linear)}});
}
void paint(LintScene& t, const std::vector<int>& texels, ColorSpace space = ColorSpace::srgb) {
    t.s.textures.clear();
    t.texture(t.bytes(texels), space);
}
/// Blues of a sky: most are of about unit length, but they do not point up.
std::vector<int> sky() {
    std::vector<int> out;
    for (int i = 0; i < 64; ++i) out.insert(out.end(), {135 - i / 8, 206 - i / 8, 235});
    return out;
}

const Case kPictures[] = {
    {"NormalMap", "", [](LintScene& t) { map_normals(t, normals(plain, 1)); }},
    {"NormalMapThatWasSavedAsColours", "normal-map", [](LintScene& t) { map_normals(t, normals(srgb_coded, 1)); }},
    {"FlatNormalMapThatWasSavedAsColours", "normal-map",
     [](LintScene& t) {
         map_normals(t, {188, 188, 255});
     }},
    {"NormalsThatAreNormalsDecodedAsWell", "",
     [](LintScene& t) {
         map_normals(t, {135, 174, 246, 34, 172, 202, 47, 179, 212, 40, 175, 207});
     }},
    {"ATenthOfTheNormalsPointsIn", "",
     [](LintScene& t) {
         std::vector<int> texels = normals(plain, 1);
         for (size_t i = 0; i < 7; ++i) texels[3 * i + 2] = 255 - texels[3 * i + 2];
         paint(t, texels);
     }},
    {"NormalMapAsColours", "color-space", [](LintScene& t) { paint(t, normals(plain, 1)); }},
    {"NormalMapAsLinearColours", "color-space", [](LintScene& t) { paint(t, normals(plain, 1), ColorSpace::linear); }},
    {"LavenderIsAColour", "",
     [](LintScene& t) {
         paint(t, {128, 128, 255, 128, 128, 255});
     }},
    {"SkyIsAColour", "", [](LintScene& t) { paint(t, sky()); }},
    {"NormalsToAllSidesAreColours", "", [](LintScene& t) { paint(t, normals(plain, 3)); }},
    {"ATenthOfTheNormalsIsSomethingElse", "",
     [](LintScene& t) {
         std::vector<int> texels = normals(plain, 1);
         for (size_t i = 0; i < 7; ++i) texels[3 * i] = texels[3 * i + 1] = 0;
         paint(t, texels);
     }},
    {"NormalMapOfTheCoat", "normal-map",
     [](LintScene& t) {
         OpenPbrMaterial m;
         t.s.textures.clear();
         m.coat_weight = 1;
         m.geometry_coat_normal = NormalMap{t.texture(t.bytes({128, 128, 0}), ColorSpace::linear)};
         t.s.materials[0] = m;
     }},
};

class Overlaps : public testing::TestWithParam<Case> {};
TEST_P(Overlaps, FindNothingElse) { expect_findings(GetParam()); }

const auto kName = [](const testing::TestParamInfo<Case>& info) { return std::string(info.param.name); };
INSTANTIATE_TEST_SUITE_P(Plane, Overlaps, testing::ValuesIn(kPlanes), kName);
INSTANTIATE_TEST_SUITE_P(Light, Overlaps, testing::ValuesIn(kLights), kName);
INSTANTIATE_TEST_SUITE_P(Picture, Overlaps, testing::ValuesIn(kPictures), kName);

}  // namespace
}  // namespace steradian::test
