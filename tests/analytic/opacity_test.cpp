// Partly opaque surfaces in all places where light may meet them: however light is sampled, the mean is the same.
#include <gtest/gtest.h>

#include "analytic/compare.h"

namespace steradian::analytic {
namespace {

/// A room behind veils: one with a pattern, a fractional one, a mix with an opaque part, a ball; and lamps, a mesh with
/// a pattern and a disk, that are there in part only, and materials that emit.
SceneText veils() {
    SceneText s;
    s.look({0, 1, 5}, {0, 1, 0}, 27).size(7, 7).integrator("path").depth(3);
    s.material("red", diffuse({0.63, 0.065, 0.05}, true)).material("white", diffuse({0.725, 0.71, 0.68}, true));
    s.material("black", diffuse(0.0));
    const auto veil = [](const char* opacity) {
        return Object("open_pbr").set("base_color", Color{0.3, 0.7, 0.4}).raw("geometry_opacity", opacity);
    };
    s.material("lace", veil(R"({"type": "checkerboard", "color0": 0.9, "color1": 0.1, "scale": [5, 5]})"))
        .material("gauze", veil("0.4"))
        .material("ember", veil("1")
                               .set("emission_luminance", 6)
                               .set("coat_weight", 0.8)
                               .set("coat_color", Color{1, 0.6, 0.3})
                               .raw("emission_color", R"({"type": "checkerboard", "color0": [1, 0.5, 0.2],
                               "color1": [0.1, 0.1, 0.6], "scale": [4, 4]})"))
        .material("spark", Object("mix").raw("materials", R"(["gauze", "ember"])").set("weight", 0.5))
        .material("net", Object("mix").raw("materials", R"(["gauze", "red"])").set("weight", 0.3));
    s.object(ground({0, 0, 0}, 1, 1, "white")).object(ceiling({0, 2, 0}, 1, 1, "white"));
    s.object(rectangle({0, 1, -1}, {1, 0, 0}, {0, 1, 0}, "white"))
        .object(rectangle({-1, 1, 0}, {0, 1, 0}, {0, 0, 1}, "red"));
    s.object(rectangle({0, 1, 0.8}, {0.8, 0, 0}, {0, 0.8, 0.1}, "lace"))
        .object(rectangle({0.3, 1.5, 0}, {0.5, 0.1, 0}, {0, 0, 0.6}, "net"))
        .object(sphere({-0.4, 0.4, 0.1}, 0.4, "gauze"));
    s.object(ceiling({0, 1.98, 0}, 0.4, 0.3, "black").set("light", emission({9, 7, 5})));
    s.object(disk({0.5, 1.2, -0.6}, {-1, 0.2, 1}, 0.25, "gauze").set("light", emission({4, 8, 16}, true)));
    s.object(mesh({{0.5, 0.1, -0.5}, {0.9, 0.1, -0.4}, {0.7, 0.8, -0.5}}, {{0, 1, 2}}, "lace")
                 .raw("uvs", "[[0, 0], [1, 0], [0.5, 1]]")
                 .set("light", emission({5, 2, 1}, true)));
    s.object(sphere({-0.6, 1.5, -0.4}, 0.15, "ember")).object(disk({0.8, 0.6, 0.2}, {-1, 0, 0.3}, 0.15, "spark"));
    s.light(point_light({0.2, 0.5, 1.2}, 0.3)).light(environment({0.3, 0.4, 0.6}));
    return s;
}

struct Ways {
    PreparedCase scene;
    RenderSettings both;
    explicit Ways(const SceneText& text) : scene(text.str(), {}), both(scene.settings) {
        both.sampler = SamplerKind::independent;
    }
};

TEST(Opacity, LightSamplesAloneAgreeWithBoth) {
    const Ways w(veils());
    RenderSettings light = w.both;
    light.light_sampling = LightSampling::light;
    expect_same_means(w.scene, w.both, light);
}

TEST(Opacity, BsdfSamplesAloneAgreeWithBoth) {
    const Ways w(veils());
    RenderSettings bsdf = w.both;
    bsdf.light_sampling = LightSampling::bsdf;
    expect_same_means(w.scene, w.both, bsdf);
}

TEST(Opacity, AtDepthOnePathsEqualDirectLight) {
    const Ways w(veils().depth(1));
    RenderSettings direct = w.both;
    direct.integrator = IntegratorKind::direct;
    expect_same_means(w.scene, w.both, direct);
}

}  // namespace
}  // namespace steradian::analytic
