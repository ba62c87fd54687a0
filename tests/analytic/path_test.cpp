// Path tracing: what must have the same mean has it, in every pixel.
#include <gtest/gtest.h>

#include "analytic/compare.h"
#include "support/support.h"

namespace steradian::analytic {
namespace {

/// Coloured walls, a mirror and a glass ball, lights of every kind: one-sided and two-sided, hidden ones, a mesh, a sky
/// that comes in at the front, and a wide sun. Small enough to be rendered many times.
SceneText room() {
    SceneText s;
    s.look({0, 1, 5}, {0, 1, 0}, 27).size(12, 12).integrator("path");
    s.material("red", diffuse({0.63, 0.065, 0.05}))
        .material("green", diffuse({0.14, 0.45, 0.091}))
        .material("white", diffuse({0.725, 0.71, 0.68}, true));
    s.material("mirror", mirror(0.9)).material("glass", glass(1.5)).material("black", diffuse(0.0));
    s.object(ground({0, 0, 0}, 1, 1, "white"))
        .object(ceiling({0, 2, 0}, 1, 1, "white"))
        .object(rectangle({0, 1, -1}, {1, 0, 0}, {0, 1, 0}, "white"));
    s.object(rectangle({-1, 1, 0}, {0, 1, 0}, {0, 0, 1}, "red"))
        .object(rectangle({1, 1, 0}, {0, 0, 1}, {0, 1, 0}, "green"));
    s.object(sphere({-0.45, 0.4, -0.2}, 0.4, "mirror")).object(sphere({0.45, 0.3, 0.3}, 0.3, "glass"));
    s.object(ceiling({0, 1.98, 0}, 0.4, 0.3, "black").set("light", emission({9, 7, 5}).set("light_samples", 2)));
    s.object(disk({0.5, 1.2, -0.6}, {-1, 0.2, 1}, 0.25, "white").set("light", emission({1, 2, 4}, true)));
    s.object(sphere({-0.5, 1.4, -0.3}, 0.2, "red").set("light", emission({4, 1, 1}).set("visible_to_camera", false)));
    s.object(
        mesh({{0, 0.9, -0.5}, {0.3, 0.9, -0.4}, {0.1, 1.3, -0.5}, {-0.2, 0.8, -0.2}}, {{0, 1, 2}, {0, 2, 3}}, "white")
            .set("light", emission({0.5, 2, 1})));
    s.light(point_light({0.2, 0.5, 0.8}, 0.3)).light(environment({0.3, 0.4, 0.6}));
    s.light(directional_light({0.2, -0.3, -1}, {0.5, 0.4, 0.2}).set("angular_diameter", 25.0));
    return s.depth(5);
}

RenderSettings independent(const PreparedCase& scene) {
    RenderSettings out = scene.settings;
    out.sampler = SamplerKind::independent;
    return out;
}

TEST(Paths, AtDepthOneEqualDirectLight) {
    const PreparedCase scene(room().depth(1).str(), {});
    RenderSettings path = independent(scene), direct = path;
    direct.integrator = IntegratorKind::direct;
    expect_same_means(scene, path, direct);
}

TEST(Paths, AtDepthOneEqualDirectLightWhereAllLightsAreHidden) {
    SceneText s = room().depth(1);
    s.light(
        directional_light({-0.5, -0.6, -1}, {1, 2, 0.2}).set("angular_diameter", 10.0).set("visible_to_camera", false));
    s.object(disk({0, 0.2, 0.4}, {0, -1, 0.4}, 0.2, "white")
                 .set("light", emission({3, 3, 1}, true).set("visible_to_camera", false)));
    const PreparedCase scene(s.str(), {});
    RenderSettings path = independent(scene), direct = path, bsdf = path;
    direct.integrator = IntegratorKind::direct;
    bsdf.light_sampling = LightSampling::bsdf;
    expect_same_means(scene, path, direct);
    expect_same_means(scene, path, bsdf);
}

/// Side by side below and before an even sky: what lets light through, each with a black wall behind its lower half,
/// and a metal that is seen from behind its shading normals.
SceneText transmitting() {
    SceneText s;
    s.camera(Object("orthographic").set("position", V3{0, 0, 9}).set("look_at", V3{0, 0, 0}).set("height", 2));
    s.size(10, 2).integrator("path").light(environment({1, 0.7, 0.4}));
    s.material("black", diffuse(0.0));
    s.material("leaf", Object("diffuse_transmission").set("reflectance", 0.2).set("transmittance", 0.6));
    s.material("frosted", Object("glass").set("roughness", 0.7));
    s.material(
        "layered",
        Object("open_pbr").set("transmission_weight", 0.8).set("specular_roughness", 0.6).set("specular_ior", 1.3));
    s.material("grey", diffuse(0.5, true)).material("mixed", Object("mix").raw("materials", R"(["leaf", "grey"])"));
    s.material("metal", Object("conductor").set("metal", "gold").set("roughness", 1));
    const char* const sheets[] = {"leaf", "frosted", "layered", "mixed"};
    for (int i = 0; i < 4; ++i) {
        s.object(rectangle({2.0 * i - 4, 0, 0}, {0.9, 0, 0}, {0, 0.9, 0.3}, sheets[i]));
        s.object(rectangle({2.0 * i - 4, -0.5, -1}, {1, 0, 0}, {0, 0.5, 0}, "black"));
    }
    // Its own normal is (0, 0.94, 0.34).
    s.object(
        mesh({{3.1, -0.9, 2.5}, {4.9, -0.9, 2.5}, {4.9, 0.9, -2.5}, {3.1, 0.9, -2.5}}, {{0, 1, 2}, {0, 2, 3}}, "metal")
            .raw("normals", "[[0, 0.8, -0.6], [0, 0.8, -0.6], [0, 0.8, -0.6], [0, 0.8, -0.6]]"));
    return s.depth(1);
}

/// The sky behind a surface lights it where it transmits, and the one above the surface wherever its shading normal is.
TEST(Paths, EveryStrategyFindsAnEvenSkyOnBothSides) {
    const PreparedCase scene(transmitting().str(), {});
    RenderSettings both = independent(scene), direct = both, light = both, bsdf = both;
    direct.integrator = IntegratorKind::direct;
    light.light_sampling = LightSampling::light;
    bsdf.light_sampling = LightSampling::bsdf;
    for (const RenderSettings& other : {direct, light, bsdf}) expect_same_means(scene, both, other);
}

/// Shapes with a texture that shines, around (0, 0.5, 0).
std::vector<std::pair<std::string, Object>> textured_lights() {
    const auto shine = [](bool two_sided, std::string_view texture = "squares") {
        return emission({4, 8, 16}, two_sided).set("texture", texture);
    };
    const Object folded =
        mesh({{-0.3, 0.2, -0.3}, {0.3, 0.3, -0.3}, {0.2, 0.8, 0.1}, {-0.4, 0.5, 0.3}}, {{0, 1, 2}, {0, 2, 3}}, "white");
    return {
        {"rectangle", rectangle({0, 0.5, 0}, {0.4, 0, 0}, {0, -0.3, 0.3}, "white").set("light", shine(false))},
        {"skewed", rectangle({0, 0.5, 0}, {0.4, 0.1, 0}, {0.1, 0.3, 0.3}, "white").set("light", shine(true))},
        {"disk", disk({0, 0.5, 0}, {0.2, -1, 0.3}, 0.4, "white").set("light", shine(true))},
        {"sphere", sphere({0, 0.5, 0}, 0.3, "white").set("light", shine(false))},
        {"ellipsoid",
         sphere({0, 0, 0}, 1, "white")
             .raw("transform", steps({scale({0.5, 0.2, 0.3}), rotate({0, 0, 1}, 30), translate({0, 0.5, 0})}))
             .set("light", shine(true))},
        {"mesh", Object(folded).raw("uvs", "[[0, 0], [1, 0], [1, 1], [0, 1]]").set("light", shine(false))},
        {"vertices", Object(folded)
                         .raw("colors", "[[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0]]")
                         .set("light", shine(true, "corners"))},
        {"mirrored", Object(folded)
                         .raw("uvs", "[[0, 0], [1, 0], [1, 1], [0, 1]]")
                         .raw("transform", steps({scale({-1, 1.2, 1})}))
                         .set("light", shine(false))},
    };
}

/// Above a floor that shows in pixels so large that the directions of the floor find each light often enough: of a few
/// hits in thousands of samples the variance is not known.
TEST(Paths, EveryStrategyFindsTexturedLights) {
    for (const auto& [name, light] : textured_lights()) {
        SCOPED_TRACE(name);
        SceneText s;
        s.look({0, 2, 2}, {0, 0.1, 0}, 26).size(3, 3).integrator("path").material("white", diffuse(0.8, true)).depth(1);
        s.texture("squares", Object("checkerboard")
                                 .set("color0", Color{1, 0.125, 0.03125})
                                 .set("color1", Color{0, 0.125, 0.5})
                                 .raw("scale", "[6, 4]")
                                 .set("rotation", 20.0));
        s.texture("corners", Object("vertex_color"));
        s.object(ground({0, 0, 0}, 1.5, 1.5, "white")).object(light);
        const PreparedCase scene(s.str(), {});
        RenderSettings both = independent(scene), direct = both, only_light = both, bsdf = both;
        direct.integrator = IntegratorKind::direct;
        only_light.light_sampling = LightSampling::light;
        bsdf.light_sampling = LightSampling::bsdf;
        for (const RenderSettings& other : {direct, only_light, bsdf}) expect_same_means(scene, both, other);
    }
}

TEST(Paths, LightSamplesAloneAgreeWithBoth) {
    const PreparedCase scene(room().depth(3).str(), {});
    RenderSettings both = independent(scene), light = both;
    light.light_sampling = LightSampling::light;
    expect_same_means(scene, both, light);
}

TEST(Paths, BsdfSamplesAloneAgreeWithBoth) {
    const PreparedCase scene(room().depth(3).str(), {});
    RenderSettings both = independent(scene), bsdf = both;
    bsdf.light_sampling = LightSampling::bsdf;
    expect_same_means(scene, both, bsdf);
}

/// The room with more lights than are all sampled at the first vertex: bright and weak ones, far ones, some inside the
/// walls' corners, some that face away, and a mesh.
SceneText room_with_many_lights() {
    SceneText s = room();
    for (int i = 0; i < 8; ++i) {
        const double x = -0.9 + 0.25 * i, brightness = 0.05 * (1 << (i % 4));
        s.light(point_light({x, 0.1 + 0.2 * i, -0.9}, brightness));
        s.object(sphere({x, 1.8, -0.7}, 0.03 + 0.01 * (i % 3), "black").set("light", emission({1, 3.0 * (i % 2), 2})));
        s.object(disk({x, 0.01, 0.8}, {0.3 * x, i % 3 ? 1.0 : -1.0, 0.1}, 0.05, "white")
                     .set("light", emission({3, 2, 0.5 * i}, i % 2 == 0)));
    }
    return s.depth(3);
}

TEST(Paths, EveryWayToChooseALightHasTheSameMean) {
    const PreparedCase scene(room_with_many_lights().str(), {});
    RenderSettings bvh = independent(scene), power = bvh, uniform = bvh;
    power.light_choice = LightChoice::power;
    uniform.light_choice = LightChoice::uniform;
    expect_same_means(scene, bvh, uniform);
    expect_same_means(scene, power, uniform);
    RenderSettings light = bvh;
    light.light_sampling = LightSampling::light;
    expect_same_means(scene, bvh, light);
}

TEST(Paths, RussianRouletteKeepsTheMean) {
    const PreparedCase scene(room().str(), {});
    expect_roulette_keeps_the_mean(scene, independent(scene));
}

TEST(Paths, RouletteBeyondTheDepthNeverStrikes) {
    const PreparedCase scene(room().str(), {});
    RenderSettings at = scene.settings, beyond = at;
    at.roulette_depth = at.max_depth;
    beyond.roulette_depth = kMaxDepth;
    EXPECT_EQ(image_hash(scene.picture(at)), image_hash(scene.picture(beyond)));
}

/// The comparison itself: one more bounce is seen.
TEST(Paths, AnotherDepthIsAnotherPicture) {
    const PreparedCase scene(room().str(), {});
    RenderSettings deep = independent(scene), shallow = deep;
    shallow.max_depth = deep.max_depth - 1;
    EXPECT_GT(different_means(scene, deep, shallow), 0u);
}

TEST(Paths, ClampingOnlyTakesIndirectLight) {
    const PreparedCase scene(room().str(), {});
    RenderSettings all = scene.settings, clamped = all, direct = all;
    all.samples_per_pixel = 16;
    clamped = direct = all;
    clamped.clamp = 0.02f;
    direct.max_depth = 1;
    const Image a = scene.picture(all), c = scene.picture(clamped);
    EXPECT_LT(mean_over(c, {0, 0, 12, 12, {}, false}, 0), mean_over(a, {0, 0, 12, 12, {}, false}, 0) * 0.98);
    EXPECT_TRUE(c.metadata.contains("steradian:clamp"));
    EXPECT_FALSE(a.metadata.contains("steradian:clamp"));
    // Without specular surfaces nothing of depth 1 is indirect.
    clamped.max_depth = 1;
    EXPECT_EQ(image_hash(scene.picture(clamped)), image_hash(scene.picture(direct)));
}

TEST(Paths, AreTheSameBitsInTilesAndCrops) {
    const PreparedCase scene(room().str(), {});
    RenderSettings settings = scene.settings;
    settings.samples_per_pixel = 70;
    const Image whole = scene.picture(settings);
    settings.crop = Crop{3, 5, 10, 9};
    const Image part = scene.picture(settings);
    for (size_t y = 0; y < 4; ++y)
        for (size_t i = 0; i < 7 * 3; ++i) ASSERT_EQ(part.pixels[y * 21 + i], whole.pixels[((y + 5) * 12 + 3) * 3 + i]);
}

}  // namespace
}  // namespace steradian::analytic
