// Textures: exact values at texel centres and between them, wrapping, formats, coordinates that make no sense.
#include "shading/texture.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "image/tone.h"
#include "math/vector.h"

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

}  // namespace
}  // namespace steradian
