// Spheres, rectangles and disks by themselves.
#include <gtest/gtest.h>

#include "accel/planar.h"
#include "accel/sphere.h"
#include "random.h"

namespace steradian::test {
namespace {

bool inside(const Box& box, const long double p[3]) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(p[axis] >= box.lo[axis] && p[axis] <= box.hi[axis])) return false;
    return true;
}

TEST(Sphere, BothRoots) {
    const SphereGeometry unit{{0, 0, 0}, 1};
    SphereCandidates c = intersect_sphere({{-3, 0, 0}, 0, {2, 0, 0}, kInfinity}, unit);
    ASSERT_EQ(c.count, 2);
    EXPECT_EQ(c.t[0], 1);
    EXPECT_EQ(c.t[1], 2);
    c = intersect_sphere({{0, 0, 0}, 0, {0, 0, -1}, kInfinity}, unit);
    ASSERT_EQ(c.count, 2);
    EXPECT_EQ(c.t[0], -1);
    EXPECT_EQ(c.t[1], 1);
    c = intersect_sphere({{1, 0, 0}, 0, {-1, 0, 0}, kInfinity}, unit);  // from the surface
    ASSERT_EQ(c.count, 2);
    EXPECT_EQ(c.t[0], 0);
    EXPECT_EQ(c.t[1], 2);
    c = intersect_sphere({{-3, 1, 0}, 0, {1, 0, 0}, kInfinity}, unit);  // touching
    ASSERT_EQ(c.count, 1);
    EXPECT_EQ(c.t[0], 3);
    EXPECT_EQ(intersect_sphere({{-3, 1.0000001f, 0}, 0, {1, 0, 0}, kInfinity}, unit).count, 0);
    EXPECT_EQ(intersect_sphere({{-3, 0, 0}, 0, {1, 0, 0}, kInfinity}, {{0, 0, 0}, 0}).count, 0);
}

// Small and far away is where the school formula fails in float: 1e-3 seen from 1e4 has (b² - ac) / b² of 1e-14.
TEST(Sphere, SmallAndFarAway) {
    Random random(1);
    for (int i = 0; i < 100'000; ++i) {
        const double r = random.decades(-3, 3);
        const Vec3 center = random.in_cube(1e3);
        const Vec3 direction = random.direction();
        Ray ray{Vec3(Vec3d(center) - Vec3d(direction) * (r * random.decades(0.1, 6))), 0, {}, kInfinity};
        ray.d = Vec3(Vec3d(center) + Vec3d(random.direction()) * (r * random.uniform(0, 0.99)) - Vec3d(ray.o));
        const SphereGeometry sphere{center, static_cast<float>(r)};
        const SphereCandidates c = intersect_sphere(ray, sphere);
        if (c.count != 2) continue;  // d itself was rounded, far away that misses
        for (const float t : c.t) {
            long double p2 = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const long double p = (long double)(ray.o[axis]) + (long double)(t)*ray.d[axis] - center[axis];
                p2 += p * p;
            }
            const double distance = length(Vec3d(ray.d)) * std::fabs(double(t));
            // t is rounded to float once: 2^-24 of the way.
            ASSERT_NEAR(double(std::sqrt(p2)), double(sphere.radius), distance * 0x1p-23 + 1e-9 * sphere.radius);
        }
    }
}

TEST(Sphere, BoundsContainIt) {
    Random random(2);
    for (int i = 0; i < 100'000; ++i) {
        const SphereGeometry s{random.in_cube(random.decades(-3, 6)), static_cast<float>(random.decades(-9, 6))};
        const Box box = sphere_bounds(s);
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_LE(box.lo[axis], (long double)(s.center[axis]) - s.radius);
            ASSERT_GE(box.hi[axis], (long double)(s.center[axis]) + s.radius);
        }
    }
}

TEST(Rectangle, CoordinatesAndEdges) {
    const RectangleGeometry r{{0, 2, 0}, {2, 0, 0}, {0, 0, 4}};
    PlanarCandidate c;
    ASSERT_TRUE(intersect_rectangle({{1, 0, -2}, 0, {0, 0.5f, 0}, kInfinity}, r, c));
    EXPECT_EQ(c.t, 4);
    EXPECT_EQ(c.a, 0.5f);
    EXPECT_EQ(c.b, -0.5f);
    EXPECT_TRUE(intersect_rectangle({{2, 0, 4}, 0, {0, 1, 0}, kInfinity}, r, c));
    EXPECT_TRUE(intersect_rectangle({{-2, 5, 4}, 0, {0, -1, 0}, kInfinity}, r, c));
    EXPECT_FALSE(intersect_rectangle({{2.000001f, 0, 4}, 0, {0, 1, 0}, kInfinity}, r, c));
    EXPECT_FALSE(intersect_rectangle({{2, 0, -4.000001f}, 0, {0, 1, 0}, kInfinity}, r, c));
    EXPECT_FALSE(intersect_rectangle({{0, 0, 0}, 0, {1, 0, 0}, kInfinity}, r, c));
    EXPECT_FALSE(intersect_rectangle({{0, 2, 0}, 0, {1, 0, 0}, kInfinity}, r, c)) << "in its plane";
    const RectangleGeometry flat{{0, 0, 0}, {0.1f, 0.2f, 0.3f}, {0.3f, 0.6f, 0.90000004f}};
    EXPECT_FALSE(intersect_rectangle({{0, 0, -1}, 0, {0, 0, 1}, kInfinity}, flat, c));
}

TEST(Disk, CoordinatesAndEdges) {
    const DiskGeometry disk{{0, 2, 0}, {2, 0, 0}, {0, 0, 4}};
    PlanarCandidate c;
    ASSERT_TRUE(intersect_disk({{1, 0, -2}, 0, {0, 1, 0}, kInfinity}, disk, c));
    EXPECT_EQ(c.t, 2);
    EXPECT_EQ(c.a, 0.5f);
    EXPECT_EQ(c.b, -0.5f);
    EXPECT_TRUE(intersect_disk({{2, 0, 0}, 0, {0, 1, 0}, kInfinity}, disk, c));
    EXPECT_FALSE(intersect_disk({{2, 0, 0.01f}, 0, {0, 1, 0}, kInfinity}, disk, c));
    EXPECT_FALSE(intersect_disk({{1.5f, 0, 3}, 0, {0, 1, 0}, kInfinity}, disk, c)) << "in the rectangle only";
}

// Points from random coordinates are found again, whatever the shape's skew.
TEST(Planar, FindsItsOwnPoints) {
    Random random(3);
    for (int i = 0; i < 200'000; ++i) {
        const double scale = random.decades(-6, 6);
        const auto s = static_cast<float>(scale);
        const RectangleGeometry r{random.in_cube(10) * s, random.in_cube(1) * s, random.in_cube(1) * s};
        const Vec3d n = cross(Vec3d(r.half_u), Vec3d(r.half_v));
        if (length(n) < 0.05 * scale * scale) continue;
        const double a = random.uniform(-0.9, 0.9), b = random.uniform(-0.9, 0.9);
        const Vec3d p = Vec3d(r.center) + Vec3d(r.half_u) * a + Vec3d(r.half_v) * b;
        Ray ray{random.in_cube(10) * s, 0, {}, kInfinity};
        ray.d = Vec3(p - Vec3d(ray.o));
        if (std::fabs(dot(normalize(n), normalize(Vec3d(ray.d)))) < 0.05) continue;
        PlanarCandidate c;
        ASSERT_TRUE(intersect_rectangle(ray, r, c));
        // d is rounded to 2^-24 of 20 scale, seen at an angle of 0.05 on axes with a sine of 0.05 or so between them.
        ASSERT_NEAR(c.t, 1, 1e-3);
        ASSERT_NEAR(c.a, a, 2e-3);
        ASSERT_NEAR(c.b, b, 2e-3);
        ASSERT_EQ(intersect_disk(ray, {r.center, r.half_u, r.half_v}, c), a * a + b * b <= 1) << a << " " << b;
    }
}

TEST(Planar, BoundsContainThem) {
    Random random(4);
    for (int i = 0; i < 50'000; ++i) {
        const double scale = random.decades(-6, 6);
        const auto s = static_cast<float>(scale);
        const RectangleGeometry r{random.in_cube(100) * s, random.in_cube(1) * s, random.in_cube(1) * s};
        const Box box = rectangle_bounds(r), round = disk_bounds({r.center, r.half_u, r.half_v});
        const double angle = random.uniform(0, 6.3);
        for (int k = 0; k < 5; ++k) {
            const long double a = k < 4 ? (k & 1 ? 1 : -1) : std::cos(angle),
                              b = k < 4 ? (k & 2 ? 1 : -1) : std::sin(angle);
            long double p[3];
            for (int axis = 0; axis < 3; ++axis) p[axis] = r.center[axis] + a * r.half_u[axis] + b * r.half_v[axis];
            ASSERT_TRUE(inside(k < 4 ? box : round, p));
        }
    }
    // Flat along an axis stays exactly flat: the t of a hit is that of the plane.
    const Box flat = rectangle_bounds({{0, 1.98f, 0}, {0.25f, 0, 0}, {0, 0, 0.25f}});
    EXPECT_EQ(flat.lo.y, 1.98f);
    EXPECT_EQ(flat.hi.y, 1.98f);
}

}  // namespace
}  // namespace steradian::test
