#include "shading/filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/hash.h"
#include "base/names.h"
#include "support/chi_square.h"
#include "support/random.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::by_tier;
using test::chi_square;
using test::ChiSquare;
using test::Random;

// All at their usual radius, and each at another one.
const std::vector<Filter> kFilters{
    {FilterKind::box, 0.5f}, {FilterKind::tent, 1.0f}, {FilterKind::gaussian, 1.5f}, {FilterKind::mitchell, 2.0f},
    {FilterKind::box, 1.7f}, {FilterKind::tent, 0.4f}, {FilterKind::gaussian, 3.0f}, {FilterKind::mitchell, 1.3f}};

std::string describe(const Filter& f) {
    static constexpr const char* kNames[] = {"box", "tent", "gaussian", "mitchell"};
    return std::string(kNames[static_cast<size_t>(f.kind)]) + " of radius " + std::to_string(f.radius);
}

/// One axis of the filter from its definition, unnormalised.
double definition(const Filter& f, double x) {
    x = std::fabs(x);
    const double r = f.radius;
    if (x > r) return 0;
    switch (f.kind) {
        case FilterKind::box:
            return 1;
        case FilterKind::tent:
            return 1 - x / r;
        case FilterKind::gaussian: {
            const double sigma = r / 3;
            return std::exp(-x * x / (2 * sigma * sigma)) - std::exp(-r * r / (2 * sigma * sigma));
        }
        case FilterKind::mitchell: {
            // Mitchell & Netravali 1988, equation 8, as printed there.
            const double b = 1.0 / 3, c = 1.0 / 3, t = 2 * x / r;
            if (t < 1) return ((12 - 9 * b - 6 * c) * t * t * t + (-18 + 12 * b + 6 * c) * t * t + (6 - 2 * b)) / 6;
            return ((-b - 6 * c) * t * t * t + (6 * b + 30 * c) * t * t + (-12 * b - 48 * c) * t + (8 * b + 24 * c)) /
                   6;
        }
    }
    return 0;
}

/// ∫ of |definition| (or of definition) from -radius to each of count + 1 equidistant places, by the midpoint rule.
std::vector<double> running_integral(const Filter& f, int count, bool absolute) {
    constexpr int kSteps = 64;
    std::vector<double> sums{0};
    const double h = 2.0 * f.radius / count / kSteps;
    for (int i = 0; i < count; ++i) {
        double sum = 0;
        for (int k = 0; k < kSteps; ++k) {
            const double y = definition(f, -f.radius + h * (i * kSteps + k + 0.5));
            sum += absolute ? std::fabs(y) : y;
        }
        sums.push_back(sums.back() + sum * h);
    }
    return sums;
}

TEST(Filter, EvaluateIsTheDefinitionNormalised) {
    for (const Filter& f : kFilters) {
        const FilterSampler sampler(f);
        const double integral = running_integral(f, 1024, false).back();
        const double peak = definition(f, 0) * definition(f, 0) / (integral * integral);
        Random random(1);
        for (int i = 0; i < 10'000; ++i) {
            const float x = static_cast<float>(random.between(-1.2, 1.2)) * f.radius;
            const float y = static_cast<float>(random.between(-1.2, 1.2)) * f.radius;
            EXPECT_NEAR(sampler.evaluate({x, y}), definition(f, x) * definition(f, y) / (integral * integral),
                        1e-6 * peak)
                << describe(f);
        }
    }
}

TEST(Filter, EvaluateIntegratesToOne) {
    for (const Filter& f : kFilters) {
        const FilterSampler sampler(f);
        constexpr int kSide = 400;
        double sum = 0;
        const float h = 2 * f.radius / kSide;
        for (int i = 0; i < kSide; ++i)
            for (int j = 0; j < kSide; ++j)
                sum += sampler.evaluate(
                    {(static_cast<float>(i) + 0.5f) * h - f.radius, (static_cast<float>(j) + 0.5f) * h - f.radius});
        // The midpoint rule: h²/24 ∫|f''| per axis, in units of the radius (1/200)²/24 · 18 at most, twice.
        EXPECT_NEAR(sum * h * h, 1, 4e-5) << describe(f);
    }
}

TEST(Filter, MitchellHasItsKnownValues) {
    const FilterSampler sampler({FilterKind::mitchell, 2});
    EXPECT_NEAR(sampler.evaluate({0, 0}), 64.0 / 81, 1e-7);
    EXPECT_NEAR(sampler.evaluate({1, 0}), 8.0 / 9 / 18, 1e-8);
    EXPECT_NEAR(sampler.evaluate({2, 0}), 0, 1e-8);
    EXPECT_LT(sampler.evaluate({1.5f, 0}), 0);
    EXPECT_GT(sampler.evaluate({1.5f, 1.5f}), 0);
}

// 8 filters × 2 binnings at 1e-6.
TEST(Filter, OffsetsHaveTheDensityOfTheAbsoluteFilter) {
    const int count = by_tier(500'000, 20'000'000);
    for (const Filter& f : kFilters) {
        const FilterSampler sampler(f);
        constexpr int kSide = 24, kFine = 400;
        const std::vector<double> coarse = running_integral(f, kSide, true), fine = running_integral(f, kFine, true);
        std::vector<double> observed(kSide * kSide), expected, observed_x(kFine), expected_x;
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i)
                expected.push_back((coarse[j + 1] - coarse[j]) * (coarse[i + 1] - coarse[i]) /
                                   (coarse.back() * coarse.back()) * count);
        for (int i = 0; i < kFine; ++i) expected_x.push_back((fine[i + 1] - fine[i]) / fine.back() * count);
        Random random(2);
        for (int i = 0; i < count; ++i) {
            Vec2 u;
            u.x = random.unit_float(), u.y = random.unit_float();
            const Vec2 p = sampler.sample(u).offset;
            const auto bin = [&](float x, int bins) {
                return clamp_to(static_cast<int>((x / f.radius + 1) / 2 * static_cast<float>(bins)), 0, bins - 1);
            };
            ++observed[static_cast<size_t>(bin(p.y, kSide) * kSide + bin(p.x, kSide))];
            ++observed_x[static_cast<size_t>(bin(p.x, kFine))];
        }
        const ChiSquare both = chi_square(observed, expected), one = chi_square(observed_x, expected_x);
        EXPECT_TRUE(both.passes()) << describe(f) << ": " << both;
        EXPECT_TRUE(one.passes()) << describe(f) << ", x alone: " << one;
    }
}

TEST(Filter, InversionIsExactToTheDocumentedError) {
    // The distribution function of |f| at the offset must be the number that was put in: off by the density's error of
    // 5e-6 of the peak over at most one cell of radius/1024 (below 1e-8), by the offset's rounding to float (6e-8 of
    // the radius times a density of at most 2 / radius), and by this reference's own midpoint rule and interpolation
    // (1e-7).
    constexpr int kPlaces = 1 << 14;
    for (const Filter& f : kFilters) {
        const FilterSampler sampler(f);
        const std::vector<double> cdf = running_integral(f, kPlaces, true);
        for (int i = 0; i < 4096; ++i) {
            const float u = static_cast<float>(i) / 4096;
            const double x = (static_cast<double>(sampler.sample({u, 0.3f}).offset.x) / f.radius + 1) / 2 * kPlaces;
            const int cell = clamp_to(static_cast<int>(x), 0, kPlaces - 1);
            const double at = cdf[cell] + (cdf[cell + 1] - cdf[cell]) * (x - cell);
            EXPECT_NEAR(at / cdf.back(), static_cast<double>(u) + 0x1p-25, 3e-7) << describe(f) << " at " << u;
        }
    }
}

TEST(Filter, WeightIsTheSignTimesAConstantAndAveragesToOne) {
    constexpr int kCount = 400'000;
    for (const Filter& f : kFilters) {
        const FilterSampler sampler(f);
        const double ratio = running_integral(f, 4096, true).back() / running_integral(f, 4096, false).back();
        const double size = ratio * ratio;
        Random random(3);
        double sum = 0;
        for (int i = 0; i < kCount; ++i) {
            Vec2 u;
            u.x = random.unit_float(), u.y = random.unit_float();
            const FilterSample s = sampler.sample(u);
            EXPECT_NEAR(std::fabs(s.weight), size, 1e-6);
            const float value = sampler.evaluate(s.offset);
            // Right at a root the offset's rounding to float may have crossed it.
            if (std::fabs(value) > 1e-6f) {
                EXPECT_EQ(s.weight > 0, value > 0) << describe(f);
            }
            sum += s.weight;
        }
        // The weights are ±size with mean 1, so their variance is size² - 1; 5.5 deviations fail once in 2e7.
        const double deviation = std::sqrt((size * size - 1 + 1e-9) / kCount);
        EXPECT_NEAR(sum / kCount, 1, 5.5 * deviation + 1e-6) << describe(f);
    }
}

TEST(Filter, OffsetsAreMonotoneSymmetricAndWithinTheRadius) {
    for (const Filter& f : kFilters) {
        const FilterSampler sampler(f);
        float last = -f.radius;
        for (uint32_t i = 0; i < 1u << 24; i += 1021) {
            const float u = static_cast<float>(i) * 0x1p-24f,
                        mirrored = static_cast<float>((1u << 24) - 1 - i) * 0x1p-24f;
            const Vec2 p = sampler.sample({u, mirrored}).offset;
            EXPECT_GE(p.x, last) << describe(f);
            EXPECT_EQ(p.x, -p.y) << describe(f);
            EXPECT_LE(std::fabs(p.x), f.radius) << describe(f);
            last = p.x;
        }
        const Vec2 ends = sampler.sample({0, kOneMinusEpsilon}).offset;
        EXPECT_LE(ends.y, f.radius);
        EXPECT_GT(ends.y, 0.97f * f.radius) << describe(f);
        EXPECT_EQ(ends.x, -ends.y);
    }
}

TEST(Filter, BoxAndTentAreTheirClosedForms) {
    const FilterSampler box({FilterKind::box, 0.5f}), tent({FilterKind::tent, 1.0f});
    for (const float u : {0.0f, 0.1f, 0.25f, 0.5f, 0.9f, kOneMinusEpsilon}) {
        const double v = static_cast<double>(u) + 0x1p-25;
        EXPECT_NEAR(box.sample({u, u}).offset.x, v - 0.5, 3e-8);
        EXPECT_NEAR(tent.sample({u, u}).offset.x, v < 0.5 ? std::sqrt(2 * v) - 1 : 1 - std::sqrt(2 - 2 * v), 6e-8);
        EXPECT_EQ(box.sample({u, u}).weight, 1);
        EXPECT_EQ(tent.sample({u, u}).weight, 1);
    }
}

TEST(FilterBits, AreWhatTheyWere) {
    Hasher hasher;
    for (const Filter& f : kFilters) {
        const FilterSampler sampler(f);
        for (uint32_t i = 0; i < 1u << 24; i += 4099) {
            const FilterSample s = sampler.sample({static_cast<float>(i) * 0x1p-24f, 0.7f});
            hasher.value(s.offset.x);
            hasher.value(s.offset.y);
            hasher.value(s.weight);
        }
    }
    EXPECT_EQ(hasher.hex(), "0076d43334d5e1f04b354e071c0d8999");
}

TEST(Filter, UsualRadii) {
    EXPECT_EQ(default_filter_radius(FilterKind::box), 0.5f);
    EXPECT_EQ(default_filter_radius(FilterKind::tent), 1.0f);
    EXPECT_EQ(default_filter_radius(FilterKind::gaussian), 1.5f);
    EXPECT_EQ(default_filter_radius(FilterKind::mitchell), 2.0f);
    EXPECT_EQ(Filter{}.radius, default_filter_radius(Filter{}.kind));
}

}  // namespace
}  // namespace steradian
