// What KHR_materials_ior, specular, clearcoat and iridescence reflect at a right angle, by their closed forms.
#include "shading/spectrum.h"
#include "shading/thin_film.h"
#include "wall.h"

namespace steradian {
namespace {

using namespace test;

/// Black and polished.
std::string black(const std::string& extensions, const std::string& metal = "\"metallicFactor\": 0") {
    return "\"pbrMetallicRoughness\": {\"baseColorFactor\": [0, 0, 0, 1], \"roughnessFactor\": 0, " + metal +
           "}, \"extensions\": {" + extensions + "}";
}
std::string ior(const std::string& value) { return "\"KHR_materials_ior\": {\"ior\": " + value + "}"; }
std::string specular(const std::string& members) { return "\"KHR_materials_specular\": {" + members + "}"; }
std::string specular_color(const std::string& color) { return specular("\"specularColorFactor\": " + color); }
std::string coat(const std::string& factor) {
    return "\"KHR_materials_clearcoat\": {\"clearcoatFactor\": " + factor + "}";
}
std::string transmission(const std::string& members) { return ", \"KHR_materials_transmission\": {" + members + "}"; }
double normal_reflectance(double n) { return (n - 1) * (n - 1) / ((n + 1) * (n + 1)); }
/// Of a coat of index 1.5 over what reflects `base`.
Rgb coated(double weight, Rgb base) {
    const auto c = static_cast<float>(weight * 0.04);
    return Rgb{c, c, c} + base * (1 - c);
}
Rgb grey(double x) { return Rgb{1, 1, 1} * static_cast<float>(x); }

void expect_color(const Mean& mean, Rgb expected) {
    EXPECT_LT(mean.error, 2e-3);
    // Amplitudes are at most 0.999.
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean.color[c], expected[c], 5 * mean.error + 2.5e-3 * double(expected[c]) + 5e-4) << c;
}
void expect_wall(const std::string& material, Rgb expected) {
    SCOPED_TRACE(material);
    expect_color(under_a_white_sky(wall(material).scene, 0, kWidth), expected);
}

TEST(GltfReflectance, IndexTimesColourIsAtMostOne) {
    expect_wall(black(ior("2")), grey(1 / 9.0));
    expect_wall(black(specular_color("[30, 1, 0.5]")), {1, 0.04f, 0.02f});
    expect_wall(black(specular("\"specularFactor\": 0.5, \"specularColorFactor\": [30, 20, 1]")), {0.5f, 0.4f, 0.02f});
    expect_wall(black(ior("1.05") + ", " + specular_color("[67.24, 67.24, 67.24]")), grey(0.04));
    expect_wall(black(ior("1") + ", " + specular_color("[67.24, 67.24, 67.24]")), grey(0));
}

/// An index of 0 stands for an interface that reflects everything, so that the colour says it all.
TEST(GltfReflectance, AnIndexOfZero) {
    expect_wall(black(ior("0")), grey(1));
    expect_wall(black(ior("0") + ", " + specular_color("[0.04, 0.04, 0.04]")), grey(0.04));
    expect_wall(black(ior("0") + ", " + specular("\"specularFactor\": 0.5, \"specularColorFactor\": [0.8, 3, 0]")),
                {0.4f, 0.5f, 0});
}

/// Of a texel that is half metal, black as well. OpenPBR would scale the metal and tint its edge.
TEST(GltfReflectance, ColoursOfDielectricsBesideMetal) {
    const std::string half = R"("metallicFactor": 0.5)";
    const std::string map = R"("metallicFactor": 1, "metallicRoughnessTexture": {"index": 0})";
    expect_wall(black(specular_color("[1, 0, 0]"), half), {0.02f, 0, 0});
    expect_wall(black(specular_color("[2, 2, 2]"), half), grey(0.04));
    expect_wall(black(ior("0"), half), grey(0.5));
    // Blue is the metalness: 0, 102 of 255, all.
    const auto material = [&](const std::string& extensions) { return black(extensions, map); };
    const std::string texels = texture_of({0, 0, 0, 255, 0, 0, 102, 255, 0, 0, 255, 255, 0, 0, 0, 255});
    const LoadedScene loaded = wall(material(specular_color("[1, 0.5, 0]")), texels);
    const auto seen = [&](uint32_t texel) {
        return under_a_white_sky(loaded.scene, texel * kWidth / 4, (texel + 1) * kWidth / 4);
    };
    expect_color(seen(0), {0.04f, 0.02f, 0});
    expect_color(seen(1), {0.024f, 0.012f, 0});
    expect_color(seen(2), {0, 0, 0});
    const Scene& s = loaded.scene;
    const auto& mix = std::get<MixMaterial>(s.materials[index(s.instances.at(0).material)]);
    EXPECT_TRUE(mix.weight.texture);
    // Where the index says it there is no mix.
    const LoadedScene plain = wall(material(specular_color("[2, 2, 2]")), texels);
    EXPECT_EQ(plain.scene.materials.size(), 1u);
}

/// Two weights by textures and a mix would be eight materials.
TEST(GltfReflectance, TheLimitOfMixesIsReported) {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle);
    const auto load = [&](const std::string& more) {
        return good_gltf(
            b.text(one_mesh(p, ", \"material\": 0") + ", \"materials\": [{" +
                   black(specular("\"specularColorFactor\": [1, 0, 0], \"specularTexture\": {\"index\": 0}") + more,
                         "\"metallicFactor\": 0.5") +
                   "}], " + kTextures));
    };
    EXPECT_TRUE(load("").fidelity.empty());
    EXPECT_TRUE(
        has(load(R"(, "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": {"index": 0}})").fidelity,
            "the texture 'clearcoatTexture' has no effect"));
    const LoadedScene coated_glass = load(", " + coat("1") + transmission("\"transmissionFactor\": 0.5"));
    EXPECT_TRUE(has(coated_glass.fidelity, "below a clearcoat a base that transmits a part of the light has no"));
}

TEST(GltfReflectance, ACoatLeavesTheBaseItsIndex) {
    expect_wall(black(coat("1")), coated(1, grey(0.04)));
    expect_wall(black(coat("0.5")), coated(0.5, grey(0.04)));
    expect_wall(black(coat("1") + ", " + ior("2")), coated(1, grey(1 / 9.0)));
    expect_wall(black(coat("1") + ", " + ior("9.7")), coated(1, grey(normal_reflectance(9.7))));
    expect_wall(black(coat("1") + ", " + ior("0")), grey(1));
    expect_wall(black(coat("1") + ", " + specular_color("[30, 1, 0]")), coated(1, {1, 0.04f, 0}));
    expect_wall(black(coat("1") + ", " + ior("9.7"), "\"metallicFactor\": 0.5"),
                coated(1, grey(normal_reflectance(9.7) / 2)));
    // What the dielectric needs must not scale the metal.
    const double normal = normal_reflectance(9.7), dielectric = normal + (1 - normal) * 0.5;
    expect_wall(
        "\"pbrMetallicRoughness\": {\"baseColorFactor\": [0.5, 0.5, 0.5, 1], \"roughnessFactor\": 0, "
        "\"metallicFactor\": 0.5}, \"extensions\": {" +
            coat("1") + ", " + ior("9.7") + "}",
        coated(1, grey((dielectric + 0.5) / 2)));
    // By a texture: nothing on the left.
    const Scene halves =
        wall(black(R"("KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": {"index": 0}})")).scene;
    expect_color(under_a_white_sky(halves, 0, kWidth / 2), grey(0.04));
    expect_color(under_a_white_sky(halves, kWidth / 2, kWidth), coated(1, grey(0.04)));
}

/// Bodies that light passes through keep the index that refracts it; the opaque part of the surface has its highlight.
TEST(GltfReflectance, ACoatOnWhatTransmitsInPart) {
    const std::string half = "\"transmissionFactor\": 0.5";
    const Scene s = wall(black(coat("1") + ", " + ior("1.7") + transmission(half))).scene;
    const auto& mix = std::get<MixMaterial>(s.materials[index(s.instances.at(0).material)]);
    const auto part = [&](MaterialId id) { return std::get<OpenPbrMaterial>(s.materials[index(id)]); };
    EXPECT_EQ(part(mix.first).specular_ior, 1.7f * 1.5f);
    EXPECT_EQ(part(mix.first).transmission_weight.value, 0);
    EXPECT_EQ(part(mix.second).specular_ior, 1.7f);
    EXPECT_EQ(part(mix.second).transmission_weight.value, 1);
    EXPECT_EQ(mix.weight.value, 0.5f);
    // Black glass, a thin sheet, reflects with its first surface alone.
    for (const char* factor : {"0.25", "0.5", "1"})
        expect_wall(black(coat("1") + transmission("\"transmissionFactor\": " + std::string(factor))),
                    coated(1, grey(0.04)));
    expect_wall(black(coat("0.5") + transmission(half)), coated(0.5, grey(0.04)));
    expect_wall(black(coat("1") + transmission(half), "\"metallicFactor\": 0.5"), coated(1, grey(0.02)));
    // By a texture: on the right it transmits.
    const Scene halves =
        wall(black(coat("1") + transmission(R"("transmissionFactor": 1, "transmissionTexture": {"index": 0})"))).scene;
    for (const uint32_t x : {0u, kWidth / 2})
        expect_color(under_a_white_sky(halves, x, x + kWidth / 2), coated(1, grey(0.04)));
}

TEST(GltfReflectance, WhatIsNotSplitBelowACoat) {
    const auto materials = [](const std::string& extensions, const std::string& metal = "\"metallicFactor\": 0") {
        return wall(black(extensions, metal)).scene.materials.size();
    };
    EXPECT_EQ(materials(coat("1") + transmission("\"transmissionFactor\": 1")), 1u);
    EXPECT_EQ(materials(coat("1") + transmission("\"transmissionFactor\": 0")), 1u);
    EXPECT_EQ(materials(coat("0") + transmission("\"transmissionFactor\": 0.5")), 1u);
    EXPECT_EQ(materials(coat("1") + transmission("\"transmissionFactor\": 0.5"), "\"metallicFactor\": 1"), 1u);
    EXPECT_EQ(materials(coat("1") + transmission("\"transmissionFactor\": 0.5")), 3u);
}

/// Airy's sum over the spectrum, in air whatever lies above.
TEST(GltfReflectance, AFilmBelowACoat) {
    const double thickness = 0.4;
    Vec3d sum, white;
    for (int nm = 380; nm < 730; ++nm) {
        const double wavelength = (nm + 0.5) / 1000;
        const Vec3d w = rgb_response(wavelength);
        sum = sum + w * film_reflectance(1, {1, 1.3, 1.5, 0}, thickness, wavelength), white = white + w;
    }
    const Rgb film{static_cast<float>(sum.x / white.x), static_cast<float>(sum.y / white.y),
                   static_cast<float>(sum.z / white.z)};
    const std::string iridescence =
        R"("KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceThicknessMaximum": 400)";
    expect_wall(black(iridescence + "}"), film);
    expect_wall(black(coat("1") + ", " + iridescence + "}"), coated(1, film));
    expect_wall(black(coat("0.5") + ", " + iridescence + "}"), coated(0.5, film));
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle);
    const auto load = [&](const std::string& more) {
        return good_gltf(b.text(one_mesh(p, ", \"material\": 0") + ", \"materials\": [{" +
                                black(more + iridescence + ", \"iridescenceIor\": 2.5}") + "}]"));
    };
    EXPECT_TRUE(load("").fidelity.empty());
    const auto clamped = [&](const std::string& more) {
        return has(load(coat("1") + more + ", ").fidelity, "an index of a film below a clearcoat");
    };
    EXPECT_TRUE(clamped(""));
    EXPECT_TRUE(clamped(transmission("\"transmissionFactor\": 0.5")));
    EXPECT_FALSE(clamped(transmission("\"transmissionFactor\": 1")));
}

}  // namespace
}  // namespace steradian
