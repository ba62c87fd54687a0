// The parts of light: that together they are the picture, and that each is what its name says.
#include <gtest/gtest.h>

#include <cmath>

#include "base/names.h"
#include "render_support.h"
#include "test_scenes.h"

namespace steradian {
namespace {

using test::channel;
using test::prepared;
using test::run;

constexpr Aov kParts[] = {
    Aov::emission,        Aov::background,        Aov::diffuse_direct,      Aov::diffuse_indirect,
    Aov::specular_direct, Aov::specular_indirect, Aov::transmission_direct, Aov::transmission_indirect};

RenderSettings settings_with(AovSet aovs, uint64_t samples = 16) {
    RenderSettings s;
    s.width = 40;
    s.height = 30;
    s.samples_per_pixel = samples;
    s.max_depth = 6;
    s.aovs = aovs;
    return s;
}
AovSet all_parts() {
    AovSet out;
    for (const Aov part : kParts) out.add(part);
    return out;
}

/// A row of spheres, one of every material that there is, in front of everything else.
Scene every_material() {
    Scene s = test::everything_scene();
    const auto texture = add<TextureId>(s.textures, Texture(ConstantTexture{{0.4f, 0.5f, 0.3f}}));
    std::vector<Material> materials{DiffuseMaterial{texture, true, 0.7f}, RefractionMaterial{}, ThinGlassMaterial{},
                                    DiffuseTransmissionMaterial{texture, texture}};
    GlassMaterial frosted;
    frosted.roughness.value = {0.3f, 0.3f};
    frosted.abbe = 10;
    ConductorMaterial metal, mirror;
    metal.reflectance = mirror.reflectance = SchlickReflectance{texture, {1, 1, 1}};
    metal.roughness.value = {0.4f, 0.4f};
    OpenPbrMaterial layered, ghost;
    layered.fuzz_weight.value = 0.4f;
    layered.coat_weight = 0.6f;
    layered.base_metalness.value = 0.3f;
    layered.transmission_weight.value = 0.4f;
    layered.transmission_dispersion_scale = 1;
    layered.base_diffuse_roughness = 0.5f;
    ghost.geometry_opacity.value = 0.4f;
    for (const Material& m : {Material(frosted), Material(metal), Material(mirror), Material(layered), Material(ghost)})
        materials.push_back(m);
    std::vector<MaterialId> ids;
    for (const Material& m : materials) ids.push_back(add<MaterialId>(s.materials, m));
    ids.push_back(add<MaterialId>(s.materials, Material(MixMaterial{ids[0], ids[5], {0.5f}})));
    ids.push_back(add<MaterialId>(s.materials, Material(MixMaterial{ids[8], MaterialId(3), {0.3f}})));
    for (size_t i = 0; i < ids.size(); ++i) {
        const float x = -2.2f + 0.44f * static_cast<float>(i);
        test::place(s, Sphere{{x, 0.35f, 2.2f}, 0.2f}, ids[i]);
    }
    // A single sheet of paper, through which light comes without another surface behind it.
    test::place(s, Rectangle{{1.2f, 1.2f, 2}, {0.4f, 0, 0}, {0, 0.4f, 0}}, ids[3]);
    // A glowing sphere, so that emission is seen directly and behind the ghost.
    const InstanceId lamp = test::place(s, Sphere{{0.5f, 0.9f, 1.5f}, 0.15f}, ids[0]);
    s.lights.push_back(AreaLight{lamp, {3, 2, 1}, false, 1});
    return s;
}

// With u = 2^-24 and m contributions to a sample: the sample's radiance is a sum of m terms in single precision, and so
// is each part; a term is divided into two with one rounding. So they differ by at most (2 (m - 1) + 1) u of the sum.
// The film adds in double, and rounds nine results once: 9 u more. A term is clamped, in all parts alike, before it is
// divided.
double rounding_bound(const RenderSettings& s, const Scene& scene) {
    const size_t first = scene.lights.size() + 1;  // light samples at the first surface; the lamp's second one
    const size_t terms = first + s.max_depth + 2 * (s.max_depth + 1);  // one more at every vertex, emission at each
    return (2.0 * double(terms) + 8) * 0x1p-24;
}

TEST(LightParts, TogetherAreThePicture) {
    const Scene scene = every_material();
    const auto ready = prepared(scene);
    for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::direct})
        for (const uint32_t depth : {0u, 1u, 6u})
            for (const LightSampling sampling : {LightSampling::mis, LightSampling::light, LightSampling::bsdf}) {
                RenderSettings settings = settings_with(all_parts(), 20);
                settings.crop = Crop{8, 10, 32, 26};
                settings.integrator = integrator;
                settings.max_depth = depth;
                settings.light_sampling = sampling;
                settings.clamp = depth == 6 ? 2 : 0;
                const Image image = run(ready, settings).image;
                const double bound = rounding_bound(settings, scene);
                for (const char* c : {"R", "G", "B"}) {
                    const auto whole = channel(image, c);
                    std::vector<double> sum(whole.size());
                    for (const Aov part : kParts) {
                        const auto values = channel(image, std::string(name_of(part)) + "." + c);
                        ASSERT_EQ(values.size(), sum.size());
                        for (size_t i = 0; i < sum.size(); ++i) {
                            ASSERT_GE(values[i], 0.0f);
                            sum[i] += double(values[i]);
                        }
                    }
                    for (size_t i = 0; i < sum.size(); ++i)
                        ASSERT_NEAR(sum[i], double(whole[i]), bound * double(whole[i])) << c << i;
                }
            }
}

/// The sum over the picture of one part's red.
double total(const Image& image, Aov part) {
    double sum = 0;
    for (const float v : channel(image, std::string(name_of(part)) + ".R")) sum += double(v);
    return sum;
}

TEST(LightParts, AllOfThemAreThereInASceneOfEverything) {
    const Image image = run(prepared(every_material()), settings_with(all_parts())).image;
    for (const Aov part : kParts) EXPECT_GT(total(image, part), 0) << name_of(part);
}

/// One sheet that fills the view, lit by one light, with nothing else.
Scene sheet(const Material& material, Light light) {
    Scene s;
    add<TextureId>(s.textures, Texture(ConstantTexture{{0.5f, 0.5f, 0.5f}}));
    const auto id = add<MaterialId>(s.materials, material);
    test::place(s, Rectangle{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, id);
    s.lights = {std::move(light)};
    s.cameras = {PerspectiveCamera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 40}};
    return s;
}

void expect_only(const Scene& scene, std::initializer_list<Aov> wanted, const char* what) {
    const Image image = run(prepared(scene), settings_with(all_parts(), 64)).image;
    for (const Aov part : kParts) {
        const bool is_wanted = std::find(wanted.begin(), wanted.end(), part) != wanted.end();
        EXPECT_EQ(total(image, part) > 0, is_wanted) << what << ": " << name_of(part) << " " << total(image, part);
    }
}

TEST(LightParts, AreSortedByWhatTheFirstSurfaceDoes) {
    const PointLight before{{1, 1, 3}, {5, 5, 5}}, behind{{1, 1, -3}, {5, 5, 5}};
    const EnvironmentLight sky{{1, 1, 1}};
    expect_only(sheet(DiffuseMaterial{TextureId(0), true}, before), {Aov::diffuse_direct}, "matte");
    expect_only(sheet(DiffuseMaterial{TextureId(0), true}, sky), {Aov::diffuse_direct}, "matte under the sky");
    ConductorMaterial metal;
    metal.reflectance = SchlickReflectance{TextureId(0), {1, 1, 1}};
    expect_only(sheet(metal, sky), {Aov::specular_direct}, "smooth metal");
    metal.roughness.value = {0.5f, 0.5f};
    expect_only(sheet(metal, before), {Aov::specular_direct}, "rough metal");
    expect_only(sheet(ThinGlassMaterial{}, sky), {Aov::specular_direct, Aov::transmission_direct}, "window");
    expect_only(sheet(DiffuseTransmissionMaterial{TextureId(0), TextureId(0)}, before), {Aov::diffuse_direct}, "paper");
    expect_only(sheet(DiffuseTransmissionMaterial{TextureId(0), TextureId(0)}, behind), {Aov::transmission_direct},
                "paper before a lamp");
    OpenPbrMaterial plastic;
    expect_only(sheet(plastic, before), {Aov::diffuse_direct, Aov::specular_direct}, "plastic");
    plastic.geometry_opacity.value = 0;
    expect_only(sheet(plastic, sky), {Aov::background}, "nothing");
    plastic.geometry_opacity.value = 0.5f;
    expect_only(sheet(plastic, sky), {Aov::background, Aov::diffuse_direct, Aov::specular_direct}, "a veil");
}

TEST(LightParts, IndirectIsWhatASecondSurfaceSends) {
    // The lamp is behind the camera's sheet's edge: a wall sends its light on.
    Scene s = sheet(DiffuseMaterial{TextureId(0), true}, EnvironmentLight{{0, 0, 0}});
    const auto wall = add<MaterialId>(s.materials, Material(DiffuseMaterial{TextureId(0), true}));
    test::place(s, Rectangle{{0, 0, 8}, {9, 0, 0}, {0, 9, 0}}, wall);
    const InstanceId lamp = test::place(s, Rectangle{{0, 0, 6}, {1, 0, 0}, {0, 1, 0}}, wall);
    s.lights = {AreaLight{lamp, {5, 5, 5}, false, 1}};  // towards the wall
    expect_only(s, {Aov::diffuse_indirect}, "a wall");
    // The same light, found through a mirror, is direct light of the mirror; what the wall sends is indirect.
    s.materials[0] = MirrorMaterial{{0.9f, 0.9f, 0.9f}};
    expect_only(s, {Aov::specular_indirect}, "a mirror");
    std::get<AreaLight>(s.lights[0]).two_sided = true;
    expect_only(s, {Aov::specular_direct, Aov::specular_indirect}, "a mirror before a lamp");
}

/// Emission and background are seen by the camera, through what is not there as well.
TEST(LightParts, WhatTheCameraSeesDirectlyIsEmissionOrBackground) {
    Scene s = sheet(DiffuseMaterial{TextureId(0), true}, AreaLight{InstanceId(0), {2, 3, 4}, true, 1});
    expect_only(s, {Aov::emission}, "a lamp");
    const Image image = run(prepared(s), settings_with(all_parts())).image;
    EXPECT_EQ(channel(image, "emission.R"), channel(image, "R"));
    OpenPbrMaterial veil;
    veil.geometry_opacity.value = 0;
    const auto id = add<MaterialId>(s.materials, Material(veil));
    test::place(s, Rectangle{{0, 0, 1}, {9, 0, 0}, {0, 9, 0}}, id);
    expect_only(s, {Aov::emission}, "a lamp behind nothing");
}

// Of plastic, the diffuse part is what is left when its facets reflect nothing back: checked against the same material
// with a specular colour of black, whose layering is the same.
TEST(LightParts, TheDiffusePartOfPlasticIsThatOfItsMatteBase) {
    OpenPbrMaterial plastic, matte;
    matte.specular_color.value = {0, 0, 0};
    const PointLight lamp{{1, 1, 3}, {5, 5, 5}};
    RenderSettings settings = settings_with(all_parts(), 16);
    settings.max_depth = 1;
    settings.light_sampling = LightSampling::light;
    const auto parts = channel(run(prepared(sheet(plastic, lamp)), settings).image, "diffuse_direct.G");
    const auto alone = channel(run(prepared(sheet(matte, lamp)), settings).image, "G");
    for (size_t i = 0; i < parts.size(); ++i) ASSERT_NEAR(parts[i], alone[i], 4e-6f * alone[i]);
}

}  // namespace
}  // namespace steradian
