// Surface points: positions, error bounds, normals and uv of every shape, placed as they are or through a transform.
#include "shading/surface.h"

#include <gtest/gtest.h>

#include <limits>

#include "shading/light.h"
#include "shading/world.h"

namespace steradian {
namespace {

using test::Random;
using test::World;

SurfacePoint look(const World& world, Vec3 o, Vec3 d) {
    const Ray ray{o, 0, d, kInfinity};
    const Hit hit = world.accel.intersect(ray);
    EXPECT_TRUE(hit.found());
    return hit.found() ? surface_at(world.shading, ray, hit) : SurfacePoint{};
}

void expect_near(Vec3 a, Vec3 b, float tolerance = 1e-6f) {
    EXPECT_TRUE(max_component(abs(a - b)) <= tolerance)
        << a.x << " " << a.y << " " << a.z << ", expected " << b.x << " " << b.y << " " << b.z;
}

World one(Shape shape, const Affine& transform = {}) {
    Scene scene;
    test::add_shape(scene, std::move(shape), transform);
    return World(std::move(scene));
}

TEST(Surface, SphereNormalsAndUv) {
    const World world = one(Sphere{{1, 2, 3}, 2});
    const struct {
        Vec3 n;
        Vec2 uv;
    } cases[] = {
        {{1, 0, 0}, {0, 0.5f}}, {{0, 0, -1}, {0.25f, 0.5f}}, {{-1, 0, 0}, {0.5f, 0.5f}}, {{0, 0, 1}, {0.75f, 0.5f}}};
    for (const auto& c : cases) {
        const SurfacePoint p = look(world, Vec3{1, 2, 3} + c.n * 5, -c.n);
        expect_near(p.p, Vec3{1, 2, 3} + c.n * 2);
        expect_near(p.ng, c.n);
        expect_near(p.ns, c.n);
        EXPECT_NEAR(p.uv.x, c.uv.x, 1e-6);
        EXPECT_NEAR(p.uv.y, c.uv.y, 1e-6);
        // From inside it points outwards as well.
        expect_near(look(world, {1, 2, 3}, c.n).ng, c.n);
    }
    EXPECT_NEAR(look(world, {1, 9, 3}, {0, -1, 0}).uv.y, 0, 1e-6);
    EXPECT_NEAR(look(world, {1, -9, 3}, {0, 1, 0}).uv.y, 1, 1e-6);
}

TEST(Surface, SmallSphereFarFromTheCamera) {
    // t is known to half a metre only; the point must be on the near side all the same.
    const World world = one(Sphere{{0, 0, 0}, 0.1f});
    const SurfacePoint p = look(world, {1e7f, 0, 0}, {-1, 0, 0});
    expect_near(p.p, {0.1f, 0, 0});
    expect_near(p.ng, {1, 0, 0});
}

TEST(Surface, RectangleAndDisk) {
    const World rectangle = one(Rectangle{{0, 1, 0}, {2, 0, 0}, {0, 0, 1}});  // facing -Y
    const SurfacePoint p = look(rectangle, {1, 5, 0.5f}, {0, -1, 0});
    expect_near(p.p, {1, 1, 0.5f});
    expect_near(p.ng, {0, -1, 0});
    EXPECT_EQ(p.uv, (Vec2{0.75f, 0.25f}));
    const World disk = one(Disk{{0, 0, 3}, {0, 0, -4}, 2});
    expect_near(look(disk, {0.5f, 1, 0}, {0, 0, 1}).ng, {0, 0, -1});
    expect_near(look(disk, {0.5f, 1, 0}, {0, 0, 1}).p, {0.5f, 1, 3});
}

TEST(Surface, OutsideStaysOutsideUnderMirroring) {
    Mesh triangle;
    triangle.positions = {{-1, 0, -1}, {0, 0, 1}, {1, 0, -1}};
    triangle.indices = {0, 1, 2};  // facing up
    for (const double x : {1.0, -1.0}) {
        const Affine transform = translation(0, 1, 0) * scaling(x, 2, 1);
        Scene scene;
        test::add_mesh(scene, triangle, transform);
        expect_near(look(World(std::move(scene)), {0, 5, 0}, {0, -1, 0}).ng, {0, 1, 0});
        expect_near(look(one(Rectangle{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}, transform), {0, 5, 0}, {0, -1, 0}).ng,
                    {0, 1, 0});
        expect_near(look(one(Disk{{0, 0, 0}, {0, 1, 0}, 1}, transform), {0, 5, 0}, {0, -1, 0}).ng, {0, 1, 0});
        expect_near(look(one(Sphere{{0, 0, 0}, 1}, transform), {0, 5, 0}, {0, -1, 0}).ng, {0, 1, 0});
    }
}

TEST(Surface, NormalsOfMeshes) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals = {{0, 0, 5}, {3, 0, 3}, {0, 0.1f, 0.1f}};
    mesh.uvs = {{0, 1}, {2, 1}, {0, -1}};
    mesh.indices = {0, 1, 2};
    const Affine transform = rotation_degrees(90, {0, 1, 0}) * scaling(2, 2, 2);  // +Z becomes +X
    Scene scene;
    test::add_mesh(scene, mesh, transform);
    const World world(std::move(scene));
    const auto in_world = [&](Vec3 v) { return static_cast<Vec3>(transform_vector(transform, v)); };
    const SurfacePoint p = look(world, in_world({0.25f, 0.5f, 1}), in_world({0, 0, -1}));
    expect_near(p.ng, {1, 0, 0});
    const float h = std::sqrt(0.5f);
    expect_near(p.ns, normalize(in_world(Vec3{0, 0, 1} * 0.25f + Vec3{h, 0, h} * 0.25f + Vec3{0, h, h} * 0.5f)));
    EXPECT_EQ(p.uv, (Vec2{0.5f, 0}));
    // Normals that point to the other side are turned around; ones that cancel give way to the geometric one.
    for (Vec3& n : mesh.normals) n = -n;
    Scene other;
    test::add_mesh(other, mesh);
    EXPECT_GT(dot(look(World(other), {0.2f, 0.2f, 1}, {0, 0, -1}).ns, Vec3{0, 0, 1}), 0.5f);
    other.meshes[0].normals = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 0}};
    other.meshes[0].uvs.clear();
    const SurfacePoint flat = look(World(other), {0.25f, 0.5f, 1}, {0, 0, -1});
    expect_near(flat.ns, {0, 0, 1});
    EXPECT_EQ(flat.uv, (Vec2{0.25f, 0.5f}));
}

/// |p - q| <= p_error for the exact point q that (u, v) stand for, computed in extended precision.
TEST(Surface, ErrorBoundsHoldAndAreTight) {
    Random random(77);
    for (int i = 0; i < 20000; ++i) {
        const double scale = std::pow(10, random.between(-3, 6)), far = std::pow(10, random.between(-3, 6));
        Scene scene;
        Mesh mesh;
        for (int k = 0; k < 3; ++k)
            mesh.positions.push_back(static_cast<Vec3>(random.direction() * far + random.direction() * scale));
        mesh.indices = {0, 1, 2};
        add<MeshId>(scene.meshes, mesh);
        test::add_shape(scene, MeshId{0});
        Diagnostics diagnostics;
        const ShadingScene shading = std::move(make_shading_scene(std::move(scene), diagnostics)).value();
        Hit hit;
        hit.u = random.uniform() * 0.5f, hit.v = random.uniform() * 0.5f, hit.prim = 0, hit.instance = 0;
        const SurfacePoint p = surface_at(shading, Ray{}, hit);
        for (int axis = 0; axis < 3; ++axis) {
            const long double u = hit.u, v = hit.v;
            const long double exact =
                mesh.positions[0][axis] * (1 - u - v) + mesh.positions[1][axis] * u + mesh.positions[2][axis] * v;
            EXPECT_LE(std::fabs(p.p[axis] - exact), p.p_error[axis]);
            const double extent = max_component(abs(mesh.positions[0])) + max_component(abs(mesh.positions[1])) +
                                  max_component(abs(mesh.positions[2]));
            EXPECT_LE(p.p_error[axis], 0x1p-23 * extent);
        }
    }
}

TEST(Surface, OffsetOriginLeavesTheBox) {
    Random random(5);
    for (int i = 0; i < 100000; ++i) {
        const Vec3 p = static_cast<Vec3>(random.direction() * std::pow(10, random.between(-6, 8)));
        const auto e = [&] { return static_cast<float>(std::pow(10, random.between(-9, 0)) * length(p)); };
        const float ex = e(), ey = e(), ez = e();
        const Vec3d exact = random.direction();
        const Vec3 n = static_cast<Vec3>(exact), d = static_cast<Vec3>(random.direction());
        const Vec3d o = offset_origin(p, {ex, ey, ez}, n, d);
        const double side = dot(Vec3d(n), Vec3d(d)) < 0 ? -1 : 1;
        // Against the worst corner of the box, and the normal before it was rounded.
        const double corner = std::fabs(exact.x) * ex + std::fabs(exact.y) * ey + std::fabs(exact.z) * ez;
        EXPECT_GT(side * dot(exact, o - Vec3d(p)), corner);
    }
    const Vec3 origin = offset_origin({}, {}, {0, 1, 0}, {0.5f, -1, 0});
    EXPECT_LT(origin.y, 0);
    EXPECT_EQ(origin.x, 0);
}

TEST(Surface, FacingTurnsBothNormals) {
    SurfacePoint p = test::receiver({}, {0, 1, 0});
    p.ns = normalize(Vec3{0.5f, 1, 0});
    EXPECT_EQ(facing(p, {0, 1, 0}).ns, p.ns);
    EXPECT_EQ(facing(p, {0, -1, 0}).ns, -p.ns);
    EXPECT_EQ(facing(p, {0, -1, 0}).ng, -p.ng);
}

}  // namespace
}  // namespace steradian
