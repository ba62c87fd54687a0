// What paths are in, and what media make of them.
#include "shading/interior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shading/bsdf.h"
#include "shading/bsdf/phase.h"
#include "shading/shading_scene.h"
#include "shading/world.h"
#include "support/chi_square.h"

namespace steradian {
namespace {

/// Materials of these indices and priorities.
ShadingScene bodies(const std::vector<std::pair<float, Priority>>& of) {
    Scene scene;
    for (const auto& [eta, priority] : of) {
        GlassMaterial glass;
        glass.eta = eta;
        glass.priority = priority;
        scene.materials.push_back(glass);
    }
    Diagnostics diagnostics;
    return std::move(make_shading_scene(std::move(scene), diagnostics)).value();
}

TEST(Interior, TheHighestPriorityFillsIt) {
    const ShadingScene scene = bodies({{1.5f, 2}, {1.33f, 1}, {1.2f, 3}});
    const std::vector<std::vector<uint32_t>> orders{{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const auto& order : orders) {
        Interior in;
        EXPECT_EQ(in.filling(), kVacuum);
        EXPECT_EQ(in.index(scene), 1);
        for (const uint32_t body : order) in.enter(scene, body);
        for (const auto& [body, index] : {std::pair(2u, 1.2f), {0u, 1.5f}, {1u, 1.33f}}) {
            EXPECT_EQ(in.filling(), body);
            EXPECT_EQ(in.index(scene), index);
            in.leave(body);
        }
        EXPECT_EQ(in.filling(), kVacuum);
    }
}

TEST(Interior, OfEqualPrioritiesTheFirstMaterialFillsIt) {
    const ShadingScene scene = bodies({{1.5f, 1}, {1.33f, 1}});
    for (const uint32_t first : {0u, 1u}) {
        Interior in;
        in.enter(scene, first);
        in.enter(scene, 1 - first);
        EXPECT_EQ(in.filling(), 0u);
    }
}

TEST(Interior, WithoutPriorityTheLastOneFillsItAndPrioritiesBeginAnew) {
    const ShadingScene scene = bodies({{1.5f, 9}, {0.5f, std::nullopt}, {1.2f, 1}});
    Interior in;
    in.enter(scene, 0);
    in.enter(scene, 1);
    EXPECT_EQ(in.filling(), 1u);
    EXPECT_EQ(in.index(scene), 0.75f);  // over what is around
    in.enter(scene, 2);
    EXPECT_EQ(in.filling(), 2u);
    EXPECT_EQ(in.index(scene), 1.2f);
    in.leave(2);
    in.leave(1);
    EXPECT_EQ(in.filling(), 0u);
}

TEST(Interior, BodiesOfOneMaterialAreTheirUnion) {
    const ShadingScene scene = bodies({{1.5f, 1}});
    Interior in;
    in.enter(scene, 0);
    in.enter(scene, 0);
    in.leave(0);
    EXPECT_EQ(in.filling(), 0u);
    in.leave(0);
    EXPECT_EQ(in.filling(), kVacuum);
    in.leave(0);  // of what it is not in
    EXPECT_EQ(in.filling(), kVacuum);
}

TEST(Interior, WhatIsTooMuchIsNotEntered) {
    const std::vector<std::pair<float, Priority>> many(Interior::kMost + 1, {1.5f, 1});
    const ShadingScene scene = bodies(many);
    Interior in;
    for (uint32_t i = Interior::kMost + 1; i-- > 1;) in.enter(scene, i);
    EXPECT_EQ(in.filling(), 1u);
    in.enter(scene, 0);  // would cover all others
    EXPECT_EQ(in.filling(), 1u);
    in.leave(0);
    for (uint32_t i = 1; i <= Interior::kMost; ++i) {
        EXPECT_EQ(in.filling(), i);
        in.leave(i);
    }
    EXPECT_EQ(in.filling(), kVacuum);
}

const Medium kMedium{{0.1f, 0.5f, 0}, {0.7f, 0, 1.5f}, 0.3f};

TEST(Medium, TransmittanceIsExponential) {
    const Rgb half = transmittance(kMedium, 2);
    EXPECT_NEAR(half.r, std::exp(-1.6), 1e-6);
    EXPECT_NEAR(half.g, std::exp(-1), 1e-6);
    EXPECT_NEAR(half.b, std::exp(-3), 1e-6);
    const Rgb far = transmittance({{1, 0, 0}, {}, 0}, double{kInfinity});
    EXPECT_EQ(far, (Rgb{0, 1, 1}));
}

/// Means over the two numbers, by the midpoint rule: what reaches a distance, and what is scattered before.
TEST(Medium, SampledDistancesHaveTheMeansOfTheMedium) {
    constexpr double kDistance = 1.3;
    constexpr int kSteps = 600;
    for (const Rgb throughput : {Rgb{1, 1, 1}, Rgb{0.2f, 3, 0.5f}}) {
        double reached[3] = {}, scattered[3] = {};
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j) {
                const Vec2 u{(static_cast<float>(i) + 0.5f) / kSteps, (static_cast<float>(j) + 0.5f) / kSteps};
                const double t = sample_scattering(kMedium, throughput, u);
                const bool before = t < kDistance;
                const Rgb weight = scattering_weight(kMedium, throughput, before ? t : kDistance, before);
                for (int c = 0; c < 3; ++c) (before ? scattered : reached)[c] += weight[c] / (kSteps * kSteps);
            }
        for (int c = 0; c < 3; ++c) {
            const double s = kMedium.scattering[c], t = s + kMedium.absorption[c];
            EXPECT_NEAR(reached[c], std::exp(-t * kDistance), 4e-3) << c;
            EXPECT_NEAR(scattered[c], s / t * (1 - std::exp(-t * kDistance)), 4e-3) << c;
        }
    }
}

/// With throughputs as shares nothing is lost on the whole, whichever channel has decided.
TEST(Medium, WeightsKeepTheSumOfWhatIsNotAbsorbed) {
    const Medium white{{}, {0.2f, 1, 5}, 0};
    const Rgb throughput{0.3f, 0.9f, 0.1f};
    for (const bool scattered : {false, true})
        for (const double t : {0.01, 0.5, 3.0}) {
            const Rgb left = throughput * scattering_weight(white, throughput, t, scattered);
            EXPECT_NEAR(left.r + left.g + left.b, 1.3, 1e-5);
        }
}

TEST(PhaseFunction, IntegratesToOneWithItsMeanCosine) {
    for (const double g : {-0.9, -0.3, 0.0, 1e-5, 0.5, 0.95}) {
        constexpr int kSteps = 200000;
        double sum = 0, mean = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double cosine = -1 + 2 * (i + 0.5) / kSteps;
            const double p = henyey_greenstein(g, cosine) * 4 * std::numbers::pi / kSteps;
            sum += p, mean += p * cosine;
        }
        EXPECT_NEAR(sum, 1, 1e-5) << g;
        EXPECT_NEAR(mean, g, 1e-5) << g;
    }
}

TEST(PhaseFunction, SamplesHaveItsDensity) {
    const Vec3 wos[] = {{0, 0, 1}, normalize(Vec3{0.3f, -0.5f, 0.2f})};
    for (const float g : {-0.6f, 0.0f, 5e-5f, 0.3f, 0.8f})
        for (const Vec3 wo : wos) {
            Bsdf phase;
            phase.lobe = PhaseBsdf{g};
            const auto draw = [&](uint64_t i) -> std::optional<Vec3> {
                test::Random random(i);
                return sample(phase, wo, 0, random.uniform2())->wi;
            };
            const auto density = [&](Vec3 wi) { return static_cast<double>(eval(phase, wo, wi).pdf); };
            const test::ChiSquare result = test::chi_square_directions(draw, density, 200'000, 20, 20);
            EXPECT_TRUE(result.passes()) << g << ": " << result;
        }
}

}  // namespace
}  // namespace steradian
