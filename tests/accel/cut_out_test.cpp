// Primitives that are not opaque: what occluded() says of them, on every kernel, builder and layout.
#include <gtest/gtest.h>

#include "accel/geometry.h"
#include "brute_force.h"
#include "options.h"
#include "support/support.h"

namespace steradian::test {
namespace {

std::vector<Accel> build_all(const TestScene& scene) {
    std::vector<Accel> built;
    const std::vector<Geometry> geometries = scene.geometries();
    for (const AccelOptions& options : all_options()) {
        Result<Accel> accel = Accel::build(geometries, scene.instances, options);
        if (!accel) throw std::runtime_error(scene.name + ": " + accel.error().message);
        built.push_back(std::move(*accel));
    }
    return built;
}

/// Of each instance none, some or all; other ones for each instance of a geometry.
void scatter_cut_outs(TestScene& scene, uint64_t seed) {
    Random random(seed);
    const std::vector<Geometry> geometries = scene.geometries();
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const size_t bytes = (primitive_count(geometries[scene.instances[i].geometry]) + 7) / 8;
        const uint32_t kind = random.below(8);
        if (kind == 0) continue;
        std::vector<uint8_t> bits(bytes, 255);
        for (uint8_t& byte : bits) {
            const uint64_t once = random.bits(), again = random.bits();
            if (kind < 6) byte = static_cast<uint8_t>(kind < 3 ? once | again : once);
        }
        scene.set_cut_outs(i, std::move(bits));
    }
}

TEST(CutOuts, OcclusionIsWhatTheDefinitionSays) {
    std::vector<TestScene> scenes = hard_scenes();
    size_t seen[3] = {};
    for (size_t s = 0; s < scenes.size(); ++s) {
        TestScene& scene = scenes[s];
        scatter_cut_outs(scene, 900 + s);
        const BruteForce brute(scene);
        const std::vector<Accel> built = build_all(scene);
        const std::vector<Ray> rays = hard_rays(scene, by_tier<size_t>(1'500, 100'000), 800 + s);
        std::vector<Accel::Occlusion> expected;
        std::vector<Hit> first;
        for (const Ray& ray : rays) {
            expected.push_back(brute.occlusion(ray)), first.push_back(brute.first_hit(ray));
            ASSERT_EQ(first.back().found(), expected.back() != Accel::clear);
            ++seen[expected.back()];
        }
        for (const Accel& accel : built) {
            std::vector<uint8_t> result(rays.size());
            std::vector<Hit> hits(rays.size());
            for (const RayKind kind : {RayKind::incoherent, RayKind::coherent}) {
                accel.occluded(rays, result, kind);
                accel.intersect(rays, hits, kind);
                for (size_t i = 0; i < rays.size(); ++i) {
                    ASSERT_EQ(result[i], expected[i]) << scene.name << " " << describe(rays[i]);
                    ASSERT_TRUE(same_bits(hits[i], first[i])) << scene.name << " " << describe(rays[i]);
                }
            }
            for (size_t i = 0; i < rays.size(); i += 3)
                ASSERT_EQ(accel.occluded(rays[i]), expected[i]) << scene.name << " " << describe(rays[i]);
        }
    }
    for (const size_t n : seen) EXPECT_GT(n, 1000u);
}

/// Four sheets in a row in two instances of one geometry: opaque ones count wherever they are, beyond cut-outs and
/// among hits at the same t.
TEST(CutOuts, OpaqueOnesBlockWhateverIsInFront) {
    TestScene scene("sheets");
    TriangleMesh mesh;
    for (const float z : {0.0f, 1.0f, 2.0f, 2.0f}) mesh.add({-1, -1, z}, {3, -1, z}, {-1, 3, z});
    scene.meshes.push_back(std::move(mesh));
    scene.instances = {{0, {}}, {0, translation(0, 0, 10)}};
    const Ray ray{{0, 0, -1}, 0, {0, 0, 1}, kInfinity}, short_ray{{0, 0, -1}, 0, {0, 0, 1}, 5},
        shorter_ray{{0, 0, -1}, 0, {0, 0, 1}, 2.5f};
    struct Case {
        uint8_t first, second;
        Accel::Occlusion all, near, nearest;
    };
    for (const Case& c : {Case{15, 15, Accel::cut_out, Accel::cut_out, Accel::cut_out},
                          Case{7, 15, Accel::blocked, Accel::blocked, Accel::cut_out},
                          Case{11, 15, Accel::blocked, Accel::blocked, Accel::cut_out},
                          Case{15, 14, Accel::blocked, Accel::cut_out, Accel::cut_out},
                          Case{0, 0, Accel::blocked, Accel::blocked, Accel::blocked}}) {
        scene.set_cut_outs(0, {c.first});
        scene.set_cut_outs(1, {c.second});
        for (const Accel& accel : build_all(scene)) {
            EXPECT_EQ(accel.occluded(ray), c.all);
            EXPECT_EQ(accel.occluded(short_ray), c.near);
            EXPECT_EQ(accel.occluded(shorter_ray), c.nearest);
            EXPECT_EQ(accel.occluded(Ray{{9, 9, 9}, 0, {0, 0, 1}, kInfinity}), Accel::clear);
            EXPECT_EQ(accel.intersect(ray).prim, 0u);
        }
    }
}

/// The bits of primitives that do not exist mean nothing, and bits that are all 0 cost nothing.
TEST(CutOuts, NoneIsAsIfThereCouldBeNone) {
    TestScene scene("one triangle");
    TriangleMesh mesh;
    mesh.add({-1, -1, 0}, {3, -1, 0}, {-1, 3, 0});
    scene.meshes.push_back(std::move(mesh));
    scene.instances = {{0, {}}};
    const Ray ray{{0, 0, -1}, 0, {0, 0, 1}, kInfinity};
    const Result<Accel> without = Accel::build(scene.geometries(), scene.instances);
    scene.set_cut_outs(0, {0});
    const Result<Accel> zeros = Accel::build(scene.geometries(), scene.instances);
    scene.set_cut_outs(0, {0xfe});
    const Result<Accel> beyond = Accel::build(scene.geometries(), scene.instances);
    scene.set_cut_outs(0, {1});
    const Result<Accel> cut_out = Accel::build(scene.geometries(), scene.instances);
    ASSERT_TRUE(without && zeros && beyond && cut_out);
    EXPECT_EQ(zeros->statistics().bytes, without->statistics().bytes);
    EXPECT_GT(cut_out->statistics().bytes, without->statistics().bytes);
    for (const auto* accel : {&without, &zeros, &beyond}) EXPECT_EQ((*accel)->occluded(ray), Accel::blocked);
    EXPECT_EQ(cut_out->occluded(ray), Accel::cut_out);
}

TEST(CutOuts, OfAnotherSizeAreRefused) {
    TestScene scene("triangles");
    TriangleMesh mesh;
    for (int i = 0; i < 9; ++i) mesh.add({-1, -1, 0}, {3, -1, 0}, {-1, 3, 0});
    scene.meshes.push_back(std::move(mesh));
    scene.instances = {{0, {}}};
    for (const size_t size : {0u, 1u, 2u, 3u, 9u}) {
        scene.set_cut_outs(0, std::vector<uint8_t>(size, 255));
        const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances);
        ASSERT_EQ(accel.ok(), size == 0 || size == 2);
        if (!accel) {
            EXPECT_EQ(accel.error().code, ErrorCode::bad_input);
        }
    }
}

}  // namespace
}  // namespace steradian::test
