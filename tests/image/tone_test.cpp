#include "image/tone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "image/view.h"
#include "support/support.h"

namespace steradian {
namespace {

TEST(Srgb, AgreesWithTheStandardInLongDouble) {
    for (int i = 0; i <= 4096; ++i) {
        const auto x = static_cast<float>(i) / 4096.0f;
        const long double lx = x;
        const long double encoded = lx <= 0.0031308L ? 12.92L * lx : 1.055L * std::pow(lx, 1 / 2.4L) - 0.055L;
        const long double decoded = lx <= 0.04045L ? lx / 12.92L : std::pow((lx + 0.055L) / 1.055L, 2.4L);
        // One rounding to float of a result good to a few units of double.
        EXPECT_NEAR(srgb_encode(x), static_cast<double>(encoded),
                    0x1p-24 * std::max(0x1p-10, static_cast<double>(encoded)))
            << x;
        EXPECT_NEAR(srgb_decode(x), static_cast<double>(decoded),
                    0x1p-24 * std::max(0x1p-10, static_cast<double>(decoded)))
            << x;
    }
}

TEST(Srgb, InvertsItself) {
    for (int v = 0; v < 65536; ++v) {
        const float encoded = static_cast<float>(v) / 65535.0f;
        const float back = srgb_encode(srgb_decode(encoded));
        EXPECT_EQ(static_cast<int>(back * 65535.0f + 0.5f), v);
    }
}

TEST(Srgb, ClipsAndTakesAnything) {
    EXPECT_EQ(srgb_encode(0), 0);
    EXPECT_EQ(srgb_encode(1), 1);
    EXPECT_EQ(srgb_decode(0), 0);
    EXPECT_EQ(srgb_decode(1), 1);
    EXPECT_EQ(srgb_encode(-3), 0);
    EXPECT_EQ(srgb_encode(std::numeric_limits<float>::infinity()), 1);
    EXPECT_EQ(srgb_encode(std::numeric_limits<float>::quiet_NaN()), 0);
}

TEST(SrgbQuantizer, IsTheRoundedEncoding) {
    const SrgbQuantizer quantize;
    const auto expected = [](float x) { return static_cast<int>(srgb_encode(x) * 255.0f + 0.5f); };
    for (int i = -100; i <= 200000; ++i) {
        const auto x = static_cast<float>(i) / 190000.0f;
        ASSERT_EQ(quantize(x), expected(x)) << x;
    }
    // Around every step, to the neighbouring float.
    for (int v = 1; v < 256; ++v) {
        float x = srgb_decode((static_cast<float>(v) - 0.5f) / 255.0f);
        for (int k = 0; k < 8; ++k) x = std::nextafter(x, 0.0f);
        for (int k = 0; k < 16; ++k, x = std::nextafter(x, 2.0f)) ASSERT_EQ(quantize(x), expected(x)) << v;
    }
    EXPECT_EQ(quantize(std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_EQ(quantize(std::numeric_limits<float>::infinity()), 255);
}

class EveryView : public testing::TestWithParam<std::string> {
protected:
    Rgb show(Rgb c, float exposure = 0) const { return apply_view(GetParam(), c, exposure); }
};

TEST_P(EveryView, GreyStaysGreyAndGrows) {
    // The published matrices of agx and aces are rounded: their rows sum to 1 within 1.4e-4 and 1.2e-3 (the products).
    const float tolerance = GetParam() == "agx" || GetParam() == "aces" ? 2e-3f : 1e-6f;
    float last = 0;
    for (int i = 0; i <= 4000; ++i) {
        const float x = std::exp2(static_cast<float>(i - 3000) / 200.0f);  // 2^-15 … 2^5
        const Rgb c = show({x, x, x});
        EXPECT_NEAR(c.r, c.g, tolerance * std::max(c.g, 0.05f));
        EXPECT_NEAR(c.b, c.g, tolerance * std::max(c.g, 0.05f));
        ASSERT_GE(c.g, last) << x;
        last = c.g;
    }
    EXPECT_GT(last, 0.75f);
}

TEST_P(EveryView, StaysWithinTheDisplay) {
    const float extremes[] = {0,
                              -1,
                              1e-45f,
                              1,
                              65504,
                              1e38f,
                              std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity(),
                              std::numeric_limits<float>::quiet_NaN()};
    for (const float r : extremes)
        for (const float g : extremes)
            for (const float b : extremes)
                for (const float exposure : {0.0f, 20.0f, -20.0f, 1e9f, -1e9f}) {
                    const Rgb c = show({r, g, b}, exposure);
                    for (int k = 0; k < 3; ++k) ASSERT_TRUE(c[k] >= 0 && c[k] <= 1) << r << " " << g << " " << b;
                }
}

TEST_P(EveryView, ExposureIsAFactor) {
    const Rgb c{0.1f, 0.2f, 0.05f};
    EXPECT_EQ(show(c, 3), show(c * 8));
    EXPECT_EQ(show(c, -2), show(c * 0.25f));
    const Rgb half = show(c, 0.5f), factor = show(c * std::sqrt(2.0f));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(half[k], factor[k], 1e-6f);
}

TEST_P(EveryView, BlackIsBlack) {
    // agx and aces lift or sink black by less than an 8-bit step.
    const Rgb c = show({0, 0, 0});
    for (int k = 0; k < 3; ++k) EXPECT_LT(srgb_encode(c[k]), 0.5f / 255);
}

INSTANTIATE_TEST_SUITE_P(Views, EveryView, testing::Values("srgb", "agx", "aces", "neutral", "reinhard"),
                         [](const auto& view) { return view.param; });

TEST(Views, AreTheListedOnes) {
    EXPECT_EQ(view_names().size(), 5u);
    for (const auto name : view_names()) EXPECT_TRUE(find_view(name, 0));
    EXPECT_FALSE(find_view("AgX ", 0));
}

TEST(Views, MatchTheirDefinitions) {
    // srgb: clipped. reinhard: L / (1 + L). neutral: below the knee the picture less 0.04, and white is 1 at infinity.
    EXPECT_EQ(apply_view("srgb", {0.25f, 2, -1}, 0), (Rgb{0.25f, 1, 0}));
    const Rgb reinhard = apply_view("reinhard", {1, 1, 1}, 0);
    EXPECT_NEAR(reinhard.g, 0.5f, 1e-6f);
    const Rgb neutral = apply_view("neutral", {0.5f, 0.4f, 0.3f}, 0);
    EXPECT_NEAR(neutral.r, 0.46f, 1e-6f);
    EXPECT_NEAR(neutral.b, 0.26f, 1e-6f);
    // Hill's fit by hand for grey 1: a = 1.0245786 - 0.000090537, b = 0.983729 + 0.432951 + 0.238081.
    EXPECT_NEAR(apply_view("aces", {1, 1, 1}, 0).g, 1.024488063 / 1.654761, 2e-3);
    // AgX puts middle grey at half of its encoded range; the fit is good to a few thousandths of that.
    EXPECT_NEAR(apply_view("agx", {0.18f, 0.18f, 0.18f}, 0).g, std::pow(0.5, 2.2), 0.01);
}

}  // namespace
}  // namespace steradian
