// Textures: exact values at texel centres and between them, wrapping, formats, coordinates that make no sense.
#include "shading/texture.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "image/tone.h"
#include "math/vector.h"
#include "shading/mip_map.h"
#include "shading/shading_scene.h"

namespace steradian {
namespace {

template <class T>
RawImage raw(uint32_t width, uint32_t height, uint8_t channels, TexelFormat format, const std::vector<T>& values) {
    RawImage image{width, height, channels, format, {}};
    image.data.resize(values.size() * sizeof(T));
    std::memcpy(image.data.data(), values.data(), image.data.size());
    return image;
}

/// A grey image of floats with one texture on it.
Scene grey(uint32_t width, uint32_t height, const std::vector<float>& values, Wrap u, Wrap v, bool bilinear = true) {
    Scene scene;
    scene.images.push_back(raw(width, height, 1, TexelFormat::f32, values));
    ImageTexture texture;
    texture.color_space = ColorSpace::linear;
    texture.wrap_u = u, texture.wrap_v = v, texture.bilinear = bilinear;
    scene.textures.push_back(texture);
    return scene;
}

float at(const Scene& scene, float u, float v) { return eval_texture(scene, TextureId{0}, {u, v}).g; }

TEST(Texture, BilinearAtCentresAndBetween) {
    const Scene scene = grey(2, 2, {0, 1, 2, 4}, Wrap::clamp, Wrap::clamp);
    EXPECT_EQ(at(scene, 0.25f, 0.25f), 0);
    EXPECT_EQ(at(scene, 0.75f, 0.25f), 1);
    EXPECT_EQ(at(scene, 0.25f, 0.75f), 2);  // v runs downwards
    EXPECT_EQ(at(scene, 0.75f, 0.75f), 4);
    EXPECT_EQ(at(scene, 0.5f, 0.25f), 0.5f);
    EXPECT_EQ(at(scene, 0.5f, 0.5f), 1.75f);
    EXPECT_EQ(at(scene, 0.375f, 0.25f), 0.25f);
}

TEST(Texture, WrapModes) {
    const std::vector<float> row{1, 2, 4, 8};
    struct Case {
        Wrap wrap;
        float before, after, far_before, far_after;  // at u = 0, 1, -0.375 and 1.625
    };
    for (const Case& c : {Case{Wrap::repeat, 4.5f, 4.5f, 4, 4}, Case{Wrap::clamp, 1, 8, 1, 8},
                          Case{Wrap::mirror, 1, 8, 2, 2}, Case{Wrap::black, 0.5f, 4, 0, 0}}) {
        const Scene u = grey(4, 1, row, c.wrap, Wrap::clamp), v = grey(1, 4, row, Wrap::clamp, c.wrap);
        for (const auto& [x, expected] :
             {std::pair{0.0f, c.before}, {1.0f, c.after}, {-0.375f, c.far_before}, {1.625f, c.far_after}}) {
            EXPECT_EQ(at(u, x, 0.5f), expected) << int(c.wrap) << " " << x;
            EXPECT_EQ(at(v, 0.5f, x), expected) << int(c.wrap) << " " << x;
        }
    }
    const Scene nearest = grey(4, 1, row, Wrap::mirror, Wrap::clamp, false);
    EXPECT_EQ(at(nearest, 0.24f, 0), 1);
    EXPECT_EQ(at(nearest, 0.25f, 0), 2);
    EXPECT_EQ(at(nearest, 1, 0), 8);
    EXPECT_EQ(at(nearest, 1.26f, 0), 4);
    EXPECT_EQ(at(nearest, -0.01f, 0), 1);
    EXPECT_EQ(at(nearest, 2, 0), 1);
}

TEST(Texture, CoordinatesThatMakeNoSense) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = kInfinity;
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror, Wrap::black})
        for (const bool bilinear : {false, true}) {
            const Scene scene = grey(3, 2, {1, 1, 1, 1, 1, 1}, wrap, wrap, bilinear);
            for (const float u : {nan, inf, -inf, 3e38f, -3e38f, 1e-45f, -1e-45f, 16777216.5f, -1e9f})
                for (const float v : {0.5f, nan, inf, 3e38f, -3e38f, -1e-45f}) {
                    const float value = at(scene, u, v);
                    EXPECT_TRUE(value >= 0 && value <= 1);
                    if (wrap != Wrap::black) {
                        EXPECT_EQ(value, 1);
                    }
                }
        }
    Scene checker;
    checker.textures.push_back(CheckerTexture{{1, 1, 1}, {0, 0, 0}, {3e38f, 3e38f}, {}});
    for (const float u : {nan, inf, -inf, 3e38f}) {
        const float value = at(checker, u, u);
        EXPECT_TRUE(value == 0 || value == 1);
    }
}

TEST(Texture, ScaleAndOffset) {
    Scene scene = grey(2, 1, {0, 1}, Wrap::repeat, Wrap::clamp);
    std::get<ImageTexture>(scene.textures[0]).scale = {2, 1};
    std::get<ImageTexture>(scene.textures[0]).offset = {0.5f, 0};
    EXPECT_EQ(at(scene, 0.125f, 0), 1);   // 0.75
    EXPECT_EQ(at(scene, 0.375f, 0), 0);   // 1.25
    EXPECT_EQ(at(scene, -0.625f, 0), 0);  // -0.75
}

/// By a quarter: u goes to -v, v to u; scale before, offset after it.
TEST(Texture, Rotation) {
    // Columns 0 … 3 of a 4 × 1 image, rows of a 1 × 4 one.
    Scene wide = grey(4, 1, {0, 1, 2, 3}, Wrap::repeat, Wrap::repeat);
    auto& t = std::get<ImageTexture>(wide.textures[0]);
    t.rotation = 90;
    t.scale = {5, 2};
    t.offset = {0.125f, 0};
    for (const float v : {0.0f, 0.125f, 0.25f, 0.375f})
        for (const float u : {0.1f, 0.7f}) EXPECT_NEAR(at(wide, u, v), 8 * v, 1e-6) << v;  // s = 2 v + 1/8
    Scene high = grey(1, 4, {0, 1, 2, 3}, Wrap::repeat, Wrap::repeat);
    auto& down = std::get<ImageTexture>(high.textures[0]);
    down.rotation = 90;
    for (const float u : {-0.125f, -0.375f, -0.625f, -0.875f}) EXPECT_NEAR(at(high, u, 0.3f), -4 * u - 0.5f, 1e-6);
    // 45 degrees: (1, 1) / √2 goes to (1, 0).
    wide = grey(4, 1, {0, 1, 2, 3}, Wrap::repeat, Wrap::repeat);
    std::get<ImageTexture>(wide.textures[0]).rotation = 45;
    const float half = std::sqrt(0.5f);
    EXPECT_NEAR(at(wide, 0.625f * half, 0.625f * half), 2, 1e-5);
    EXPECT_NEAR(at(wide, 0.625f * half + 3, 0.625f * half - 3), 2, 1e-5);
}

/// Of the heights themselves between texel centres, turned back into u and v.
TEST(Texture, Slope) {
    const auto slope_of = [](const Scene& s, Vec2 uv) {
        Diagnostics diagnostics;
        const ShadingScene shading = std::move(make_shading_scene(s, diagnostics)).value();
        SurfacePoint point;
        point.uv = uv;
        return texture_slope(shading, TextureId{0}, point);
    };
    Scene scene = grey(4, 4, {0, 1, 2, 3, 2, 3, 4, 5, 4, 5, 6, 7, 6, 7, 8, 9}, Wrap::clamp, Wrap::clamp);
    auto& t = std::get<ImageTexture>(scene.textures[0]);
    const auto expect_slope = [&](Vec2 uv, float du, float dv) {
        const Vec2 slope = slope_of(scene, uv);
        EXPECT_NEAR(slope.x, du, 1e-4);
        EXPECT_NEAR(slope.y, dv, 1e-4);
    };
    expect_slope({0.4f, 0.6f}, 4, 8);
    expect_slope({0.5f, 0.5f}, 4, 8);
    t.scale = {2, 0.5f};
    expect_slope({0.25f, 1}, 8, 4);
    t.scale = {1, 1}, t.rotation = 90;
    expect_slope({-0.5f, 0.5f}, -8, 4);  // s = v, t = -u
    scene.textures[0] = ConstantTexture{};
    EXPECT_EQ(slope_of(scene, {0.3f, 0.1f}), (Vec2{0, 0}));
}

/// Every level has the mean of the image, in linear light, whatever the number of texels.
TEST(Texture, LevelsOfMipMapsKeepTheMean) {
    for (const auto& [width, height] : {std::pair{8u, 8u}, {7u, 5u}, {1u, 9u}, {13u, 1u}, {3u, 6u}}) {
        std::vector<uint8_t> bytes;
        for (uint32_t i = 0; i < 3 * width * height; ++i) bytes.push_back(static_cast<uint8_t>(i * 89 % 251));
        const RawImage image = raw(width, height, 3, TexelFormat::u8, bytes);
        const auto mean = [](const RawImage& level, ColorSpace space) {
            double sum = 0;
            for (uint32_t y = 0; y < level.height; ++y)
                for (uint32_t x = 0; x < level.width; ++x) sum += texel(level, space, x, y).g;
            return sum / level.width / level.height;
        };
        const double expected = mean(image, ColorSpace::srgb);
        const MipMap map = MipMap::make(image, ColorSpace::srgb);
        uint64_t size = 0;
        for (const RawImage& level : map.levels) {
            EXPECT_NEAR(mean(level, ColorSpace::linear), expected, 1e-3) << level.width << " " << level.height;
            size += level.data.size();
        }
        ASSERT_FALSE(map.levels.empty());
        EXPECT_EQ(map.levels.back().width * map.levels.back().height, 1u);
        EXPECT_EQ(MipMap::bytes(image), size);
    }
    // Half floats to the nearest: 1/3 is 0x3555, 2^-20 is 16 of the smallest.
    const MipMap exact = MipMap::make(raw<float>(2, 1, 1, TexelFormat::f32, {1, 2.5f}), ColorSpace::linear);
    EXPECT_EQ(texel(exact.levels.at(0), ColorSpace::linear, 0, 0).r, 1.75f);
    const MipMap third = MipMap::make(raw<uint8_t>(2, 1, 1, TexelFormat::u8, {85, 85}), ColorSpace::linear);
    EXPECT_EQ(third.levels.at(0).format, TexelFormat::f16);
    EXPECT_NEAR(texel(third.levels.at(0), ColorSpace::linear, 0, 0).r, 1 / 3.0, 1.3e-4);
}

/// On a square of one metre with an image of 16 x 16 texels a footprint of 1/8 m is two texels: level 1.
TEST(Texture, TheFootprintChoosesTheLevel) {
    Scene scene;
    std::vector<float> values;
    for (int i = 0; i < 256; ++i) values.push_back(static_cast<float>(i * 37 % 101));
    scene.images.push_back(raw(16, 16, 1, TexelFormat::f32, values));
    ImageTexture texture;
    texture.color_space = ColorSpace::linear;
    texture.mip_map = true;
    scene.textures.push_back(texture);
    scene.shapes.push_back(Rectangle{{}, {0.5f, 0, 0}, {0, 0.5f, 0}});
    scene.materials.push_back(MirrorMaterial{});
    scene.instances.push_back({});
    const Scene plain = scene;
    Diagnostics diagnostics;
    const ShadingScene shading = std::move(make_shading_scene(scene, diagnostics)).value();
    const MipMap& map = *shading.mip_maps.at(0);
    SurfacePoint point;
    point.instance = 0, point.prim = 0;
    point.ng = point.ns = {0, 0, 1};
    point.uv = {1.5f / 8, 2.5f / 8};
    const auto read = [&](float footprint) {
        point.footprint = footprint;
        return eval_texture(shading, TextureId{0}, point).g;
    };
    const float finest = at(plain, point.uv.x, point.uv.y);
    EXPECT_EQ(read(0), finest);
    EXPECT_EQ(read(1 / 17.0f), finest);
    const float one = texel(map.levels[0], ColorSpace::linear, 1, 2).g;
    EXPECT_NEAR(read(1 / 8.0f), one, 1e-4f);
    EXPECT_NEAR(read(std::sqrt(0.5f) / 8), (finest + one) / 2, 1e-4f);
    EXPECT_NEAR(read(100), texel(map.levels.back(), ColorSpace::linear, 0, 0).g, 1e-4f);
}

TEST(Texture, Checkerboard) {
    Scene scene;
    scene.textures.push_back(CheckerTexture{{1, 1, 1}, {0, 0, 0}, {2, 4}, {0, 0.5f}});
    EXPECT_EQ(at(scene, 0.1f, 0.1f), 1);
    EXPECT_EQ(at(scene, 0.6f, 0.1f), 0);
    EXPECT_EQ(at(scene, 0.1f, 0.2f), 0);
    EXPECT_EQ(at(scene, 0.6f, 0.2f), 1);
    EXPECT_EQ(at(scene, -0.1f, 0.1f), 0);
    EXPECT_EQ(at(scene, -0.1f, -0.2f), 1);
}

TEST(Texture, FormatsAndChannels) {
    const RawImage u8 = raw<uint8_t>(2, 1, 3, TexelFormat::u8, {0, 128, 255, 51, 102, 153});
    EXPECT_EQ(texel(u8, ColorSpace::linear, 1, 0), (Rgb{51 / 255.0f, 102 / 255.0f, 153 / 255.0f}));
    EXPECT_EQ(texel(u8, ColorSpace::srgb, 0, 0), (Rgb{0, srgb_decode(128 / 255.0f), 1}));
    const RawImage u16 = raw<uint16_t>(1, 1, 4, TexelFormat::u16, {0, 32768, 65535, 7});
    EXPECT_EQ(texel(u16, ColorSpace::linear, 0, 0), (Rgb{0, 32768 / 65535.0f, 1}));
    EXPECT_EQ(texel(u16, ColorSpace::srgb, 0, 0), (Rgb{0, srgb_decode(32768 / 65535.0f), 1}));
    const RawImage grey_alpha = raw<uint8_t>(2, 1, 2, TexelFormat::u8, {255, 0, 51, 99});
    EXPECT_EQ(texel(grey_alpha, ColorSpace::linear, 0, 0), (Rgb{1, 1, 1}));
    EXPECT_EQ(texel(grey_alpha, ColorSpace::linear, 1, 0), (Rgb{0.2f, 0.2f, 0.2f}));
    // Half floats: 1, -2, the largest, the smallest normal and subnormal, infinity, NaN.
    const RawImage half = raw<uint16_t>(3, 1, 3, TexelFormat::f16,
                                        {0x3c00, 0xc000, 0x7bff, 0x0400, 0x0001, 0x8000, 0x7c00, 0x7e01, 0xfc00});
    EXPECT_EQ(texel(half, ColorSpace::linear, 0, 0), (Rgb{1, -2, 65504}));
    EXPECT_EQ(texel(half, ColorSpace::linear, 1, 0), (Rgb{0x1p-14f, 0x1p-24f, 0}));
    EXPECT_EQ(texel(half, ColorSpace::linear, 2, 0), (Rgb{0, 0, 0}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const RawImage f32 = raw<float>(1, 2, 3, TexelFormat::f32, {1e30f, -1, 0.5f, nan, kInfinity, -kInfinity});
    EXPECT_EQ(texel(f32, ColorSpace::linear, 0, 0), (Rgb{1e30f, -1, 0.5f}));
    EXPECT_EQ(texel(f32, ColorSpace::linear, 0, 1), (Rgb{0, 0, 0}));
    EXPECT_EQ(count_bad_texels(f32, false), 1u);
    EXPECT_EQ(count_bad_texels(f32, true), 2u);
    EXPECT_EQ(count_bad_texels(half, false), 1u);
    EXPECT_EQ(count_bad_texels(u8, true), 0u);
}

/// One image, above 1, as each of these; the warnings.
TEST(Texture, OnlyColoursOfWhatReflectsAddEnergy) {
    const auto warnings = [](const Material& material, std::optional<Relief> relief = {}) {
        Scene scene = grey(2, 2, {3, 3, 3, 3}, Wrap::repeat, Wrap::repeat);
        scene.names.images = {"big.pfm"};
        scene.materials.push_back(material);
        if (relief) scene.reliefs.push_back(*relief);
        Diagnostics diagnostics;
        EXPECT_TRUE(make_shading_scene(std::move(scene), diagnostics).ok());
        return diagnostics.warnings();
    };
    const TextureId big{0};
    const auto pbr = [&](auto member) {
        OpenPbrMaterial m;
        (m.*member).texture = big;
        return m;
    };
    const SchlickReflectance grey_metal{big, {1, 1, 1}};
    for (const Material& m : std::vector<Material>{
             DiffuseMaterial{big}, ConductorMaterial{grey_metal, {}, {1, 1, 1}}, DiffuseTransmissionMaterial{big, big},
             pbr(&OpenPbrMaterial::base_color), pbr(&OpenPbrMaterial::transmission_color)}) {
        const auto said = warnings(m);
        ASSERT_EQ(said.size(), 1u) << m.index();
        EXPECT_NE(said[0].message.find("image texture big.pfm: values above 1"), std::string::npos) << said[0].message;
    }
    GlassMaterial frosted;
    frosted.roughness.texture = big;
    for (const Material& m :
         std::vector<Material>{frosted, pbr(&OpenPbrMaterial::geometry_opacity), pbr(&OpenPbrMaterial::fuzz_weight),
                               pbr(&OpenPbrMaterial::thin_film_thickness), pbr(&OpenPbrMaterial::coat_color),
                               pbr(&OpenPbrMaterial::geometry_tangent), pbr(&OpenPbrMaterial::emission_color)})
        EXPECT_TRUE(warnings(m).empty()) << m.index();
    EXPECT_TRUE(warnings(MirrorMaterial{}, Relief{MaterialId{0}, BumpMap{big}}).empty());
}

TEST(Texture, ColoursBelowZeroAreCounted) {
    const auto warnings = [](const Material& material) {
        Scene scene = grey(2, 2, {-0.5f, 0.5f, -0.1f, kInfinity}, Wrap::repeat, Wrap::repeat);
        scene.materials.push_back(material);
        Diagnostics diagnostics;
        EXPECT_TRUE(make_shading_scene(std::move(scene), diagnostics).ok());
        return diagnostics.warnings();
    };
    const auto of_color = warnings(DiffuseMaterial{TextureId{0}});
    ASSERT_EQ(of_color.size(), 2u);
    EXPECT_EQ(of_color[1].message, "image texture: texels below 0 count as 0");
    EXPECT_EQ(of_color[1].count, 2u);
    GlassMaterial frosted;
    frosted.roughness.texture = TextureId{0};
    EXPECT_EQ(warnings(frosted).size(), 1u);  // of the one that is not finite
}

}  // namespace
}  // namespace steradian
