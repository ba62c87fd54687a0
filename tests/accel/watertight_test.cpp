// Closed meshes let no ray through, whatever it is aimed at.
#include <gtest/gtest.h>

#include "brute_force.h"
#include "support/support.h"

namespace steradian::test {
namespace {

struct Closed {
    std::string name;
    TriangleMesh mesh;
    Vec3 center;    ///< rays start around it
    double radius;  ///< a ball around the centre of this size is inside
};

std::vector<Closed> closed_meshes() {
    std::vector<Closed> all;
    const auto add = [&](const std::string& name, TriangleMesh mesh, double scale, Vec3 at, double inside) {
        mesh.move(scale, at);
        all.push_back({name, std::move(mesh), at, inside * scale});
    };
    add("icosphere", icosphere(3), 1, {0, 0, 0}, 0.9);
    add("icosphere of radius 2, far from the origin", icosphere(3), 2, {148376, 1234, -223423}, 0.9);
    add("icosphere of radius 2, so far that vertices are coarse", icosphere(2), 2, {3e6f, -2e6f, 1e6f}, 0.3);
    add("coarse icosphere", icosphere(0), 1, {0.1f, 0.2f, 0.3f}, 0.7);
    add("needles", needles(1000), 1, {0, 0, 0}, 0.9);
    add("needles far from the origin", needles(100), 3, {1000, 2000, -3000}, 0.5);
    for (const double scale : {1e-20, 1e-3, 1.0, 1e3, 1e6, 1e14}) {
        add("cube of " + std::to_string(scale), cube(), scale, {0, 0, 0}, 0.999999);
        add("icosphere of " + std::to_string(scale), icosphere(2), scale, {0, 0, 0}, 0.9);
    }
    return all;
}

/// From inside: near the middle, near the surface, or a float away from a face of a cube.
Vec3 start(const Closed& closed, Vec3 target, Random& random) {
    const double near = closed.radius * random.unit();
    switch (random.below(4)) {
        case 0:
            return closed.center;
        case 1:
            return Vec3(Vec3d(closed.center) + Vec3d(random.direction()) * near);
        case 2: {  // from the middle towards the target, almost there
            const Vec3d to = Vec3d(target) - Vec3d(closed.center);
            return Vec3(Vec3d(closed.center) + normalize(to) * closed.radius);
        }
        default:
            return Vec3(Vec3d(closed.center) + Vec3d(random.direction()) * closed.radius);
    }
}

Ray aimed_ray(const Closed& closed, Random& random) {
    const TriangleMesh& m = closed.mesh;
    const uint32_t triangle = 3 * random.below(static_cast<uint32_t>(m.indices.size() / 3));
    const uint32_t corner = random.below(3);
    const Vec3 a = m.positions[m.indices[triangle + corner]], b = m.positions[m.indices[triangle + (corner + 1) % 3]];
    const double s = random.below(3) == 0 ? 0 : random.below(8) == 0 ? random.decades(-9, -1) : random.unit();
    const Vec3 target = Vec3(Vec3d(a) * (1 - s) + Vec3d(b) * s);
    Ray ray;
    ray.o = start(closed, target, random);
    ray.d = Vec3(Vec3d(target) - Vec3d(ray.o));
    if (random.below(2)) ray.d = normalize(ray.d);
    if (random.below(4) == 0)  // straight through the diagonals and along the axes
        for (int axis = 0; axis < 3; ++axis) ray.d[axis] = static_cast<float>(int(random.below(3)) - 1);
    return ray;
}

TEST(Watertight, NoRayFromInsideGetsThrough) {
    const std::vector<Closed> all = closed_meshes();
    const size_t each = by_tier<size_t>(2'000'000, 50'000'000) / all.size();
    for (size_t c = 0; c < all.size(); ++c) {
        const Geometry geometry = all[c].mesh.geometry();
        const GeometryInstance instance;
        std::vector<Accel> built;
        for (const BvhBuilder builder : {BvhBuilder::sah, BvhBuilder::high_quality})
            for (const BvhLayout layout : {BvhLayout::full, BvhLayout::compact}) {
                AccelOptions options;
                options.builder = builder;
                options.layout = layout;
                Result<Accel> accel = Accel::build({&geometry, 1}, {&instance, 1}, options);
                ASSERT_TRUE(accel);
                built.push_back(std::move(*accel));
            }
        Random random(500 + c);
        std::vector<Ray> rays(1000);
        std::vector<Hit> hits(rays.size());
        size_t escaped = 0;
        for (size_t done = 0; done < each; done += rays.size()) {
            for (Ray& ray : rays) ray = aimed_ray(all[c], random);
            built[done / rays.size() % built.size()].intersect(rays, hits);
            for (size_t i = 0; i < rays.size(); ++i) {
                if (hits[i].found() || length(Vec3d(rays[i].d)) == 0) continue;
                if (++escaped <= 3) ADD_FAILURE() << all[c].name << ": escaped " << describe(rays[i]);
            }
        }
        EXPECT_EQ(escaped, 0u) << all[c].name;
    }
}

// The ray is rounded on its way into the space of the instance; the mesh stays closed.
TEST(Watertight, RotatedInstancesAreClosedToo) {
    Closed closed{"icosphere", icosphere(2), {0, 0, 0}, 0.9};
    const Geometry geometry = closed.mesh.geometry();
    Random random(7);
    for (int i = 0; i < 40; ++i) {
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
        const double away = i % 2 ? 1e4 : 1;
        const GeometryInstance instance{0, translation(away * x, away * y, away * z) *
                                               rotation_degrees(360 * y, {x, y, z}) *
                                               scaling(i % 3 ? 1 : -2, 1, 0.5 + random.unit())};
        AccelOptions options;
        options.layout = i % 4 < 2 ? BvhLayout::full : BvhLayout::compact;
        options.open = i % 5 < 3 ? OpenInstances::always : OpenInstances::never;
        const Result<Accel> accel = Accel::build({&geometry, 1}, {&instance, 1}, options);
        ASSERT_TRUE(accel);
        for (size_t k = 0; k < by_tier<size_t>(5'000, 200'000); ++k) {
            Ray ray = aimed_ray(closed, random);
            const auto m = [&](Vec3 v, double w) {
                const auto& a = instance.world_from_object.m;
                const auto row = [&](int r) { return a[r][0] * v.x + a[r][1] * v.y + a[r][2] * v.z + w * a[r][3]; };
                return Vec3(Vec3d{row(0), row(1), row(2)});
            };
            ray.o = m(ray.o, 1), ray.d = m(ray.d, 0);
            if (length(Vec3d(ray.d)) == 0) continue;
            ASSERT_TRUE(accel->intersect(ray).found()) << describe(ray);
        }
    }
}

}  // namespace
}  // namespace steradian::test
