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
    std::vector<Mesh> meshes = {};
    std::vector<SphereGeometry> spheres = {};
    std::vector<RectangleGeometry> rectangles = {};
    std::vector<DiskGeometry> disks = {};
    std::vector<GeometryInstance> instances = {{0, {}}};
    OpenInstances open = OpenInstances::automatic;

    std::vector<Geometry> geometries() const {
        std::vector<Geometry> all;
        for (const Mesh& m : meshes) all.push_back(TriangleGeometry{m.positions, m.indices});
        if (!spheres.empty()) all.push_back(std::span(spheres));
        if (!rectangles.empty()) all.push_back(std::span(rectangles));
        if (!disks.empty()) all.push_back(std::span(disks));
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

/// A bumpy square of 2 side² triangles, with the vertices shared as in any mesh.
Mesh height_field(int side) {
    Mesh mesh;
    const auto at = [](int x, int y) {
        return Vec3{float(x), 3 * float(std::sin(0.1 * x) * std::cos(0.13 * y)), float(y)};
    };
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            mesh.add(at(x, y), at(x + 1, y), at(x, y + 1));
            mesh.add(at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
        }
    return mesh;
}

/// Worlds of about n primitives each: what a primitive takes is very different from one to the next.
std::vector<World> triangle_worlds(int n) {
    std::vector<World> all;
    all.push_back({"small triangles", {soup(n, 0.01, 1)}});
    all.push_back({"large triangles", {soup(n, 1, 2)}});
    all.push_back({"height field", {height_field(int(std::sqrt(n / 2)))}});
    World same{"coincident triangles", {{}}}, points{"points", {{}}}, nested{"exponentially nested", {{}}},
        tetrahedra{"tetrahedra", {{}}}, same_points{"coincident points", {{}}};
    Random random(3);
    for (int i = 0; i < n; ++i) {
        same.meshes[0].add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        same_points.meshes[0].add({0, 0, 0}, {0, 0, 0}, {0, 0, 0});
        const Vec3 p = in_cube(random, 1);
        points.meshes[0].add(p, p, p);
        const auto s = static_cast<float>(std::pow(10.0, -30 + 45.0 * i / n));
        nested.meshes[0].add({0, 0, 0}, {s, 0, s}, {0, s, s});
        if (i % 4) continue;
        const Vec3 a = p + in_cube(random, 0.01), b = p + in_cube(random, 0.01), c = p + in_cube(random, 0.01);
        Mesh& four = tetrahedra.meshes[0];
        four.add(p, a, b), four.add(p, b, c), four.add(p, c, a), four.add(a, b, c);
    }
    for (World* w : {&same, &points, &nested, &tetrahedra, &same_points}) all.push_back(std::move(*w));
    return all;
}

std::vector<World> shape_worlds(int n) {
    Random random(4);
    World spheres{"spheres"}, rectangles{"rectangles"}, disks{"disks"}, same_spheres{"coincident spheres"},
        same_rectangles{"coincident rectangles"}, same_disks{"coincident disks"}, mixed{"of every kind"};
    for (int i = 0; i < n; ++i) {
        const Vec3 at = in_cube(random, 1), u = in_cube(random, 0.01), v = in_cube(random, 0.01);
        spheres.spheres.push_back({at, 0.01f}), same_spheres.spheres.push_back({{1, 2, 3}, 1});
        rectangles.rectangles.push_back({at, u, v}), disks.disks.push_back({at, u, v});
        same_rectangles.rectangles.push_back({{1, 2, 3}, {1, 0, 0}, {0, 1, 0}});
        same_disks.disks.push_back({{1, 2, 3}, {1, 0, 0}, {0, 1, 0}});
        if (i % 4 == 1) mixed.spheres.push_back({at, 0.01f});
        if (i % 4 == 2) mixed.rectangles.push_back({at, u, v});
        if (i % 4 == 3) mixed.disks.push_back({at, u, v});
    }
    mixed.meshes = {soup(n / 4, 0.01, 4)};
    mixed.instances = {{0, {}}, {1, {}}, {2, {}}, {3, {}}};
    std::vector<World> all;
    for (World* w : {&spheres, &rectangles, &disks, &same_spheres, &same_rectangles, &same_disks, &mixed})
        all.push_back(std::move(*w));
    return all;
}

World pile_of(int triangles, int count) {
    World pile{"instances within each other", {soup(triangles, 0.02, 8)}, {}, {}, {}, {}};
    Random random(6);
    for (int i = 0; i < count; ++i) {
        const Vec3 at = in_cube(random, 0.5), around = in_cube(random, 1);
        pile.instances.push_back(
            {0, translation(at.x, at.y, at.z) * rotation_degrees(i, {around.x, around.y, around.z})});
    }
    return pile;
}

std::vector<World> instance_worlds(int n) {
    World many{"instances", {soup(100, 0.1, 5), soup(n / 4, 0.1, 6)}, {}, {}, {}, {{1, {}}}},
        same{"coincident instances", {soup(100, 0.1, 5)}, {}, {}, {}, {}}, pile = pile_of(n, n / 100);
    const int side = int(std::sqrt(n));
    for (int i = 0; i < n; ++i) many.instances.push_back({0, translation(i % side, i / side, 0)});
    for (int i = 0; i < n; ++i) same.instances.push_back({0, rotation_degrees(30, {1, 2, 3})});
    World opened = pile;
    opened.name = "opened instances", opened.open = OpenInstances::always;
    opened.meshes.push_back(soup(100, 0.1, 9)), opened.instances.push_back({1, {}});
    std::vector<World> all;
    for (World* w : {&many, &same, &pile, &opened}) all.push_back(std::move(*w));
    return all;
}

World one_of(const std::string& what) {
    World w{"one " + what};
    if (what == "triangle" || what == "instance") w.meshes = {soup(1, 1, 7)};
    if (what == "sphere") w.spheres = {{{1, 2, 3}, 1}};
    if (what == "rectangle") w.rectangles = {{{1, 2, 3}, {1, 0, 0}, {0, 1, 0}}};
    if (what == "disk") w.disks = {{{1, 2, 3}, {1, 0, 0}, {0, 1, 0}}};
    if (what == "instance") w.instances = {{0, rotation_degrees(30, {1, 2, 3})}};
    return w;
}

/// Beside the result a build holds at most this many times as much, and a little that does not grow with it: what
/// finding out takes whether instances are to be opened (65536 items of about 180 bytes), where that may be, and
/// otherwise histograms, bins and chunks.
constexpr int64_t kMostBeside = 2, kLittle = 24 << 10, kTrial = 12 << 20;
/// How far above what is held the bounds of build_memory are, at most, as it says.
constexpr int64_t kPeakSlack = 20, kResultSlack = 21;

void expect_bounded(const World& world, const AccelOptions& options, int64_t constant, const std::string& what) {
    const std::vector<Geometry> geometries = world.geometries();
    const BuildMemory bound = build_memory(geometries, world.instances, options);
    bench::reset_memory_use();
    const Result<Accel> accel = Accel::build(geometries, world.instances, options);
    const bench::MemoryUse use = bench::memory_use();
    ASSERT_TRUE(accel) << what;
    EXPECT_LE(use.peak - use.held, kMostBeside * use.held + constant) << what << " holds " << use.held;
    EXPECT_LE(use.held, int64_t(bound.result)) << what;
    EXPECT_LE(use.peak, int64_t(bound.peak)) << what;
    if (accel->statistics().primitives < 1000) return;
    EXPECT_GE(use.held * kResultSlack, int64_t(bound.result)) << what;
    EXPECT_GE(use.peak * kPeakSlack, int64_t(bound.peak)) << what;
}

void expect_bounded_in_all_ways(const World& world, int64_t constant) {
    for (uint8_t builder = 0; builder < names_of<BvhBuilder>().size(); ++builder)
        for (const BvhLayout layout : {BvhLayout::full, BvhLayout::compact})
            for (const uint32_t threads : {1u, 4u})
                with_threads(threads, [&] {
                    AccelOptions options;
                    options.builder = BvhBuilder(builder), options.layout = layout;
                    options.open = world.open;
                    expect_bounded(world, options, constant,
                                   world.name + ", " + std::string(name_of(options.builder)) + ", " +
                                       std::string(name_of(layout)) + ", " + std::to_string(threads));
                });
}

class BuildMemory : public testing::Test {
protected:
    void SetUp() override {
        with_threads(4, [] { parallel_for(1000, 1, [](size_t, size_t) {}); });  // workers themselves do not count
    }
    const ThreadLimit limit_{4};
};

// A number of leaves of four triangles, or of eight, where a hierarchy is smallest.
constexpr int kCount = 16'384;

TEST_F(BuildMemory, OfTriangles) {
    for (const World& world : triangle_worlds(kCount)) expect_bounded_in_all_ways(world, kLittle);
}
TEST_F(BuildMemory, OfShapes) {
    for (const World& world : shape_worlds(kCount)) expect_bounded_in_all_ways(world, kLittle);
}
TEST_F(BuildMemory, OfInstances) {
    for (const World& world : instance_worlds(kCount))
        expect_bounded_in_all_ways(world, world.open == OpenInstances::automatic ? kTrial : kLittle);
}
/// So many that what is tried takes more than kTrial, in the layout in which the result is smaller.
TEST_F(BuildMemory, OfManyPartsOfInstances) {
    const World pile = pile_of(480'000, 1000);
    for (const BvhBuilder builder : {BvhBuilder::sah, BvhBuilder::fast})
        with_threads(4, [&] {
            AccelOptions options;
            options.builder = builder, options.layout = BvhLayout::compact;
            expect_bounded(pile, options, kLittle, pile.name);
        });
}
TEST_F(BuildMemory, OfOneOfEach) {
    for (const char* what : {"triangle", "sphere", "rectangle", "disk", "instance"})
        expect_bounded_in_all_ways(one_of(what), kLittle);
}

}  // namespace
}  // namespace steradian::test
