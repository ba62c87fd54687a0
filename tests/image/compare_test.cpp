#include "image/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "image/samples.h"

namespace steradian {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

Image constant(uint32_t width, uint32_t height, float value) {
    Image image = test::sample_image(width, height);
    for (float& v : image.pixels) v = value;
    return image;
}

TEST(CompareImages, EqualPictures) {
    const Image a = test::sample_image(20, 10);
    const auto d = compare_images(a, a);
    ASSERT_TRUE(d);
    EXPECT_EQ(d->mse, 0);
    EXPECT_EQ(d->rel_mse, 0);
    EXPECT_EQ(d->psnr, kInf);
    EXPECT_EQ(d->max_abs, 0);
    EXPECT_EQ(d->different_pixels, 0u);
}

TEST(CompareImages, ClosedForms) {
    // 1/4 apart everywhere, the reference is 1/2: exact in binary.
    const auto d = compare_images(constant(9, 7, 0.75f), constant(9, 7, 0.5f));
    EXPECT_EQ(d->mse, 1.0 / 16);
    EXPECT_DOUBLE_EQ(d->rel_mse, (1.0 / 16) / (0.25 + 1e-2));
    EXPECT_NEAR(d->psnr, 10 * std::log10(16.0), 1e-12);
    EXPECT_EQ(d->max_abs, 0.25);
    EXPECT_EQ(d->different_pixels, 63u);
}

TEST(CompareImages, FindsTheOnePixel) {
    const Image a = test::sample_image(100, 50);
    Image b = a;
    b.pixels[(31 * 100 + 77) * 3 + 1] += 2;
    const auto d = compare_images(a, b);
    EXPECT_EQ(d->max_x, 77u);
    EXPECT_EQ(d->max_y, 31u);
    EXPECT_EQ(d->different_pixels, 1u);
    EXPECT_NEAR(d->mse, 4.0 / 15000, 1e-9);
}

TEST(CompareImages, IsByChannelName) {
    Image a = test::sample_image(2, 1), b = a;
    b.channels = {"B", "G", "R"};
    for (size_t i = 0; i < 6; i += 3) std::swap(b.pixels[i], b.pixels[i + 2]);
    EXPECT_EQ(compare_images(a, b)->different_pixels, 0u);
    b.channels = {"B", "G", "A"};
    EXPECT_FALSE(compare_images(a, b));
    EXPECT_FALSE(compare_images(a, test::sample_image(1, 2)));
    EXPECT_FALSE(compare_images(a, test::sample_image(2, 1, {"R", "G"})));
    EXPECT_EQ(compare_images(a, test::sample_image(1, 2)).error().code, ErrorCode::bad_input);
}

TEST(CompareImages, NotFiniteValues) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    Image a = constant(2, 1, 1), b = a;
    a.pixels[0] = b.pixels[0] = nan;
    a.pixels[1] = b.pixels[1] = inf;
    EXPECT_EQ(compare_images(a, b)->mse, 0);
    b.pixels[4] = nan;
    const auto one_nan = compare_images(a, b);
    EXPECT_EQ(one_nan->max_abs, kInf);
    EXPECT_EQ(one_nan->mse, kInf);
    EXPECT_EQ(one_nan->psnr, -kInf);
    EXPECT_EQ(one_nan->max_x, 1u);
    b = a;
    b.pixels[1] = -inf;
    EXPECT_EQ(compare_images(a, b)->max_abs, kInf);
    Image minus = constant(1, 1, -0.0f);
    EXPECT_EQ(compare_images(constant(1, 1, 0.0f), minus)->different_pixels, 1u) << "bits differ, values do not";
    EXPECT_EQ(compare_images(constant(1, 1, 0.0f), minus)->mse, 0);
}

TEST(CompareImages, SumsDoNotDrift) {
    // A large term first: a plain sum in double would lose the small ones.
    Image a = constant(1000, 300, 0), b = a;
    a.pixels[0] = 1e8f;
    for (size_t i = 1; i < a.pixels.size(); ++i) a.pixels[i] = 0.5f;
    const double expected = (1e16 + 0.25 * 899999) / 900000;
    EXPECT_DOUBLE_EQ(compare_images(a, b)->mse, expected);
}

TEST(DifferenceImage, IsTheDistancePerChannel) {
    const Image a = test::sample_image(6, 5);
    Image b = a;
    b.pixels[10] += 1;
    const auto d = difference_image(a, b);
    ASSERT_TRUE(d);
    for (size_t i = 0; i < a.pixels.size(); ++i) EXPECT_EQ(d->pixels[i], std::fabs(a.pixels[i] - b.pixels[i]));
    EXPECT_EQ(d->channels, a.channels);
    EXPECT_FALSE(difference_image(a, test::sample_image(5, 6)));
}

}  // namespace
}  // namespace steradian
