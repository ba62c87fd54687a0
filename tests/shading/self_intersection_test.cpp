// A ray that leaves a surface does not hit it again: all shapes, placed as they are or through transforms, at scales
// from a millimetre to a thousand kilometres, at the origin and far from it.
#include <gtest/gtest.h>

#include <string>

#include "shading/world.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::Random;
using test::World;

struct Placement {
    const char* name;
    Affine linear;
    bool baked;  ///< the shape itself is moved to its place; otherwise the instance is
};

std::vector<Placement> placements() {
    const Affine turn = rotation_degrees(37, {1, 2, -0.5});
    return {{"as it is", {}, true},
            {"moved", {}, false},
            {"rotated", turn, false},
            {"scaled", rotation_degrees(71, {0.2, -1, 3}) * scaling(0.07, 1.3, 19) * turn, false},
            {"mirrored", turn * scaling(-1, 1, 1), false},
            {"sheared", turn * scaling(1, 1e-3, 1) * rotation_degrees(45, {0, 0, 1}) * scaling(1, 1, 50), false}};
}

constexpr const char* kShapes[] = {"triangles", "slivers", "sphere", "rectangle", "disk"};

Vec3 at(Vec3d p, double scale, Vec3d offset) { return static_cast<Vec3>(p * scale + offset); }

/// The shape of the given kind, `scale` in size, about `offset`.
void add_kind(Scene& scene, std::string_view kind, double scale, Vec3d offset, const Affine& placement,
              Random& random) {
    const auto s = static_cast<float>(scale);
    const Vec3 center = static_cast<Vec3>(offset);
    if (kind == "sphere") {
        test::add_shape(scene, Sphere{center, s}, placement);
    } else if (kind == "rectangle") {
        test::add_shape(scene, Rectangle{center, Vec3{0.6f, 0.3f, -0.1f} * s, Vec3{-0.1f, 0.4f, 0.9f} * s}, placement);
    } else if (kind == "disk") {
        test::add_shape(scene, Disk{center, {0.3f, 1, -0.2f}, s}, placement);
    } else {
        Mesh mesh;
        for (uint32_t i = 0; i < 64; ++i) {
            const Vec3d p = random.direction() * random.between(0, 1);
            const Vec3d a = random.direction() * random.between(0.05, 1);
            const Vec3d b = kind == "slivers" ? a * 0.9 + random.direction() * 1e-4 : random.direction();
            for (const Vec3d v : {p, p + a, p + b}) {
                mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size()));
                mesh.positions.push_back(at(v, scale, offset));
            }
        }
        // One that is flat in y, as floors are.
        for (const Vec3d v : {Vec3d{-1, 0, -1}, Vec3d{1, 0, -1}, Vec3d{-1, 0, 1}}) {
            mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(at(v, scale, offset));
        }
        test::add_mesh(scene, std::move(mesh), placement);
    }
}

struct Count {
    uint64_t spawned = 0, hit_again = 0, far_side = 0, far_side_wrong = 0;
    void operator+=(const Count& c) {
        spawned += c.spawned, hit_again += c.hit_again, far_side += c.far_side, far_side_wrong += c.far_side_wrong;
    }
};

/// How far a ray from a point of the sphere into it goes before it leaves; nothing where that length is not large
/// compared with what the origin is uncertain by.
std::optional<double> chord(const World& world, const SurfacePoint& from, Vec3 d) {
    const Scene& scene = world.shading.scene;
    const Sphere& sphere = std::get<Sphere>(scene.shapes[0]);
    const Affine& inverse = world.shading.transform_of(0).object_from_world;
    const Vec3d n = normalize(transform_point(inverse, from.p) - Vec3d(sphere.center));
    const Vec3d direction = transform_vector(inverse, d);
    double error = 0;
    for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 3; ++c) error += std::fabs(inverse.m[r][c]) * from.p_error[static_cast<int>(c)];
    const double cosine = -dot(n, direction) / length(direction), r = sphere.radius;
    if (!(error < 1e-3 * r * cosine * cosine) || cosine < 0) return std::nullopt;
    return 2 * r * cosine / length(direction);
}

/// Below this cosine with ng, rounding decides which side of the exact surface a direction points to: that of ng, and
/// with a transform that of the direction in the object's space.
double undecided_cosine(const ShadingScene::TransformData& instance) {
    double most = 0;
    for (size_t r = 0; r < 3; ++r) {
        const double* row = &instance.round_trip[3 * r];
        most = max_of(most, row[0] + row[1] + row[2]);
    }
    return 0x1p-20 * most;
}

/// Spawns rays to both sides from points that random rays find.
Count spawn_from(const World& world, bool is_sphere, Random& random, int hits) {
    Count count;
    const Accel::Bounds bounds = world.accel.bounds();
    const Vec3d middle = (Vec3d(bounds.lo) + Vec3d(bounds.hi)) * 0.5;
    const double size = length(Vec3d(bounds.hi) - Vec3d(bounds.lo));
    const double tangent = undecided_cosine(world.shading.transform_of(0));
    int found = 0;
    for (int attempt = 0; attempt < 50 * hits && found < hits; ++attempt) {
        const Vec3d target = middle + random.direction() * (random.between(0, 0.4) * size);
        const Ray ray = test::ray_towards(middle + random.direction() * (random.between(0.8, 4) * size), target);
        const Hit hit = world.accel.intersect(ray);
        if (!hit.found()) continue;
        ++found;
        const SurfacePoint point = surface_at(world.shading, ray, hit);
        for (int i = 0; i < 4; ++i) {
            // Half of them close to the tangent plane.
            Vec3d direction = random.direction();
            const Vec3d n = point.ng;
            if (i % 2 == 1)
                direction =
                    normalize(direction - n * (dot(direction, n) * (1 - std::pow(10, random.between(-5.5, 0)))));
            const Vec3 d = static_cast<Vec3>(direction);
            const double cosine = dot(Vec3d(d), n);
            if (std::fabs(cosine) < tangent) continue;
            const Hit next = world.accel.intersect(spawn_ray(point, d));
            ++count.spawned;
            if (!is_sphere || cosine > 0) {
                count.hit_again += next.found() && next.prim == hit.prim;
            } else if (const std::optional<double> expected = chord(world, point, d)) {
                ++count.far_side;
                count.far_side_wrong += !(std::fabs(next.t - *expected) < 1e-2 * *expected);
            }
        }
    }
    return count;
}

class SelfIntersection : public testing::TestWithParam<const char*> {};

TEST_P(SelfIntersection, NeverHappens) {
    const std::string_view kind = GetParam();
    const int hits = test::by_tier(1200, 40000);
    Count all;
    for (const Placement& placement : placements())
        for (const double scale : {1e-3, 1.0, 1e3, 1e6})
            for (const double far : {0.0, 1.0, 1e5, 1e6}) {
                const Vec3d offset = Vec3d{0.7, -1, 0.4} * far;
                // Vertices that are rounded to a grid coarser than the shape make no shape.
                if (placement.baked && far > 1e4 * scale) continue;
                Random random(17);
                Scene scene;
                const Affine moved = translation(offset.x, offset.y, offset.z) * placement.linear;
                add_kind(scene, kind, scale, placement.baked ? offset : Vec3d{}, placement.baked ? Affine{} : moved,
                         random);
                const World world(std::move(scene));
                const Count count = spawn_from(world, kind == "sphere", random, hits);
                EXPECT_EQ(count.hit_again, 0u) << placement.name << ", scale " << scale << ", offset " << far;
                EXPECT_EQ(count.far_side_wrong, 0u) << placement.name << ", scale " << scale << ", offset " << far;
                all += count;
            }
    EXPECT_GT(all.spawned, 200u * static_cast<uint64_t>(hits));
    if (kind == "sphere") {
        EXPECT_GT(all.far_side, 50u * static_cast<uint64_t>(hits));
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, SelfIntersection, testing::ValuesIn(kShapes), [](const auto& p) { return p.param; });

/// The offset is needed: from the rounded point itself many rays do hit the surface again.
TEST(SelfIntersectionControl, HappensWithoutTheOffset) {
    Random random(3);
    Scene scene;
    add_kind(scene, "triangles", 1, {}, placements()[2].linear, random);
    const World world(std::move(scene));
    uint64_t again = 0;
    for (int i = 0; i < 4000; ++i) {
        const Ray ray = test::ray_towards(random.direction() * 5, random.direction() * 0.5);
        const Hit hit = world.accel.intersect(ray);
        if (!hit.found()) continue;
        const SurfacePoint point = surface_at(world.shading, ray, hit);
        const Hit next = world.accel.intersect({point.p, 0, static_cast<Vec3>(random.direction()), kInfinity});
        again += next.found() && next.prim == hit.prim;
    }
    EXPECT_GT(again, 100u);
}

}  // namespace
}  // namespace steradian
