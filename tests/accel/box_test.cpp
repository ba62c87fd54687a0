#include "accel/box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "accel/instance.h"
#include "random.h"
#include "support/support.h"

namespace steradian::test {
namespace {

constexpr float kInf = kInfinity;

Ray ray_of(Vec3 o, Vec3 d) {
    Ray ray;
    EXPECT_TRUE(canonical({o, 0, d, kInf}, ray));
    return ray;
}
Interval interval(const Box& box, Vec3 o, Vec3 d) { return slab_interval(box, SlabRay(ray_of(o, d))); }
bool meets(const Box& box, Vec3 o, Vec3 d) {
    const Interval i = interval(box, o, d);
    return max_of(i.in, 0.0f) <= i.out;
}
const Box kUnit{{-1, -1, -1}, {1, 1, 1}};

TEST(Slab, EntryAndExit) {
    const Interval i = interval(kUnit, {-5, 0, 0}, {2, 0, 0});
    EXPECT_EQ(i.in, 2);
    EXPECT_EQ(i.out, 3 * kFarScale + kFarPad);
    const Interval corner = interval(kUnit, {-3, -3, -3}, {1, 1, 1});
    EXPECT_EQ(corner.in, 2);
    EXPECT_EQ(corner.out, 4 * kFarScale + kFarPad);
    EXPECT_TRUE(interval(kUnit, {-5, 1.1f, 0}, {1, 0, 0}).empty());
    EXPECT_TRUE(interval(kUnit, {-5, 0, 0}, {1, 1, 0}).empty());
    // Behind the origin: an interval of the line, but not of the ray.
    EXPECT_FALSE(interval(kUnit, {5, 0, 0}, {1, 0, 0}).empty());
    EXPECT_FALSE(meets(kUnit, {5, 0, 0}, {1, 0, 0}));
}

TEST(Slab, ZeroComponentsOfEitherSign) {
    for (const float zero : {0.0f, -0.0f})
        for (const float other : {0.0f, -0.0f}) {
            EXPECT_TRUE(meets(kUnit, {-5, 0, 0}, {1, zero, other}));
            EXPECT_FALSE(meets(kUnit, {-5, 2, 0}, {1, zero, other}));
            EXPECT_FALSE(meets(kUnit, {-5, -2, 0}, {1, zero, other}));
            EXPECT_FALSE(meets(kUnit, {-5, 0, 2}, {1, zero, other}));
            // In the planes of the faces 0 * inf is NaN: still inside. Also where two of them meet.
            for (const float face : {-1.0f, 1.0f}) {
                EXPECT_TRUE(meets(kUnit, {-5, face, 0}, {1, zero, other}));
                EXPECT_TRUE(meets(kUnit, {-5, face, face}, {1, zero, other}));
                EXPECT_TRUE(meets(kUnit, {-5, face, -face}, {1, zero, other}));
                EXPECT_FALSE(meets(kUnit, {-5, face, 1.0000001f}, {1, zero, other}));
            }
        }
}

TEST(Slab, FlatAndPointBoxes) {
    const Box flat{{-1, 0.3f, -1}, {1, 0.3f, 1}};
    EXPECT_TRUE(meets(flat, {0.1f, 2, 0.2f}, {0.01f, -1, 0.02f}));
    EXPECT_TRUE(meets(flat, {-5, 0.3f, 0}, {1, 0, 0}));
    EXPECT_FALSE(meets(flat, {-5, 0.3000001f, 0}, {1, 0, 0}));
    const Box point{{0.1f, 0.2f, 0.3f}, {0.1f, 0.2f, 0.3f}};
    EXPECT_TRUE(meets(point, {0.1f, 0.2f, 0.3f}, {1, 2, 3}));
    const Interval i = interval(point, {-0.9f, -1.8f, -2.7f}, {1, 2, 3});
    EXPECT_FALSE(i.empty());
    EXPECT_NEAR(i.in, 1, 1e-6);
}

TEST(Slab, InfinitiesAndExtremes) {
    // Empty boxes are never met, whatever the direction.
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        Vec3 d = random.direction();
        d[static_cast<int>(random.below(3))] = random.below(2) ? 0.0f : -0.0f;
        EXPECT_TRUE(interval(Box{}, random.in_cube(10), d).empty());
    }
    // A reciprocal that is denormal, a component so small that it counts as 0, origins at the end of the range.
    const float big = std::numeric_limits<float>::max();
    EXPECT_TRUE(meets(kUnit, {-5, 0, 0}, {big, 0, 0}));
    EXPECT_TRUE(meets(kUnit, {-5, 0, 0}, {1e-38f * 1.5f, 0, 0}));
    EXPECT_TRUE(meets(kUnit, {-5, 1, 0}, {1, 1e-39f, 0}));
    EXPECT_TRUE(meets(kUnit, {-big, 0, 0}, {1, 0, 0}));
    EXPECT_FALSE(meets(kUnit, {-big, big, 0}, {1, 0, 0}));
}

TEST(Slab, CanonicalRays) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Ray out;
    for (const float bad : {nan, kInf, -kInf})
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 v{1, 2, 3};
            v[axis] = bad;
            EXPECT_FALSE(canonical({v, 0, {1, 0, 0}, 1}, out));
            EXPECT_FALSE(canonical({{0, 0, 0}, 0, v, 1}, out));
        }
    EXPECT_FALSE(canonical({{}, 0, {0, -0.0f, 0}, 1}, out));
    EXPECT_FALSE(canonical({{}, 0, {1e-39f, -1e-40f, 0}, 1}, out));
    EXPECT_FALSE(canonical({{}, 0, {1, 0, 0}, nan}, out));
    EXPECT_FALSE(canonical({{}, 0, {1, 0, 0}, -1}, out));
    EXPECT_FALSE(canonical({{}, 2, {1, 0, 0}, 1}, out));
    EXPECT_FALSE(canonical({{}, kInf, {1, 0, 0}, kInf}, out));
    ASSERT_TRUE(canonical({{}, nan, {1, -1e-39f, 0}, kInf}, out));
    EXPECT_EQ(out.tmin, 0);
    EXPECT_EQ(out.d.y, 0);
    EXPECT_TRUE(std::signbit(out.d.y));
    ASSERT_TRUE(canonical({{}, -3, {1, 0, 0}, 0}, out));
    EXPECT_EQ(out.tmin, 0);
}

/// The exact interval up to 2^-60 relatively; false when the line misses the box.
bool exact_interval(const Box& box, const Ray& ray, long double& in, long double& out) {
    in = -std::numeric_limits<long double>::infinity(), out = -in;
    for (int axis = 0; axis < 3; ++axis) {
        const long double o = ray.o[axis], d = ray.d[axis], lo = box.lo[axis], hi = box.hi[axis];
        if (d == 0) {
            if (o < lo || o > hi) return false;
            continue;
        }
        const long double a = (lo - o) / d, b = (hi - o) / d;
        in = std::max(in, std::min(a, b));
        out = std::min(out, std::max(a, b));
    }
    return in <= out;
}

Box random_box(Random& random, double scale) {
    Box box;
    box.extend(random.in_cube(scale));
    if (random.below(4)) box.extend(random.in_cube(scale));
    if (random.below(4) == 0) box.hi.y = box.lo.y;
    return box;
}

/// A ray that meets the box, most often just so: at a corner, on an edge, in the plane of a face.
Ray grazing_ray(const Box& box, Random& random, double scale) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
        const uint32_t where = random.below(3);
        p[axis] = where == 0   ? box.lo[axis]
                  : where == 1 ? box.hi[axis]
                               : static_cast<float>(random.uniform(box.lo[axis], box.hi[axis]));
    }
    Ray ray;
    ray.o = Vec3(Vec3d(p) + Vec3d(random.in_cube(1)) * (scale * random.decades(-4, 4)));
    ray.d = Vec3(Vec3d(p) - Vec3d(ray.o));
    for (int axis = 0; axis < 3; ++axis)
        if (random.below(5) == 0) ray.o[axis] = p[axis], ray.d[axis] = random.below(2) ? 0.0f : -0.0f;
    ray.d = ray.d * static_cast<float>(random.decades(-8, 8));
    return ray;
}

// What the far scale is derived for: wherever the exact interval is not empty, neither is the computed one, and it
// contains the exact one but for the three roundings at its near end.
TEST(Slab, ConservativeAgainstTheExactInterval) {
    Random random(2);
    size_t met = 0;
    for (size_t i = 0; i < by_tier<size_t>(1'000'000, 20'000'000); ++i) {
        const double scale = random.decades(-20, 15);
        const Box box = random_box(random, scale);
        Ray ray;
        if (!canonical(grazing_ray(box, random, scale), ray)) continue;
        long double in, out;
        if (!exact_interval(box, ray, in, out) || out < 0) continue;
        ++met;
        const Interval found = slab_interval(box, SlabRay(ray));
        const long double near_error = 4 * 0x1p-24L * std::fabs(in) + 0x1p-148L;
        // Written so that infinities, where a float does not reach, pass.
        ASSERT_TRUE(!found.empty() && !(found.in > in + near_error) && !(found.out < out))
            << "exact [" << double(in) << ", " << double(out) << "], computed [" << found.in << ", " << found.out
            << "]";
    }
    EXPECT_GT(met, by_tier<size_t>(300'000, 6'000'000));
}

// What traversal rests on: a box's computed interval lies within that of any box around it.
TEST(Slab, MonotoneInTheBox) {
    Random random(3);
    for (size_t i = 0; i < by_tier<size_t>(1'000'000, 20'000'000); ++i) {
        const double scale = random.decades(-40, 15);
        const Box inner = random_box(random, scale);
        Box outer = inner;
        for (int more = 0; more < 2; ++more) {
            Vec3 p = random.in_cube(scale);
            for (int axis = 0; axis < 3; ++axis)
                if (random.below(2)) p[axis] = inner.lo[axis];
            outer.extend(p);
        }
        Ray ray;
        if (!canonical(grazing_ray(random.below(2) ? inner : outer, random, scale), ray)) continue;
        const SlabRay slab(ray);
        const Interval a = slab_interval(inner, slab), b = slab_interval(outer, slab);
        ASSERT_TRUE(b.in <= a.in && a.out <= b.out)
            << "inner [" << a.in << ", " << a.out << "] outer [" << b.in << ", " << b.out << "]";
    }
}

TEST(Instance, WorldBoundsContainEveryTransformedPoint) {
    Random random(4);
    for (int i = 0; i < 20'000; ++i) {
        const Box box = random_box(random, random.decades(-6, 6));
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1.1);
        const Affine transform = translation(x * random.decades(-3, 8), y, z) *
                                 rotation_degrees(random.uniform(0, 360), {z, x, y}) *
                                 scaling(random.decades(-3, 3), -1, random.decades(-3, 3));
        const std::optional<PlacedGeometry> placed = place(0, transform, box);
        ASSERT_TRUE(placed);
        for (int k = 0; k < 8; ++k) {
            const long double p[3] = {k & 1 ? box.lo.x : box.hi.x, k & 2 ? box.lo.y : box.hi.y,
                                      k & 4 ? box.lo.z : box.hi.z};
            for (int row = 0; row < 3; ++row) {
                long double value = transform.m[row][3];
                for (int axis = 0; axis < 3; ++axis) value += transform.m[row][axis] * p[axis];
                ASSERT_LE(placed->world.lo[row], value);
                ASSERT_GE(placed->world.hi[row], value);
            }
        }
    }
}

TEST(Instance, RefusesTransformsThatLoseTheRay) {
    EXPECT_FALSE(place(0, scaling(1, 0, 1), kUnit));
    EXPECT_FALSE(place(0, scaling(1, std::numeric_limits<double>::quiet_NaN(), 1), kUnit));
    EXPECT_FALSE(place(0, scaling(1e31, 1e31, 1e31), kUnit));
    EXPECT_FALSE(place(0, scaling(1, 1e-31, 1), kUnit));
    EXPECT_TRUE(place(0, scaling(-1, 1e-20, 1e20), kUnit));
}

}  // namespace
}  // namespace steradian::test
