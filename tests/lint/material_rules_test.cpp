// Scenes for the rules about materials, textures and what is unused, and near misses.
#include <cmath>
#include <limits>

#include "rule_cases.h"

namespace steradian::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

OpenPbrMaterial rough_by(TextureId texture) {
    OpenPbrMaterial m;
    m.specular_roughness = {1, texture};
    return m;
}
void map_normals(LintScene& t, const std::vector<int>& texels) {
    t.s.reliefs.push_back({MaterialId{0}, NormalMap{t.texture(t.bytes(texels), ColorSpace::linear)}});
}
Mesh with_uvs(Mesh m) {
    m.uvs.resize(m.positions.size());
    return m;
}

const Case kMaterialCases[] = {
    {"nothing", "", [](LintScene&) {}},
    {"UnusedMaterial", "unused", [](LintScene& t) { t.material(MirrorMaterial{}); }},
    {"UnusedTexture", "unused", [](LintScene& t) { t.constant(1); }},
    {"UnusedImage", "unused",
     [](LintScene& t) {
         t.bytes({1, 2, 3});
     }},
    {"UnusedShape", "unused", [](LintScene& t) { add<ShapeId>(t.s.shapes, Shape(Sphere{})); }},
    {"UnusedMesh", "unused", [](LintScene& t) { add<MeshId>(t.s.meshes, cube(1)); }},
    {"UnusedProfile", "unused",
     [](LintScene& t) {
         t.s.profiles.push_back({{0, 90}, {0}, {1, 1}});
     }},
    {"UsedByAMix", "",
     [](LintScene& t) {
         t.s.instances[0].material = t.material(MixMaterial{MaterialId{0}, t.material(MirrorMaterial{})});
     }},
    {"Bright", "albedo-above-one",
     [](LintScene& t) {
         t.s.textures[0] = ConstantTexture{{0.1f, 1.1f, 0}};
     }},
    {"White", "",
     [](LintScene& t) {
         t.s.textures[0] = ConstantTexture{{1, 1, 1}};
     }},
    {"BrightChecker", "albedo-above-one",
     [](LintScene& t) {
         t.s.textures[0] = CheckerTexture{{0, 0, 0}, {2, 0, 0}};
     }},
    {"BrightTexel", "albedo-above-one",
     [](LintScene& t) {
         t.s.images.clear(), t.s.textures.clear();
         t.texture(t.image({0.5f, 1.5f, 0.2f}), ColorSpace::linear);
     }},
    {"BrightestTexelIsWhite", "",
     [](LintScene& t) {
         t.s.textures.clear();
         t.texture(t.image({0.5f, 1, 0.2f}), ColorSpace::linear);
     }},
    {"BrightProduct", "albedo-above-one",
     [](LintScene& t) {
         const TextureId texels = t.texture(t.image({0.5f, 0.9f}), ColorSpace::linear), twice = t.constant(2);
         t.s.textures[0] = ProductTexture{texels, twice};
     }},
    {"SumOfTwo", "albedo-above-one",
     [](LintScene& t) {
         t.s.materials[0] = DiffuseTransmissionMaterial{TextureId{0}, t.constant(0.6f)};
     }},
    {"SumOfTwoIsOne", "",
     [](LintScene& t) {
         t.s.materials[0] = DiffuseTransmissionMaterial{TextureId{0}, t.constant(0.5f)};
     }},
    {"BrightMirror", "albedo-above-one",
     [](LintScene& t) {
         wear(t, MirrorMaterial{{1, 1, 1.5f}});
     }},
    {"BrightGlass", "albedo-above-one",
     [](LintScene& t) {
         wear(t, GlassMaterial{1.5f, {1, 1, 1}, {2, 2, 2}});
     }},
    {"BrightMetal", "albedo-above-one",
     [](LintScene& t) {
         wear(t, ConductorMaterial{*metal_index("gold"), {}, {1.2f, 1, 1}});
     }},
    {"BrightBase", "albedo-above-one",
     [](LintScene& t) {
         OpenPbrMaterial m;
         m.base_color = {{1.5f, 0, 0}};
         wear(t, m);
     }},
    {"BrightBaseOfLittleWeight", "",
     [](LintScene& t) {
         OpenPbrMaterial m;
         m.base_color = {{1.5f, 0, 0}};
         m.base_weight = 0.5f;
         wear(t, m);
     }},
    {"BrightVertices", "albedo-above-one",
     [](LintScene& t) {
         t.s.textures[0] = VertexColorTexture{};
         Mesh m = cube(1);
         m.colors.assign(8, {0, 0, 3});
         t.s.instances.clear(), t.s.shapes.clear();
         t.place(m, MaterialId{0});
     }},
    {"EmissionMayBeBright", "",
     [](LintScene& t) {
         t.s.lights.push_back(
             AreaLight{InstanceId{0}, {5, 5, 5}, false, 1, true, t.texture(t.image({3, 4}), ColorSpace::linear)});
     }},
    {"VacuumGlass", "ior-one", [](LintScene& t) { wear(t, glass(1)); }},
    {"ThinAir", "", [](LintScene& t) { wear(t, glass(1.002f)); }},
    {"Fog", "",
     [](LintScene& t) {
         wear(t, GlassMaterial{1, {1, 1, 1}, {1, 1, 1}, {}, 0, {{}, {1, 1, 1}, 0}});
     }},
    {"AirWithAPriority", "",
     [](LintScene& t) {
         wear(t, GlassMaterial{1, {1, 1, 1}, {1, 1, 1}, {}, 0, {}, 2});
     }},
    {"VacuumRefraction", "ior-one", [](LintScene& t) { wear(t, RefractionMaterial{1}); }},
    {"OpaqueWithIorOne", "",
     [](LintScene& t) {
         OpenPbrMaterial m;
         m.specular_ior = 1;
         wear(t, m);
     }},
    {"RoughnessOfColours", "color-space",
     [](LintScene& t) {
         wear(t, {}), t.s.materials[0] = rough_by(t.texture(t.bytes({9, 99, 199}), ColorSpace::srgb));
     }},
    {"RoughnessOfNumbers", "",
     [](LintScene& t) {
         wear(t, {}), t.s.materials[0] = rough_by(t.texture(t.bytes({9, 99, 199}), ColorSpace::linear));
     }},
    {"BlackOrWhiteRoughness", "",
     [](LintScene& t) {
         wear(t, {}), t.s.materials[0] = rough_by(t.texture(t.bytes({0, 0, 0, 255, 255, 255}), ColorSpace::srgb));
     }},
    {"ColoursReadAsNumbers", "color-space",
     [](LintScene& t) {
         t.s.textures.clear(), t.texture(t.bytes({200, 100, 50}), ColorSpace::linear);
     }},
    {"ColoursReadAsColours", "",
     [](LintScene& t) {
         t.s.textures.clear(), t.texture(t.bytes({200, 100, 50}), ColorSpace::srgb);
     }},
    {"LinearFloatColours", "",
     [](LintScene& t) { t.s.textures.clear(), t.texture(t.image({0.2f}), ColorSpace::linear); }},
    {"RoughnessBeyondOne", "out-of-range",
     [](LintScene& t) {
         wear(t, {}), t.s.materials[0] = rough_by(t.texture(t.image({0.2f, 1.5f}), ColorSpace::linear));
     }},
    {"RoughnessBelowZero", "out-of-range",
     [](LintScene& t) {
         wear(t, {}), t.s.materials[0] = rough_by(t.texture(t.image({-0.2f, 0.5f}), ColorSpace::linear));
     }},
    {"RoughnessUpToOne", "",
     [](LintScene& t) {
         wear(t, {}), t.s.materials[0] = rough_by(t.texture(t.image({0, 1}), ColorSpace::linear));
     }},
    {"TexelsThatAreNoNumbers", "out-of-range",
     [](LintScene& t) {
         t.s.textures.clear(), t.texture(t.image({0.2f, kNan}), ColorSpace::linear);
     }},
    {"PictureAsNormals", "normal-map",
     [](LintScene& t) {
         map_normals(t, {128, 128, 128, 250, 250, 250, 100, 110, 120});
     }},
    {"NormalsIntoTheSurface", "normal-map",
     [](LintScene& t) {
         map_normals(t, {128, 128, 0});
     }},
    {"FlatNormals", "",
     [](LintScene& t) {
         map_normals(t, {128, 128, 255, 200, 128, 233});
     }},
    {"NoUvs", "missing-uvs",
     [](LintScene& t) { t.s.textures[0] = CheckerTexture{}, t.place(cube(0.1f), MaterialId{0}, at(2, 0, 0)); }},
    {"Uvs", "",
     [](LintScene& t) {
         t.s.textures[0] = CheckerTexture{}, t.place(with_uvs(cube(0.1f)), MaterialId{0}, at(2, 0, 0));
     }},
    {"NoUvsOfSetOne", "missing-uvs",
     [](LintScene& t) {
         ImageTexture image;
         image.image = t.bytes({10, 20, 30, 40, 50, 60});
         image.uv_set = 1;
         t.s.textures[0] = image;
         t.place(with_uvs(cube(0.1f)), MaterialId{0}, at(2, 0, 0));
     }},
    {"NoUvsForOneTexel", "",
     [](LintScene& t) {
         t.s.textures.clear(), t.texture(t.bytes({200, 100, 50}), ColorSpace::srgb);
         t.place(cube(0.1f), MaterialId{0}, at(2, 0, 0));
     }},
    {"NoColours", "missing-colors",
     [](LintScene& t) {
         const MaterialId painted =
             t.material(DiffuseMaterial{add<TextureId>(t.s.textures, Texture(VertexColorTexture{})), true});
         t.place(cube(0.1f), painted, at(2, 0, 0));
     }},
    {"AlphasWithoutColours", "",
     [](LintScene& t) {
         Mesh m = cube(0.1f);
         m.alphas.assign(m.positions.size(), 0.5f);
         t.place(m, t.material(DiffuseMaterial{add<TextureId>(t.s.textures, Texture(VertexColorTexture{})), true}),
                 at(2, 0, 0));
     }},
};

INSTANTIATE_TEST_SUITE_P(Material, Rules, testing::ValuesIn(kMaterialCases), name_of_case);

}  // namespace

std::span<const Case> material_cases() { return kMaterialCases; }

}  // namespace steradian::test
