#include "accel/triangle.h"

#include <gtest/gtest.h>

#include <array>

#include "accel/accel.h"
#include "random.h"
#include "support/support.h"

namespace steradian::test {
namespace {

bool test(const Ray& in, Vec3 a, Vec3 b, Vec3 c, TriangleCandidate& out) {
    Ray ray;
    return canonical(in, ray) && intersect_triangle(TriangleRay(ray), a, b, c, out);
}
bool test(const Ray& in, Vec3 a, Vec3 b, Vec3 c) {
    TriangleCandidate ignored;
    return test(in, a, b, c, ignored);
}

constexpr Vec3 kA{0, 0, 0}, kB{1, 0, 0}, kC{0, 1, 0};
Ray down(float x, float y) { return {{x, y, 2}, 0, {0, 0, -1}, kInfinity}; }

TEST(Triangle, BarycentricsAndDistance) {
    TriangleCandidate c;
    ASSERT_TRUE(test(down(0.25f, 0.5f), kA, kB, kC, c));
    EXPECT_EQ(c.t, 2);
    EXPECT_EQ(c.u, 0.25f);
    EXPECT_EQ(c.v, 0.5f);
    // t counts in lengths of d; both sides are hit.
    ASSERT_TRUE(test({{0.25f, 0.5f, -2}, 0, {0, 0, 8}, kInfinity}, kA, kB, kC, c));
    EXPECT_EQ(c.t, 0.25f);
    EXPECT_EQ(c.u, 0.25f);
    EXPECT_EQ(c.v, 0.5f);
}

TEST(Triangle, EdgesAndVerticesAreInside) {
    for (const auto& [x, y] : {std::pair{0.f, 0.f}, {1.f, 0.f}, {0.f, 1.f}, {0.5f, 0.f}, {0.f, 0.5f}, {0.5f, 0.5f}})
        for (const auto& t : {std::array{kA, kB, kC}, std::array{kB, kC, kA}, std::array{kC, kB, kA}})
            EXPECT_TRUE(test(down(x, y), t[0], t[1], t[2])) << x << " " << y;
    const float tiny = 1e-30f, over = std::nextafter(1.0f, 2.0f);
    EXPECT_FALSE(test(down(-tiny, 0.5f), kA, kB, kC));
    EXPECT_FALSE(test(down(0.5f, -tiny), kA, kB, kC));
    EXPECT_FALSE(test(down(over, 0), kA, kB, kC));
    EXPECT_FALSE(test(down(0.5f, std::nextafter(0.5f, 1.0f)), kA, kB, kC));
}

TEST(Triangle, NeverWithoutAreaOrEdgeOn) {
    EXPECT_FALSE(test(down(0, 0), kA, kA, kA));
    EXPECT_FALSE(test(down(0.5f, 0), kA, kB, kB));
    EXPECT_FALSE(test(down(0.5f, 0), kA, kB, {0.5f, 0, 0}));
    EXPECT_FALSE(test({{-1, 0.25f, 0}, 0, {1, 0, 0}, kInfinity}, kA, kB, kC));
    EXPECT_FALSE(test({{-1, 0, 0}, 0, {1, 0, 0}, kInfinity}, kA, kB, kC));
}

TEST(Triangle, RangeIsInclusive) {
    const std::array<Vec3, 3> positions{kA, kB, kC};
    const std::array<uint32_t, 3> indices{0, 1, 2};
    const Geometry geometry = TriangleGeometry{positions, indices};
    const GeometryInstance instance;
    const Result<Accel> accel = Accel::build({&geometry, 1}, {&instance, 1});
    ASSERT_TRUE(accel);
    Ray ray = down(0.25f, 0.25f);
    const auto hit = [&](float tmin, float tmax) {
        ray.tmin = tmin, ray.tmax = tmax;
        EXPECT_EQ(accel->occluded(ray), accel->intersect(ray).found());
        return accel->intersect(ray).found();
    };
    EXPECT_TRUE(hit(0, 2));
    EXPECT_TRUE(hit(2, 2));
    EXPECT_TRUE(hit(2, kInfinity));
    EXPECT_FALSE(hit(0, std::nextafter(2.0f, 0.0f)));
    EXPECT_FALSE(hit(std::nextafter(2.0f, 3.0f), kInfinity));
    ray.o.z = 0;  // on the surface: t is 0, also for a tmin that counts as 0
    EXPECT_TRUE(hit(0, 1));
    EXPECT_TRUE(hit(-1, 1));
    EXPECT_TRUE(hit(0, 0));
    ray.o.z = -1;
    EXPECT_FALSE(hit(0, kInfinity));
    EXPECT_FALSE(hit(-kInfinity, kInfinity));
}

__extension__ typedef __int128 Wide;
struct Int3 {
    int64_t x, y, z;
    explicit operator Vec3() const { return {float(x), float(y), float(z)}; }
};
Wide volume(Int3 d, Int3 p, Int3 q) {
    return Wide(d.x) * (p.y * q.z - p.z * q.y) + Wide(d.y) * (p.z * q.x - p.x * q.z) +
           Wide(d.z) * (p.x * q.y - p.y * q.x);
}

// Coordinates are integers and d.z is a power of two and the largest, so the shear is exact and the answer must be what
// exact integer arithmetic says, hits on edges and vertices included.
TEST(Triangle, ExactOnIntegers) {
    Random random(1);
    size_t hits = 0, on_edge = 0;
    const auto integer = [&](int64_t half) { return int64_t(random.below(uint32_t(2 * half + 1))) - half; };
    for (size_t i = 0; i < by_tier<size_t>(2'000'000, 20'000'000); ++i) {
        const int64_t half = random.below(2) ? 4 : 1000;
        Int3 p[3], d{integer(8), integer(8), random.below(2) ? 8 : -8};
        for (Int3& v : p) v = {integer(half), integer(half), integer(half)};
        const Int3 o{integer(half), integer(half), integer(half)};
        Int3 r[3];
        for (int k = 0; k < 3; ++k) r[k] = {p[k].x - o.x, p[k].y - o.y, p[k].z - o.z};
        const Wide u = volume(d, r[2], r[1]), v = volume(d, r[0], r[2]), w = volume(d, r[1], r[0]);
        const bool expected = u + v + w != 0 && ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0));
        TriangleCandidate c{};
        const bool found = test({Vec3(o), 0, Vec3(d), kInfinity}, Vec3(p[0]), Vec3(p[1]), Vec3(p[2]), c);
        ASSERT_EQ(found, expected);
        if (!found) continue;
        ++hits;
        on_edge += u == 0 || v == 0 || w == 0;
        const long double sum = static_cast<long double>(u + v + w);
        const long double t = (static_cast<long double>(u) * r[0].z + static_cast<long double>(v) * r[1].z +
                               static_cast<long double>(w) * r[2].z) /
                              (sum * d.z);
        ASSERT_NEAR(c.t, t, 1e-6 * std::fabs(double(t)) + 1e-9);
        ASSERT_NEAR(c.u, v / sum, 1e-7);
        ASSERT_NEAR(c.v, w / sum, 1e-7);
        ASSERT_TRUE(c.u >= 0 && c.v >= 0 && double(c.u) + double(c.v) <= 1);
    }
    EXPECT_GT(hits, 100'000u);
    EXPECT_GT(on_edge, 10'000u);
}

// The point that u and v give and the point that t gives are the same one.
TEST(Triangle, SolvesTheEquation) {
    Random random(2);
    size_t hits = 0;
    for (int i = 0; i < 300'000; ++i) {
        const double scale = random.decades(-15, 14);
        const auto s = static_cast<float>(scale);
        const Vec3 a = random.in_cube(1) * s, b = random.in_cube(1) * s, c = random.in_cube(1) * s;
        Ray ray{random.in_cube(3) * s, 0, {}, kInfinity};
        ray.d = Vec3((Vec3d(a) + Vec3d(b) + Vec3d(c)) * (1.0 / 3)) + random.in_cube(0.3) * s - ray.o;
        TriangleCandidate found;
        if (!test(ray, a, b, c, found)) continue;
        ++hits;
        ASSERT_TRUE(found.u >= 0 && found.v >= 0 && double(found.u) + double(found.v) <= 1);
        const double u = found.u, v = found.v;
        const Vec3d from_weights = Vec3d(a) * (1 - u - v) + Vec3d(b) * u + Vec3d(c) * v;
        const Vec3d from_t = Vec3d(ray.o) + Vec3d(ray.d) * double(found.t);
        // u and v are off by 2^-25 of the edges, t by 2^-25 of itself, both of sizes below 10 scale.
        ASSERT_LE(length(from_weights - from_t), 1e-6 * scale);
    }
    EXPECT_GT(hits, 50'000u);
}

// A sign that is exact where the difference of the rounded products is not.
TEST(Triangle, DifferenceOfProductsHasTheRightSign) {
    Random random(3);
    for (int i = 0; i < 1'000'000; ++i) {
        const auto integer = [&] { return int64_t(random.bits() >> 12); };  // 52 bits: exact in double
        const int64_t a = integer(), b = integer(), c = a + int64_t(random.below(3)) - 1;
        const int64_t d = random.below(2) ? b : b + int64_t(random.below(3)) - 1;
        const Wide exact = Wide(a) * b - Wide(c) * d;
        const double found = detail::difference_of_products(double(a), double(b), double(c), double(d));
        ASSERT_EQ(found > 0, exact > 0);
        ASSERT_EQ(found < 0, exact < 0);
    }
}

}  // namespace
}  // namespace steradian::test
