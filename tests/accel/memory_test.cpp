// What a build takes, counted, against what it says it takes at most. A program of its own: operator new counts here.
#include <gtest/gtest.h>

#include <cmath>

#include "accel/build_memory.h"
#include "base/names.h"
#include "base/parallel.h"
#include "counting_new.h"
#include "math/transform.h"
#include "support/random.h"

namespace steradian::test {
namespace {

struct Mesh {
    std::vector<Vec3> positions;
    std::vector<uint32_t> indices;
    void add(Vec3 a, Vec3 b, Vec3 c) {
        for (const Vec3& p : {a, b, c}) indices.push_back(uint32_t(positions.size())), positions.push_back(p);
    }
};

struct World {
    std::string name;
    std::vector<Mesh> meshes;
    std::vector<SphereGeometry> spheres;
    std::vector<GeometryInstance> instances;
    OpenInstances open = OpenInstances::automatic;

    std::vector<Geometry> geometries() const {
        std::vector<Geometry> all;
        for (const Mesh& m : meshes) all.push_back(TriangleGeometry{m.positions, m.indices});
        if (!spheres.empty()) all.push_back(std::span(spheres));
        return all;
    }
};

Vec3 in_cube(Random& random, double size) {
    const auto x = [&] { return float(random.between(-size, size)); };
    const float a = x(), b = x();
    return {a, b, x()};
}

Mesh soup(int count, double size, uint64_t seed) {
    Random random(seed);
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const Vec3 c = in_cube(random, 1);
        const Vec3 p = c + in_cube(random, size), q = c + in_cube(random, size);
        mesh.add(c, p, q);
    }
    return mesh;
}

std::vector<World> worlds() {
    const int n = 20'000;
    std::vector<World> all;
    all.push_back({"small triangles", {soup(n, 0.01, 1)}, {}, {{0, {}}}});
    all.push_back({"large triangles", {soup(n, 1, 2)}, {}, {{0, {}}}});
    World same{"coincident triangles", {{}}, {}, {{0, {}}}}, points{"points", {{}}, {}, {{0, {}}}},
        nested{"exponentially nested", {{}}, {}, {{0, {}}}};
    Random random(3);
    for (int i = 0; i < n; ++i) {
        same.meshes[0].add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        const Vec3 p = in_cube(random, 1);
        points.meshes[0].add(p, p, p);
        const auto s = static_cast<float>(std::pow(10.0, -30 + 45.0 * i / n));
        nested.meshes[0].add({0, 0, 0}, {s, 0, s}, {0, s, s});
    }
    all.push_back(std::move(same)), all.push_back(std::move(points)), all.push_back(std::move(nested));
    World spheres{"spheres", {}, {}, {{0, {}}}}, many{"instances", {soup(100, 0.1, 5), soup(5000, 0.1, 6)}, {}, {}},
        few{"one triangle", {soup(1, 1, 7)}, {}, {{0, {}}}};
    for (int i = 0; i < n; ++i) spheres.spheres.push_back({in_cube(random, 1), 0.01f});
    many.instances.push_back({1, {}});
    for (int i = 0; i < n; ++i) many.instances.push_back({0, translation(i % 141, i / 141, 0)});
    World pile{"instances within each other", {soup(n, 0.02, 8)}, {}, {}},
        opened{"opened instances", {soup(n, 0.02, 8)}, {}, {{0, {}}}, OpenInstances::always};
    for (int i = 0; i < 200; ++i) {
        const Vec3 at = in_cube(random, 0.5), around = in_cube(random, 1);
        pile.instances.push_back(
            {0, translation(at.x, at.y, at.z) * rotation_degrees(i, {around.x, around.y, around.z})});
    }
    opened.instances = pile.instances;
    opened.meshes.push_back(soup(100, 0.1, 9)), opened.instances.push_back({1, {}});
    all.push_back(std::move(pile)), all.push_back(std::move(opened));
    all.push_back(std::move(spheres)), all.push_back(std::move(many)), all.push_back(std::move(few));
    return all;
}

/// How far above what is held the bounds are, at most, as build_memory says.
constexpr int64_t kPeakSlack = 10, kResultSlack = 16;

TEST(BuildMemory, IsNeverMoreThanItSays) {
    const ThreadLimit limit(4);
    with_threads(4, [] { parallel_for(1000, 1, [](size_t, size_t) {}); });  // the workers themselves are not counted
    for (const World& world : worlds())
        for (uint8_t builder = 0; builder < names_of<BvhBuilder>().size(); ++builder)
            for (const BvhLayout layout : {BvhLayout::full, BvhLayout::compact})
                for (const uint32_t threads : {1u, 4u})
                    with_threads(threads, [&] {
                        AccelOptions options;
                        options.builder = BvhBuilder(builder), options.layout = layout;
                        options.open = world.open;
                        const std::vector<Geometry> geometries = world.geometries();
                        const auto bound = build_memory(geometries, world.instances, options);
                        bench::reset_memory_use();
                        const Result<Accel> accel = Accel::build(geometries, world.instances, options);
                        const bench::MemoryUse use = bench::memory_use();
                        ASSERT_TRUE(accel);
                        const std::string what = world.name + ", " + std::string(name_of(options.builder)) + ", " +
                                                 std::string(name_of(layout)) + ", " + std::to_string(threads);
                        EXPECT_LE(use.held, int64_t(bound.result)) << what;
                        EXPECT_LE(use.peak, int64_t(bound.peak)) << what;
                        if (accel->statistics().primitives < 1000) return;
                        EXPECT_GE(use.held * kResultSlack, int64_t(bound.result)) << what;
                        EXPECT_GE(use.peak * kPeakSlack, int64_t(bound.peak)) << what;
                    });
}

}  // namespace
}  // namespace steradian::test
