// What dispersion must leave alone.
#include <gtest/gtest.h>

#include <limits>

#include "render_support.h"
#include "test_scenes.h"

namespace steradian {
namespace {

using test::channel;
using test::prepared;
using test::run;

RenderSettings small(IntegratorKind integrator) {
    RenderSettings s;
    s.width = 32;
    s.height = 24;
    s.samples_per_pixel = 6;
    s.integrator = integrator;
    return s;
}

Scene with_abbe(float abbe) {
    Scene s = test::everything_scene();
    for (Material& material : s.materials)
        if (auto* glass = std::get_if<GlassMaterial>(&material)) glass->abbe = abbe;
    return s;
}

/// Nor does a ball of such glass that no path meets, though the scene disperses light then.
TEST(Dispersion, NoAbbeNumberChangesNoBit) {
    Scene beside = with_abbe(0);
    GlassMaterial glass;
    glass.abbe = 10;
    test::place(beside, Sphere{{0, -1e4f, 0}, 0.01f}, add<MaterialId>(beside.materials, Material(glass)));
    const auto plain = prepared(with_abbe(0)), infinite = prepared(with_abbe(std::numeric_limits<float>::infinity())),
               unseen = prepared(beside), dispersive = prepared(with_abbe(10));
    for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::direct}) {
        const RenderSettings settings = small(integrator);
        const std::vector<float> pixels = run(plain, settings).image.pixels;
        EXPECT_EQ(run(infinite, settings).image.pixels, pixels);
        EXPECT_EQ(run(unseen, settings).image.pixels, pixels);
        EXPECT_NE(run(dispersive, settings).image.pixels, pixels);
    }
}

/// What the camera sees first has no wavelength: features are those of n_d, to the bit, whatever the Abbe number.
TEST(Dispersion, FeaturesHaveNoColorNoise) {
    RenderSettings settings = small(IntegratorKind::path);
    settings.aovs = {Aov::albedo, Aov::normal, Aov::depth, Aov::alpha};
    const Image plain = run(prepared(with_abbe(0)), settings).image,
                dispersive = run(prepared(with_abbe(10)), settings).image;
    ASSERT_EQ(plain.channels, dispersive.channels);
    ASSERT_GT(plain.channels.size(), 3u);
    EXPECT_NE(channel(plain, "R"), channel(dispersive, "R"));
    for (const std::string& name : plain.channels) {
        if (name == "R" || name == "G" || name == "B") continue;
        EXPECT_EQ(channel(plain, name), channel(dispersive, name)) << name;
    }
}

/// The samples of a picture are those of its crop, and of any number of threads and any size of tiles.
TEST(Dispersion, WavelengthsBelongToSamples) {
    const auto scene = prepared(with_abbe(10));
    RenderSettings settings = small(IntegratorKind::path);
    settings.samples_per_pixel = 70;
    Execution one, many;
    one.threads = 1, one.tile_size = 8;
    many.threads = 3, many.tile_size = 32;
    const Image whole = run(scene, settings, one).image;
    EXPECT_EQ(run(scene, settings, many).image.pixels, whole.pixels);
    settings.crop = Crop{9, 8, 20, 19};
    const Image crop = run(scene, settings).image;
    for (uint32_t y = 0; y < 11; ++y)
        for (uint32_t x = 0; x < 33; ++x)
            ASSERT_EQ(crop.pixels[y * 33 + x], whole.pixels[(y + 8) * 96 + 27 + x]) << x << " " << y;
}

}  // namespace
}  // namespace steradian
