// Pictures of textures: filtered by footprint, of vertices, mixed.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "steradian/render.h"
#include "support/support.h"
#include "test_scenes.h"

namespace steradian {
namespace {

Image picture(Scene scene, uint64_t samples, IntegratorKind kind = IntegratorKind::albedo, uint64_t seed = 0) {
    RenderSettings s;
    s.integrator = kind;
    s.width = 48, s.height = 32;
    s.samples_per_pixel = samples;
    s.seed = seed;
    s.filter = {FilterKind::box, 0.5f};
    auto result = render(std::move(scene), s);
    if (!result) throw std::runtime_error(result.error().str());
    return std::move(result->image);
}

/// A floor up to the horizon with a checkerboard whose squares are smaller than pixels in most of the picture.
Scene checkered_floor(bool mip_map) {
    constexpr uint32_t kSize = 64;
    Scene s;
    RawImage image{kSize, kSize, 1, TexelFormat::u8, {}};
    for (uint32_t y = 0; y < kSize; ++y)
        for (uint32_t x = 0; x < kSize; ++x) image.data.push_back(std::byte{(x + y) % 2 ? uint8_t{255} : uint8_t{0}});
    ImageTexture texture;
    texture.image = add<ImageId>(s.images, image);
    texture.color_space = ColorSpace::linear;
    texture.mip_map = mip_map;
    texture.scale = {20, 20};
    const auto id = add<TextureId>(s.textures, Texture(texture));
    const auto material = add<MaterialId>(s.materials, Material(DiffuseMaterial{id}));
    test::place(s, Rectangle{{0, 0, 0}, {50, 0, 0}, {0, 0, -50}}, material);
    s.lights = {EnvironmentLight{}};
    s.cameras = {PerspectiveCamera{{0, 3, 40}, {0, -1, 30}, {0, 1, 0}, 30}};
    return s;
}

double mean_of(const Image& image) {
    double sum = 0;
    for (const float x : image.pixels) sum += x;
    return sum / double(image.pixels.size());
}

/// One sample of the filtered texture is nearer to the picture than one of the texture itself, by far; the mean stays,
/// within five standard errors of black and white points.
TEST(TextureFilter, OneSampleOfAFineCheckerboardIsNearTheReference) {
    const Image reference = picture(checkered_floor(false), 1024);
    const auto error = [&](const Image& image) {
        double sum = 0;
        for (size_t i = 0; i < image.pixels.size(); ++i)
            sum += std::pow(double(image.pixels[i]) - reference.pixels[i], 2) / double(image.pixels.size());
        return std::sqrt(sum);
    };
    const Image plain = picture(checkered_floor(false), 1), filtered = picture(checkered_floor(true), 1);
    EXPECT_GT(error(plain), 0.15);  // looked up bilinearly, the squares are pyramids: 1/6
    EXPECT_LT(error(filtered), error(plain) / 5);
    const double pixels = 48 * 32;
    EXPECT_NEAR(mean_of(filtered), mean_of(reference), 5 * 0.5 / std::sqrt(pixels));
    EXPECT_NEAR(mean_of(picture(checkered_floor(true), 256)), mean_of(reference), 5 * 0.5 / std::sqrt(256 * pixels));
}

/// What a filtered texture takes is in the estimate: a third of the texels, twice the bytes.
TEST(TextureFilter, MemoryIsEstimated) {
    const auto hierarchy = [](bool mip_map) { return estimate_memory(checkered_floor(mip_map), {}).hierarchy; };
    EXPECT_EQ(hierarchy(true) - hierarchy(false), 2u * (32 * 32 + 16 * 16 + 8 * 8 + 4 * 4 + 2 * 2 + 1));
}

/// A triangle with one colour at each corner, over the whole picture.
TEST(VertexColors, AreBlendedOverTheTriangle) {
    Scene s;
    Mesh mesh;
    mesh.positions = {{-6, -4, 0}, {18, -4, 0}, {-6, 20, 0}};
    mesh.indices = {0, 1, 2};
    mesh.colors = {{1, 0.5f, 0}, {0, 0.5f, 0.25f}, {0.5f, 0.25f, 1}};
    const auto id = add<MeshId>(s.meshes, mesh);
    const auto painted = add<TextureId>(s.textures, Texture(VertexColorTexture{}));
    test::place(s, id, add<MaterialId>(s.materials, Material(DiffuseMaterial{painted})));
    test::place(s, Rectangle{{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}, MaterialId{0});
    s.lights = {EnvironmentLight{}};
    s.cameras = {OrthographicCamera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 8}};
    const Image image = picture(s, 16);
    for (uint32_t y = 0; y < 32; ++y)
        for (uint32_t x = 0; x < 48; ++x) {
            const double px = (x + 0.5) / 4 - 6, py = 4 - (y + 0.5) / 4;
            const double b1 = (px + 6) / 24, b2 = (py + 4) / 24, b0 = 1 - b1 - b2;
            for (int c = 0; c < 3; ++c) {
                const double expected = b0 * mesh.colors[0][c] + b1 * mesh.colors[1][c] + b2 * mesh.colors[2][c];
                // Stratified over a pixel of a hundredth of the triangle.
                EXPECT_NEAR(image.pixels[(y * 48 + x) * 3 + static_cast<uint32_t>(c)], expected, 2e-3);
            }
        }
    // What has no colours of its own is white.
    s.instances[0].world_from_object = translation(0, 0, -9);
    EXPECT_EQ(picture(s, 1).pixels[(16 * 48 + 24) * 3], 1);
}

/// All of one material is that material, to the bit; half of each is the mean of both.
TEST(Mix, LiesBetweenItsMaterials) {
    const auto scene_of = [](int way) {
        Scene s;
        const MaterialId red = test::diffuse(s, {0.8f, 0.1f, 0.2f}, true);
        const auto leaf_color = add<TextureId>(s.textures, Texture(ConstantTexture{{0.3f, 0.4f, 0.1f}}));
        const auto leaf = add<MaterialId>(s.materials, Material(DiffuseTransmissionMaterial{leaf_color, leaf_color}));
        const auto mix = [&](float weight) {
            return add<MaterialId>(s.materials, Material(MixMaterial{red, leaf, {weight}}));
        };
        const MaterialId used = way == 0 ? red : way == 1 ? leaf : way == 2 ? mix(0) : way == 3 ? mix(1) : mix(0.5f);
        test::place(s, Rectangle{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, used);
        s.lights = {PointLight{{1, 1, 2}, {20, 20, 20}}, DirectionalLight{{0.2f, 0.1f, 1}, {2, 2, 2}}};
        s.cameras = {PerspectiveCamera{{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 40}};
        return s;
    };
    const auto shown = [&](int way) { return picture(scene_of(way), 4, IntegratorKind::direct); };
    const Image red = shown(0), leaf = shown(1), half = shown(4);
    EXPECT_EQ(image_hash(shown(2)), image_hash(red));
    EXPECT_EQ(image_hash(shown(3)), image_hash(leaf));
    for (size_t i = 0; i < half.pixels.size(); ++i)
        EXPECT_NEAR(half.pixels[i], (red.pixels[i] + leaf.pixels[i]) / 2, 1e-5f * (1 + half.pixels[i]));
}

}  // namespace
}  // namespace steradian
