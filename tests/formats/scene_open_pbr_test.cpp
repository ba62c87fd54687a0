// The keys of open_pbr in our own format.
#include <iterator>

#include "formats/scene_test.h"

namespace steradian::test {
namespace {

TEST(NativeScene, OpenPbr) {
    const LoadedScene loaded =
        load_good(scene_with(R"("textures": {"t": {"type": "constant", "color": 0.1}}, "materials": {
        "plain": {"type": "open_pbr"},
        "set": {"type": "open_pbr", "base_weight": 0.01, "base_color": [0.02, 0, 1], "base_metalness": 0.03,
                "base_diffuse_roughness": 0.04, "specular_weight": 0.05, "specular_color": 0.06,
                "specular_roughness": 0.07, "specular_ior": 1.08, "specular_roughness_anisotropy": 0.09,
                "transmission_weight": 0.1, "transmission_color": 0.11, "subsurface_weight": 0.12,
                "subsurface_color": 0.13, "fuzz_weight": 0.14, "fuzz_color": 0.15, "fuzz_roughness": 0.16,
                "coat_weight": 0.17, "coat_color": 0.18, "coat_roughness": 0.19, "coat_roughness_anisotropy": 0.2,
                "coat_ior": 1.21, "coat_darkening": 0.22, "geometry_opacity": 0.23, "subsurface_scatter_anisotropy": 0.24,
                "thin_film_weight": 0.25, "thin_film_thickness": 0.26, "thin_film_ior": 1.27,
                "emission_luminance": 0.28, "emission_color": 0.29, "transmission_dispersion_scale": 0.3,
                "transmission_dispersion_abbe_number": 31, "geometry_thin_walled": true},
        "textured": {"type": "open_pbr", "base_color": "t", "specular_roughness": "t",
                     "specular_color": "t", "coat_roughness": "t", "fuzz_roughness": "t"}})"));
    const auto get = [&](size_t i) { return std::get<OpenPbrMaterial>(loaded.scene.materials[i]); };
    const OpenPbrMaterial plain = get(0), m = get(1), textured = get(2);
    EXPECT_EQ(plain.base_color.value, (Rgb{0.8f, 0.8f, 0.8f}));
    EXPECT_EQ(plain.specular_roughness.value, 0.3f);
    EXPECT_EQ(plain.coat_ior, 1.6f);
    EXPECT_EQ(plain.transmission_dispersion_scale, 0);
    EXPECT_EQ(plain.transmission_dispersion_abbe_number, 20);
    EXPECT_EQ(m.base_color.value, (Rgb{0.02f, 0, 1}));
    const float numbers[] = {m.base_weight,
                             m.base_color.value.r,
                             m.base_metalness.value,
                             m.base_diffuse_roughness,
                             m.specular_weight,
                             m.specular_color.value.g,
                             m.specular_roughness.value,
                             m.specular_ior - 1,
                             m.specular_roughness_anisotropy.value,
                             m.transmission_weight.value,
                             m.transmission_color.value.b,
                             m.subsurface_weight.value,
                             m.subsurface_color.value.r,
                             m.fuzz_weight.value,
                             m.fuzz_color.value.g,
                             m.fuzz_roughness.value,
                             m.coat_weight,
                             m.coat_color.value.b,
                             m.coat_roughness.value,
                             m.coat_roughness_anisotropy,
                             m.coat_ior - 1,
                             m.coat_darkening,
                             m.geometry_opacity.value,
                             m.subsurface_scatter_anisotropy,
                             m.thin_film_weight.value,
                             m.thin_film_thickness.maximum,
                             m.thin_film_ior - 1,
                             m.emission_luminance,
                             m.emission_color.value.r,
                             m.transmission_dispersion_scale,
                             m.transmission_dispersion_abbe_number / 100};
    EXPECT_TRUE(m.geometry_thin_walled);
    EXPECT_FALSE(plain.geometry_thin_walled);
    for (size_t i = 0; i < std::size(numbers); ++i) EXPECT_NEAR(numbers[i], 0.01 * double(i + 1), 1e-6) << i;
    EXPECT_EQ(textured.base_color.value, (Rgb{1, 1, 1}));
    EXPECT_EQ(textured.base_color.texture, TextureId{0});
    EXPECT_EQ(textured.specular_color.texture, TextureId{0});
    for (const FloatInput& in : {textured.coat_roughness, textured.fuzz_roughness}) EXPECT_EQ(in.texture, TextureId{0});
    EXPECT_EQ(textured.specular_roughness.value, 1);
    EXPECT_EQ(textured.specular_roughness.texture, TextureId{0});
}

TEST(NativeScene, ThinFilmsWithTextures) {
    const auto with = [](const std::string& members) {
        return scene_with(
            R"("textures": {"t": {"type": "constant", "color": 0.1}, "n": {"type": "constant", "color": 0.5}},
            "materials": {"m": {"type": "open_pbr", "thin_film_weight": "t", "thin_film_thickness": )" +
            members + "}}");
    };
    const auto film = [&](const std::string& members) {
        return std::get<OpenPbrMaterial>(load_good(with(members)).scene.materials[0]);
    };
    const OpenPbrMaterial all = film(R"({"texture": "n", "minimum": 0.3, "maximum": 0.1})");
    EXPECT_EQ(all.thin_film_weight.texture, TextureId{0});
    EXPECT_EQ(all.thin_film_thickness.texture, TextureId{1});
    EXPECT_EQ(all.thin_film_thickness.minimum, 0.3f);
    EXPECT_EQ(all.thin_film_thickness.maximum, 0.1f);
    EXPECT_EQ(film(R"({"texture": "n", "maximum": 10})").thin_film_thickness.minimum, 0);
    expect_error(with(R"(§{"texture": "n"})"), "'maximum'");
    expect_error(with(R"(§{"maximum": 1})"), "'texture'");
    expect_error(with(R"({"texture": "n", "maximum": §10.1})"), "'maximum'");
    expect_error(with(R"({"texture": "n", "maximum": 1, "minimum": §-1})"), "'minimum'");
    expect_error(with(R"({"texture": §0.5, "maximum": 1})"), "a texture");
    expect_error(with(R"({"texture": "n", "maximum": 1, §"scale": 2})"), "scale");
    expect_error(with(R"(§"n")"), "'thin_film_thickness'");
}

TEST(NativeScene, FramesOfOpenPbrLayers) {
    const LoadedScene loaded = load_good(
        scene_with(R"("textures": {"t": {"type": "constant", "color": 0.1}, "n": {"type": "constant", "color": 0.5}},
        "materials": {
        "plain": {"type": "open_pbr"},
        "short": {"type": "open_pbr", "geometry_coat_normal": "n", "geometry_tangent": "n",
                  "specular_roughness_anisotropy": "t"},
        "long": {"type": "open_pbr", "geometry_coat_normal": {"texture": "n", "strength": 0.5, "flip_y": true},
                 "geometry_tangent_rotation": -30}})"));
    const auto get = [&](size_t i) { return std::get<OpenPbrMaterial>(loaded.scene.materials[i]); };
    EXPECT_FALSE(get(0).geometry_coat_normal);
    EXPECT_FALSE(get(0).geometry_tangent.texture);
    EXPECT_EQ(get(1).geometry_coat_normal->texture, TextureId{1});
    EXPECT_EQ(get(1).geometry_coat_normal->strength, 1);
    EXPECT_EQ(get(1).geometry_tangent.texture, TextureId{1});
    EXPECT_EQ(get(1).geometry_tangent.rotation, 0);
    EXPECT_EQ(get(1).specular_roughness_anisotropy.texture, TextureId{0});
    EXPECT_EQ(get(2).geometry_coat_normal->strength, 0.5f);
    EXPECT_TRUE(get(2).geometry_coat_normal->flip_y);
    EXPECT_EQ(get(2).geometry_tangent.rotation, -30);
    EXPECT_EQ(get(2).specular_grain_shape, GrainShape::open_pbr);
}

}  // namespace
}  // namespace steradian::test
