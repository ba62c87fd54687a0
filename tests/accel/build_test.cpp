// The builders on what breaks builders.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <thread>

#include "accel/bvh.h"
#include "accel/geometry.h"
#include "accel/wide_node.h"
#include "base/parallel.h"
#include "brute_force.h"
#include "math/transform.h"
#include "support/support.h"

namespace steradian::test {
namespace {

constexpr BvhBuilder kBuilders[] = {BvhBuilder::sah, BvhBuilder::median, BvhBuilder::fast, BvhBuilder::high_quality};

TestScene scene_of(const std::string& name, TriangleMesh mesh) {
    TestScene scene(name);
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({0, {}});
    return scene;
}

std::vector<TestScene> abuse(int count) {
    std::vector<TestScene> scenes;
    TriangleMesh same, centroids, nested, points, line, fives;
    Random random(5);
    Vec3 cluster;
    for (int i = 0; i < count; ++i) {
        same.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        // Boxes around the origin, of very different sizes, all with the same centroid.
        const auto s = static_cast<float>(random.decades(-6, 0));
        centroids.add({-s, -s, 0}, {s, -s, 0}, {-s, s, 0});
        // Each one is almost all of the rest: the heuristic wants to split off one at a time.
        const auto n = static_cast<float>(std::pow(10.0, -30 + 45.0 * i / count));
        nested.add({0, 0, 0}, {n, 0, n}, {0, n, n});
        const Vec3 p = random.in_cube(1);
        points.add(p, p, p);
        const auto x = static_cast<float>(i);
        line.add({x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0});
        // As leaves these would take too much memory, so that nodes are gathered, and subtrees divided, in another way.
        if (i % 5 == 0) cluster = random.in_cube(1000);
        const Vec3 q = cluster + random.in_cube(0.1f);
        fives.add(q, q + random.in_cube(0.1f), q + random.in_cube(0.1f));
    }
    scenes.push_back(scene_of("coincident triangles", std::move(same)));
    scenes.push_back(scene_of("coincident centroids", std::move(centroids)));
    scenes.push_back(scene_of("exponentially nested", std::move(nested)));
    scenes.push_back(scene_of("points", std::move(points)));
    scenes.push_back(scene_of("a long line", std::move(line)));
    scenes.push_back(scene_of("clusters of five", std::move(fives)));
    return scenes;
}

// Time is not measured here; that the depth stays bounded, that no leaf takes more than it must and that every level
// costs O(n) make it O(n log n). With 64 levels a tree over n always fits, so leaves hold at most 8 triangles.
TEST(Build, AbuseStaysBoundedAndCorrect) {
    const int count = by_tier(100'000, 1'000'000);
    for (TestScene& scene : abuse(count)) {
        const BruteForce brute(scene);
        scene.finish(1);
        const std::vector<Ray> rays = hard_rays(scene, by_tier<size_t>(10, 40), 9);
        std::vector<Hit> expected(rays.size());
        for (size_t i = 0; i < rays.size(); ++i) expected[i] = brute.first_hit(rays[i]);
        for (const BvhBuilder builder : kBuilders)
            for (const uint32_t max_depth : {64u, 18u, 2u}) {
                AccelOptions options;
                options.builder = builder;
                options.max_depth = max_depth;
                const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
                ASSERT_TRUE(accel) << accel.error().message;
                const AccelStatistics& s = accel->statistics();
                EXPECT_EQ(s.primitives, uint64_t(count));
                EXPECT_LE(s.depth, max_depth);
                if (max_depth >= 18) {  // 2^18 * 4 > count
                    EXPECT_GE(s.leaves * 8, uint64_t(count)) << scene.name << " " << max_depth;
                }
                for (size_t i = 0; i < rays.size(); ++i)
                    ASSERT_TRUE(same_bits(accel->intersect(rays[i]), expected[i]))
                        << scene.name << " " << describe(rays[i]);
            }
    }
}

TEST(Build, SmallAndEmpty) {
    const Ray ray{{0.2f, 0.2f, 1}, 0, {0, 0, -1}, kInfinity};
    for (const BvhBuilder builder : kBuilders) {
        AccelOptions options;
        options.builder = builder;
        const Result<Accel> nothing = Accel::build({}, {}, options);
        ASSERT_TRUE(nothing);
        EXPECT_FALSE(nothing->intersect(ray).found());
        EXPECT_GT(nothing->bounds().lo.x, nothing->bounds().hi.x);
        EXPECT_EQ(nothing->statistics().primitives, 0u);

        TriangleMesh empty, one;
        one.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        const Geometry geometries[] = {empty.geometry(), one.geometry(), std::span<const SphereGeometry>()};
        const Result<Accel> unused = Accel::build(geometries, {}, options);
        ASSERT_TRUE(unused);
        EXPECT_FALSE(unused->occluded(ray));
        const GeometryInstance instances[] = {{0, {}}, {2, {}}, {1, {}}};
        const Result<Accel> accel = Accel::build(geometries, instances, options);
        ASSERT_TRUE(accel);
        const Hit hit = accel->intersect(ray);
        EXPECT_EQ(hit.instance, 2u);
        EXPECT_EQ(hit.prim, 0u);
        EXPECT_EQ(accel->bounds().lo, (Vec3{0, 0, 0}));
        EXPECT_EQ(accel->bounds().hi, (Vec3{1, 1, 0}));
        EXPECT_EQ(accel->statistics().depth, 0u);
    }
}

TEST(Build, SameForAnyNumberOfThreads) {
    const ThreadLimit limit(7);
    TestScene scene("soup");
    TriangleMesh mesh;
    Random random(8);
    for (int i = 0; i < 80'000; ++i) {
        const Vec3 c = random.in_cube(1);
        mesh.add(c + random.in_cube(0.02), c + random.in_cube(0.02), c + random.in_cube(0.02));
    }
    scene.meshes.push_back(std::move(mesh));
    scene.finish(3);
    const std::vector<Ray> rays = hard_rays(scene, 3000, 10);
    std::vector<Hit> expected;
    for (const BvhBuilder builder : kBuilders) {
        std::optional<AccelStatistics> statistics;
        for (const uint32_t threads : {1u, 2u, 7u})
            with_threads(threads, [&] {
                AccelOptions options;
                options.builder = builder;
                const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
                ASSERT_TRUE(accel);
                const AccelStatistics& s = accel->statistics();
                if (!statistics) statistics = s;
                EXPECT_EQ(s.nodes, statistics->nodes);
                EXPECT_EQ(s.leaves, statistics->leaves);
                EXPECT_EQ(s.depth, statistics->depth);
                EXPECT_EQ(s.bytes, statistics->bytes);
                std::vector<Hit> hits(rays.size());
                accel->intersect(rays, hits);
                if (expected.empty()) expected = hits;
                for (size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(same_bits(hits[i], expected[i]));
            });
    }
}

TEST(Build, Cancelled) {
    TestScene scene = std::move(abuse(50'000)[4]);
    for (const BvhBuilder builder : kBuilders)
        for (const int after : {0, 1, 3}) {
            std::atomic<int> asked{0}, inside{0};
            AccelOptions options;
            options.builder = builder;
            options.cancelled = [&] {
                EXPECT_EQ(inside++, 0) << "asked by two threads at once";
                std::this_thread::yield();
                --inside;
                return asked++ >= after;
            };
            const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
            ASSERT_FALSE(accel);
            EXPECT_EQ(accel.error().code, ErrorCode::render_failed);
        }
}

/// A function that waits for tasks, one of which polls, on the thread that is asking already.
TEST(Build, CancellationMayBeAskedWhileItAsks) {
    int asked = 0, inner = 0;
    BuildMonitor* self = nullptr;
    const std::function<bool()> function = [&] {
        inner += self->poll();
        return asked++ == 1;
    };
    BuildMonitor monitor(function);
    self = &monitor;
    EXPECT_FALSE(monitor.poll());
    EXPECT_EQ(asked, 1);
    EXPECT_TRUE(monitor.poll());
    EXPECT_TRUE(monitor.poll());
    EXPECT_EQ(asked, 2);
    EXPECT_EQ(inner, 0);
}

/// Meshes and shapes in place, and instances, so that all stages have something to do.
TestScene some_of_everything() {
    TestScene scene = std::move(abuse(30'000)[4]);
    scene.meshes.push_back(icosphere(4));
    Random random(3);
    scene.spheres.emplace_back();
    for (int i = 0; i < 9'000; ++i) scene.spheres[0].push_back({random.in_cube(100), 1});
    scene.instances.push_back({2, {}});
    for (int i = 0; i < 40; ++i) scene.instances.push_back({1, translation(3.0 * i, 5, 0)});
    return scene;
}

/// Whose stages differ.
struct Way {
    BvhBuilder builder;
    BvhLayout layout;
};
constexpr Way kWays[] = {{BvhBuilder::sah, BvhLayout::full},
                         {BvhBuilder::median, BvhLayout::full},
                         {BvhBuilder::fast, BvhLayout::full},
                         {BvhBuilder::high_quality, BvhLayout::full},
                         {BvhBuilder::sah, BvhLayout::compact}};

TEST(Build, CancelledAtEveryQuestion) {
    const TestScene scene = some_of_everything();
    const auto build = [&](const Way& way, int after, int& asked) {
        AccelOptions options;
        options.builder = way.builder, options.layout = way.layout;
        options.cancelled = [&] { return asked++ >= after; };
        options.progress = [&](double) { EXPECT_LE(asked, after) << "told something after it was stopped"; };
        return Accel::build(scene.geometries(), scene.instances, options);
    };
    for (const Way& way : kWays) {
        int questions = 0;
        ASSERT_TRUE(build(way, 1'000'000, questions));
        EXPECT_GT(questions, 20);
        // On one thread the same questions are asked each time.
        with_threads(1, [&] {
            int all = 0;
            ASSERT_TRUE(build(way, 1'000'000, all));
            // All of them in the long tier, fifteen of them all along the build in the quick one.
            const int step = test::by_tier(std::max(1, all / 15), 1);
            for (int after = 0; after < all; after += step) {
                int asked = 0;
                const Result<Accel> accel = build(way, after, asked);
                ASSERT_FALSE(accel) << after << " of " << all;
                EXPECT_EQ(accel.error().code, ErrorCode::render_failed);
                EXPECT_EQ(asked, after + 1) << "asked again after a yes";
            }
        });
        for (const int after : {0, 1, 2, 5, 10, 20}) {
            int asked = 0;
            EXPECT_FALSE(build(way, after, asked)) << after;
        }
    }
}

/// Whether it pays to open instances is asked of levels by rays, and kernels look into whatever nodes there are.
TEST(Build, ACancelledLevelIsEmpty) {
    TestScene scene("a sphere");
    scene.meshes.push_back(icosphere(4));
    const std::vector<Geometry> geometries = scene.geometries();
    const LevelPart part{0, kNoHit, 0};
    with_threads(1, [&] {
        for (const Way& way : kWays) {
            bool cancelled = true;
            for (int after = 0; cancelled; ++after) {
                ASSERT_LT(after, 1000);
                LargeArray<BuildPrimitive> primitives;
                ASSERT_TRUE(append_primitives(geometries[0], 0, 0, primitives));
                int asked = 0;
                BuildMonitor monitor([&] { return asked++ >= after; });
                BvhOptions options;
                options.builder = way.builder, options.layout = way.layout;
                const Level level = build_level(std::move(primitives), geometries, {&part, 1}, {}, options, monitor);
                cancelled = asked > after;
                const bool compact = way.layout == BvhLayout::compact;
                EXPECT_EQ(level.nodes.empty(), cancelled || compact) << after;
                EXPECT_EQ(level.compact.nodes.empty(), cancelled || !compact) << after;
                EXPECT_EQ(level.view().nodes == nullptr, cancelled) << after;
                if (!cancelled) {
                    EXPECT_GT(after, compact ? 10 : 3);
                }
            }
        }
    });
}

TEST(Build, SaysHowFarItIs) {
    const ThreadLimit limit(5);
    const TestScene scene = some_of_everything();
    for (const Way& way : kWays)
        for (const uint32_t threads : {1u, 5u})
            with_threads(threads, [&] {
                std::vector<double> told;
                std::atomic<int> inside{0};
                AccelOptions options;
                options.builder = way.builder, options.layout = way.layout;
                options.progress = [&](double fraction) {
                    EXPECT_EQ(inside++, 0) << "told by two threads at once";
                    told.push_back(fraction);
                    --inside;
                };
                ASSERT_TRUE(Accel::build(scene.geometries(), scene.instances, options));
                ASSERT_GE(told.size(), 8u);
                EXPECT_GT(told.front(), 0);
                for (size_t i = 1; i < told.size(); ++i) EXPECT_GT(told[i], told[i - 1]);
                EXPECT_EQ(told.back(), 1);
                // All the work was announced, and what was announced is done: the last step before the end is small.
                // The compact layout, which takes longest to pack, says so meanwhile.
                EXPECT_GT(told[told.size() - 2], way.layout == BvhLayout::compact ? 0.95 : 0.85);
                if (threads > 1) return;
                for (size_t i = 1; i < told.size(); ++i) EXPECT_LT(told[i] - told[i - 1], 0.5);
            });
}

TEST(Build, CountsItsBytes) {
    TestScene scene = std::move(abuse(50'000)[4]);
    const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances);
    ASSERT_TRUE(accel);
    const AccelStatistics& s = accel->statistics();
    // At least the nine coordinates and the id of every triangle, and the nodes.
    EXPECT_GE(s.bytes, 50'000u * 40 + s.nodes * sizeof(WideNode));
    EXPECT_LE(s.bytes, 50'000u * 160 + s.nodes * sizeof(WideNode) + 10'000);
    EXPECT_GT(s.build_seconds, 0);
}

}  // namespace
}  // namespace steradian::test
