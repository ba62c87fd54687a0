// A replayed sample is the one that the render added, to the bit, and its trace adds up.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/names.h"
#include "steradian/replay.h"
#include "test_scenes.h"

namespace steradian {
namespace {

constexpr uint32_t kWidth = 7, kHeight = 5;
constexpr uint64_t kSamples = 6;

std::shared_ptr<const RenderScene> prepared(Scene scene) {
    Diagnostics diagnostics;
    auto result = prepare(std::move(scene), {}, diagnostics);
    if (!result) throw std::runtime_error(result.error().str());
    return *result;
}

RenderSettings small() {
    RenderSettings s;
    s.width = kWidth;
    s.height = kHeight;
    s.samples_per_pixel = kSamples;
    s.roulette_depth = 1;
    s.filter = {FilterKind::mitchell, 2};
    return s;
}

RenderResult run(const std::shared_ptr<const RenderScene>& scene, const RenderSettings& settings,
                 const Execution& execution = {}) {
    auto job = RenderJob::start(scene, settings, execution);
    if (!job) throw std::runtime_error(job.error().str());
    auto result = (*job)->take();
    if (!result) throw std::runtime_error(result.error().str());
    return std::move(*result);
}

SampleTrace trace(const std::shared_ptr<const RenderScene>& scene, const RenderSettings& settings, uint32_t x,
                  uint32_t y, uint64_t sample) {
    auto result = replay(scene, settings, x, y, sample);
    if (!result) throw std::runtime_error(result.error().str());
    return std::move(*result);
}

std::vector<RenderSettings> many_settings() {
    std::vector<RenderSettings> out;
    for (size_t i = 0; i < names_of<IntegratorKind>().size(); ++i) {
        out.push_back(small());
        out.back().integrator = static_cast<IntegratorKind>(i);
    }
    out.push_back(small());
    out.back().light_sampling = LightSampling::bsdf;
    out.back().clamp = 0.05f;
    out.push_back(small());
    out.back().sampler = SamplerKind::independent;
    out.back().seed = 77;
    return out;
}

TEST(Replay, GivesTheBitsThatTheRenderAdds) {
    const auto scene = prepared(test::everything_scene());
    for (const RenderSettings& settings : many_settings()) {
        const Image image = run(scene, settings, {2, 4, BvhBuilder::sah, 64}).image;
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) {
                double sum[3] = {};
                for (uint64_t i = 0; i < kSamples; ++i) {
                    const SampleTrace t = trace(scene, settings, x, y, i);
                    for (int c = 0; c < 3; ++c) sum[c] += double(t.radiance[c]) * double(t.filter_weight);
                }
                for (int c = 0; c < 3; ++c)
                    ASSERT_EQ(static_cast<float>(sum[c] / kSamples), image.pixels[(y * kWidth + x) * 3 + size_t(c)])
                        << name_of(settings.integrator) << " " << x << "," << y;
            }
    }
}

/// What the vertices bring, added in their order, is the radiance; each throughput follows from the one before.
TEST(Replay, TracesAddUp) {
    const auto scene = prepared(test::everything_scene());
    size_t lights = 0, occluded = 0, bounces = 0, roulette = 0;
    for (RenderSettings settings : many_settings()) {
        if (settings.integrator != IntegratorKind::path && settings.integrator != IntegratorKind::direct) continue;
        for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
            for (uint64_t i = 0; i < kSamples; ++i) {
                const SampleTrace t = trace(scene, settings, pixel % kWidth, pixel / kWidth, i);
                Rgb sum, throughput{1, 1, 1};
                for (const TracedVertex& v : t.vertices) {
                    ASSERT_EQ(v.throughput, throughput);
                    sum = sum + v.contribution;
                    for (const TracedLight& l : v.lights) {
                        if (l.shadow_ray && !l.occluded) sum = sum + l.contribution;
                        lights += l.shadow_ray, occluded += l.occluded;
                    }
                    if (!v.bounce) continue;
                    ++bounces, roulette += !v.bounce->survived;
                    ASSERT_EQ(&v == &t.vertices.back(), !v.bounce->survived);
                    throughput = throughput * v.bounce->weight / v.bounce->survival;
                }
                ASSERT_EQ(sum, t.radiance);
                ASSERT_FALSE(t.bad);
            }
    }
    EXPECT_GT(lights, 1000u);
    EXPECT_GT(occluded, 100u);
    EXPECT_GT(bounces, 500u);
    EXPECT_GT(roulette, 50u);
}

/// At most one on a path, where it meets the glass ball for the first time, and all adds up with its colour.
TEST(Replay, TellsTheWavelength) {
    Scene s = test::everything_scene();
    for (Material& material : s.materials)
        if (auto* glass = std::get_if<GlassMaterial>(&material)) glass->abbe = 10;
    const auto scene = prepared(std::move(s));
    size_t chosen = 0, later = 0;
    for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::direct}) {
        RenderSettings settings = small();
        settings.integrator = integrator;
        const Image image = run(scene, settings).image;
        for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel) {
            double red = 0;
            for (uint64_t i = 0; i < kSamples; ++i) {
                const SampleTrace t = trace(scene, settings, pixel % kWidth, pixel / kWidth, i);
                red += double(t.radiance.r) * double(t.filter_weight);
                Rgb throughput{1, 1, 1}, sum;
                bool has = false;
                for (const TracedVertex& v : t.vertices) {
                    ASSERT_EQ(v.throughput, throughput);
                    if (v.wavelength > 0) {
                        ASSERT_FALSE(has);
                        ASSERT_EQ(v.instance, 2u);
                        ASSERT_TRUE(v.wavelength >= 390 && v.wavelength <= 680);
                        ASSERT_NEAR(v.wavelength_weight.r + v.wavelength_weight.g + v.wavelength_weight.b, 3, 1e-6);
                        throughput = throughput * v.wavelength_weight;
                        later += &v != &t.vertices.front();
                        ++chosen;
                        has = true;
                    }
                    ASSERT_TRUE(has || v.escaped || v.instance != 2 || !v.bounce);
                    sum = sum + v.contribution;
                    for (const TracedLight& l : v.lights)
                        if (l.shadow_ray && !l.occluded) sum = sum + l.contribution;
                    if (v.bounce) throughput = throughput * v.bounce->weight / v.bounce->survival;
                }
                ASSERT_EQ(sum, t.radiance);
            }
            ASSERT_EQ(static_cast<float>(red / kSamples), image.pixels[size_t(pixel) * 3]);
        }
    }
    EXPECT_GT(chosen, 20u);
    EXPECT_GT(later, 2u);
}

/// The weights of the two ways to find a direction: squares of density times number of samples, and they sum to one.
TEST(Replay, WeightsAreThePowerHeuristic) {
    const auto scene = prepared(test::everything_scene());
    RenderSettings settings = small();
    settings.light_choice = LightChoice::uniform;
    size_t by_light = 0, by_bsdf = 0;
    for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
        for (uint64_t i = 0; i < kSamples; ++i) {
            const SampleTrace t = trace(scene, settings, pixel % kWidth, pixel / kWidth, i);
            bool first = true;
            for (const TracedVertex& v : t.vertices) {
                if (v.bsdf_pdf > 0 && v.light_pdf > 0) {
                    const double b = v.bsdf_pdf, l = v.light_pdf;
                    EXPECT_NEAR(v.mis_weight, b * b / (b * b + l * l), 1e-6);
                    ++by_bsdf;
                } else if (!is_black(v.emission)) {
                    EXPECT_EQ(v.mis_weight, 1);
                }
                for (const TracedLight& light : v.lights) {
                    // Light 0 takes two samples where all are sampled; elsewhere one light of five is.
                    const double n = !first ? 0.2 : light.light == 0 ? 2 : 1;
                    const double l = n * light.light_pdf, b = light.bsdf_pdf;
                    EXPECT_NEAR(light.mis_weight, l == 0 ? 1 : l * l / (l * l + b * b), 1e-6);
                    ++by_light;
                }
                if (!v.lights.empty()) first = false;
            }
        }
    EXPECT_GT(by_light, 500u);
    EXPECT_GT(by_bsdf, 50u);
}

TEST(Replay, FindsBadSamples) {
    Scene s;
    const MaterialId white = test::diffuse(s, {1, 1, 1}, true);
    test::place(s, Rectangle{{0, 0, 0}, {5, 0, 0}, {0, 5, 0}}, white);
    s.lights = {PointLight{{0, 0, 1e-6f}, {3e38f, 3e38f, 3e38f}}};
    s.cameras = {PerspectiveCamera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 30}};
    const auto scene = prepared(std::move(s));
    const RenderSettings settings = small();
    const RenderStatistics statistics = run(scene, settings).statistics;
    ASSERT_TRUE(statistics.first_bad_sample);
    const PixelSample& first = *statistics.first_bad_sample;
    const SampleTrace t = trace(scene, settings, first.x, first.y, first.sample);
    EXPECT_TRUE(t.bad);
    EXPECT_FALSE(std::isfinite(t.radiance.r));
    uint64_t bad = 0;
    for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
        for (uint64_t i = 0; i < kSamples; ++i) bad += trace(scene, settings, pixel % kWidth, pixel / kWidth, i).bad;
    EXPECT_EQ(bad, statistics.bad_samples);
}

TEST(Replay, RefusesWhatIsNotInThePicture) {
    const auto scene = prepared(test::everything_scene());
    const auto code = [&](const RenderSettings& settings, uint32_t x, uint32_t y, uint64_t sample) {
        const auto result = replay(scene, settings, x, y, sample);
        return result.ok() ? -1 : static_cast<int>(result.error().code);
    };
    const int usage = static_cast<int>(ErrorCode::usage);
    RenderSettings settings = small();
    EXPECT_EQ(code(settings, kWidth - 1, kHeight - 1, kSamples - 1), -1);
    EXPECT_EQ(code(settings, kWidth, 0, 0), usage);
    EXPECT_EQ(code(settings, 0, kHeight, 0), usage);
    EXPECT_EQ(code(settings, 0, 0, kSamples), usage);
    settings.crop = Crop{2, 1, 4, 3};
    EXPECT_EQ(code(settings, 1, 1, 0), usage);
    EXPECT_EQ(code(settings, 2, 1, 0), -1);
    settings.camera = 5;
    EXPECT_EQ(code(settings, 2, 1, 0), usage);
}

TEST(Fireflies, AreTheBrightestSamplesOnAnyNumberOfThreads) {
    const auto scene = prepared(test::everything_scene());
    const RenderSettings settings = small();
    std::vector<PixelSample> all;
    for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
        for (uint64_t i = 0; i < kSamples; ++i) {
            const SampleTrace t = trace(scene, settings, pixel % kWidth, pixel / kWidth, i);
            all.push_back({t.x, t.y, t.sample, t.radiance});
        }
    const auto order = [](const PixelSample& s) { return std::tuple(-luminance(s.value), s.sample, s.y, s.x); };
    std::sort(all.begin(), all.end(), [&](const auto& a, const auto& b) { return order(a) < order(b); });
    for (const uint32_t wanted : {0u, 1u, 12u, 1000u})
        for (const uint32_t threads : {1u, 5u}) {
            Execution execution{threads, 3, BvhBuilder::sah, 64};
            execution.fireflies = wanted;
            const std::vector<PixelSample> found = run(scene, settings, execution).statistics.fireflies;
            ASSERT_EQ(found.size(), std::min<size_t>(wanted, all.size()));
            for (size_t i = 0; i < found.size(); ++i) EXPECT_EQ(order(found[i]), order(all[i])) << i;
        }
}

}  // namespace
}  // namespace steradian
