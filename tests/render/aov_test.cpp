// AOVs: what they hold, that they leave the colour alone, and that they depend on nothing that must not matter.
#include <gtest/gtest.h>

#include <cmath>

#include "base/names.h"
#include "render/aov.h"
#include "render/memory_estimate.h"
#include "render/render_scene.h"
#include "render_support.h"
#include "steradian/replay.h"
#include "test_scenes.h"

namespace steradian {
namespace {

using test::channel;
using test::prepared;
using test::run;

RenderSettings settings_with(AovSet aovs, uint64_t samples = 16) {
    RenderSettings s;
    s.width = 31;
    s.height = 22;
    s.samples_per_pixel = samples;
    s.aovs = aovs;
    return s;
}

/// A floor that fills the picture from below the horizon, with nothing above it.
Scene floor_scene(Rgb albedo = {0.2f, 0.4f, 0.6f}) {
    Scene s;
    test::place(s, Rectangle{{0, 0, 0}, {50, 0, 0}, {0, 0, -50}}, test::diffuse(s, albedo, true));
    s.lights = {EnvironmentLight{{1, 1, 1}}};
    s.cameras = {PerspectiveCamera{{0, 2, 10}, {0, 2, 0}, {0, 1, 0}, 40}};
    return s;
}

TEST(Aovs, LeaveTheColourAloneToTheBit) {
    const auto scene = prepared(test::everything_scene());
    for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::direct})
        for (const FilterKind filter : {FilterKind::box, FilterKind::gaussian, FilterKind::mitchell}) {
            RenderSettings plain = settings_with({}, 70), all = settings_with(AovSet::all(), 70);
            plain.integrator = all.integrator = integrator;
            plain.filter = all.filter = {filter, default_filter_radius(filter)};
            const Image with = run(scene, all).image;
            EXPECT_EQ(image_hash(color_channels(with)), image_hash(run(scene, plain).image));
            EXPECT_EQ(with.types.size(), with.channels.size());
        }
}

TEST(Aovs, TheSameBitsOnAnyNumberOfThreadsTilesAndKernels) {
    const Scene all_kinds = test::everything_scene();
    const auto scene = prepared(all_kinds);
    RenderSettings settings = settings_with(AovSet::all(), 136);
    settings.filter = {FilterKind::mitchell, 2};
    const std::string expected = image_hash(run(scene, settings, {1, 16}).image);
    for (const uint32_t threads : {2u, 5u}) EXPECT_EQ(image_hash(run(scene, settings, {threads, 16}).image), expected);
    for (const uint32_t tile : {1u, 7u, 64u}) EXPECT_EQ(image_hash(run(scene, settings, {2, tile}).image), expected);
    for (const Isa isa : {Isa::scalar, Isa::automatic}) {
        const Execution execution{2, 16, BvhBuilder::median, 64, isa, BvhLayout::compact};
        EXPECT_EQ(image_hash(run(prepared(all_kinds, execution), settings, execution).image), expected);
    }
}

TEST(Aovs, ACropIsThatPartOfTheWhole) {
    const auto scene = prepared(test::everything_scene());
    RenderSettings settings = settings_with(AovSet::all());
    const Image full = run(scene, settings).image;
    settings.crop = Crop{5, 3, 17, 20};
    const Image part = run(scene, settings).image;
    ASSERT_EQ(part.channels, full.channels);
    const size_t channels = full.channels.size();
    for (uint32_t y = 0; y < part.height; ++y)
        for (size_t i = 0; i < part.width * channels; ++i)
            ASSERT_EQ(part.pixels[y * part.width * channels + i],
                      full.pixels[((y + 3) * full.width + 5) * channels + i])
                << full.channels[i % channels];
}

TEST(Aovs, AFilmInPartsIsTheFilm) {
    // With a time limit blocks are continued; the limit is never reached here.
    const auto scene = prepared(test::everything_scene());
    const RenderSettings settings = settings_with(AovSet::all(), 100);
    Execution timed;
    timed.time_limit = 1e6;
    EXPECT_EQ(image_hash(run(scene, settings, timed).image), image_hash(run(scene, settings).image));
}

TEST(Aovs, OnlyThoseThatWereAskedFor) {
    const auto scene = prepared(floor_scene());
    const Image all = run(scene, settings_with(AovSet::all())).image;
    for (uint32_t i = 0; i < kAovs; ++i) {
        const auto aov = static_cast<Aov>(i);
        const Image one = run(scene, settings_with({aov})).image;
        EXPECT_GT(one.channels.size(), 3u) << name_of(aov);
        for (const std::string& name : one.channels) EXPECT_EQ(channel(one, name), channel(all, name)) << name;
    }
}

TEST(Aovs, AFloorIsWhatItIsWithEveryFilter) {
    const Rgb albedo{0.2f, 0.4f, 0.6f};
    const auto scene = prepared(floor_scene(albedo));
    for (const FilterKind kind : {FilterKind::box, FilterKind::tent, FilterKind::gaussian, FilterKind::mitchell}) {
        RenderSettings settings = settings_with(AovSet::all(), 64);
        settings.filter = {kind, default_filter_radius(kind)};
        const Image image = run(scene, settings).image;
        const auto at = [&](const char* name, uint32_t x, uint32_t y) {
            return channel(image, name)[y * image.width + x];
        };
        for (uint32_t x = 0; x < image.width; ++x) {
            const uint32_t low = image.height - 1, high = 0;  // far from the horizon
            EXPECT_EQ(at("A", x, low), 1.0f);
            EXPECT_NEAR(at("albedo.R", x, low), albedo.r, 1e-7f);
            EXPECT_NEAR(at("albedo.B", x, low), albedo.b, 1e-7f);
            EXPECT_EQ(at("N.X", x, low), 0.0f);
            EXPECT_EQ(at("N.Y", x, low), 1.0f);
            EXPECT_EQ(at("P.Y", x, low), 0.0f);
            EXPECT_EQ(at("object.id", x, low), 1.0f);
            EXPECT_EQ(at("material.id", x, low), 1.0f);
            EXPECT_EQ(at("primitive.id", x, low), 1.0f);
            EXPECT_EQ(at("samples.count", x, low), 64.0f);
            // P and Z are of one point, which the centre of the pixel shows: 64 samples come within a quarter of a
            // pixel.
            const float tangent = std::tan(20 * float(3.14159265358979) / 180), z = at("Z", x, low);
            EXPECT_NEAR(at("P.Z", x, low), 10 - z, 1e-5f);
            const float u = at("P.X", x, low) / z / tangent * 11 + 15.5f, v = 2 / z / tangent * 11 + 11;
            EXPECT_NEAR(u, static_cast<float>(x) + 0.5f, 0.3f);
            EXPECT_NEAR(v, static_cast<float>(low) + 0.5f, 0.3f);
            EXPECT_EQ(at("A", x, high), 0.0f);
            EXPECT_EQ(at("albedo.R", x, high), 0.0f);
            EXPECT_EQ(at("Z", x, high), CentreSample::kFarDepth);
            EXPECT_EQ(at("object.id", x, high), 0.0f);
            // The sky is as bright everywhere, so that samples differ by their filter's weights alone.
            if (kind != FilterKind::mitchell) {
                EXPECT_LT(at("variance.R", x, high), 1e-15f);
            }
        }
    }
}

TEST(Aovs, ThePixelsCentreIsWhatTheIdsOfTheNearestSampleShow) {
    // With a filter of radius 2 samples lie in neighbouring pixels, but ids are those of a box filter's.
    const auto scene = prepared(test::everything_scene());
    const AovSet ids{Aov::object, Aov::primitive};
    RenderSettings wide = settings_with(ids, 256), narrow = settings_with(ids, 4);
    wide.filter = {FilterKind::tent, 2};
    narrow.filter = {FilterKind::box, 0.05f};
    const auto a = channel(run(scene, wide).image, "object.id"), b = channel(run(scene, narrow).image, "object.id");
    size_t different = 0;
    for (size_t i = 0; i < a.size(); ++i) different += a[i] != b[i];
    // The nearest of 256 samples is about 0.07 pixels from the centre: few edges lie between.
    EXPECT_LT(different, a.size() / 25);
}

TEST(Aovs, WhatIsNotThereIsLookedThrough) {
    Scene s = floor_scene();
    const auto sheet = [&](float opacity, float x) {
        OpenPbrMaterial m;
        m.geometry_opacity.value = opacity;
        const auto id = add<MaterialId>(s.materials, Material(m));
        test::place(s, Rectangle{{x, 0, 5}, {2, 0, 0}, {0, 20, 0}}, id);
    };
    sheet(0, -2), sheet(0.25f, 2);
    const auto scene = prepared(std::move(s));
    const Image image = run(scene, settings_with(AovSet::all(), 1024)).image;
    const auto at = [&](const char* name, uint32_t x, uint32_t y) {
        return double(channel(image, name)[y * image.width + x]);
    };
    const uint32_t low = image.height - 1;
    EXPECT_EQ(at("object.id", 8, low), 1);
    EXPECT_EQ(at("A", 8, low), 1);
    EXPECT_EQ(at("A", 8, 0), 0);
    // Of 1024 independent samples a share of ¼ has a standard deviation of 0.0135; Sobol's are closer.
    EXPECT_NEAR(at("A", 23, 0), 0.25, 0.0135 * 4);
    EXPECT_NEAR(at("N.Z", 23, low), 0.25, 0.0135 * 4);
    EXPECT_NEAR(at("N.Y", 23, low), 0.75, 0.0135 * 4);
}

// The estimate of the variance of a mean has the mean that it should: against the spread over 64 seeds. Chi-square with
// 63 degrees of freedom has a relative standard deviation of √(2/63) = 0.18, averaged over 31 × 22 pixels that are
// nearly independent (and whose estimates have errors of their own, smaller ones): 0.007.
TEST(Aovs, TheVarianceIsThatOfThePixelsMean) {
    const auto scene = prepared(test::everything_scene());
    for (const FilterKind kind : {FilterKind::box, FilterKind::mitchell}) {
        RenderSettings settings = settings_with({Aov::variance}, 16);
        settings.filter = {kind, default_filter_radius(kind)};
        settings.sampler = SamplerKind::independent;
        settings.clamp = 3;  // fireflies would need more seeds
        constexpr int kSeeds = 64;
        std::vector<double> sum, squares, claimed;
        for (int seed = 0; seed < kSeeds; ++seed) {
            settings.seed = uint64_t(seed);
            const Image image = run(scene, settings).image;
            const auto mean = channel(image, "G"), variance = channel(image, "variance.G");
            sum.resize(mean.size()), squares.resize(mean.size()), claimed.resize(mean.size());
            for (size_t i = 0; i < mean.size(); ++i)
                sum[i] += double(mean[i]), squares[i] += double(mean[i]) * double(mean[i]),
                    claimed[i] += double(variance[i]) / kSeeds;
        }
        double ratio = 0;
        size_t pixels = 0;
        for (size_t i = 0; i < sum.size(); ++i) {
            const double spread = (squares[i] - sum[i] * sum[i] / kSeeds) / (kSeeds - 1);
            if (!(claimed[i] > 1e-9)) continue;
            ratio += spread / claimed[i], ++pixels;
        }
        EXPECT_GT(pixels, sum.size() / 2);
        EXPECT_NEAR(ratio / double(pixels), 1, 5 * 0.18 / std::sqrt(double(pixels)));
    }
}

/// With a filter that has negative lobes too.
TEST(Aovs, AlphaIsAShare) {
    RenderSettings settings = settings_with({Aov::alpha}, 2);
    settings.filter = Filter{FilterKind::mitchell, 2};
    float most = 0;
    for (const float a : channel(run(prepared(test::everything_scene()), settings).image, "A")) {
        EXPECT_GE(a, 0);
        EXPECT_LE(a, 1);
        most = std::max(most, a);
    }
    EXPECT_EQ(most, 1);
}

TEST(Aovs, OneSampleHasNoVariance) {
    const Image image = run(prepared(test::everything_scene()), settings_with({Aov::variance}, 1)).image;
    for (const float v : channel(image, "variance.R")) EXPECT_EQ(v, 0.0f);
}

TEST(Aovs, ComeWithPathAndDirectOnly) {
    const auto scene = prepared(floor_scene());
    RenderSettings settings = settings_with({Aov::depth});
    settings.integrator = IntegratorKind::ao;
    const auto job = RenderJob::start(scene, settings, {});
    ASSERT_FALSE(job.ok());
    EXPECT_EQ(job.error().code, ErrorCode::usage);
    EXPECT_NE(job.error().message.find("ao"), std::string::npos);
}

TEST(Aovs, AreInTheEstimateOfMemory) {
    RenderSettings plain = settings_with({}), all = settings_with(AovSet::all());
    plain.width = plain.height = all.width = all.height = 1024;
    const uint64_t per_pixel = SumKinds(AovSet::all()).bytes_per_pixel() - sizeof(RgbSum) +
                               sizeof(float) * (PictureChannels(AovSet::all()).count() - 3);
    EXPECT_GE(picture_bytes(all, {1}), picture_bytes(plain, {1}) + (per_pixel << 20));
    EXPECT_LE(picture_bytes(all, {1}), picture_bytes(plain, {1}) + (per_pixel << 20) + (16 << 20));
    const TileSums tile(100, SumKinds(AovSet::all()));
    EXPECT_EQ(tile.color.size() * sizeof(RgbSum) + tile.features.size() * sizeof(FeatureSum) +
                  tile.squares.size() * sizeof(SquareSum) + tile.centres.size() * sizeof(CentreSample) +
                  tile.light.size() * sizeof(LightSum) +
                  (tile.objects.size() + tile.materials.size()) * MatteCounts::typical_bytes(),
              100 * SumKinds(AovSet::all()).bytes_per_pixel());
}

TEST(Aovs, DoNotHinderReplay) {
    const auto scene = prepared(test::everything_scene());
    const auto plain = replay(scene, settings_with({}), 9, 9, 3);
    const auto with = replay(scene, settings_with(AovSet::all()), 9, 9, 3);
    ASSERT_TRUE(plain.ok() && with.ok());
    EXPECT_EQ(plain->radiance, with->radiance);
}

TEST(Aovs, APictureSaysWhichItHas) {
    const Image image = run(prepared(floor_scene()), settings_with({Aov::normal, Aov::albedo})).image;
    EXPECT_EQ(image.metadata.at("steradian:aovs"), "albedo,normal");
}

}  // namespace
}  // namespace steradian
