// Where rules begin: scenes a little to both sides of their numbers.
#include <cmath>

#include "lint_scene.h"

namespace steradian::test {
namespace {

Affine at(double x, double y, double z) { return translation(x, y, z); }
Mesh scaled(Mesh m, Vec3 by) {
    for (Vec3& p : m.positions) p = {p.x * by.x, p.y * by.y, p.z * by.z};
    return m;
}
/// A box without one of its triangles, beside which the sphere of 2 m is small: above it and its camera.
void giant(LintScene& t, float half, float thin = 1) {
    const Mesh m = without_last_triangles(scaled(cube(half), {1, thin, 1}), 1);
    t.place(m, MaterialId{0}, at(0, half * thin + 2, 0));
}
/// The distance at which the sphere is so many pixels, by its box's diagonal.
void look_from(LintScene& t, double pixels) {
    const double pixel = 2 * std::tan(20 * M_PI / 180) / t.settings.height, size = 2 * std::sqrt(3.0);
    t.s.cameras = {PerspectiveCamera{{0, 0, static_cast<float>(size / (pixels * pixel))}}};
}
void far_from_origin(LintScene& t, float far) {
    Mesh m = cube(1);
    for (Vec3& p : m.positions) p = p + Vec3{far - 1, 0, 0};
    t.place(m, MaterialId{0}, at(-double(far) - 2, 0, 0));
}
void room(LintScene& t, double wall) {
    t.place(cube(5000), MaterialId{0}, at(0, 5000 - wall, 0)), t.s.lights[0] = PointLight{{2, 2, 2}};
}
void tilted_sheet(LintScene& t, double degrees) {
    const Affine tilt = at(2, -1, 0) * rotation_degrees(degrees, {1, 0, 0});
    t.place(Shape(Rectangle{{0, 0, 0}, {0.5f, 0, 0}, {0, 0, -0.5f}}), t.material(GlassMaterial{}), tilt);
}
void tilted_mesh(LintScene& t, double degrees) {
    const Affine tilt = at(2, -1, 0) * rotation_degrees(degrees - 90, {1, 0, 0});
    t.place(scaled(triangle(), {0.5f, 0.5f, 1}), t.material(GlassMaterial{}), tilt);
}
void map_normals(LintScene& t, const std::vector<int>& texels) {
    t.s.reliefs.push_back({MaterialId{0}, NormalMap{t.texture(t.bytes(texels), ColorSpace::linear)}});
}
/// Triangles one above the other, of which the normals of the first few point down.
void turned_normals(LintScene& t, size_t turned, size_t all) {
    Mesh m;
    for (size_t i = 0; i < all; ++i) {
        Mesh one = triangle();
        for (Vec3& p : one.positions) p.z = float(i);
        m = joined(m, one);
    }
    m.normals.assign(3 * all, {0, 0, 1});
    for (size_t i = 0; i < 3 * turned; ++i) m.normals[i].z = -1;
    t.place(m, MaterialId{0}, at(2, 0, 0));
}
void lamp_behind(LintScene& t, float distance) {
    t.place(Shape(Rectangle{{2.5f, 0, 0}, {1, 0, 0}, {0, 1, 0}}), MaterialId{0});
    const InstanceId lamp = t.place(Shape(Rectangle{{2.5f, 0, -distance}, {0.5f, 0, 0}, {0, 0.5f, 0}}), t.grey());
    t.s.lights.push_back(AreaLight{lamp});
}
/// The sides are 1 and `side`, and overlap by `part` of the smaller one.
void overlap(LintScene& t, float part) {
    t.place(Shape(Rectangle{{2, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}}), MaterialId{0});
    t.place(Shape(Rectangle{{3 - part, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}}), t.grey());
}
/// 64 texels of which so many are no normals.
void almost_normals(LintScene& t, size_t others) {
    std::vector<int> texels;
    for (int i = 0; i < 64; ++i)
        for (const double x : {0.3 * std::cos(i), 0.3 * std::sin(i), std::sqrt(0.91)})
            texels.push_back(int((x + 1) * 127.5 + 0.5));
    for (size_t i = 0; i < others; ++i) texels[3 * i] = texels[3 * i + 1] = texels[3 * i + 2] = 10;
    t.s.textures.clear();
    t.texture(t.bytes(texels), ColorSpace::srgb);
}

/// A block of that absorption times a colour, before a camera far away.
void ink(LintScene& t, float half, float absorption, Rgb color = {1, 1, 1}, float scattering = 0, float thin = 1) {
    GlassMaterial m;
    m.interior.absorption = color * absorption;
    m.interior.scattering = Rgb{1, 1, 1} * scattering;
    t.s.cameras = {PerspectiveCamera{{0, 0, 60}}};
    t.place(scaled(cube(half), {1, thin, 1}), t.material(m), translation(0, 8, 0));
}

const Case kCases[] = {
    {"Albedo", "albedo-above-one",
     [](LintScene& t) {
         t.s.textures[0] = ConstantTexture{{1.00002f, 1, 1}};
     }},
    {"AlbedoButForRounding", "",
     [](LintScene& t) {
         t.s.textures[0] = ConstantTexture{{1.000005f, 1, 1}};
     }},
    {"Ior", "ior-one", [](LintScene& t) { t.s.textures.clear(), t.s.materials[0] = GlassMaterial{1.0009f}; }},
    {"IorAbove", "", [](LintScene& t) { t.s.textures.clear(), t.s.materials[0] = GlassMaterial{1.0011f}; }},
    {"IorBelow", "", [](LintScene& t) { t.s.textures.clear(), t.s.materials[0] = GlassMaterial{0.9989f}; }},
    {"Giant", "scale", [](LintScene& t) { giant(t, 1010); }},
    {"LargeThing", "", [](LintScene& t) { giant(t, 990); }},
    {"FlatGiant", "", [](LintScene& t) { giant(t, 1800, 0.24f); }},
    {"ThickGiant", "scale", [](LintScene& t) { giant(t, 1800, 0.26f); }},
    {"GiantAroundAll", "scale", [](LintScene& t) { room(t, 900); }},
    {"Dome", "", [](LintScene& t) { room(t, 1100); }},
    {"Ink", "scale", [](LintScene& t) { ink(t, 6, 12.6f); }},
    {"DarkGlass", "", [](LintScene& t) { ink(t, 6, 12.4f); }},
    {"SmallInk", "", [](LintScene& t) { ink(t, 2.88f, 1000); }},
    {"LargeInk", "scale", [](LintScene& t) { ink(t, 2.89f, 1000); }},
    {"RedGlass", "",
     [](LintScene& t) {
         ink(t, 6, 1000, {0, 1, 1});
     }},
    {"Milk", "",
     [](LintScene& t) {
         ink(t, 6, 1000, {1, 1, 1}, 1);
     }},
    {"ThinInk", "",
     [](LintScene& t) {
         ink(t, 6, 1000, {1, 1, 1}, 0, 0.003f);
     }},
    {"Dot", "scale", [](LintScene& t) { look_from(t, 1.95); }},
    {"SmallThing", "", [](LintScene& t) { look_from(t, 2.05); }},
    {"Coarse", "precision", [](LintScene& t) { far_from_origin(t, 7200); }},
    {"FineEnough", "", [](LintScene& t) { far_from_origin(t, 7000); }},
    {"SlantedPane", "open-glass", [](LintScene& t) { tilted_sheet(t, 38); }},
    {"LevelPane", "", [](LintScene& t) { tilted_sheet(t, 35); }},
    {"SlantedTriangle", "open-glass", [](LintScene& t) { tilted_mesh(t, 38); }},
    {"LevelTriangle", "", [](LintScene& t) { tilted_mesh(t, 35); }},
    {"OneOfThreeIsANormal", "normal-map",
     [](LintScene& t) {
         map_normals(t, {128, 128, 255, 128, 128, 128, 128, 128, 128});
     }},
    {"OneOfTwoIsANormal", "",
     [](LintScene& t) {
         map_normals(t, {128, 128, 255, 128, 128, 128});
     }},
    {"TwoOfThreeNormalsPointIn", "normal-map",
     [](LintScene& t) {
         map_normals(t, {128, 128, 0, 128, 128, 0, 128, 128, 255});
     }},
    {"OneOfTwoNormalsPointsIn", "",
     [](LintScene& t) {
         map_normals(t, {128, 128, 0, 128, 128, 255});
     }},
    {"NormalsOfThreeQuarters", "",
     [](LintScene& t) {
         map_normals(t, {128, 128, 224});
     }},
    {"NormalsOfLessThanThreeQuarters", "normal-map",
     [](LintScene& t) {
         map_normals(t, {128, 128, 222});
     }},
    {"GreyOf8Bits", "",
     [](LintScene& t) {
         t.s.textures.clear();
         t.texture(t.bytes({100, 50}, 1), ColorSpace::linear);
     }},
    {"TwoOfThreeNormalsTurned", "inverted-normals", [](LintScene& t) { turned_normals(t, 2, 3); }},
    {"TwoOfFourNormalsTurned", "", [](LintScene& t) { turned_normals(t, 2, 4); }},
    {"LampCloseBehindAWall", "light-in-wall", [](LintScene& t) { lamp_behind(t, 0.0095f); }},
    {"LampBehindAWall", "", [](LintScene& t) { lamp_behind(t, 0.0105f); }},
    {"Overlap", "overlapping-surfaces", [](LintScene& t) { overlap(t, 0.01f); }},
    {"OverlapOfRounding", "", [](LintScene& t) { overlap(t, 0.0002f); }},
    {"ThreeOf64AreNoNormals", "color-space", [](LintScene& t) { almost_normals(t, 3); }},
    {"FourOf64AreNoNormals", "", [](LintScene& t) { almost_normals(t, 4); }},
};

class Thresholds : public testing::TestWithParam<Case> {};
TEST_P(Thresholds, AreWhereTheyAre) { expect_findings(GetParam()); }
const auto kName = [](const testing::TestParamInfo<Case>& info) { return std::string(info.param.name); };
INSTANTIATE_TEST_SUITE_P(Rules, Thresholds, testing::ValuesIn(kCases), kName);

}  // namespace
}  // namespace steradian::test
