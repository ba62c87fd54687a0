#include "analytic/compare.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/support.h"

namespace steradian::analytic {
namespace {

struct Moments {
    std::vector<double> sum, squares;
};

Moments moments(const PreparedCase& scene, RenderSettings settings, uint64_t first_seed, uint32_t seeds) {
    const size_t numbers = size_t(settings.width) * settings.height * 3;
    Moments out{std::vector<double>(numbers), std::vector<double>(numbers)};
    settings.samples_per_pixel = test::by_tier<uint64_t>(64, 256);
    for (uint32_t i = 0; i < seeds; ++i) {
        settings.seed = first_seed + i;
        const Image image = scene.picture(settings);
        for (size_t k = 0; k < numbers; ++k) {
            out.sum[k] += image.pixels[k];
            out.squares[k] += double(image.pixels[k]) * image.pixels[k];
        }
    }
    return out;
}

/// P(|t| > z) of Student's distribution, by its density's integral.
double tail(double z, double degrees) {
    const double scale = std::exp(std::lgamma((degrees + 1) / 2) - std::lgamma(degrees / 2)) / std::sqrt(degrees * kPi);
    return 1 -
           2 * scale * integrate([&](double t) { return std::pow(1 + t * t / degrees, -(degrees + 1) / 2); }, 0, z, 64);
}

struct Comparison {
    std::vector<size_t> different;
    size_t noisy = 0, bright = 0;
};

Comparison compare(const PreparedCase& scene, const RenderSettings& first, const PreparedCase& other,
                   const RenderSettings& second) {
    const uint32_t seeds = test::by_tier(32u, 128u);
    const Moments a = moments(scene, first, 100, seeds), b = moments(other, second, 10100, seeds);
    const size_t numbers = a.sum.size();
    // Welch's t has at least seeds - 1 degrees of freedom.
    const double allowed = 1 - std::pow(1 - 0.001, 1.0 / static_cast<double>(numbers));
    double bound = 3;
    while (tail(bound, seeds - 1) > allowed) bound += 0.01;
    const auto n = static_cast<double>(seeds);
    Comparison out;
    for (size_t i = 0; i < numbers; ++i) {
        double variance = 0;
        for (const Moments* m : {&a, &b})
            variance += std::max(0.0, m->squares[i] / n - m->sum[i] / n * m->sum[i] / n) / (n - 1);
        const double difference = std::abs(a.sum[i] - b.sum[i]) / n, arithmetic = kRounding * b.sum[i] / n;
        out.noisy += variance > 0;
        out.bright += a.sum[i] > 0 || b.sum[i] > 0;
        if (!(difference <= bound * std::sqrt(variance) + arithmetic)) out.different.push_back(i);
    }
    return out;
}

}  // namespace

void expect_same_means(const PreparedCase& scene, const RenderSettings& a, const RenderSettings& b) {
    expect_same_means(scene, a, scene, b);
}

void expect_same_means(const PreparedCase& scene, const RenderSettings& a, const PreparedCase& other,
                       const RenderSettings& b) {
    const Comparison c = compare(scene, a, other, b);
    for (const size_t i : c.different)
        ADD_FAILURE() << "pixel " << i / 3 % a.width << ", " << i / 3 / a.width << " channel " << i % 3;
    EXPECT_GT(c.noisy, c.bright / 2);
    EXPECT_GT(c.bright, 0u);
}

size_t different_means(const PreparedCase& scene, const RenderSettings& a, const RenderSettings& b) {
    return different_means(scene, a, scene, b);
}

size_t different_means(const PreparedCase& scene, const RenderSettings& a, const PreparedCase& other,
                       const RenderSettings& b) {
    return compare(scene, a, other, b).different.size();
}

void expect_strategies_agree(const PreparedCase& scene, const RenderSettings& both) {
    RenderSettings light = both, bsdf = both;
    light.light_sampling = LightSampling::light;
    bsdf.light_sampling = LightSampling::bsdf;
    expect_same_means(scene, both, light);
    expect_same_means(scene, both, bsdf);
}

void expect_roulette_keeps_the_mean(const PreparedCase& scene, RenderSettings often) {
    RenderSettings never = often;
    often.roulette_depth = 0;
    never.roulette_depth = never.max_depth;
    expect_same_means(scene, often, never);
    often.samples_per_pixel = never.samples_per_pixel = 16;
    EXPECT_LT(scene.render(often).statistics.bounce_rays, scene.render(never).statistics.bounce_rays);
}

}  // namespace steradian::analytic
