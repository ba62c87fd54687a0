// The float filter drops nothing that the exact test accepts, and most of the rest.
#include <gtest/gtest.h>

#include "accel/triangle_block.h"
#include "random.h"
#include "support/support.h"

namespace steradian::test {
namespace {

TriangleBlock random_block(Random& random, double scale, double triangle, Vec3 offset) {
    TriangleBlock block{};
    for (uint32_t lane = 0; lane < kBlock; ++lane) {
        const Vec3 c = random.in_cube(scale);
        block.prim[lane] = lane;
        for (auto& corner : block.vertex) {
            const Vec3 p = Vec3(Vec3d(c) + Vec3d(random.in_cube(triangle)) + Vec3d(offset));
            for (int axis = 0; axis < 3; ++axis) corner[axis][lane] = p[axis];
        }
        if (random.below(4) == 0)  // a sliver
            for (int axis = 0; axis < 3; ++axis)
                block.vertex[2][axis][lane] = 0.5f * (block.vertex[0][axis][lane] + block.vertex[1][axis][lane]);
    }
    return block;
}

/// At a vertex, an edge or the inside of one of the triangles, from near or far.
Ray aimed_at(const TriangleBlock& block, Random& random, double scale) {
    const uint32_t lane = random.below(kBlock), kind = random.below(3);
    const double s = kind == 0 ? 0 : random.unit(), t = kind == 2 ? random.unit() * (1 - s) : 0;
    const Vec3d target = Vec3d(block.corner(0, lane)) * (1 - s - t) + Vec3d(block.corner(1, lane)) * s +
                         Vec3d(block.corner(2, lane)) * t;
    Ray ray;
    ray.o = Vec3(target + Vec3d(random.direction()) * (scale * random.decades(-4, 4)));
    ray.d = Vec3(target - Vec3d(ray.o)) * static_cast<float>(random.decades(-3, 3));
    if (random.below(4) == 0) {
        const int axis = static_cast<int>(random.below(3));
        ray.o = Vec3(target), ray.d = {0, 0, 0};
        ray.d[axis] = 1;
        ray.o[axis] = static_cast<float>(target[axis] - scale);
    }
    return ray;
}

struct Tally {
    size_t tested = 0, accepted = 0, passed = 0;
};

void check(const TriangleBlock& block, const Ray& in, Tally& tally) {
    Ray ray;
    if (!canonical(in, ray)) return;
    const TriangleRay triangle_ray(ray);
    const uint32_t maybe = filter_block(block, BlockRay(triangle_ray));
    for (uint32_t lane = 0; lane < kBlock; ++lane) {
        TriangleCandidate c;
        const bool accepted =
            intersect_triangle(triangle_ray, block.corner(0, lane), block.corner(1, lane), block.corner(2, lane), c);
        const bool passed = (maybe >> lane & 1) != 0;
        ASSERT_TRUE(passed || !accepted);
        ++tally.tested, tally.accepted += accepted, tally.passed += passed;
    }
}

TEST(Filter, DropsNothingThatIsHit) {
    Random random(1);
    Tally tally;
    for (size_t i = 0; i < by_tier<size_t>(500'000, 20'000'000); ++i) {
        const double scale = random.decades(-44, 15);
        const Vec3 offset = random.below(2) ? Vec3{} : random.in_cube(min_of(1e15, scale * random.decades(0, 8)));
        const TriangleBlock block = random_block(random, scale, scale * random.decades(-4, 0), offset);
        check(block, aimed_at(block, random, scale), tally);
        if (HasFatalFailure()) FAIL() << "scale " << scale;
    }
    EXPECT_GT(tally.accepted, tally.tested / 50);
}

TEST(Filter, ExtremeOrigins) {
    Random random(2);
    Tally tally;
    for (int i = 0; i < 100'000; ++i) {
        const TriangleBlock block = random_block(random, 1e15, 1e15, {});
        Ray ray = aimed_at(block, random, 1e15);
        ray.o = ray.o * static_cast<float>(random.decades(0, 22));
        ray.d = Vec3(Vec3d(block.corner(0, 0)) - Vec3d(ray.o));
        check(block, ray, tally);
        if (HasFatalFailure()) FAIL();
    }
}

// Ordinary triangles, seen from up to a thousand of their sizes away: few that miss reach the exact test.
TEST(Filter, DropsMostOfTheRest) {
    Random random(3);
    Tally tally;
    for (int i = 0; i < 100'000; ++i) {
        const TriangleBlock block = random_block(random, 1, 0.3, {});
        Ray ray{random.in_cube(1) * static_cast<float>(random.decades(0, 2)), 0, {}, kInfinity};
        ray.d = random.in_cube(1) - ray.o;
        check(block, ray, tally);
    }
    EXPECT_LT(double(tally.passed - tally.accepted), 0.01 * double(tally.tested));
}

}  // namespace
}  // namespace steradian::test
