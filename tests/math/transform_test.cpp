#include "math/transform.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace steradian {
namespace {

using test::Random;

void expect_near(Vec3d a, Vec3d b, double tolerance) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
}

Affine random_affine(Random& r) {
    Affine a;
    for (auto& row : a.m)
        for (double& x : row) x = r.between(-2, 2);
    return a;
}

Vec3d random_vector(Random& r) {
    Vec3d v;
    v.x = r.between(-5, 5), v.y = r.between(-5, 5), v.z = r.between(-5, 5);
    return v;
}

TEST(Transform, ProductAppliesTheRightOneFirst) {
    expect_near(transform_point(translation(1, 2, 3) * scaling(2, 3, 4), {1, 1, 1}), {3, 5, 7}, 0);
    expect_near(transform_point(scaling(2, 3, 4) * translation(1, 2, 3), {1, 1, 1}), {4, 9, 16}, 0);
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const Affine a = random_affine(random), b = random_affine(random);
        const Vec3d p = random_vector(random);
        expect_near(transform_point(a * b, p), transform_point(a, transform_point(b, p)), 1e-12);
        expect_near(transform_vector(a * b, p), transform_vector(a, transform_vector(b, p)), 1e-12);
    }
}

TEST(Transform, VectorsIgnoreTranslation) {
    expect_near(transform_vector(translation(1, 2, 3), {4, 5, 6}), {4, 5, 6}, 0);
    expect_near(transform_point(translation(1, 2, 3), {4, 5, 6}), {5, 7, 9}, 0);
}

TEST(Transform, InverseUndoes) {
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const Affine a = random_affine(random);
        const double volume = std::fabs(determinant(a));
        if (volume < 0.1) continue;
        const auto inverted = inverse(a);
        ASSERT_TRUE(inverted);
        const Vec3d p = random_vector(random);
        // The entries are at most 2, cofactors 8, so the inverse's entries are at most 8 / 0.1: some 100 roundings of
        // numbers of up to 80 · 2 · 3 · 7.
        expect_near(transform_point(*inverted, transform_point(a, p)), p, 1e-9);
        EXPECT_NEAR(determinant(*inverted) * determinant(a), 1, 1e-9);
    }
}

TEST(Transform, SingularAndNonFiniteHaveNoInverse) {
    EXPECT_FALSE(inverse(scaling(1, 0, 1)));
    Affine rank_two;
    rank_two.m[2] = {1, 1, 0, 0};
    rank_two.m[0] = {1, 0, 0, 0}, rank_two.m[1] = {0, 1, 0, 0};
    EXPECT_FALSE(inverse(rank_two));
    EXPECT_FALSE(inverse(translation(INFINITY, 0, 0)));
    EXPECT_FALSE(inverse(scaling(1, NAN, 1)));
    EXPECT_FALSE(inverse(scaling(1e-320, 1, 1)));  // 1 / determinant overflows
    EXPECT_TRUE(inverse(scaling(1e-30, 1e-30, 1e-30)));
}

TEST(Transform, QuarterTurnsAreExact) {
    for (int k = -9; k <= 9; ++k) {
        Affine turned = rotation_degrees(90.0 * k, {0, 0, 3});
        Affine steps;
        for (int i = 0; i < ((k % 4) + 4) % 4; ++i) steps = rotation_degrees(90, {0, 0, 1}) * steps;
        for (auto* m : {&turned, &steps})
            for (const auto& row : m->m)
                for (const double x : row) EXPECT_TRUE(x == 0 || x == 1 || x == -1);
        EXPECT_EQ(turned, steps) << k;
    }
    EXPECT_TRUE(is_identity(rotation_degrees(360, {1, 2, 3})));
    EXPECT_TRUE(is_identity(rotation_degrees(-720, {1, 2, 3})));
}

TEST(Transform, RotationsAreCounterClockwiseSeenFromTheTip) {
    expect_near(transform_vector(rotation_degrees(90, {0, 0, 1}), {1, 0, 0}), {0, 1, 0}, 0);
    expect_near(transform_vector(rotation_degrees(90, {1, 0, 0}), {0, 1, 0}), {0, 0, 1}, 0);
    expect_near(transform_vector(rotation_degrees(90, {0, 1, 0}), {0, 0, 1}), {1, 0, 0}, 0);
    expect_near(transform_vector(rotation_degrees(30, {0, 0, 1}), {1, 0, 0}), {std::sqrt(3.0) / 2, 0.5, 0}, 1e-15);
    expect_near(transform_vector(rotation_degrees(-30, {0, 0, 1}), {1, 0, 0}), {std::sqrt(3.0) / 2, -0.5, 0}, 1e-15);
    expect_near(transform_vector(rotation_degrees(120, {1, 1, 1}), {1, 0, 0}), {0, 1, 0}, 1e-15);
}

TEST(Transform, RotationsKeepLengthAxisAndHandedness) {
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d axis = random_vector(random), v = random_vector(random);
        const Affine r = rotation_degrees(random.between(-1000, 1000), {axis.x, axis.y, axis.z});
        EXPECT_NEAR(length(transform_vector(r, v)), length(v), 1e-13);
        expect_near(transform_vector(r, axis), axis, 1e-13);
        EXPECT_NEAR(determinant(r), 1, 1e-13);
        EXPECT_NEAR(uniform_scale(r).value_or(0), 1, 1e-13);
    }
}

TEST(Transform, NormalsStayPerpendicular) {
    Random random(4);
    for (int i = 0; i < 1000; ++i) {
        const Affine a = random_affine(random);
        const auto inverted = inverse(a);
        if (!inverted || std::fabs(determinant(a)) < 0.1) continue;
        const Vec3d s = random_vector(random), t = random_vector(random);
        const Vec3d n = transform_normal_by_inverse(*inverted, cross(s, t));
        const Vec3d as = transform_vector(a, s), at = transform_vector(a, t);
        EXPECT_NEAR(dot(n, as), 0, 1e-12 * length(n) * length(as) + 1e-10);
        EXPECT_NEAR(dot(n, at), 0, 1e-12 * length(n) * length(at) + 1e-10);
    }
    expect_near(transform_normal_by_inverse(*inverse(scaling(2, 1, 1)), {1, 1, 0}), {0.5, 1, 0}, 0);
}

TEST(Transform, UniformScaleIsFoundAndOnlyThen) {
    EXPECT_NEAR(uniform_scale(scaling(3, 3, 3) * rotation_degrees(33, {1, 2, 3})).value_or(0), 3, 1e-12);
    EXPECT_NEAR(uniform_scale(scaling(-2, 2, 2)).value_or(0), 2, 0);  // a reflection
    EXPECT_NEAR(uniform_scale(translation(5, 6, 7)).value_or(0), 1, 0);
    EXPECT_NEAR(uniform_scale(scaling(1e-20, 1e-20, 1e-20)).value_or(0), 1e-20, 1e-32);
    EXPECT_TRUE(uniform_scale(scaling(1, 1, 1 + 2e-7)));
    EXPECT_FALSE(uniform_scale(scaling(1, 1, 1 + 2e-6)));
    EXPECT_FALSE(uniform_scale(scaling(1, 2, 1)));
    EXPECT_FALSE(uniform_scale(scaling(0, 0, 0)));
    EXPECT_FALSE(uniform_scale(scaling(NAN, 1, 1)));
    Affine shear;
    shear.m[0][1] = 0.5;
    EXPECT_FALSE(uniform_scale(shear));
}

TEST(Transform, FiniteAndIdentityAreRecognised) {
    EXPECT_TRUE(is_identity(Affine{}));
    EXPECT_FALSE(is_identity(translation(0, 0, 1e-300)));
    EXPECT_TRUE(is_finite(scaling(1e300, 1, 1)));
    EXPECT_FALSE(is_finite(translation(0, NAN, 0)));
    EXPECT_FALSE(is_finite(rotation_degrees(INFINITY, {0, 0, 1})));
}

}  // namespace
}  // namespace steradian
