// Hierarchies in which the boxes of triangles are split, on rays that would be lost if the parts did not hold every t
// that a hit may have by definition.
#include <gtest/gtest.h>

#include <algorithm>

#include "accel/bvh.h"
#include "accel/geometry.h"
#include "accel/kernels/kernels.h"
#include "brute_force.h"
#include "support/support.h"

namespace steradian::test {
namespace {

/// A point of the plane x + 2 y + 3 z = 0; exact, for small numbers.
Vec3 on_lattice(int a, int b) {
    return Vec3{static_cast<float>(3 * a), static_cast<float>(3 * b), static_cast<float>(-a - 2 * b)} * 0.0625f;
}
Vec3 on_lattice(Random& random, int most) {
    const int a = int(random.below(static_cast<uint32_t>(2 * most + 1))) - most;
    return on_lattice(a, int(random.below(static_cast<uint32_t>(2 * most + 1))) - most);
}

constexpr uint32_t kLattice = 24, kSheets = 16, kSlivers = 60, kSmall = 300;

/// Large triangles that lie exactly in one plane, which is not along the axes; sheets of huge ones so close to each
/// other that from far away they are at the same t; slivers across each other in all directions; and small triangles in
/// between that make it worth while to split all of these.
TestScene overlapping(uint64_t seed) {
    TestScene scene("overlapping");
    TriangleMesh mesh;
    Random random(seed);
    for (uint32_t i = 0; i < kLattice; ++i) {
        const Vec3 p = on_lattice(random, 40), q = on_lattice(random, 40);
        mesh.add(p, q, on_lattice(random, 40));
    }
    for (uint32_t i = 0; i < kSheets; i += 2) {
        const Vec3 by = random.in_cube(random.decades(-3, -0.5));
        const Vec3 a = Vec3{-9, -1.37f, -8} + by, b = Vec3{9, -0.71f, -9} + by, c = Vec3{8, -2.13f, 9} + by,
                   d = Vec3{-8, -2.77f, 8} + by;
        mesh.add(a, b, c), mesh.add(a, c, d);
    }
    for (uint32_t i = 0; i < kSlivers; ++i) {
        const Vec3 from = random.in_cube(8), to = random.in_cube(8);
        mesh.add(from, to, to + random.in_cube(random.decades(-7, -1)));
    }
    for (uint32_t i = 0; i < kSmall; ++i) {
        const Vec3 p = random.in_cube(8);
        mesh.add(p, p + random.in_cube(0.3), p + random.in_cube(0.3));
    }
    scene.meshes.push_back(std::move(mesh));
    scene.finish(seed);
    return scene;
}

Bvh split(const TestScene& scene) {
    LargeArray<BuildPrimitive> primitives;
    EXPECT_TRUE(append_primitives(scene.geometries()[0], 0, 0, primitives));
    BvhOptions options;
    options.builder = BvhBuilder::high_quality;
    options.split_boxes = true;
    BuildMonitor monitor;
    return build_bvh(primitives, options, monitor);
}

TEST(SplitBoxes, AreBoundedAndLoseNothing) {
    for (uint64_t seed = 0; seed < 20; ++seed) {
        const TestScene scene = overlapping(seed);
        const size_t triangles = scene.meshes[0].indices.size() / 3;
        std::vector<uint32_t> ids = split(scene).blocks;
        ids.erase(std::remove(ids.begin(), ids.end(), kNoHit), ids.end());
        EXPECT_GT(ids.size(), triangles + 20) << "nothing was split: the other tests show nothing";
        EXPECT_LE(ids.size(), triangles + triangles / 2);
        std::sort(ids.begin(), ids.end());
        ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
        EXPECT_EQ(ids.size(), triangles);
    }
}

/// A point of a triangle, now and then on an edge.
Vec3 point_on(const TriangleMesh& mesh, size_t triangle, Random& random) {
    const auto corner = [&](size_t i) { return Vec3d(mesh.positions[mesh.indices[3 * triangle + i]]); };
    double u = random.unit(), v = random.below(4) ? random.unit() : 0;
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return Vec3(corner(0) * (1 - u - v) + corner(1) * u + corner(2) * v);
}

/// Towards a triangle from up to 1e7 times its size away, where a float of t is wider than it is; in its plane, but for
/// rounding, or exactly, where only the arithmetic of the test decides what is hit; along an axis through one of its
/// points, and through a corner of a box.
std::vector<Ray> adversarial_rays(const TestScene& scene, size_t count, uint64_t seed) {
    const TriangleMesh& mesh = scene.meshes[0];
    const auto triangles = static_cast<uint32_t>(mesh.indices.size() / 3);
    Random random(seed);
    std::vector<Ray> rays;
    while (rays.size() < count) {
        const size_t triangle = random.below(2)   ? kLattice + random.below(kSheets)
                                : random.below(2) ? random.below(kLattice + kSheets + kSlivers)
                                                  : random.below(triangles);
        const Vec3 target = point_on(mesh, triangle, random);
        Ray ray{{}, 0, {}, kInfinity};
        switch (random.below(5)) {
            case 0:
                ray.o = Vec3(Vec3d(target) + Vec3d(random.direction()) * random.decades(0, 8));
                ray.d = Vec3(Vec3d(target) - Vec3d(ray.o));
                if (random.below(2)) ray.d = normalize(ray.d);
                break;
            case 1: {
                const Vec3d along = Vec3d(point_on(mesh, triangle, random)) - Vec3d(target);
                ray.o = Vec3(Vec3d(target) - along * random.decades(-1, 7));
                ray.d = Vec3(along);
                break;
            }
            case 2: {
                const auto axis = static_cast<int>(random.below(3));
                ray.o = target, ray.d = {};
                ray.o[axis] += static_cast<float>(random.decades(0, 7));
                ray.d[axis] = -1;
                break;
            }
            case 3:
                ray.o = on_lattice(random, 60);
                ray.d = on_lattice(random, 12);
                break;
            default: {
                const Vec3 other = mesh.positions[mesh.indices[3 * triangle + random.below(3)]];
                Vec3 at = target;
                for (int axis = 0; axis < 3; ++axis)
                    if (random.below(2)) at[axis] = other[axis];
                ray.o = Vec3(Vec3d(at) + Vec3d(random.direction()) * random.decades(-2, 3));
                ray.d = Vec3(Vec3d(at) - Vec3d(ray.o));
            }
        }
        if (random.below(8) == 0) ray.tmin = static_cast<float>(length(Vec3d(target) - Vec3d(ray.o)));
        if (length(Vec3d(ray.d)) > 0) rays.push_back(ray);
    }
    return rays;
}

TEST(SplitBoxes, EveryBitOfEveryHit) {
    size_t hit = 0, shot = 0;
    for (uint64_t seed = 0; seed < 20; ++seed) {
        const TestScene scene = overlapping(seed);
        const BruteForce brute(scene);
        const std::vector<Ray> rays = adversarial_rays(scene, by_tier<size_t>(2'500, 250'000), seed + 100);
        std::vector<Hit> expected(rays.size());
        for (size_t i = 0; i < rays.size(); ++i) expected[i] = brute.first_hit(rays[i]);
        for (const Isa isa : supported_isas()) {
            AccelOptions options;
            options.builder = BvhBuilder::high_quality;
            options.isa = isa;
            const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
            ASSERT_TRUE(accel);
            for (const RayKind kind : {RayKind::incoherent, RayKind::coherent}) {
                std::vector<Hit> hits(rays.size());
                std::vector<uint8_t> occluded(rays.size());
                accel->intersect(rays, hits, kind);
                accel->occluded(rays, occluded, kind);
                for (size_t i = 0; i < rays.size(); ++i)
                    ASSERT_TRUE(same_bits(hits[i], expected[i]) && (occluded[i] != 0) == expected[i].found())
                        << "scene " << seed << ", instruction set " << int(isa) << "\nray      " << describe(rays[i])
                        << "\nexpected " << describe(expected[i]) << "\ngot      " << describe(hits[i]);
            }
        }
        for (const Hit& h : expected) hit += h.found();
        shot += rays.size();
    }
    EXPECT_GT(hit, shot / 2);
}

/// Three of each, so that the tree is made fuller with parts of boxes in it: they are behind all whole ones then.
TEST(SplitBoxes, InTreesThatAreMadeFuller) {
    TestScene scene("copies");
    TriangleMesh mesh;
    Random random(1);
    for (int i = 0; i < 1700; ++i) {
        const Vec3 p = random.in_cube(1), q = p + random.in_cube(1), r = p + random.in_cube(1);
        for (int copy = 0; copy < 3; ++copy) mesh.add(p, q, r);
    }
    std::vector<Ray> rays;
    for (uint32_t i = 0; i < 5000; ++i)
        rays.push_back({random.in_cube(2), 0, point_on(mesh, random.below(1700) * 3, random), kInfinity});
    for (Ray& ray : rays) ray.d = ray.d - ray.o;
    scene.meshes.push_back(std::move(mesh));
    scene.finish(1);
    std::vector<Hit> hits[2];
    for (const bool split : {false, true}) {
        AccelOptions options;
        options.builder = split ? BvhBuilder::high_quality : BvhBuilder::median;
        const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
        ASSERT_TRUE(accel);
        hits[split].resize(rays.size());
        accel->intersect(rays, hits[split], RayKind::incoherent);
    }
    for (size_t i = 0; i < rays.size(); ++i)
        ASSERT_TRUE(same_bits(hits[1][i], hits[0][i])) << "ray " << describe(rays[i]) << "\nexpected "
                                                       << describe(hits[0][i]) << "\ngot      " << describe(hits[1][i]);
}

// A triangle in several leaves counts once.
TEST(SplitBoxes, NextHitEnumeratesEveryTriangleOnce) {
    for (uint64_t seed = 0; seed < 20; ++seed) {
        const TestScene scene = overlapping(seed);
        const BruteForce brute(scene);
        AccelOptions options;
        options.builder = BvhBuilder::high_quality;
        const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
        ASSERT_TRUE(accel);
        for (const Ray& ray : adversarial_rays(scene, by_tier<size_t>(1'000, 20'000), seed + 200)) {
            Hit hit = accel->intersect(ray);
            for (const Hit& wanted : brute.all_hits(ray)) {
                ASSERT_TRUE(same_bits(hit, wanted))
                    << describe(ray) << "\nexpected " << describe(wanted) << "\ngot      " << describe(hit);
                const Hit after = hit;
                accel->next_hit({&ray, 1}, {&after, 1}, {&hit, 1});
            }
            EXPECT_FALSE(hit.found());
        }
    }
}

}  // namespace
}  // namespace steradian::test
