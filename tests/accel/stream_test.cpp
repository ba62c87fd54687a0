// Any hits of many rays: what they share, and what each of them visits by itself.
#include <gtest/gtest.h>

#include "accel/geometry.h"
#include "brute_force.h"
#include "math/transform.h"
#include "options.h"
#include "support/support.h"

namespace steradian::test {
namespace {

/// A box that is empty but for a small triangle at either end of a diagonal.
TriangleMesh corners() {
    TriangleMesh m;
    m.add({-1, -1, 0}, {-0.9f, -1, 0}, {-1, -0.9f, 0});
    m.add({1, 1, 0.5f}, {0.9f, 1, 0.5f}, {1, 0.9f, 0.5f});
    return m;
}

/// Far more boxes of instances along z than a ray begins with when it visits them by itself, with little in them, and
/// spheres, rectangles and a body of triangles of the upper level between them.
TestScene row_of_boxes(size_t boxes) {
    TestScene scene("row of boxes");
    scene.meshes.push_back(icosphere(2));
    scene.meshes.back().move(0.3, {0, 0, 3});
    scene.meshes.push_back(corners());
    Random random(1);
    scene.spheres.emplace_back();
    for (int i = 0; i < 60; ++i)
        scene.spheres.back().push_back(
            {{float(random.uniform(-1, 1)), float(random.uniform(-1, 1)), float(i) / 5}, 0.02f});
    scene.rectangles.push_back({{{0.2f, -0.8f, 13}, {0.3f, 0, 0}, {0, 0.3f, 0}}});
    for (const uint32_t geometry : {0u, 2u, 3u}) scene.instances.push_back({geometry, {}, {}});
    for (size_t i = 0; i < boxes; ++i) {
        Affine m;
        m.m[0][3] = random.uniform(-0.3, 0.3), m.m[1][3] = random.uniform(-0.3, 0.3);
        m.m[2][3] = 12 * double(i) / double(boxes);
        scene.instances.push_back({1, m, {}});
    }
    scene.finish(1);
    return scene;
}

/// Side by side along the row, a few of them in the first octant, where they are a stream by themselves. Some start far
/// away, where opened instances are met as wholes.
std::vector<Ray> beam(size_t count) {
    Random random(2);
    std::vector<Ray> rays;
    for (size_t i = 0; i < count; ++i) {
        const float x = float(random.uniform(0, 0.01)), y = float(random.uniform(0, 0.01));
        const Vec3 d{i % 50 == 0 ? x : -x, y, 1};
        const Vec3 from{float(random.uniform(-1, 1)), float(random.uniform(-1, 1)), -1};
        rays.push_back({i % 7 == 3 ? from - d * 1e5f : from, 0, d, i % 5 == 2 ? 6.0f : kInfinity});
        if (i % 7 == 3) rays.back().tmax = kInfinity;
    }
    return rays;
}

void expect_right(const TestScene& scene, const std::vector<Ray>& rays, const std::vector<Accel::Occlusion>& expected,
                  const AccelOptions& options) {
    const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
    ASSERT_TRUE(accel);
    std::vector<uint8_t> result(rays.size());
    accel->occluded(rays, result);
    for (size_t i = 0; i < rays.size(); ++i)
        ASSERT_EQ(result[i], expected[i]) << scene.name << " " << describe(options) << " " << describe(rays[i]);
}
void expect_right_always(const TestScene& scene, const std::vector<Ray>& rays,
                         const std::vector<Accel::Occlusion>& expected, OpenInstances open) {
    for (AccelOptions options : all_options()) {
        options.open = open;
        expect_right(scene, rays, expected, options);
    }
}

std::vector<uint8_t> all_of(const TestScene& scene, uint32_t geometry) {
    return std::vector<uint8_t>((primitive_count(scene.geometries()[geometry]) + 7) / 8, 255);
}

TEST(Streams, MuchThatRaysVisitByThemselves) {
    TestScene scene = row_of_boxes(600);
    const std::vector<Ray> rays = beam(300);
    size_t seen[3] = {};
    for (const bool cut_outs : {false, true}) {
        // The spheres are cut-outs altogether, and all boxes but every sixteenth.
        for (size_t i = 0; cut_outs && i < scene.instances.size(); ++i)
            if (i % 16) scene.set_cut_outs(i, all_of(scene, scene.instances[i].geometry));
        const BruteForce brute(scene);
        std::vector<Accel::Occlusion> expected;
        for (const Ray& ray : rays) expected.push_back(brute.occlusion(ray)), ++seen[expected.back()];
        for (const OpenInstances open : {OpenInstances::never, OpenInstances::always})
            expect_right_always(scene, rays, expected, open);
    }
    for (const size_t n : seen) EXPECT_GT(n, 20u);
}

/// What a ray has to visit by itself is more than it begins with, and only one of all boxes stops it. The first stream
/// has few rays, so that there is room for that much of each.
TEST(Streams, OneBoxOfVeryMany) {
    constexpr uint32_t kBoxes = 2000;
    for (uint32_t stopping = 0; stopping < kBoxes; stopping += 133) {
        TestScene scene("one of many boxes");
        scene.meshes.push_back(icosphere(1));
        scene.meshes.back().move(1, {5, 0, 0});
        scene.meshes.push_back(corners());
        scene.meshes.push_back(corners());
        scene.meshes.back().add({-1, -1, 0.25f}, {1, -1, 0.25f}, {0, 1, 0.25f});
        scene.instances.push_back({0, {}, {}});
        for (uint32_t i = 0; i < kBoxes; ++i) {
            Affine m;
            m.m[2][3] = 0.1 * i;
            scene.instances.push_back({i == stopping ? 2u : 1u, m, {}});
        }
        std::vector<Ray> rays;
        for (int i = 0; i < 120; ++i)
            rays.push_back(
                {{0, 0, -1}, 0, {i % 15 == 0 ? 1e-5f : -1e-5f, 1e-6f * static_cast<float>(i), 1}, kInfinity});
        for (const Isa isa : supported_isas()) {
            AccelOptions options;
            options.isa = isa, options.open = OpenInstances::never;
            expect_right(scene, rays, std::vector<Accel::Occlusion>(rays.size(), Accel::blocked), options);
        }
    }
}

/// From so far away that a ray along an axis, exact in the world, is shifted in the space of an instance: it can hit
/// there although it passes the boxes of all parts, and must take instances as wholes.
TEST(Streams, FarRaysPastThePartsOfInstances) {
    size_t blocked = 0;
    for (uint64_t seed = 0; seed < by_tier<uint64_t>(100, 3000); ++seed) {
        Random random(seed);
        TestScene scene("sparse instance");
        scene.meshes.resize(2);
        scene.meshes[0].add({-3, -3, -3}, {-2.9f, -3, -3}, {-3, -2.9f, -3});
        for (int i = 0; i < 40; ++i) {
            const Vec3 at = random.in_cube(1);
            const double size = random.decades(-2, -0.5);
            scene.meshes[1].add(at + random.in_cube(size), at + random.in_cube(size), at + random.in_cube(size));
        }
        const Vec3 around = random.direction(), to = random.in_cube(1.5);
        const double scale = random.uniform(0.3, 1.5);
        scene.instances = {
            {0, {}, {}},
            {1,
             translation(to.x, to.y, to.z) * rotation_degrees(random.uniform(0, 360), {around.x, around.y, around.z}) *
                 scaling(scale, scale, scale),
             {}}};
        const int axis = static_cast<int>(random.below(3));
        const auto away = static_cast<float>(random.decades(6.5, 7.2));
        std::vector<Ray> rays;
        for (int i = 0; i < 128; ++i) {
            Ray ray{random.in_cube(2), 0, {}, kInfinity};
            ray.d[axis] = 1, ray.o[axis] -= away;
            rays.push_back(ray);
        }
        const BruteForce brute(scene);
        std::vector<Accel::Occlusion> expected;
        for (const Ray& ray : rays)
            expected.push_back(brute.occlusion(ray)), blocked += expected.back() == Accel::blocked;
        for (const Isa isa : supported_isas()) {
            AccelOptions options;
            options.isa = isa, options.open = OpenInstances::always;
            expect_right(scene, rays, expected, options);
        }
    }
    EXPECT_GT(blocked, 100u);
}

/// First many that share nearly nothing, then many that share nearly everything, and both again.
TEST(Streams, RaysThatShareLittleOrMuch) {
    TestScene scene("sphere");
    scene.meshes.push_back(icosphere(by_tier(4, 6)));
    scene.finish(1);
    Random random(3);
    std::vector<Ray> rays;
    for (int turn = 0; turn < 2; ++turn) {
        for (int i = 0; i < 2000; ++i) {
            const Vec3 from = random.direction() * 1.001f;
            rays.push_back({from, 0, random.in_cube(1), float(random.uniform(0, 2))});
        }
        const Vec3 from = Vec3{0.4f, 0.3f, 1.1f};
        for (int i = 0; i < 2000; ++i)
            rays.push_back({from + random.in_cube(0.05), 0, random.in_cube(1) - from, kInfinity});
    }
    const BruteForce brute(scene);
    std::vector<Accel::Occlusion> expected;
    for (const Ray& ray : rays) expected.push_back(brute.occlusion(ray));
    expect_right_always(scene, rays, expected, OpenInstances::never);
}

}  // namespace
}  // namespace steradian::test
