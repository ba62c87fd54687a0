// Opened instances: where their parts are, when they are opened, and that no answer depends on it. (The oracle tests,
// the hostile scenes, refits and watertightness have them as well.)
#include "accel/open.h"

#include <gtest/gtest.h>

#include "brute_force.h"
#include "math/transform.h"
#include "options.h"
#include "support/support.h"

namespace steradian::test {
namespace {

Affine any_transform(Random& random) {
    const Vec3 at = random.in_cube(3), around = random.in_cube(1);
    Affine m = translation(at.x, at.y, at.z) * rotation_degrees(random.uniform(0, 360), {around.x, around.y, around.z});
    if (random.below(3) == 0) m = translation(at.x, at.y, at.z) * rotation_degrees(45, {0, 0, 1});
    if (random.below(3) == 0) m = m * scaling(-random.decades(-1, 1), random.decades(-1, 1), random.decades(-1, 1));
    if (random.below(3) == 0) m.m[0][1] += random.uniform(-1, 1);
    const double scale = random.below(2) ? 1 : random.decades(-4, 4);
    return m * scaling(scale, scale, scale);
}

/// A near ray that goes past a corner of a box at next to no distance, from far away, mostly along an axis.
Ray grazing_ray(const Box& part, const Affine& world_from_object, const Box& near, Random& random) {
    Vec3 corner;
    for (int axis = 0; axis < 3; ++axis) corner[axis] = random.below(2) ? part.lo[axis] : part.hi[axis];
    const Vec3d target = transform_point(world_from_object, corner);
    Ray ray{Vec3(target), 0, {}, kInfinity};
    const int along = int(random.below(3));
    for (int axis = 0; axis < 3; ++axis) {
        const float size = near.hi[axis] - near.lo[axis];
        if (axis == along || random.below(4) == 0) ray.o[axis] = random.below(2) ? near.lo[axis] : near.hi[axis];
        if (axis != along) ray.o[axis] += size * static_cast<float>((random.unit() - 0.5) * 0x1p-20);
        ray.o[axis] = std::clamp(ray.o[axis], near.lo[axis], near.hi[axis]);
    }
    ray.d = Vec3(target - Vec3d(ray.o));
    const float length = max_component(abs(ray.d));
    if (random.below(4) == 0) ray.d = -ray.d;  // candidates behind the origin have intervals too
    if (random.below(4)) ray.d = ray.d * static_cast<float>(random.decades(-8, 8) / length);
    return ray;
}

/// Where a primitive may have accepted a t of a near ray, the world's box of every part that holds the primitive has it
/// in its interval.
TEST(Margin, EveryAcceptedTimeIsInTheWorldsBox) {
    Random random(5);
    size_t met = 0, lost_without = 0;
    for (size_t k = 0; k < by_tier<size_t>(3'000, 300'000); ++k) {
        const GeometryInstance instance{0, any_transform(random)};
        const Vec3 lo = random.in_cube(1), size = random.in_cube(1);
        Box bounds, part;
        bounds.extend(lo), bounds.extend(lo + abs(size));
        for (int i = 0; i < 2; ++i) {
            const auto between = [&](int axis) {
                return std::clamp(lo[axis] + static_cast<float>(random.unit()) * std::fabs(size[axis]), bounds.lo[axis],
                                  bounds.hi[axis]);
            };
            const float x = between(0), y = between(1);
            part.extend(Vec3{x, y, between(2)});
        }
        Placement placement;
        placement.instances = {&instance, 1};
        placement.placed.push_back(*place(0, instance.world_from_object, bounds));
        placement.scene = placement.placed[0].world;
        const double away = random.decades(-2, 0.7) * length(Vec3d(placement.scene.hi) - Vec3d(placement.scene.lo));
        for (int i = 0; i < 2; ++i) placement.scene.extend(placement.scene.hi + random.in_cube(away));
        placement.add_margins();
        if (!placement.margins[0]) continue;
        for (int i = 0; i < 100; ++i) {
            const Ray ray = grazing_ray(part, instance.world_from_object, placement.near, random);
            Ray canonical_ray, object_ray;
            if (!canonical(ray, canonical_ray) || !is_near(placement.near, canonical_ray)) continue;
            ASSERT_TRUE(placement.placed[0].to_object(canonical_ray, object_ray));
            const Interval own = slab_interval(part, SlabRay(object_ray));
            if (own.empty()) continue;
            const auto holds = [&](const Box& box) {
                const Interval world = slab_interval(box, SlabRay(canonical_ray));
                return world.in <= own.in && own.out <= world.out;
            };
            ++met;
            lost_without += !holds(transformed_bounds(instance.world_from_object, part));
            ASSERT_TRUE(holds(placement.placed[0].world)) << describe(ray);
            ASSERT_TRUE(holds(placement.world_box(0, part))) << describe(ray);
        }
    }
    // The rays are of the kind that needs a margin.
    std::printf("%zu boxes met, %zu of them would be missed without a margin\n", met, lost_without);
    EXPECT_GT(met, 10'000u);
    EXPECT_GT(lost_without, met / 1000);
}

struct Pile {
    TriangleMesh mesh;
    std::vector<GeometryInstance> instances;
    Geometry geometry() const { return mesh.geometry(); }
};

/// `count` instances of a mesh of radius 1 around [-half, half]³, or on a grid where they do not touch.
Pile pile_of(TriangleMesh mesh, int count, double half, bool apart) {
    Pile pile{std::move(mesh), {}};
    Random random(9);
    for (int i = 0; i < count; ++i) {
        Vec3 at = random.in_cube(half);
        if (apart) at = Vec3{float(i % 5), float(i / 5 % 5), float(i / 25)} * 2.5f;
        const Vec3 around = random.in_cube(1);
        pile.instances.push_back({0, translation(at.x, at.y, at.z) *
                                         rotation_degrees(random.uniform(0, 360), {around.x, around.y, around.z})});
    }
    return pile;
}
/// Small triangles in a ball, with much room between them.
TriangleMesh cloud(int count, bool degenerate = false) {
    TriangleMesh mesh;
    Random random(12);
    for (int i = 0; i < count; ++i) {
        const Vec3 at = random.direction() * static_cast<float>(std::cbrt(random.unit()));
        const Vec3 b = at + random.in_cube(0.02), c = at + random.in_cube(0.02);
        mesh.add(at, b, degenerate ? b : c);
    }
    return mesh;
}

std::vector<Ray> rays_around(const Accel& accel, size_t count, uint64_t seed, double distance) {
    Random random(seed);
    const Accel::Bounds b = accel.bounds();
    const Vec3 middle = (b.lo + b.hi) * 0.5f;
    const double size = 0.5 * max_component(b.hi - b.lo);
    std::vector<Ray> rays;
    for (size_t i = 0; i < count; ++i) {
        const Vec3 from = middle + random.in_cube(size * distance), to = middle + random.in_cube(size);
        rays.push_back({from, 0, to - from, kInfinity});
    }
    return rays;
}

double mean_work(const Accel& accel) {
    double sum = 0;
    const std::vector<Ray> rays = rays_around(accel, 2000, 3, 1);
    for (const Ray& ray : rays) sum += accel.visits(ray).nodes + accel.visits(ray).items;
    return sum / double(rays.size());
}

/// Piles of solids are opened, and rays have less to do; solids that stand apart and what rays go through are not.
TEST(OpenInstances, WhereItPays) {
    for (const BvhLayout layout : {BvhLayout::full, BvhLayout::compact}) {
        const auto build = [&](const Pile& pile, OpenInstances open) {
            AccelOptions options;
            options.layout = layout, options.open = open;
            const Geometry geometry = pile.geometry();
            return std::move(*Accel::build({&geometry, 1}, pile.instances, options));
        };
        for (const int count : {30, 100}) {
            const Pile solid = pile_of(icosphere(4), count, 1.2, false);
            const Accel opened = build(solid, OpenInstances::automatic), whole = build(solid, OpenInstances::never);
            EXPECT_GT(opened.statistics().instance_parts, uint64_t(count) * 16);
            EXPECT_EQ(whole.statistics().instance_parts, 0u);
            EXPECT_GT(opened.statistics().bytes, whole.statistics().bytes);
            EXPECT_LT(mean_work(opened), 0.95 * mean_work(whole));
            EXPECT_EQ(opened.bounds().lo, whole.bounds().lo);
            EXPECT_EQ(opened.bounds().hi, whole.bounds().hi);
            for (const Pile& other : {pile_of(icosphere(4), count, 1, true), pile_of(cloud(5000), count, 1.2, false)})
                EXPECT_EQ(build(other, OpenInstances::automatic).statistics().instance_parts, 0u);
        }
        const Pile one = pile_of(icosphere(4), 1, 1, false);
        EXPECT_EQ(build(one, OpenInstances::automatic).statistics().instance_parts, 0u);
        EXPECT_GT(build(one, OpenInstances::always).statistics().instance_parts, 0u);
    }
}

/// Near and far, with directions of any length.
TEST(OpenInstances, ChangeNoBit) {
    const Pile pile = pile_of(icosphere(4), 20, 1.2, false);
    const Geometry geometry = pile.geometry();
    for (AccelOptions options : all_options()) {
        options.open = OpenInstances::never;
        const Result<Accel> whole = Accel::build({&geometry, 1}, pile.instances, options);
        options.open = OpenInstances::always;
        const Result<Accel> opened = Accel::build({&geometry, 1}, pile.instances, options);
        ASSERT_TRUE(whole && opened);
        ASSERT_GT(opened->statistics().instance_parts, 1000u);
        size_t hit = 0;
        for (const double distance : {1.0, 3.0, 15.0, 20.0, 1e3, 1e6}) {
            std::vector<Ray> rays = rays_around(*whole, by_tier<size_t>(300, 50'000), 7, distance);
            Random random(8);
            for (Ray& ray : rays)
                if (random.below(3) == 0) ray.d = ray.d * static_cast<float>(random.decades(-14, 14));
            std::vector<Hit> a(rays.size()), b(rays.size());
            std::vector<uint8_t> blocked_a(rays.size()), blocked_b(rays.size());
            for (const RayKind kind : {RayKind::incoherent, RayKind::coherent}) {
                whole->intersect(rays, a, kind), opened->intersect(rays, b, kind);
                whole->occluded(rays, blocked_a, kind), opened->occluded(rays, blocked_b, kind);
                for (size_t i = 0; i < rays.size(); ++i) {
                    ASSERT_TRUE(same_bits(a[i], b[i])) << describe(options) << ", " << describe(rays[i]) << "\n"
                                                       << describe(a[i]) << "\n"
                                                       << describe(b[i]);
                    ASSERT_EQ(blocked_a[i], blocked_b[i]) << describe(options);
                    hit += a[i].found();
                }
            }
            whole->next_hit(rays, a, a), opened->next_hit(rays, b, b);
            for (size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(same_bits(a[i], b[i])) << describe(options);
        }
        EXPECT_GT(hit, 600u);
    }
}

/// Triangles of no area are never hit, so that rays visit what the surface-area heuristic says: it knows nothing of
/// hits. Instances are only moved, which keeps their boxes as tight as those of their hierarchies.
TEST(OpenInstances, CostIsWhatUniformLinesVisit) {
    Pile pile = pile_of(cloud(3000, true), 12, 1, false);
    Random placing(4);
    for (GeometryInstance& instance : pile.instances) {
        const Vec3 at = placing.in_cube(1);
        instance.world_from_object = translation(at.x, at.y, at.z);
    }
    const Geometry geometry = pile.geometry();
    for (const OpenInstances open : {OpenInstances::never, OpenInstances::always}) {
        AccelOptions options;
        options.open = open;
        const Result<Accel> accel = Accel::build({&geometry, 1}, pile.instances, options);
        ASSERT_TRUE(accel);
        const Accel::Bounds b = accel->bounds();
        const Box box{b.lo, b.hi};
        const Vec3d middle = Vec3d(b.lo + b.hi) * 0.5;
        const double radius = 0.5 * length(Vec3d(b.hi - b.lo));
        Random random(6);
        double visits = 0;
        size_t lines = 0;
        while (lines < by_tier<size_t>(20'000, 1'000'000)) {
            // Uniform in the disk across the direction, as wide as the sphere around the box.
            const Vec3d d = normalize(Vec3d(random.direction()));
            const Vec3d u = normalize(cross(d, std::fabs(d.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}));
            const double x = random.uniform(-radius, radius), y = random.uniform(-radius, radius);
            if (x * x + y * y > radius * radius) continue;
            const Vec3d across = u * x + cross(d, u) * y;
            const Ray ray{Vec3(middle + across - d * (2 * radius)), 0, Vec3(d), kInfinity};
            if (slab_interval(box, SlabRay(ray)).empty()) continue;
            const RayVisits v = accel->visits(ray);
            visits += v.nodes + v.items, ++lines;
        }
        const double mean = visits / double(lines), cost = accel->statistics().cost;
        std::printf("%zu parts: cost %g, visits %g\n", size_t(accel->statistics().instance_parts), cost, mean);
        EXPECT_NEAR(cost / mean, 1, 0.1);
    }
}

}  // namespace
}  // namespace steradian::test
