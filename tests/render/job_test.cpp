// The picture is a function of scene, settings and seed alone; jobs can be watched and stopped.
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <thread>

#include "base/parallel.h"
#include "render_support.h"
#include "steradian/render.h"
#include "support/support.h"
#include "test_scenes.h"

namespace steradian {
namespace {

RenderSettings small_settings() {
    RenderSettings s;
    s.width = 61;
    s.height = 43;
    s.integrator = IntegratorKind::direct;
    s.samples_per_pixel = 72;  // one whole block and an open one
    return s;
}

using test::prepared;
using test::run;

TEST(Job, TheSameBitsOnAnyNumberOfThreadsTilesAndBuilders) {
    const auto scene = prepared(test::everything_scene());
    const std::string expected = image_hash(run(scene, small_settings(), {1, 16, BvhBuilder::sah, 64}).image);
    for (const uint32_t threads : {2u, 7u})
        EXPECT_EQ(image_hash(run(scene, small_settings(), {threads, 16, BvhBuilder::sah, 64}).image), expected)
            << threads;
    for (const uint32_t tile : {1u, 13u, 64u, 256u})
        EXPECT_EQ(image_hash(run(scene, small_settings(), {2, tile, BvhBuilder::sah, 64}).image), expected) << tile;
    for (const BvhBuilder builder : {BvhBuilder::sah, BvhBuilder::median, BvhBuilder::fast, BvhBuilder::high_quality})
        for (const uint32_t depth : {1u, 3u, 64u}) {
            const Execution execution{2, 16, builder, depth};
            EXPECT_EQ(image_hash(run(prepared(test::everything_scene(), execution), small_settings(), execution).image),
                      expected)
                << depth;
        }
    for (const BvhBuilder builder : {BvhBuilder::sah, BvhBuilder::median, BvhBuilder::fast, BvhBuilder::high_quality}) {
        const Execution execution{2, 16, builder, 64, Isa::automatic, BvhLayout::compact};
        EXPECT_EQ(image_hash(run(prepared(test::everything_scene(), execution), small_settings(), execution).image),
                  expected);
    }
}

TEST(Job, SevenThreadsTakePart) {
    RenderSettings settings = small_settings();
    settings.samples_per_pixel = 640;
    EXPECT_EQ(run(prepared(test::everything_scene()), settings, {7, 4, BvhBuilder::sah, 64}).statistics.threads, 7u);
}

TEST(Job, ACropIsThatPartOfTheFullPicture) {
    const auto scene = prepared(test::everything_scene());
    for (const SamplerKind sampler : {SamplerKind::sobol, SamplerKind::independent}) {
        RenderSettings settings = small_settings();
        settings.sampler = sampler;
        const Image full = run(scene, settings).image;
        settings.crop = Crop{7, 5, 50, 31};
        const Image part = run(scene, settings).image;
        ASSERT_EQ(part.width, 43u);
        ASSERT_EQ(part.height, 26u);
        for (size_t y = 0; y < part.height; ++y)
            for (size_t x = 0; x < size_t(part.width) * 3; ++x)
                ASSERT_EQ(part.pixels[y * part.width * 3 + x], full.pixels[(y + 5) * full.width * 3 + 7 * 3 + x]);
    }
}

TEST(Job, EverySettingThatShouldChangeThePictureDoes) {
    const auto scene = prepared(test::everything_scene());
    std::set<std::string> hashes;
    const auto distinct = [&](auto change) {
        RenderSettings settings = small_settings();
        settings.samples_per_pixel = 4;
        change(settings);
        return hashes.insert(image_hash(run(scene, settings).image)).second;
    };
    EXPECT_TRUE(distinct([](RenderSettings&) {}));
    EXPECT_TRUE(distinct([](RenderSettings& s) { s.seed = 1; }));
    EXPECT_TRUE(distinct([](RenderSettings& s) { s.seed = ~uint64_t(0); }));
    EXPECT_TRUE(distinct([](RenderSettings& s) { s.sampler = SamplerKind::independent; }));
    EXPECT_TRUE(distinct([](RenderSettings& s) { s.max_depth = 0; }));
    EXPECT_TRUE(distinct([](RenderSettings& s) { s.max_depth = 1; }));
    EXPECT_TRUE(distinct([](RenderSettings& s) { s.max_depth = 2; }));
    EXPECT_TRUE(distinct([](RenderSettings& s) { s.samples_per_pixel = 5; }));
    EXPECT_TRUE(distinct([](RenderSettings& s) { s.filter = {FilterKind::box, 0.5f}; }));
    EXPECT_TRUE(distinct([](RenderSettings& s) { s.filter = {FilterKind::tent, 1.0f}; }));
    EXPECT_TRUE(distinct([](RenderSettings& s) { s.filter = {FilterKind::mitchell, 2.0f}; }));
    EXPECT_TRUE(distinct([](RenderSettings& s) { s.filter.radius = 2.5f; }));
}

TEST(Job, TheHostsFloatingPointModeDoesNotMatter) {
    const auto scene = prepared(test::everything_scene());
    RenderSettings settings = small_settings();
    settings.samples_per_pixel = 4;
    const std::string expected = image_hash(run(scene, settings).image);
#if defined(__x86_64__)
    const unsigned saved = __builtin_ia32_stmxcsr();
    __builtin_ia32_ldmxcsr(saved | 0x8040u | 0x6000u);  // flush to zero, denormals as zero, round towards zero
    const auto hostile_scene = prepared(test::everything_scene());
    const std::string hostile = image_hash(run(hostile_scene, settings).image);
    __builtin_ia32_ldmxcsr(saved);
    EXPECT_EQ(hostile, expected);
#endif
}

TEST(Job, CancelKeepsWhatIsDone) {
    RenderSettings settings = small_settings();
    settings.samples_per_pixel = kMaxSamplesPerPixel;  // would take days
    auto job = RenderJob::start(prepared(test::everything_scene()), settings, {2, 16, BvhBuilder::sah, 64});
    ASSERT_TRUE(job.ok());
    EXPECT_FALSE((*job)->wait_for(0.3));
    while ((*job)->progress().samples_done < uint64_t(settings.width) * settings.height * 64) std::this_thread::yield();
    const Result<Image> snapshot = (*job)->snapshot();
    ASSERT_TRUE(snapshot.ok());
    EXPECT_GT(snapshot->pixels[0], 0);
    (*job)->cancel();
    auto result = (*job)->take();
    ASSERT_TRUE(result.ok());
    EXPECT_TRUE((*job)->finished());
    EXPECT_FALSE(result->complete);
    EXPECT_GE(result->max_samples, 64u);
    EXPECT_LT(result->max_samples, settings.samples_per_pixel);
    EXPECT_TRUE(result->image.metadata.count("steradian:partial"));
    for (const float v : result->image.pixels) ASSERT_TRUE(std::isfinite(v));
}

// A job that is stopped has a whole picture: no tile gets its next block before every tile has got its last one.
TEST(Job, TheWholeFrameAdvancesTogether) {
    RenderSettings settings = small_settings();
    settings.samples_per_pixel = kMaxSamplesPerPixel;
    auto job = RenderJob::start(prepared(test::everything_scene()), settings, {1, 16, BvhBuilder::sah, 64});
    ASSERT_TRUE(job.ok());
    const uint64_t frame = uint64_t(settings.width) * settings.height * 64;
    while ((*job)->progress().samples_done < 3 * frame / 2) std::this_thread::yield();
    (*job)->cancel();
    auto result = (*job)->take();
    ASSERT_TRUE(result.ok());
    EXPECT_GE(result->min_samples, 64u);
    EXPECT_LE(result->max_samples - result->min_samples, 64u);
}

TEST(Job, CancelDoesNotWaitForThousandsOfLightSamples) {
    Scene scene = test::everything_scene();
    std::get<AreaLight>(scene.lights[0]).samples = kMaxLightSamples;
    RenderSettings settings = small_settings();
    settings.width = settings.height = 512;
    auto job = RenderJob::start(prepared(std::move(scene)), settings, {2, 256, BvhBuilder::sah, 64});
    ASSERT_TRUE(job.ok());
    while ((*job)->progress().rays < 100'000) std::this_thread::yield();  // far from the first unit's end
    (*job)->cancel();
    auto result = (*job)->take();
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(result->max_samples, 0u);
    EXPECT_LT((*job)->progress().rays, 30'000'000u);  // a unit has 256 × 256 × 64 × 4096
}

TEST(Job, DestroyingAJobStopsIt) {
    RenderSettings settings = small_settings();
    settings.samples_per_pixel = kMaxSamplesPerPixel;
    for (int i = 0; i < 10; ++i) {
        auto job = RenderJob::start(prepared(test::everything_scene()), settings, {3, 16, BvhBuilder::sah, 64});
        ASSERT_TRUE(job.ok());
    }
}

uint64_t entries(const char* folder) {
    const std::filesystem::directory_iterator all(folder);
    return static_cast<uint64_t>(std::distance(begin(all), end(all)));
}

uint64_t resident_bytes() {
    uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages >> pages;
    return pages * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
}

// As a preview does: scenes come, are rendered for a while and dropped.
TEST(Job, AHundredCancelledRendersLeaveNothingBehind) {
    RenderSettings settings = small_settings();
    settings.samples_per_pixel = kMaxSamplesPerPixel;
    std::mt19937 random(1);
    const auto render_for_a_while = [&] {
        auto job = RenderJob::start(prepared(test::everything_scene()), settings, {3, 16, BvhBuilder::sah, 64});
        ASSERT_TRUE(job.ok()) << job.error().str();
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 20000));
        (*job)->cancel();
        if (random() % 2) {
            ASSERT_TRUE((*job)->take().ok());
        }
    };
    for (int i = 0; i < 20; ++i) render_for_a_while();  // whatever is kept for good is there after that
    const uint64_t threads = entries("/proc/self/task"), files = entries("/proc/self/fd"), memory = resident_bytes();
    for (int i = 0; i < 100; ++i) render_for_a_while();
    EXPECT_EQ(entries("/proc/self/task"), threads);
    EXPECT_EQ(entries("/proc/self/fd"), files);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they keep what was freed
    EXPECT_LT(resident_bytes(), memory + (16 << 20));                // one such job holds about as much
#else
    static_cast<void>(memory);
#endif
}

TEST(Job, BadSamplesAreDroppedCountedAndReported) {
    Scene s;
    const MaterialId white = test::diffuse(s, {1, 1, 1}, true);
    test::place(s, Rectangle{{0, 0, 0}, {5, 0, 0}, {0, 5, 0}}, white);
    s.lights = {PointLight{{0, 0, 1e-6f}, {3e38f, 3e38f, 3e38f}}};
    s.cameras = {PerspectiveCamera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 30}};
    RenderSettings settings = small_settings();
    settings.samples_per_pixel = 8;
    const RenderResult r = run(prepared(std::move(s)), settings, {2, 16, BvhBuilder::sah, 64});
    EXPECT_GT(r.statistics.bad_samples, 0u);
    ASSERT_TRUE(r.statistics.first_bad_sample.has_value());
    EXPECT_EQ(r.statistics.first_bad_sample->sample, 0u);
    for (const float v : r.image.pixels) ASSERT_TRUE(std::isfinite(v));
}

TEST(Job, RaysAreCounted) {
    Scene s;
    const MaterialId white = test::diffuse(s, {1, 1, 1});
    test::place(s, Rectangle{{0, 0, 0}, {50, 0, 0}, {0, 50, 0}}, white);
    s.lights = {PointLight{{0, 0, 3}, {1, 1, 1}}, PointLight{{1, 0, 3}, {1, 1, 1}}};
    s.cameras = {PerspectiveCamera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 30}};
    RenderSettings settings = small_settings();
    settings.samples_per_pixel = 3;
    const RenderStatistics statistics = run(prepared(std::move(s)), settings).statistics;
    EXPECT_EQ(statistics.samples, 61u * 43u * 3u);
    EXPECT_EQ(statistics.camera_rays, 61u * 43u * 3u);
    EXPECT_EQ(statistics.shadow_rays, 2u * 61u * 43u * 3u);
    EXPECT_EQ(statistics.bounce_rays, 0u);
}

TEST(Job, SettingsThatMakeNoSenseAreRefused) {
    const auto scene = prepared(test::everything_scene());
    const auto code = [&](auto change) {
        RenderSettings settings = small_settings();
        Execution execution;
        change(settings, execution);
        const auto job = RenderJob::start(scene, settings, execution);
        return job.ok() ? -1 : static_cast<int>(job.error().code);
    };
    const int usage = static_cast<int>(ErrorCode::usage), resources = static_cast<int>(ErrorCode::resources);
    EXPECT_EQ(code([](auto& s, auto&) { s.width = 0; }), usage);
    EXPECT_EQ(code([](auto& s, auto&) { s.width = 0x80000000u; }), resources);
    EXPECT_EQ(code([](auto& s, auto&) { s.width = s.height = 1'000'000; }), resources);
    EXPECT_EQ(code([](auto& s, auto&) { s.samples_per_pixel = 0; }), usage);
    EXPECT_EQ(code([](auto& s, auto&) { s.samples_per_pixel = uint64_t(1) << 63; }), usage);
    EXPECT_EQ(code([](auto& s, auto&) { s.crop = Crop{5, 5, 5, 9}; }), usage);
    EXPECT_EQ(code([](auto& s, auto&) { s.crop = Crop{0, 0, 62, 9}; }), usage);
    EXPECT_EQ(code([](auto& s, auto&) { s.filter.radius = 0; }), usage);
    EXPECT_EQ(code([](auto& s, auto&) { s.filter.radius = std::nanf(""); }), usage);
    EXPECT_EQ(code([](auto& s, auto&) { s.camera = 1; }), usage);
    EXPECT_EQ(code([](auto&, auto& e) { e.tile_size = 0; }), usage);
    EXPECT_EQ(code([](auto&, auto& e) { e.threads = 100000; }), usage);
}

TEST(Job, OddSizesWork) {
    const auto scene = prepared(test::everything_scene());
    for (const auto& [w, h] : {std::pair{1u, 1u}, {1u, 3000u}, {3000u, 1u}}) {
        RenderSettings settings = small_settings();
        settings.width = w, settings.height = h, settings.samples_per_pixel = 1;
        const RenderResult r = run(scene, settings);
        EXPECT_EQ(r.image.pixels.size(), size_t(w) * h * 3);
        for (const float v : r.image.pixels) ASSERT_TRUE(std::isfinite(v));
    }
}

}  // namespace
}  // namespace steradian
