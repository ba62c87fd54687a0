// What vertices bring along beside positions, normals and one set of texture coordinates.
#include <cstring>

#include "math/transform.h"
#include "scene/validate.h"
#include "shading/relief.h"
#include "shading/texture.h"
#include "shading/world.h"

namespace steradian {
namespace {

using test::World;

/// The triangle (0, 0), (4, 0), (0, 4) in the plane z = 0.
Mesh triangle() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    mesh.indices = {0, 1, 2};
    return mesh;
}

/// From above, where the weights of the corners are 1/2, 1/4 and 1/4.
SurfacePoint middle(const World& world) {
    const Ray ray{{1, 1, 5}, 0, {0, 0, -1}, kInfinity};
    const Hit hit = world.accel.intersect(ray);
    EXPECT_TRUE(hit.found());
    return surface_at(world.shading, ray, hit);
}

TEST(MeshAttributes, TexturesReadTheSetThatTheyName) {
    Mesh mesh = triangle();
    mesh.uvs = {{0.125f, 0.5f}, {0.125f, 0.5f}, {0.125f, 0.5f}};
    mesh.more_uvs = {{}, {{0.5f, 0.5f}, {0.5f, 0.5f}, {1, 0.5f}}};
    Scene scene;
    // Four texels side by side.
    scene.images = {{4, 1, 1, TexelFormat::u8, {std::byte{0}, std::byte{51}, std::byte{102}, std::byte{255}}}};
    for (const uint32_t set : {0u, 1u, 2u}) {
        ImageTexture texture;
        texture.color_space = ColorSpace::linear;
        texture.uv_set = set;
        add<TextureId>(scene.textures, Texture{texture});
    }
    add<TextureId>(scene.textures, Texture{ProductTexture{TextureId{2}, TextureId{2}}});
    test::add_mesh(scene, mesh);
    const World world(std::move(scene));
    const SurfacePoint point = middle(world);
    const auto value = [&](uint32_t texture) { return eval_texture(world.shading, TextureId{texture}, point).r; };
    EXPECT_FLOAT_EQ(value(0), 0);
    EXPECT_FLOAT_EQ(value(1), 0);             // the set is empty: the first
    EXPECT_FLOAT_EQ(value(2), 102 / 255.0f);  // at 5/8, a texel's centre
    EXPECT_FLOAT_EQ(value(3), 102 / 255.0f * (102 / 255.0f));
    EXPECT_FLOAT_EQ(uv_at(world.shading, point, 2).x, 0.625f);
    EXPECT_FLOAT_EQ(uv_at(world.shading, point, 7).x, 0.125f);
    // u of set 2 grows with y only, 1/8 a metre.
    const SurfaceDerivatives d = derivatives_at(world.shading, point, 2);
    EXPECT_EQ(d.determinant, 0);
}

TEST(MeshAttributes, AlphasOfVerticesAreBlended) {
    Mesh mesh = triangle();
    mesh.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.alphas = {1, 0.5f, 0};
    Scene scene;
    add<TextureId>(scene.textures, Texture{VertexColorTexture{}});
    add<TextureId>(scene.textures, Texture{VertexColorTexture{true}});
    add<TextureId>(scene.textures, Texture{ProductTexture{TextureId{0}, TextureId{1}}});
    test::add_mesh(scene, mesh);
    const World world(std::move(scene));
    const SurfacePoint point = middle(world);
    EXPECT_EQ(eval_texture(world.shading, TextureId{0}, point), (Rgb{0.5f, 0.25f, 0.25f}));
    EXPECT_EQ(eval_texture(world.shading, TextureId{1}, point), (Rgb{0.625f, 0.625f, 0.625f}));
    EXPECT_EQ(eval_texture(world.shading, TextureId{2}, point), (Rgb{0.3125f, 0.15625f, 0.15625f}));
}

/// A triangle whose normal map says (0.6, 0, 0.8) or (0, 0.6, 0.8), under a transform, baked or not.
Vec3d mapped(const Tangent& tangent, Rgb map, const Affine& world_from_object, bool bake) {
    Mesh mesh = triangle();
    mesh.normals.assign(3, {0, 0, 1});
    mesh.tangents.assign(3, tangent);
    mesh.uvs = {{0, 0}, {0, 1}, {1, 0}};  // u along y: the tangents say otherwise
    Scene scene;
    test::add_mesh(scene, mesh, world_from_object);
    const auto constant = add<TextureId>(
        scene.textures, Texture{ConstantTexture{{map.r / 2 + 0.5f, map.g / 2 + 0.5f, map.b / 2 + 0.5f}}});
    scene.reliefs = {{MaterialId{0}, NormalMap{constant}}};
    if (bake) bake_transforms(scene);
    const World world(std::move(scene));
    const Vec3d target = transform_point(world_from_object, Vec3{1, 1, 0});
    const Vec3d above = transform_normal_by_inverse(*inverse(world_from_object), Vec3{0, 0, 1});
    const Ray ray = test::ray_towards(target + normalize(above) * 3, target);
    const Hit hit = world.accel.intersect(ray);
    EXPECT_TRUE(hit.found());
    return relief_normal(world.shading, surface_at(world.shading, ray, hit), world.shading.scene.reliefs[0]).n;
}

void expect_near(Vec3d a, Vec3d b) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-6);
}

TEST(MeshAttributes, TangentsTurnNormalMaps) {
    for (const bool bake : {false, true}) {
        const Affine none;
        expect_near(mapped({{1, 0, 0}, 1}, {0.6f, 0, 0.8f}, none, bake), {0.6, 0, 0.8});
        // up = side (normal × tangent): along +y.
        expect_near(mapped({{1, 0, 0}, 1}, {0, 0.6f, 0.8f}, none, bake), {0, 0.6, 0.8});
        expect_near(mapped({{1, 0, 0}, -1}, {0, 0.6f, 0.8f}, none, bake), {0, -0.6, 0.8});
        expect_near(mapped({{0, -2, 0}, 1}, {0.6f, 0, 0.8f}, none, bake), {0, -0.6, 0.8});
        expect_near(mapped({{0, -2, 0}, 1}, {0, 0.6f, 0.8f}, none, bake), {0.6, 0, 0.8});
        // A mirror image of the surface is one of its relief.
        const Affine mirror = scaling(-1, 1, 1);
        expect_near(mapped({{1, 0, 0}, 1}, {0.6f, 0, 0.8f}, mirror, bake), {-0.6, 0, 0.8});
        expect_near(mapped({{1, 0, 0}, 1}, {0, 0.6f, 0.8f}, mirror, bake), {0, 0.6, 0.8});
        // Tangents lie in the surface: they turn with it.
        const Affine turned = translation(1, 2, 3) * rotation_degrees(90, {0, 1, 0});
        expect_near(mapped({{1, 0, 0}, 1}, {0.6f, 0, 0.8f}, turned, bake), {0.8, 0, -0.6});
        expect_near(mapped({{1, 0, 0}, 1}, {0, 0.6f, 0.8f}, turned, bake), {0.8, 0.6, 0});
        // Without a direction the texture coordinates say it: u along y.
        expect_near(mapped({{0, 0, 0}, 1}, {0.6f, 0, 0.8f}, none, bake), {0, 0.6, 0.8});
    }
}

TEST(MeshAttributes, TangentsAreBlended) {
    Mesh mesh = triangle();
    mesh.tangents = {{{1, 0, 0}, 1}, {{0, 1, 0}, 1}, {{0, 1, 0}, 1}};
    Scene scene;
    test::add_mesh(scene, mesh);
    const World world(std::move(scene));
    const Vec3 t = tangent_at(world.shading, middle(world));
    EXPECT_NEAR(t.x, std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(t.y, std::sqrt(0.5), 1e-6);
}

}  // namespace
}  // namespace steradian
