// Bodies within each other and media: what must have the same mean has it, in every pixel.
#include <gtest/gtest.h>

#include "analytic/compare.h"
#include "support/support.h"

namespace steradian::analytic {
namespace {

/// From z = a to b, 2 m wide; its surfaces are those of the block above where they meet.
Object block(double a, double b, std::string_view material) {
    const std::vector<V3> corners{{-1, -1, a}, {1, -1, a}, {1, 1, a}, {-1, 1, a},
                                  {-1, -1, b}, {1, -1, b}, {1, 1, b}, {-1, 1, b}};
    return mesh(corners,
                {{0, 2, 1},
                 {0, 3, 2},
                 {4, 5, 6},
                 {4, 6, 7},
                 {0, 1, 5},
                 {0, 5, 4},
                 {1, 2, 6},
                 {1, 6, 5},
                 {2, 3, 7},
                 {2, 7, 6},
                 {3, 0, 4},
                 {3, 4, 7}},
                material);
}

Object body(double eta, Color absorption, int priority) {
    return glass(eta).set("interior", Object().set("absorption", absorption)).set("priority", priority);
}

/// Glass on water, seen from the side and from above, before a lamp and a floor.
SceneText aquarium(double water_top, bool water_first, double roughness = 0) {
    SceneText s;
    s.look({2.2, -5, 2.5}, {0, 0, 0}, 32, {0, 0, 1}).size(8, 8).integrator("path").depth(8);
    const auto water = [&] {
        s.material("water", body(1.33, {0.5, 0.1, 0.05}, 1)).object(block(-1, water_top, "water"));
    };
    if (water_first) water();
    s.material("glass", body(1.5, {0.1, 0.4, 0.4}, 2).set("roughness", roughness)).object(block(0, 0.6, "glass"));
    if (!water_first) water();
    s.material("floor", diffuse({0.7, 0.6, 0.5}))
        .object(rectangle({0, 0, -1.01}, {4, 0, 0}, {0, 4, 0}, "floor"))
        .material("black", diffuse(0.0));
    s.object(disk({0, 2.5, 1}, {0, -1, -0.2}, 1, "black").set("light", emission({4, 3, 2})));
    return s.light(environment({0.3, 0.4, 0.6}));
}

RenderSettings independent(const PreparedCase& scene) {
    RenderSettings out = scene.settings;
    out.sampler = SamplerKind::independent;
    return out;
}

TEST(NestedBodies, OverlappingIsAbutting) {
    struct Variant {
        double roughness;
        bool water_first;
    };
    for (const Variant& v : {Variant{0, false}, Variant{0, true}, Variant{0.4, true}}) {
        const PreparedCase abutting(aquarium(0, false, v.roughness).str(), {});
        const PreparedCase overlapping(aquarium(0.3, v.water_first, v.roughness).str(), {});
        expect_same_means(abutting, independent(abutting), overlapping, independent(overlapping));
    }
}

/// The comparison itself: a gap between the two is seen.
TEST(NestedBodies, AGapIsSeen) {
    const PreparedCase abutting(aquarium(0, false).str(), {}), gap(aquarium(-0.2, false).str(), {});
    EXPECT_GT(different_means(abutting, independent(abutting), gap, independent(gap)), 0u);
}

/// What bounces between the facets of frosted glass is that of the boundary's own index, whatever is around: in a white
/// sky nothing is lost, to the 1 % of its tables.
TEST(NestedBodies, FrostedGlassInWaterLosesNothing) {
    SceneText s;
    s.look({0, 0, 4}, {0, 0, 0}, 20).size(8, 8).integrator("path").depth(1000).light(environment(1));
    s.material("water", glass(1.33).set("priority", 1)).object(sphere({0, 0, 0}, 1, "water"));
    s.material("stone", glass(2.4).set("priority", 2).set("roughness", 1)).object(sphere({0, 0, 0}, 0.8, "stone"));
    const PreparedCase scene(s.str(), {});
    std::vector<double> means;
    for (uint64_t seed = 1; seed <= 16; ++seed)
        means.push_back(mean_over(scene.picture(seed, 256), {0, 0, 8, 8, {}, false}, 0));
    const Estimate mean = estimate(means);
    EXPECT_LT(mean.standard_error, 0.005);
    EXPECT_NEAR(mean.mean, 1, 0.01 + 4 * mean.standard_error);
}

/// Fog with a lamp, a matte ball and a glass bead in it, seen from within.
SceneText fog() {
    SceneText s;
    s.look({0, 0.3, 3}, {0, 0, 0}, 40).size(8, 8).integrator("path").depth(5);
    Object medium = Object()
                        .set("absorption", Color{0.02, 0.05, 0.1})
                        .set("scattering", Color{0.3, 0.2, 0.1})
                        .set("anisotropy", 0.4);
    s.material("fog", glass(1).set("interior", medium)).object(sphere({0, 0, 0}, 6, "fog"));
    s.material("ball", diffuse({0.6, 0.5, 0.4})).object(sphere({-0.6, -0.2, 0}, 0.5, "ball"));
    s.material("bead", glass(1.5)).object(sphere({0.7, -0.3, 0.3}, 0.4, "bead"));
    s.material("black", diffuse(0.0));
    s.object(disk({0.4, 1.2, -0.5}, {-0.2, -1, 0.4}, 0.5, "black").set("light", emission({9, 8, 7})));
    return s.light(environment({0.5, 0.6, 0.8}));
}

TEST(Fog, LightSamplesAndPhaseFunctionAgree) {
    const PreparedCase scene(fog().depth(3).str(), {});
    expect_strategies_agree(scene, independent(scene));
}

TEST(Fog, RussianRouletteKeepsTheMean) {
    const PreparedCase scene(fog().str(), {});
    expect_roulette_keeps_the_mean(scene, independent(scene));
}

}  // namespace
}  // namespace steradian::analytic
