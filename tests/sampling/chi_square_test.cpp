// The test of the test: known quantiles, and that wrong densities are refused.
#include "support/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/random.h"

namespace steradian::test {
namespace {

TEST(ChiSquare, TailsAreThoseOfTheTables) {
    // Two degrees of freedom: e^(-x/2). One: erfc(√(x/2)).
    for (const double x : {0.0, 0.1, 1.0, 2.0, 7.0, 30.0, 200.0}) {
        EXPECT_NEAR(chi_square_upper_tail(x, 2) / std::exp(-x / 2), 1, 1e-12);
        EXPECT_NEAR(chi_square_upper_tail(x, 1) / std::erfc(std::sqrt(x / 2)), 1, 1e-11);
    }
    // Four: e^(-x/2) (1 + x/2).
    EXPECT_NEAR(chi_square_upper_tail(9, 4), std::exp(-4.5) * 5.5, 1e-14);
    // Abramowitz & Stegun, table 26.8: the 5 % points.
    EXPECT_NEAR(chi_square_upper_tail(11.0705, 5), 0.05, 1e-6);
    EXPECT_NEAR(chi_square_upper_tail(124.342, 100), 0.05, 1e-5);
    // Many: nearly normal, the median is close to dof - 2/3.
    EXPECT_NEAR(chi_square_upper_tail(100000 - 2.0 / 3, 100000), 0.5, 1e-4);
}

TEST(ChiSquare, StatisticIsPearsons) {
    const std::vector<double> observed{10, 20, 30}, expected{20, 20, 20};
    const ChiSquare result = chi_square(observed, expected);
    EXPECT_DOUBLE_EQ(result.statistic, 10);
    EXPECT_EQ(result.dof, 2);
    EXPECT_NEAR(result.p_value, std::exp(-5.0), 1e-15);
}

TEST(ChiSquare, SmallBinsArePooled) {
    const std::vector<double> observed{1, 2, 0, 47, 50}, expected{2, 2, 2, 44, 50};
    const ChiSquare result = chi_square(observed, expected);
    EXPECT_EQ(result.dof, 2);
    EXPECT_NEAR(result.statistic, 9.0 / 6 + 9.0 / 44, 1e-12);
}

TEST(ChiSquare, ImpossibleObservationsAreRefused) {
    const auto p = [](std::vector<double> o, std::vector<double> e) { return chi_square(o, e).p_value; };
    EXPECT_EQ(p({1, 99}, {0, 100}), 0);
    EXPECT_EQ(p({50, 49}, {50, 50}), 0);
    EXPECT_EQ(p({50, 50}, {50, NAN}), 0);
    EXPECT_EQ(p({50, 50}, {100}), 0);
    EXPECT_EQ(p({0, 100}, {0, 100}), 1);
}

TEST(ChiSquare, PValuesOfRightDensitiesAreUniform) {
    // 400 p-values in ten classes: a chi-square test of the chi-square test.
    Random random(1);
    std::vector<double> classes(10), forty(10, 40.0);
    for (int run = 0; run < 400; ++run) {
        std::vector<double> observed(20), expected(20, 50.0);
        for (int i = 0; i < 1000; ++i) ++observed[static_cast<size_t>(random.unit() * 20)];
        ++classes[static_cast<size_t>(std::min(9.0, chi_square(observed, expected).p_value * 10))];
    }
    const ChiSquare result = chi_square(classes, forty);
    EXPECT_TRUE(result.passes()) << result;
}

/// Uniform directions on the sphere, of which the lower `missing` (in z) are not returned.
std::optional<Vec3> uniform_direction(Random& random, double missing) {
    const double z = random.between(-1, 1), phi = random.between(0, 2 * std::numbers::pi);
    const double r = std::sqrt(1 - z * z);
    if (z < -1 + 2 * missing) return std::nullopt;
    return Vec3{static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z)};
}

TEST(ChiSquareDirections, AcceptsTheRightDensityAndRefusesOthers) {
    constexpr double kUniform = 1 / (4 * std::numbers::pi);
    constexpr uint64_t kCount = 100'000;
    Random random(2);
    const auto whole = [&](uint64_t) { return uniform_direction(random, 0); };
    const auto part = [&](uint64_t) { return uniform_direction(random, 0.25); };
    const auto density = [](Vec3) { return kUniform; };
    const auto part_density = [](Vec3 v) { return v.z >= -0.5f ? kUniform : 0; };
    const auto tilted = [](Vec3 v) { return kUniform * (1 + 0.05 * v.x); };
    const auto check = [](const auto& sample, const auto& pdf) {
        return chi_square_directions(sample, pdf, kCount, 8, 16);
    };
    EXPECT_TRUE(check(whole, density).passes()) << check(whole, density);
    EXPECT_TRUE(check(part, part_density).passes()) << check(part, part_density);
    EXPECT_FALSE(check(whole, tilted).passes());
    EXPECT_FALSE(check(part, density).passes());
    EXPECT_FALSE(check(whole, part_density).passes());
    EXPECT_FALSE(check(whole, [](Vec3) { return 1.01 * kUniform; }).passes());
    EXPECT_FALSE(check(whole, [](Vec3) { return 0.99 * kUniform; }).passes());
    EXPECT_FALSE(check([](uint64_t) { return std::optional<Vec3>({NAN, 0, 1}); }, density).passes());
}

}  // namespace
}  // namespace steradian::test
