// A hierarchy whose geometry has moved, against the loop over everything and against a new build.
#include <gtest/gtest.h>

#include <algorithm>

#include "accel/kernels/kernels.h"
#include "base/names.h"
#include "base/parallel.h"
#include "brute_force.h"
#include "math/transform.h"
#include "support/support.h"

namespace steradian::test {
namespace {

constexpr BvhLayout kLayouts[] = {BvhLayout::full, BvhLayout::compact};

/// Moves every vertex and parameter by up to `amount` of the scene's size, and every transform but identities.
void deform(TestScene& scene, double amount, uint64_t seed) {
    Random random(seed);
    const double by = amount * scene.size;
    const auto moved = [&](Vec3 p) {
        const Vec3d q = Vec3d(p) + Vec3d(random.in_cube(1)) * by;
        const auto kept = [](double x) { return std::clamp(x, -9e14, 9e14); };
        return Vec3(Vec3d{kept(q.x), kept(q.y), kept(q.z)});
    };
    for (TriangleMesh& mesh : scene.meshes)
        for (Vec3& p : mesh.positions) p = moved(p);
    for (auto& all : scene.spheres)
        for (SphereGeometry& s : all)
            s.center = moved(s.center), s.radius *= static_cast<float>(random.uniform(0.5, 1.5));
    for (auto& all : scene.rectangles)
        for (RectangleGeometry& r : all) r = {moved(r.center), r.half_v, r.half_u};
    for (auto& all : scene.disks)
        for (DiskGeometry& d : all) d = {moved(d.center), d.axis_v, d.axis_u * 0.5f};
    for (GeometryInstance& i : scene.instances)
        if (!is_identity(i.world_from_object))
            i.world_from_object = i.world_from_object * rotation_degrees(360 * amount * random.unit(), {1, 2, 3});
    scene.points.clear();
    const std::vector<GeometryInstance> instances = scene.instances;
    scene.finish(seed);
    scene.instances = instances;
}

void expect_answers(const Accel& accel, const std::vector<Ray>& rays, const std::vector<Hit>& expected,
                    const std::string& what) {
    std::vector<Hit> hits(rays.size());
    std::vector<uint8_t> occluded(rays.size());
    for (const RayKind kind : {RayKind::incoherent, RayKind::coherent}) {
        accel.intersect(rays, hits, kind);
        accel.occluded(rays, occluded, kind);
        for (size_t i = 0; i < rays.size(); ++i) {
            ASSERT_TRUE(same_bits(hits[i], expected[i])) << what << "\nray " << describe(rays[i]) << "\nexpected "
                                                         << describe(expected[i]) << "\ngot " << describe(hits[i]);
            ASSERT_EQ(occluded[i] != 0, expected[i].found()) << what << " " << describe(rays[i]);
        }
    }
}

TEST(Refit, EveryBitOfEveryHitOnEveryKernel) {
    const size_t count = by_tier<size_t>(1'500, 40'000);
    size_t turn = 0;
    for (TestScene& scene : hard_scenes()) {
        std::vector<Accel> built;
        for (const Isa isa : supported_isas())
            for (const BvhLayout layout : kLayouts) {
                AccelOptions options;
                options.isa = isa, options.layout = layout;
                options.builder = BvhBuilder(turn++ % names_of<BvhBuilder>().size());
                if (turn % 5 == 0) options.max_depth = 2;
                options.open = turn % 3 == 0 ? OpenInstances::never : OpenInstances::always;
                Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
                ASSERT_TRUE(accel) << scene.name;
                built.push_back(std::move(*accel));
            }
        // Little, so much that nothing is where it was, and back to little.
        for (const double amount : {0.01, 1.0, 0.1}) {
            deform(scene, amount, 77 + turn);
            const BruteForce brute(scene);
            const std::vector<Ray> rays = hard_rays(scene, count, turn);
            std::vector<Hit> expected(rays.size());
            for (size_t i = 0; i < rays.size(); ++i) expected[i] = brute.first_hit(rays[i]);
            const Result<Accel> fresh = Accel::build(scene.geometries(), scene.instances);
            ASSERT_TRUE(fresh) << scene.name << " " << fresh.error().message;
            for (Accel& accel : built) {
                const Status status = accel.refit(scene.geometries(), scene.instances);
                ASSERT_TRUE(status) << scene.name << " " << status.error().message;
                EXPECT_EQ(accel.bounds().lo, fresh->bounds().lo) << scene.name;
                EXPECT_EQ(accel.bounds().hi, fresh->bounds().hi) << scene.name;
                expect_answers(accel, rays, expected, scene.name);
            }
        }
    }
}

TestScene soup_of(int count, uint64_t seed) {
    TestScene scene("soup");
    TriangleMesh mesh;
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        const Vec3 c = random.in_cube(1);
        mesh.add(c + random.in_cube(0.02), c + random.in_cube(0.02), c + random.in_cube(0.02));
    }
    scene.meshes.push_back(std::move(mesh));
    scene.finish(seed);
    return scene;
}

/// Large enough that several workers share the work.
TEST(Refit, LargeMeshesOnAnyNumberOfThreads) {
    const ThreadLimit limit(5);
    TestScene scene = soup_of(60'000, 4);
    std::vector<Hit> expected;
    std::vector<std::vector<Vec3>> frames;
    for (int frame = 0; frame < 3; ++frame) deform(scene, 0.05, 9 + frame), frames.push_back(scene.meshes[0].positions);
    const std::vector<Ray> rays = hard_rays(scene, 3000, 3);
    const Result<Accel> fresh = Accel::build(scene.geometries(), scene.instances);
    ASSERT_TRUE(fresh);
    expected.resize(rays.size());
    fresh->intersect(rays, expected);
    for (const BvhLayout layout : kLayouts) {
        AccelOptions options;
        options.layout = layout;
        double cost = 0;
        for (const uint32_t threads : {1u, 2u, 5u})
            with_threads(threads, [&] {
                scene.meshes[0].positions = frames[0];
                Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
                ASSERT_TRUE(accel);
                for (const auto& frame : frames) {
                    scene.meshes[0].positions = frame;
                    ASSERT_TRUE(accel->refit(scene.geometries(), scene.instances));
                }
                expect_answers(*accel, rays, expected, "soup");
                // Sums in fixed chunks: the same to the bit.
                if (cost == 0) cost = accel->statistics().cost;
                EXPECT_EQ(accel->statistics().cost, cost);
            });
    }
}

class RefitLayout : public testing::TestWithParam<BvhLayout> {
protected:
    RefitLayout() { options_.layout = GetParam(); }
    AccelOptions options_;
};
INSTANTIATE_TEST_SUITE_P(Refit, RefitLayout, testing::ValuesIn(kLayouts));

/// A refit with nothing moved gives the boxes of the build; what moves apart costs more than a new build.
TEST_P(RefitLayout, CostSaysWhatItDidToTheBoxes) {
    TestScene scene = soup_of(20'000, 5);
    Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options_);
    ASSERT_TRUE(accel);
    const double built = accel->statistics().cost;
    EXPECT_GT(built, 1);
    ASSERT_TRUE(accel->refit(scene.geometries(), scene.instances));
    EXPECT_EQ(accel->statistics().cost, built);
    double before = built;
    for (const double amount : {0.02, 0.1, 0.5}) {
        TestScene moved = soup_of(20'000, 5);
        deform(moved, amount, 6);
        ASSERT_TRUE(accel->refit(moved.geometries(), moved.instances));
        const Result<Accel> fresh = Accel::build(moved.geometries(), moved.instances, options_);
        ASSERT_TRUE(fresh);
        EXPECT_GT(accel->statistics().cost, before);
        EXPECT_GT(accel->statistics().cost, fresh->statistics().cost) << amount;
        before = accel->statistics().cost;
    }
    ASSERT_TRUE(accel->refit(scene.geometries(), scene.instances));
    EXPECT_EQ(accel->statistics().cost, built);
}

/// One triangle and one instance of a node's cost, by hand.
TEST(Refit, CostByHand) {
    TriangleMesh one;
    one.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const Geometry g = one.geometry();
    const GeometryInstance once;
    // The root, and its one block.
    EXPECT_EQ(Accel::build({&g, 1}, {&once, 1})->statistics().cost, 2);
    const GeometryInstance twice[] = {{0, {}}, {0, {}}};
    // The root, two instances in the same place, and in each of them a root and a block.
    EXPECT_EQ(Accel::build({&g, 1}, twice)->statistics().cost, 1 + 2 * (1 + 2));
}

TEST_P(RefitLayout, RefusesWhatIsNotTheSameAndChangesNothing) {
    TestScene scene("some of everything");
    scene.meshes.push_back(icosphere(2));
    scene.meshes.push_back(cube());
    scene.spheres.push_back({{{3, 0, 0}, 1}, {{5, 0, 0}, 1}});
    scene.instances = {{0, {}}, {2, {}}, {1, translation(0, 3, 0)}, {1, translation(0, -3, 0)}};
    scene.finish(1);
    Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options_);
    ASSERT_TRUE(accel);
    const std::vector<Ray> rays = hard_rays(scene, 2000, 2);
    std::vector<Hit> expected(rays.size());
    accel->intersect(rays, expected);
    const double cost = accel->statistics().cost;
    const auto refused = [&](const std::vector<Geometry>& geometries, const std::vector<GeometryInstance>& instances,
                             const std::string& what) {
        const Status status = accel->refit(geometries, instances);
        ASSERT_FALSE(status) << what;
        EXPECT_EQ(status.error().code, ErrorCode::bad_input) << what;
        expect_answers(*accel, rays, expected, what);
        EXPECT_EQ(accel->statistics().cost, cost);
    };
    const std::vector<Geometry> geometries = scene.geometries();
    const auto with = [&](size_t i, const Geometry& g) {
        std::vector<Geometry> all = geometries;
        all[i] = g;
        return all;
    };
    refused({geometries[0], geometries[1]}, scene.instances, "a geometry less");
    refused(with(0, geometries[1]), scene.instances, "fewer triangles");
    refused(with(2, std::span(scene.spheres[0]).first(1)), scene.instances, "a sphere less");
    const DiskGeometry disks[2] = {{{3, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{5, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    refused(with(2, std::span(disks)), scene.instances, "disks for spheres");
    auto instances = scene.instances;
    instances.pop_back();
    refused(geometries, instances, "an instance less");
    instances = scene.instances, std::swap(instances[0], instances[1]);
    refused(geometries, instances, "instances of others");
    instances = scene.instances, instances[0].world_from_object = translation(1, 0, 0);
    refused(geometries, instances, "a transform where there was none");
    instances = scene.instances, instances[2].world_from_object = scaling(1, 0, 1);
    refused(geometries, instances, "a singular transform");
    instances = scene.instances, instances[2].world_from_object = translation(1e17, 0, 0);
    refused(geometries, instances, "out of the world");
    // The last thing that is looked at is wrong, after everything else has moved.
    TestScene moved("moved");
    moved.meshes = scene.meshes, moved.spheres = scene.spheres, moved.instances = scene.instances;
    for (TriangleMesh& mesh : moved.meshes) mesh.move(2, {1, 1, 1});
    moved.spheres[0][1].radius = -1;
    refused(moved.geometries(), scene.instances, "a negative radius");
    moved.spheres = scene.spheres, moved.meshes[1].positions[0].x = kInfinity;
    refused(moved.geometries(), scene.instances, "a vertex that is not finite");
    moved.meshes[1] = scene.meshes[1], moved.meshes[0].indices[5] = 1'000'000;
    refused(moved.geometries(), scene.instances, "a vertex that does not exist");
    moved.meshes[0] = scene.meshes[0];
    instances = scene.instances, instances[2].world_from_object = {};  // any transform will do where there was one
    EXPECT_TRUE(accel->refit(moved.geometries(), instances));
}

/// Triangles that share corners by where they are, and not by index: the compact layout takes more bytes once they have
/// moved apart, and as many as before when they come back.
TEST(Refit, VerticesThatMoveApartAndBack) {
    TestScene scene("sheet");
    TriangleMesh sheet;
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 60; ++x) {
            const auto at = [](int i, int j) { return Vec3{float(i), float(j), float(i * j % 3)}; };
            sheet.add(at(x, y), at(x + 1, y), at(x + 1, y + 1));
            sheet.add(at(x, y), at(x + 1, y + 1), at(x, y + 1));
        }
    scene.meshes.push_back(std::move(sheet));
    scene.finish(1);
    AccelOptions options;
    options.layout = BvhLayout::compact;
    Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
    ASSERT_TRUE(accel);
    const AccelStatistics built = accel->statistics();
    const std::vector<Vec3> positions = scene.meshes[0].positions;
    deform(scene, 0.01, 3);
    ASSERT_TRUE(accel->refit(scene.geometries(), scene.instances));
    EXPECT_GT(accel->statistics().bytes, built.bytes * 5 / 4);
    EXPECT_EQ(accel->statistics().build_seconds, built.build_seconds);
    const BruteForce brute(scene);
    const std::vector<Ray> rays = hard_rays(scene, 500, 2);
    std::vector<Hit> expected(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) expected[i] = brute.first_hit(rays[i]);
    expect_answers(*accel, rays, expected, "moved apart");
    scene.meshes[0].positions = positions;
    ASSERT_TRUE(accel->refit(scene.geometries(), scene.instances));
    EXPECT_EQ(accel->statistics().bytes, built.bytes);
    EXPECT_EQ(accel->statistics().cost, built.cost);
}

TEST(Refit, OfNothing) {
    for (const BvhLayout layout : kLayouts) {
        AccelOptions options;
        options.layout = layout;
        Result<Accel> accel = Accel::build({}, {}, options);
        ASSERT_TRUE(accel);
        EXPECT_TRUE(accel->refit({}, {}));
        EXPECT_FALSE(accel->intersect({{0, 0, 0}, 0, {1, 0, 0}, kInfinity}).found());
    }
}

}  // namespace
}  // namespace steradian::test
