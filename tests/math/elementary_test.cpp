// The elementary functions against the C library in long double, which has at least 11 more bits.
#include "math/elementary.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "support/random.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::by_tier;
using test::Random;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();

struct Arguments {
    double x = 0, y = 0;
};
using Generator = std::function<Arguments(Random&)>;
using Function = std::function<double(Arguments)>;
using Reference = std::function<long double(Arguments)>;

/// |got - exact| in units in the last place of the double nearest to `exact`.
double error_in_ulp(double got, long double exact) {
    const double nearest = static_cast<double>(exact);
    if (std::isnan(got) || std::isnan(nearest)) return std::isnan(got) && std::isnan(nearest) ? 0 : kInf;
    if (std::isinf(got) || std::isinf(nearest)) {
        // Overflow: the largest number and infinity are neighbours, one unit apart.
        const double largest = std::numeric_limits<double>::max();
        return got == nearest ? 0 : std::fabs(got) >= largest && std::fabs(nearest) >= largest ? 1 : kInf;
    }
    int exponent;
    std::frexp(nearest, &exponent);
    const double ulp = std::ldexp(1.0, std::max(exponent - 53, -1074));
    return static_cast<double>(std::fabs(static_cast<long double>(got) - exact) / ulp);
}

// The references are good to 2^-10 of a double's unit in the last place.
constexpr double kReferenceError = 0x1p-10;

void expect_accurate(const char* what, double bound, const Generator& generate, const Function& ours,
                     const Reference& reference) {
    Random random(7);
    const int count = by_tier(150'000, 5'000'000);
    double worst = 0;
    Arguments where;
    for (int i = 0; i < count; ++i) {
        const Arguments a = generate(random);
        const double error = error_in_ulp(ours(a), reference(a));
        if (error > worst) worst = error, where = a;
    }
    EXPECT_LT(worst, bound + kReferenceError) << what << " at " << std::hexfloat << where.x << ", " << where.y;
}

Generator uniform(double a, double b) {
    return [=](Random& r) { return Arguments{r.between(a, b)}; };
}

/// Every exponent from that of 2^low up to below that of 2^high is equally likely, either sign.
Generator any_exponent(int low, int high) {
    return [=](Random& r) {
        const double m = 1 + r.unit();
        const int e = low + static_cast<int>(r.next() % static_cast<uint64_t>(high - low));
        return Arguments{std::ldexp(r.next() & 1 ? m : -m, e)};
    };
}

Generator positive(Generator g) {
    return [=](Random& r) { return Arguments{std::fabs(g(r).x)}; };
}

/// Doubles next to multiples of π/2, where the reduction cancels most.
Generator near_quadrants(int bits) {
    return [=](Random& r) {
        const double n = static_cast<double>(r.next() >> (64 - bits));
        double x = static_cast<double>(static_cast<long double>(n) * std::numbers::pi_v<long double> / 2);
        for (int i = static_cast<int>(r.next() % 3); i-- > 0;) x = std::nextafter(x, kInf);
        return Arguments{x};
    };
}

/// 1 ± a few units in the last place and everything between that and 1/2 or 2.
Generator near_one() {
    return [=](Random& r) {
        const double d = std::ldexp(1 + r.unit(), -1 - static_cast<int>(r.next() % 53));
        return Arguments{r.next() & 1 ? 1 + d : 1 - d / 2};
    };
}

#define STERADIAN_UNARY(name) \
    [](Arguments a) { return math::name(a.x); }, [](Arguments a) { return name##l(static_cast<long double>(a.x)); }

TEST(Elementary, SineIsAccurate) {
    expect_accurate("a few turns", 1, uniform(-10, 10), STERADIAN_UNARY(sin));
    expect_accurate("a million", 1, uniform(-1e6, 1e6), STERADIAN_UNARY(sin));
    expect_accurate("all sizes", 1, any_exponent(-1074, 52), STERADIAN_UNARY(sin));
    expect_accurate("near quadrants", 1, near_quadrants(19), STERADIAN_UNARY(sin));
    expect_accurate("near far quadrants", 1, near_quadrants(50), STERADIAN_UNARY(sin));
}

TEST(Elementary, CosineIsAccurate) {
    expect_accurate("a few turns", 1, uniform(-10, 10), STERADIAN_UNARY(cos));
    expect_accurate("a million", 1, uniform(-1e6, 1e6), STERADIAN_UNARY(cos));
    expect_accurate("all sizes", 1, any_exponent(-1074, 52), STERADIAN_UNARY(cos));
    expect_accurate("near quadrants", 1, near_quadrants(19), STERADIAN_UNARY(cos));
    expect_accurate("near far quadrants", 1, near_quadrants(50), STERADIAN_UNARY(cos));
}

TEST(Elementary, TangentIsAccurate) {
    expect_accurate("a few turns", 2, uniform(-10, 10), STERADIAN_UNARY(tan));
    expect_accurate("a million", 2, uniform(-1e6, 1e6), STERADIAN_UNARY(tan));
    expect_accurate("all sizes", 2, any_exponent(-1074, 52), STERADIAN_UNARY(tan));
    expect_accurate("near quadrants", 2, near_quadrants(19), STERADIAN_UNARY(tan));
    expect_accurate("near far quadrants", 2, near_quadrants(50), STERADIAN_UNARY(tan));
}

TEST(Elementary, ExponentialIsAccurate) {
    expect_accurate("all results", 1, uniform(-746, 710), STERADIAN_UNARY(exp));
    expect_accurate("denormal results", 1, uniform(-746, -707), STERADIAN_UNARY(exp));
    expect_accurate("near overflow", 1, uniform(709.7, 709.8), STERADIAN_UNARY(exp));
    expect_accurate("small", 1, uniform(-1, 1), STERADIAN_UNARY(exp));
    expect_accurate("all sizes", 1, any_exponent(-1074, 10), STERADIAN_UNARY(exp));
}

TEST(Elementary, LogarithmsAreAccurate) {
    expect_accurate("all sizes", 1, positive(any_exponent(-1074, 1024)), STERADIAN_UNARY(log));
    expect_accurate("near one", 1, near_one(), STERADIAN_UNARY(log));
    expect_accurate("all sizes, base 2", 1, positive(any_exponent(-1074, 1024)), STERADIAN_UNARY(log2));
    expect_accurate("near one, base 2", 1, near_one(), STERADIAN_UNARY(log2));
}

TEST(Elementary, InverseSineAndCosineAreAccurate) {
    const Generator near_ends = [](Random& r) {
        const double x = 1 - std::ldexp(r.unit(), -static_cast<int>(r.next() % 53));
        return Arguments{r.next() & 1 ? x : -x};
    };
    expect_accurate("asin", 1, uniform(-1, 1), STERADIAN_UNARY(asin));
    expect_accurate("asin, all sizes", 1, any_exponent(-1074, 0), STERADIAN_UNARY(asin));
    expect_accurate("asin, near ±1", 1, near_ends, STERADIAN_UNARY(asin));
    expect_accurate("acos", 1, uniform(-1, 1), STERADIAN_UNARY(acos));
    expect_accurate("acos, all sizes", 1, any_exponent(-1074, 0), STERADIAN_UNARY(acos));
    expect_accurate("acos, near ±1", 1, near_ends, STERADIAN_UNARY(acos));
}

TEST(Elementary, ArctangentOfTwoIsAccurate) {
    const Function ours = [](Arguments a) { return math::atan2(a.y, a.x); };
    const Reference reference = [](Arguments a) {
        return atan2l(static_cast<long double>(a.y), static_cast<long double>(a.x));
    };
    const Generator far_apart = [g = any_exponent(-1074, 1024)](Random& r) {
        const double x = g(r).x;
        return Arguments{x, g(r).x};
    };
    const Generator alike = [g = any_exponent(-1074, 1020)](Random& r) {
        const double x = g(r).x, ratio = r.between(-9, 9);
        return Arguments{x, x * ratio};
    };
    expect_accurate("any", 1, far_apart, ours, reference);
    expect_accurate("alike", 1, alike, ours, reference);
    expect_accurate(
        "square", 1,
        [](Random& r) {
            const double x = r.between(-1, 1);
            return Arguments{x, r.between(-1, 1)};
        },
        ours, reference);
}

TEST(Elementary, PowersAreAccurate) {
    const Function ours = [](Arguments a) { return math::pow(a.x, a.y); };
    const Reference reference = [](Arguments a) {
        return powl(static_cast<long double>(a.x), static_cast<long double>(a.y));
    };
    // Exponents chosen so that the results cover every size, overflow and denormal ones too.
    const auto any_result = [](Generator g) {
        return [=](Random& r) {
            const double x = std::fabs(g(r).x);
            return Arguments{x, r.between(-747, 711) / std::log(x)};
        };
    };
    expect_accurate("any", 1, any_result(any_exponent(-1074, 1024)), ours, reference);
    expect_accurate("bases near one", 1, any_result(near_one()), ours, reference);
    expect_accurate(
        "display gamma", 1,
        [](Random& r) {
            return Arguments{r.unit() + 1e-9, 2.4};
        },
        ours, reference);
    expect_accurate(
        "whole exponents", 1,
        [](Random& r) {
            const double x = r.between(-20, 20);
            return Arguments{x, static_cast<double>(r.next() % 401) - 200};
        },
        ours, reference);
}

TEST(Elementary, FloatVersionsRoundOnce) {
    Random random(3);
    for (int i = 0; i < 100'000; ++i) {
        const float x = static_cast<float>(random.between(-100, 100));
        EXPECT_EQ(math::sin(x), static_cast<float>(math::sin(static_cast<double>(x))));
        // Correctly rounded unless the exact value lies within one double rounding of the middle of two floats.
        EXPECT_NEAR(math::exp(x * 0.8f), static_cast<float>(expl(static_cast<long double>(x * 0.8f))),
                    math::exp(x * 0.8f) * 0x1p-24f);
    }
}

/// Same number, sign of zero included; NaN equals NaN.
::testing::AssertionResult same(double got, double want) {
    if (std::isnan(got) && std::isnan(want)) return ::testing::AssertionSuccess();
    if (std::bit_cast<uint64_t>(got) == std::bit_cast<uint64_t>(want)) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << got << " instead of " << want;
}

TEST(Elementary, SpecialValuesOfOneArgument) {
    for (const auto& f : {+[](double x) { return math::sin(x); }, +[](double x) { return math::tan(x); },
                          +[](double x) { return math::asin(x); }}) {
        EXPECT_TRUE(same(f(0.0), 0.0));
        EXPECT_TRUE(same(f(-0.0), -0.0));
        EXPECT_TRUE(same(f(kTiny), kTiny));
        EXPECT_TRUE(same(f(-kTiny), -kTiny));
        for (const double x : {kInf, -kInf, kNan}) EXPECT_TRUE(same(f(x), kNan));
    }
    EXPECT_TRUE(same(math::cos(0.0), 1));
    EXPECT_TRUE(same(math::cos(-0.0), 1));
    for (const double x : {kInf, -kInf, kNan, 0x1.0000000000001p52}) EXPECT_TRUE(same(math::cos(x), kNan));
    EXPECT_TRUE(same(math::exp(0.0), 1));
    EXPECT_TRUE(same(math::exp(-0.0), 1));
    EXPECT_TRUE(same(math::exp(kInf), kInf));
    EXPECT_TRUE(same(math::exp(-kInf), 0));
    EXPECT_TRUE(same(math::exp(710.0), kInf));
    EXPECT_TRUE(same(math::exp(-746.0), 0));
    EXPECT_TRUE(same(math::exp(-745.0), kTiny));
    EXPECT_TRUE(same(math::exp(kNan), kNan));
    for (const auto& f : {+[](double x) { return math::log(x); }, +[](double x) { return math::log2(x); }}) {
        EXPECT_TRUE(same(f(1), 0.0));
        EXPECT_TRUE(same(f(0.0), -kInf));
        EXPECT_TRUE(same(f(-0.0), -kInf));
        EXPECT_TRUE(same(f(kInf), kInf));
        for (const double x : {-kTiny, -1.0, -kInf, kNan}) EXPECT_TRUE(same(f(x), kNan));
    }
    EXPECT_TRUE(same(math::acos(1.0), 0.0));
    EXPECT_TRUE(same(math::acos(-1.0), std::numbers::pi));
    EXPECT_TRUE(same(math::acos(0.0), std::numbers::pi / 2));
    EXPECT_TRUE(same(math::asin(1.0), std::numbers::pi / 2));
    EXPECT_TRUE(same(math::asin(-1.0), -std::numbers::pi / 2));
    for (const double x : {1.0000000000000002, -1.0000000000000002, kInf, -kInf, kNan}) {
        EXPECT_TRUE(same(math::asin(x), kNan));
        EXPECT_TRUE(same(math::acos(x), kNan));
    }
}

// Every pair of these through both libraries: C's Annex F says what must come out, glibc does it.
constexpr double kNotable[] = {0.0,
                               kTiny,
                               0x1p-1022,
                               0.5,
                               1,
                               1.5,
                               2,
                               3,
                               4,
                               5,
                               0x1p52,
                               0x1p53,
                               0x1.0000000000001p53,
                               1e300,
                               std::numeric_limits<double>::max(),
                               kInf,
                               kNan};

TEST(Elementary, SpecialValuesOfTwoArguments) {
    for (const double a : kNotable)
        for (const double b : kNotable)
            for (const double x : {a, -a})
                for (const double y : {b, -b}) {
                    const double power = std::pow(x, y), angle = std::atan2(x, y);
                    const double our_power = math::pow(x, y), our_angle = math::atan2(x, y);
                    if (std::isfinite(power) && power != 0)
                        EXPECT_LT(error_in_ulp(our_power, power), 1.5) << "pow " << x << ", " << y;
                    else
                        EXPECT_TRUE(same(our_power, power)) << "pow " << x << ", " << y;
                    if (std::isfinite(angle) && angle != 0)
                        EXPECT_LT(error_in_ulp(our_angle, angle), 1.5) << "atan2 " << x << ", " << y;
                    else
                        EXPECT_TRUE(same(our_angle, angle)) << "atan2 " << x << ", " << y;
                }
}

TEST(Elementary, ExactResultsAreExact) {
    for (int n = -1074; n <= 1023; ++n) {
        EXPECT_EQ(math::pow(2.0, static_cast<double>(n)), std::ldexp(1.0, n)) << n;
        EXPECT_EQ(math::log2(std::ldexp(1.0, n)), n);
    }
    for (int n = 1; n < 50; ++n) {
        const double x = n;
        EXPECT_EQ(math::pow(x, 3.0), x * x * x);
        EXPECT_EQ(math::pow(-x, 3.0), -x * x * x);
        EXPECT_EQ(math::pow(x * x, 0.5), x);
    }
}

TEST(Elementary, SymmetriesHoldToTheBit) {
    Random random(5);
    for (int i = 0; i < 100'000; ++i) {
        const double x = random.between(-100, 100), y = random.between(-100, 100), c = random.between(-1, 1);
        EXPECT_EQ(math::sin(-x), -math::sin(x));
        EXPECT_EQ(math::cos(-x), math::cos(x));
        EXPECT_EQ(math::tan(-x), -math::tan(x));
        EXPECT_EQ(math::asin(-c), -math::asin(c));
        EXPECT_EQ(math::atan2(-y, x), -math::atan2(y, x));
    }
}

TEST(Elementary, IdentitiesHoldToRounding) {
    Random random(6);
    for (int i = 0; i < 100'000; ++i) {
        const double x = random.between(-1e4, 1e4), c = random.between(-1, 1);
        const double s = math::sin(x), k = math::cos(x);
        // Each square is off by at most 2 · 1 ulp of the factor plus a rounding: below 2^-52 (2 s² + 2 k² + 1).
        EXPECT_NEAR(s * s + k * k, 1, 3 * 0x1p-52);
        EXPECT_NEAR(math::asin(c) + math::acos(c), std::numbers::pi / 2, 4 * 0x1p-53);
    }
}

}  // namespace
}  // namespace steradian
