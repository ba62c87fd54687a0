// Pictures of surfaces with normal maps: in a white room they vanish, a flat map changes nothing, nothing leaks.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "steradian/render.h"
#include "support/support.h"
#include "test_scenes.h"

namespace steradian {
namespace {

RenderResult picture(Scene scene, RenderSettings settings) {
    auto result = render(std::move(scene), settings);
    if (!result) throw std::runtime_error(result.error().str());
    return std::move(*result);
}

RenderSettings small(IntegratorKind integrator = IntegratorKind::path) {
    RenderSettings s;
    s.integrator = integrator;
    s.width = s.height = 16;
    s.samples_per_pixel = 64;
    s.filter = {FilterKind::box, 0.5f};
    return s;
}

/// Normals in all directions up to `tilt` degrees from the surface's own, a different one in each texel.
RawImage wild_normals(double tilt) {
    constexpr uint32_t kSize = 64;
    RawImage image{kSize, kSize, 3, TexelFormat::f32, {}};
    std::vector<float> values;
    uint32_t state = 1;
    const auto random = [&] {
        state = state * 747796405u + 2891336453u;
        return (state >> 8) * 0x1p-24;
    };
    for (uint32_t i = 0; i < kSize * kSize; ++i) {
        const double theta = random() * tilt * M_PI / 180, phi = random() * 2 * M_PI;
        for (const double x : {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)})
            values.push_back(static_cast<float>((x + 1) / 2));
    }
    image.data.resize(values.size() * sizeof(float));
    std::memcpy(image.data.data(), values.data(), image.data.size());
    return image;
}

void add_normal_map(Scene& s, MaterialId material, double tilt) {
    ImageTexture texture;
    texture.image = add<ImageId>(s.images, wild_normals(tilt));
    texture.color_space = ColorSpace::linear;
    texture.bilinear = false;
    s.reliefs.push_back({material, NormalMap{add<TextureId>(s.textures, Texture(texture))}});
}

/// A sphere of triangles with smooth normals and texture coordinates.
Mesh ball(uint32_t rings) {
    Mesh mesh;
    for (uint32_t i = 0; i <= rings; ++i)
        for (uint32_t j = 0; j <= 2 * rings; ++j) {
            const double theta = M_PI * i / rings, phi = M_PI * j / rings;
            const Vec3 n{static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::cos(theta)),
                         static_cast<float>(-std::sin(theta) * std::sin(phi))};
            mesh.positions.push_back(n);
            mesh.normals.push_back(n);
            mesh.uvs.push_back({static_cast<float>(j) / static_cast<float>(2 * rings),
                                static_cast<float>(i) / static_cast<float>(rings)});
        }
    const uint32_t row = 2 * rings + 1;
    for (uint32_t i = 0; i < rings; ++i)
        for (uint32_t j = 0; j < 2 * rings; ++j) {
            const uint32_t a = i * row + j, b = a + row;
            mesh.indices.insert(mesh.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
        }
    return mesh;
}

MaterialId metal(Scene& s, Rgb color, float roughness) {
    const auto texture = add<TextureId>(s.textures, Texture(ConstantTexture{color}));
    ConductorMaterial m{SchlickReflectance{texture, {1, 1, 1}}, {}};
    m.roughness.value = {roughness, roughness};
    return add<MaterialId>(s.materials, Material(m));
}

/// White surfaces under a white sky, with the wildest of normal maps. The bound is the noise of 64 samples, which is
/// small as all weights are near 1, and what the tables of rough metal are off.
TEST(ReliefPictures, AreInvisibleInAWhiteFurnace) {
    for (const int kind : {0, 1, 2, 3}) {
        SCOPED_TRACE(kind);
        Scene s;
        MaterialId material{};
        if (kind == 0) material = test::diffuse(s, {1, 1, 1});
        if (kind == 1) material = add<MaterialId>(s.materials, Material(MirrorMaterial{}));
        if (kind == 2) material = metal(s, {1, 1, 1}, 0.5f);
        if (kind == 3) material = add<MaterialId>(s.materials, Material(GlassMaterial{}));
        add_normal_map(s, material, 80);
        test::place(s, Sphere{{0, 0, 0}, 1}, material);
        s.lights = {EnvironmentLight{{1, 1, 1}}};
        s.cameras = {PerspectiveCamera{{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 32}};
        RenderSettings settings = small();
        settings.max_depth = 4096;
        settings.roulette_depth = 4096;
        settings.light_sampling = LightSampling::bsdf;
        if (kind == 2) settings.samples_per_pixel = 1024;
        const RenderResult result = picture(std::move(s), settings);
        EXPECT_EQ(result.statistics.bad_samples, 0u);
        double sum = 0;
        for (const float value : result.image.pixels) {
            EXPECT_NEAR(value, 1, kind == 2 ? 0.02 : 1e-4);
            sum += value;
        }
        EXPECT_NEAR(sum / double(result.image.pixels.size()), 1, kind == 2 ? 2e-3 : 1e-5);
    }
}

/// Both samplers of `path` have the same mean: lights are looked for where the turned lobe is.
TEST(ReliefPictures, LightSamplesAndBsdfSamplesAgree) {
    Scene s;
    const MaterialId white = test::diffuse(s, {0.8f, 0.8f, 0.8f}, true), rough = metal(s, {0.9f, 0.7f, 0.5f}, 0.6f);
    add_normal_map(s, white, 60);
    add_normal_map(s, rough, 60);
    test::place(s, Sphere{{-1, 0, 0}, 0.9f}, white);
    test::place(s, Sphere{{1, 0, 0}, 0.9f}, rough);
    const MaterialId black = test::diffuse(s, {0, 0, 0});
    const InstanceId lamp = test::place(s, Rectangle{{0, 3, 2}, {1, 0, 0}, {0, 0.5f, 0.8f}}, black);
    s.lights = {AreaLight{lamp, {5, 5, 5}, true, 1}, EnvironmentLight{{0.3f, 0.3f, 0.3f}}};
    s.cameras = {PerspectiveCamera{{0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 30}};
    RenderSettings settings = small();
    settings.width = settings.height = 2;
    settings.max_depth = 1;
    settings.samples_per_pixel = test::by_tier(4096, 65536);
    constexpr int kSeeds = 16;
    double mean[2][12] = {}, square[2][12] = {};
    for (int way = 0; way < 2; ++way)
        for (int seed = 0; seed < kSeeds; ++seed) {
            settings.light_sampling = way == 0 ? LightSampling::light : LightSampling::bsdf;
            settings.seed = uint64_t(seed + 100 * way);
            const Image image = picture(s, settings).image;
            for (size_t i = 0; i < 12; ++i) {
                mean[way][i] += double(image.pixels[i]) / kSeeds;
                square[way][i] += double(image.pixels[i]) * image.pixels[i] / kSeeds;
            }
        }
    for (size_t i = 0; i < 12; ++i) {
        double variance = 0;
        for (int way = 0; way < 2; ++way)
            variance += std::max(square[way][i] - mean[way][i] * mean[way][i], 0.0) / (kSeeds - 1);
        EXPECT_NEAR(mean[0][i], mean[1][i], 5 * std::sqrt(variance) + 1e-6) << i;
        EXPECT_GT(mean[0][i], 0.01);
    }
}

/// A sheet lit from behind only, by light of every kind, in front of nothing.
TEST(ReliefPictures, NoLightFromBehindPassesThroughASheet) {
    Scene s;
    const MaterialId materials[] = {test::diffuse(s, {1, 1, 1}, true), metal(s, {1, 1, 1}, 0.4f),
                                    add<MaterialId>(s.materials, Material(OpenPbrMaterial{}))};
    for (int i = 0; i < 3; ++i) {
        add_normal_map(s, materials[i], 89);
        test::place(s, Rectangle{{float(i) - 1, 0, 0}, {0.5f, 0, 0}, {0, 5, 0}}, materials[i]);
    }
    const InstanceId lamp = test::place(s, Rectangle{{0, 0, -1}, {3, 0, 0}, {0, 3, 0}}, test::diffuse(s, {0, 0, 0}));
    s.lights = {AreaLight{lamp, {5, 5, 5}, false, 1}, PointLight{{0, 0, -0.5f}, {9, 9, 9}},
                DirectionalLight{{0.3f, 0.1f, 1}, {1, 1, 1}}};
    s.cameras = {OrthographicCamera{{0.5f, 0.3f, 3}, {0, 0, 0}, {0, 1, 0}, 2.2f}};
    const RenderResult result = picture(std::move(s), small());
    for (const float value : result.image.pixels) EXPECT_EQ(value, 0);
}

/// To the bit, also where the mesh has normals of its own.
TEST(ReliefPictures, AFlatMapChangesNothing) {
    const auto scene_of = [](int relief) {
        Scene s;
        const MaterialId materials[] = {test::diffuse(s, {0.7f, 0.6f, 0.5f}), metal(s, {0.9f, 0.8f, 0.7f}, 0.5f),
                                        add<MaterialId>(s.materials, Material(GlassMaterial{}))};
        const auto mesh = add<MeshId>(s.meshes, ball(7));
        const auto shape = add<ShapeId>(s.shapes, Shape(mesh));
        for (int i = 0; i < 3; ++i)
            s.instances.push_back({shape, materials[i], translation(2 * i - 2, 0, 0) * scaling(0.9, 0.9, 0.9)});
        s.lights = {PointLight{{3, 4, 5}, {30, 30, 30}}, EnvironmentLight{{0.3f, 0.4f, 0.5f}}};
        s.cameras = {PerspectiveCamera{{0, 1, 8}, {0, 0, 0}, {0, 1, 0}, 30}};
        const auto flat = add<TextureId>(s.textures, Texture(ConstantTexture{{0.5f, 0.5f, 1}}));
        for (const MaterialId material : materials) {
            if (relief == 1) s.reliefs.push_back({material, NormalMap{flat}});
            if (relief == 2) s.reliefs.push_back({material, BumpMap{flat, 3}});
        }
        return s;
    };
    for (const IntegratorKind kind : {IntegratorKind::path, IntegratorKind::normals, IntegratorKind::ao}) {
        const std::string plain = image_hash(picture(scene_of(0), small(kind)).image);
        EXPECT_EQ(image_hash(picture(scene_of(1), small(kind)).image), plain);
        EXPECT_EQ(image_hash(picture(scene_of(2), small(kind)).image), plain);
    }
}

/// The inspector shows the normals of the map.
TEST(ReliefPictures, NormalsAreShownAsMapped) {
    Scene s;
    const MaterialId grey = test::diffuse(s, {0.5f, 0.5f, 0.5f});
    const auto map = add<TextureId>(s.textures, Texture(ConstantTexture{{0.8f, 0.5f, 0.9f}}));  // (0.6, 0, 0.8)
    s.reliefs = {{grey, NormalMap{map}}};
    test::place(s, Rectangle{{0, 0, 0}, {5, 0, 0}, {0, 5, 0}}, grey);
    s.cameras = {OrthographicCamera{{0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 1}};
    const Image image = picture(std::move(s), small(IntegratorKind::normals)).image;
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
        EXPECT_NEAR(image.pixels[i], 0.8, 1e-6);
        EXPECT_NEAR(image.pixels[i + 1], 0.5, 1e-6);
        EXPECT_NEAR(image.pixels[i + 2], 0.9, 1e-6);
    }
}

}  // namespace
}  // namespace steradian
