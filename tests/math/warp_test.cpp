#include "math/warp.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/chi_square.h"
#include "support/random.h"

namespace steradian {
namespace {

using test::chi_square;
using test::chi_square_directions;
using test::ChiSquare;
using test::Random;

constexpr int kSamples = 400'000;

Vec2 random_point(Random& r) {
    Vec2 u;
    u.x = r.unit_float(), u.y = r.unit_float();
    return u;
}

/// `bin` maps a sample to one of `bins` bins that are equally likely.
template <class Bin>
ChiSquare equal_bins(int bins, uint64_t seed, Bin bin) {
    Random random(seed);
    std::vector<double> observed(static_cast<size_t>(bins)), expected(observed.size(), double(kSamples) / bins);
    for (int i = 0; i < kSamples; ++i) ++observed[static_cast<size_t>(bin(random_point(random)))];
    return chi_square(observed, expected);
}

int cell(double u, int cells) { return clamp_to(static_cast<int>(u * cells), 0, cells - 1); }

double turn(double y, double x) {
    const double phi = std::atan2(y, x) / (2 * std::numbers::pi);
    return phi < 0 ? phi + 1 : phi;
}

TEST(Warp, DiskIsUniform) {
    const auto result = equal_bins(16 * 32, 1, [](Vec2 u) {
        const warp::DiskPoint p = warp::disk(u);
        EXPECT_NEAR(p.x * p.x + p.y * p.y, p.radius * p.radius, 1e-15);
        EXPECT_LT(p.radius, 1);
        return cell(p.x * p.x + p.y * p.y, 16) * 32 + cell(turn(p.y, p.x), 32);
    });
    EXPECT_TRUE(result.passes()) << result;
}

/// Areas in polar coordinates of the outline: the share of the radius up to the outline, squared, and the place along
/// the outline, in corners, are both uniform and independent when points are uniform.
TEST(Warp, PolygonIsUniform) {
    for (const uint32_t corners : {3u, 4u, 5u, 6u, 9u, 64u}) {
        const double step = 2 * std::numbers::pi / corners, apothem = std::cos(step / 2);
        const auto result = equal_bins(16 * 48, corners, [&](Vec2 u) {
            const warp::DiskPoint p = warp::polygon(u, corners);
            EXPECT_NEAR(std::sqrt(p.x * p.x + p.y * p.y), p.radius, 1e-15);
            const double around = turn(p.y, p.x) * corners, side = std::floor(around);
            const double from_middle = (around - side - 0.5) * step;
            const double share = p.radius * std::cos(from_middle) / apothem;
            EXPECT_LT(share, 1);
            const double along = side + 0.5 + std::tan(from_middle) / std::tan(step / 2) / 2;
            return cell(share * share, 16) * 48 + cell(along / corners, 48);
        });
        EXPECT_TRUE(result.passes()) << corners << " corners: " << result;
    }
}

TEST(Warp, PolygonHasItsFirstCornerToTheRight) {
    // The middle of the square's right side is angle 0; all but half a cell of the way outwards.
    const warp::DiskPoint corner = warp::polygon({kOneMinusEpsilon, 0.5f}, 5);
    EXPECT_NEAR(corner.x, 1, 1e-6);
    EXPECT_NEAR(corner.y, 0, 1e-6);
    // A quarter of a turn on a square is its second corner.
    const warp::DiskPoint top = warp::polygon({0.5f, kOneMinusEpsilon}, 4);
    EXPECT_NEAR(top.x, 0, 1e-6);
    EXPECT_NEAR(top.y, 1, 1e-6);
}

TEST(Warp, DiskKeepsNeighboursTogether) {
    // The stretch of Shirley and Chiu's map: 2 across the rings, at most π/2 along them. So points 2^-10 apart stay
    // within 2^-10 · √(2² + (π/2)²) < 2^-10 · 2.6, also over the four seams.
    Random random(2);
    constexpr float kStep = 0x1p-10f;
    for (int i = 0; i < 100'000; ++i) {
        const Vec2 u = random_point(random);
        if (u.x + kStep >= 1) continue;
        const warp::DiskPoint a = warp::disk(u), b = warp::disk({u.x + kStep, u.y});
        EXPECT_LT(std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)), kStep * 2.6);
    }
}

template <class Warp, class Pdf>
void expect_directions(uint64_t seed, Warp direction, Pdf pdf) {
    Random random(seed);
    const auto result = chi_square_directions(
        [&](uint64_t) {
            const Vec3d v = direction(random_point(random));
            EXPECT_NEAR(length(v), 1, 1e-15 * 4);
            return std::optional<Vec3>(Vec3(v));
        },
        pdf, kSamples, 16, 32);
    EXPECT_TRUE(result.passes()) << result;
}

TEST(Warp, CosineHemisphereHasItsDensity) {
    expect_directions(3, warp::cosine_hemisphere, [](Vec3 v) { return warp::cosine_hemisphere_pdf(v.z); });
}

TEST(Warp, HemisphereHasItsDensity) {
    expect_directions(4, warp::hemisphere, [](Vec3 v) { return v.z > 0 ? warp::kHemispherePdf : 0; });
}

TEST(Warp, SphereHasItsDensity) {
    expect_directions(5, warp::sphere, [](Vec3) { return warp::kSpherePdf; });
}

TEST(Warp, ConeHasItsDensity) {
    // 1 - cos θ = 3/8 ends at a border of the 16 bands.
    expect_directions(
        6, [](Vec2 u) { return warp::cone(u, 0.375); },
        [](Vec3 v) { return v.z > 0.625f ? warp::cone_pdf(0.375) : 0; });
}

TEST(Warp, NarrowConesKeepTheirDigits) {
    // The sun's disk, and far narrower ones, whose cosine rounds to 1.
    for (const double angle : {4.65e-3, 1e-6, 1e-9, 1e-12}) {
        const double limit = warp::one_minus_cos(angle * angle);
        EXPECT_NEAR(limit / (angle * angle / 2), 1, angle * angle);
        const auto result = equal_bins(16 * 32, 7, [&](Vec2 u) {
            const Vec3d v = warp::cone(u, limit);
            const double squared_sine = v.x * v.x + v.y * v.y;
            return cell(warp::one_minus_cos(squared_sine) / limit, 16) * 32 + cell(turn(v.y, v.x), 32);
        });
        EXPECT_TRUE(result.passes()) << angle << ": " << result;
    }
}

TEST(Warp, OneMinusCosIsExactAtBothEnds) {
    EXPECT_EQ(warp::one_minus_cos(0), 0);
    EXPECT_EQ(warp::one_minus_cos(1), 1);
    EXPECT_NEAR(warp::one_minus_cos(0.75), 0.5, 1e-16);
}

TEST(Warp, TriangleIsUniform) {
    // 16² small triangles of equal area: the two halves of each parallelogram of a grid in the weights.
    constexpr int kSide = 16;
    const auto result = equal_bins(kSide * kSide, 8, [](Vec2 u) {
        const warp::TrianglePoint p = warp::triangle(u);
        EXPECT_GT(p.b1, 0);
        EXPECT_GT(p.b2, 0);
        EXPECT_LT(p.b1 + p.b2, 1);
        const int i = cell(p.b1, kSide), j = cell(p.b2, kSide);
        const bool upper = p.b1 * kSide - i + p.b2 * kSide - j > 1;
        // Row i holds 2 (kSide - i) - 1 triangles and starts after those of the rows before.
        return i * (2 * kSide - i) + 2 * j + (upper ? 1 : 0);
    });
    EXPECT_TRUE(result.passes()) << result;
}

}  // namespace
}  // namespace steradian
