// What a caller may get wrong, and hostile rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cstdlib>
#include <limits>

#include "accel/kernels/kernels.h"
#include "brute_force.h"

namespace steradian::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kMax = std::numeric_limits<float>::max();

template <class T>
ErrorCode refused(const T& geometry, const Affine& transform = {}, uint32_t max_depth = 64, uint32_t index = 0) {
    const Geometry g = geometry;
    const GeometryInstance instance{index, transform};
    AccelOptions options;
    options.max_depth = max_depth;
    const Result<Accel> accel = Accel::build({&g, 1}, {&instance, 1}, options);
    EXPECT_FALSE(accel);
    if (accel) return ErrorCode::resources;
    EXPECT_FALSE(accel.error().message.empty());
    return accel.error().code;
}

TEST(Api, RefusesBadGeometry) {
    for (const float bad : {kNan, kInfinity, -kInfinity, kMax, 1.1e15f, -1.1e15f}) {
        for (size_t vertex = 0; vertex < 3; ++vertex)
            for (int axis = 0; axis < 3; ++axis) {
                TriangleMesh mesh;
                mesh.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
                mesh.positions[vertex][axis] = bad;
                EXPECT_EQ(refused(mesh.geometry()), ErrorCode::bad_input);
            }
        const SphereGeometry spheres[] = {{{bad, 0, 0}, 1}, {{0, 0, 0}, bad}, {{0, bad, 0}, 0}};
        for (const auto& s : spheres) EXPECT_EQ(refused(std::span(&s, 1)), ErrorCode::bad_input);
        const RectangleGeometry rectangles[] = {
            {{0, 0, bad}, {1, 0, 0}, {0, 1, 0}}, {{}, {bad, 0, 0}, {0, 1, 0}}, {{}, {1, 0, 0}, {0, bad, 0}}};
        for (const auto& r : rectangles) {
            EXPECT_EQ(refused(std::span(&r, 1)), ErrorCode::bad_input);
            const DiskGeometry d{r.center, r.half_u, r.half_v};
            EXPECT_EQ(refused(std::span(&d, 1)), ErrorCode::bad_input);
        }
    }
    const SphereGeometry negative{{0, 0, 0}, -1};
    EXPECT_EQ(refused(std::span(&negative, 1)), ErrorCode::bad_input);
}

TEST(Api, RefusesBadIndicesTransformsAndOptions) {
    TriangleMesh mesh;
    mesh.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    EXPECT_EQ(refused(mesh.geometry(), {}, 0), ErrorCode::usage);
    EXPECT_EQ(refused(mesh.geometry(), {}, 65), ErrorCode::usage);
    EXPECT_EQ(refused(mesh.geometry(), {}, 64, 1), ErrorCode::bad_input);
    EXPECT_EQ(refused(mesh.geometry(), scaling(1, 0, 1)), ErrorCode::bad_input);
    EXPECT_EQ(refused(mesh.geometry(), scaling(1, std::numeric_limits<double>::infinity(), 1)), ErrorCode::bad_input);
    EXPECT_EQ(refused(mesh.geometry(), translation(1e17, 0, 0)), ErrorCode::bad_input);
    EXPECT_EQ(refused(mesh.geometry(), scaling(1e20, 1e20, 1e20)), ErrorCode::bad_input);
    mesh.indices.push_back(0);
    EXPECT_EQ(refused(mesh.geometry()), ErrorCode::bad_input);
    mesh.indices = {0, 1, 3};
    EXPECT_EQ(refused(mesh.geometry()), ErrorCode::bad_input);
}

/// Vertices nobody uses do not matter.
TEST(Api, UnusedVerticesAreNotLookedAt) {
    TriangleMesh mesh;
    mesh.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh.positions.push_back({kNan, 0, 0});
    const Geometry g = mesh.geometry();
    const GeometryInstance instance;
    EXPECT_TRUE(Accel::build({&g, 1}, {&instance, 1}));
}

std::vector<Ray> hostile_rays() {
    std::vector<Ray> rays;
    const float values[] = {0.0f, -0.0f, 1.0f, -1.0f, 1e-45f, 1e-39f, 2e-38f, kMax, -kMax, kInfinity, -kInfinity, kNan};
    for (const float x : values)
        for (const float y : values)
            for (const float z : values) {
                rays.push_back({{0.1f, 0.2f, 0.3f}, 0, {x, y, z}, kInfinity});
                rays.push_back({{x, y, z}, 0, {-1, 0.5f, 0.25f}, kInfinity});
            }
    for (const float tmin : values)
        for (const float tmax : values) rays.push_back({{-3, 0.1f, 0.2f}, tmin, {1, 0, 0}, tmax});
    return rays;
}

TEST(Api, HostileRaysGetTheDefinedAnswer) {
    const std::vector<Ray> rays = hostile_rays();
    for (const TestScene& scene : hard_scenes()) {
        const BruteForce brute(scene);
        const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances);
        ASSERT_TRUE(accel);
        for (const Ray& ray : rays) {
            const Hit hit = accel->intersect(ray);
            ASSERT_TRUE(same_bits(hit, brute.first_hit(ray))) << scene.name << " " << describe(ray);
            ASSERT_EQ(accel->occluded(ray), hit.found());
            const bool usable = is_finite(ray.o) && is_finite(ray.d) && length(Vec3d(ray.d)) > 0;
            ASSERT_TRUE(usable || !hit.found());
            if (hit.found()) {
                ASSERT_TRUE(is_finite(hit.t) && is_finite(hit.u) && is_finite(hit.v));
            }
        }
    }
}

/// The same in spans, on every kernel.
TEST(Api, HostileRaysAmongManyGetTheDefinedAnswer) {
    const std::vector<Ray> rays = hostile_rays();
    for (const TestScene& scene : hard_scenes()) {
        const BruteForce brute(scene);
        std::vector<Hit> expected, hits(rays.size());
        std::vector<uint8_t> occluded(rays.size());
        for (const Ray& ray : rays) expected.push_back(brute.first_hit(ray));
        for (const Isa isa : supported_isas())
            for (const BvhLayout layout : {BvhLayout::full, BvhLayout::compact}) {
                AccelOptions options;
                options.isa = isa;
                options.layout = layout;
                const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances, options);
                ASSERT_TRUE(accel);
                for (const RayKind kind : {RayKind::incoherent, RayKind::coherent}) {
                    accel->intersect(rays, hits, kind);
                    accel->occluded(rays, occluded, kind);
                    for (size_t i = 0; i < rays.size(); ++i) {
                        ASSERT_TRUE(same_bits(hits[i], expected[i])) << scene.name << " " << describe(rays[i]);
                        ASSERT_EQ(occluded[i] != 0, expected[i].found());
                    }
                }
            }
    }
}

/// Of a row of triangles of which a ray along it meets all boxes, and of one that misses everything.
TEST(Api, VisitsAreCounted) {
    constexpr int kTriangles = 512;
    TriangleMesh mesh;
    for (int i = 0; i < kTriangles; ++i) {
        const auto z = static_cast<float>(i);
        mesh.add({-1, -1, z}, {1, -1, z}, {0, 1, z});
    }
    const Geometry geometry = mesh.geometry();
    const GeometryInstance instance{};
    // Past every triangle, but not past its box; the nearest first, of which no more than the first leaf is needed; and
    // past everything.
    const Ray rays[] = {{{0.9f, 0.9f, -1}, 0, {0, 0, 1}, kInfinity},
                        {{0, 0, -1}, 0, {0, 0, 1}, kInfinity},
                        {{5, 0, -1}, 0, {0, 0, 1}, kInfinity}};
    for (const Isa isa : supported_isas())
        for (const BvhLayout layout : {BvhLayout::full, BvhLayout::compact}) {
            AccelOptions options;
            options.isa = isa;
            options.layout = layout;
            const Result<Accel> accel = Accel::build({&geometry, 1}, {&instance, 1}, options);
            ASSERT_TRUE(accel);
            const AccelStatistics& s = accel->statistics();
            const RayVisits all = accel->visits(rays[0]), first = accel->visits(rays[1]);
            EXPECT_EQ(all.nodes, s.nodes);
            EXPECT_GE(all.items, uint32_t(kTriangles / 4));
            EXPECT_GE(all.items, s.leaves);
            EXPECT_LT(first.nodes, all.nodes);
            EXPECT_LE(first.items, 2u);
            EXPECT_EQ(accel->visits(rays[2]), (RayVisits{1, 0}));
        }
}

// Embree's bound is 2.5 times a normal ray; these return before they look at anything.
TEST(Api, NextHitAfterAMissIsAMiss) {
    TestScene scene("sphere");
    scene.meshes.push_back(icosphere(1));
    scene.finish(1);
    const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances);
    ASSERT_TRUE(accel);
    const Ray ray{{0, 0, 0}, 0, {1, 0, 0}, kInfinity};
    const Hit miss;
    Hit hit = accel->intersect(ray);
    EXPECT_TRUE(hit.found());
    accel->next_hit({&ray, 1}, {&miss, 1}, {&hit, 1});
    EXPECT_TRUE(same_bits(hit, Hit{}));
}

// A host program's rounding mode neither leaks into the answers nor is lost.
TEST(Api, IndependentOfTheCallersRoundingMode) {
    const TestScene scene = std::move(hard_scenes()[0]);
    const Result<Accel> expected = Accel::build(scene.geometries(), scene.instances);
    ASSERT_TRUE(expected);
    const std::vector<Ray> rays = hard_rays(scene, 2000, 4);
    std::vector<Hit> wanted(rays.size()), hits(rays.size());
    expected->intersect(rays, wanted);
    std::fesetround(FE_UPWARD);
    const Result<Accel> accel = Accel::build(scene.geometries(), scene.instances);
    if (accel) accel->intersect(rays, hits);
    const int mode = std::fegetround();
    std::fesetround(FE_TONEAREST);
    ASSERT_TRUE(accel);
    EXPECT_EQ(mode, FE_UPWARD);
    for (size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(same_bits(hits[i], wanted[i]));
}

/// Sets a variable for as long as it lives.
class Environment {
public:
    Environment(const char* name, const char* value) : name_(name) { ::setenv(name, value, 1); }
    ~Environment() { ::unsetenv(name_); }

private:
    const char* name_;
};

TEST(Isa, ChosenByOptionThenEnvironmentThenMachine) {
    const std::vector<Isa> here = supported_isas();
    ASSERT_EQ(here.back(), Isa::scalar);
    EXPECT_EQ(*select_kernels(Isa::automatic), *select_kernels(here.front()));
    const Environment environment("STERADIAN_ISA", "scalar");
    EXPECT_EQ(*select_kernels(Isa::automatic), &kScalarKernels);
    EXPECT_EQ(*select_kernels(here.front()), *select_kernels(here.front()));
    for (const char* name : {"", "auto"}) {
        const Environment other("STERADIAN_ISA", name);
        EXPECT_EQ(*select_kernels(Isa::automatic), *select_kernels(here.front()));
    }
}

TEST(Isa, RefusesWhatTheMachineLacksAndSaysWhatItHas) {
    const std::vector<Isa> here = supported_isas();
    for (const Isa isa : {Isa::scalar, Isa::sse4, Isa::avx2, Isa::avx512, Isa::neon}) {
        const Result<const Kernels*> kernels = select_kernels(isa);
        const bool has = std::find(here.begin(), here.end(), isa) != here.end();
        ASSERT_EQ(kernels.ok(), has);
        if (has) continue;
        EXPECT_EQ(kernels.error().code, ErrorCode::usage);
        EXPECT_NE(kernels.error().hint.find("scalar"), std::string::npos);
        AccelOptions options;
        options.isa = isa;
        EXPECT_FALSE(Accel::build({}, {}, options));
    }
    const Environment environment("STERADIAN_ISA", "mmx");
    const Result<const Kernels*> kernels = select_kernels(Isa::automatic);
    ASSERT_FALSE(kernels);
    EXPECT_NE(kernels.error().message.find("mmx"), std::string::npos);
}

}  // namespace
}  // namespace steradian::test
