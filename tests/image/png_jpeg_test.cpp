#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>

#include "image/decode.h"
#include "image/samples.h"
#include "image/tone.h"

namespace steradian {
namespace {

RawImage texels(const std::string& bytes) {
    auto raw = decode_texels(bytes, "test", {});
    if (!raw) throw std::runtime_error(raw.error().str());
    return *std::move(raw);
}

TEST(Png, SixteenBitsAreKeptInNativeOrder) {
    const std::string rows("\0\x12\x34\xab\xcd\0\x01", 7);  // no filter, three grey values, big-endian
    const RawImage raw = texels(test::png_file(3, 1, 16, 0, rows));
    ASSERT_EQ(raw.format, TexelFormat::u16);
    ASSERT_EQ(raw.channels, 1);
    uint16_t values[3];
    std::memcpy(values, raw.data.data(), sizeof values);
    EXPECT_EQ(values[0], 0x1234);
    EXPECT_EQ(values[1], 0xabcd);
    EXPECT_EQ(values[2], 1);
    const auto image = decode_image(test::png_file(3, 1, 16, 0, rows), "test", {});
    EXPECT_EQ(image->channels, std::vector<std::string>{"Y"});
    EXPECT_EQ(image->pixels[1], srgb_decode(static_cast<float>(0xabcd) / 65535.0f));
}

TEST(Png, SmallDepthsAreExpanded) {
    const RawImage one = texels(test::png_file(8, 1, 1, 0, std::string("\0\xa5", 2)));
    for (size_t i = 0; i < 8; ++i) EXPECT_EQ(static_cast<int>(one.data[i]), (0xa5 >> (7 - i) & 1) * 255);
    const RawImage four = texels(test::png_file(2, 1, 4, 0, std::string("\0\x1f", 2)));
    EXPECT_EQ(static_cast<int>(four.data[0]), 0x11);
    EXPECT_EQ(static_cast<int>(four.data[1]), 0xff);
}

TEST(Png, AlphaIsNotPremultiplied) {
    const RawImage raw = texels(test::png_file(1, 1, 8, 6, std::string("\0\xc8\x64\x32\x00", 5)));
    ASSERT_EQ(raw.channels, 4);
    EXPECT_EQ(static_cast<int>(raw.data[0]), 0xc8) << "even where alpha is 0";
    EXPECT_EQ(static_cast<int>(raw.data[3]), 0);
    const auto image = decode_image(test::png_file(1, 1, 8, 6, std::string("\0\xc8\x64\x32\x80", 5)), "test", {});
    EXPECT_EQ(image->pixels[3], 128.0f / 255.0f) << "alpha is linear";
}

TEST(Png, TransparentColourBecomesAlpha) {
    constexpr size_t kAfterHeader = 8 + 25;
    std::string grey = test::png_file(2, 1, 16, 0, std::string("\0\x12\x34\x12\x35", 5));
    const RawImage one = texels(grey.insert(kAfterHeader, test::png_chunk("tRNS", "\x12\x35")));
    ASSERT_EQ(one.channels, 2);
    uint16_t values[4];
    ASSERT_EQ(one.data.size(), sizeof values);
    std::memcpy(values, one.data.data(), sizeof values);
    EXPECT_EQ(values[1], 65535);
    EXPECT_EQ(values[2], 0x1235) << "the colour stays";
    EXPECT_EQ(values[3], 0);

    std::string palette = test::png_file(2, 1, 8, 3, std::string("\0\0\1", 3));
    palette.insert(kAfterHeader, test::png_chunk("PLTE", "abcdef") + test::png_chunk("tRNS", "\x07"));
    const RawImage two = texels(palette);
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(two.data.data()), two.data.size()),
              "abc\x07"
              "def\xff");
}

std::vector<unsigned char> smooth_pixels(uint32_t width, uint32_t height, int components) {
    std::vector<unsigned char> out;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            for (int c = 0; c < components; ++c)
                out.push_back(static_cast<unsigned char>(128 + 100 * std::sin(0.1 * x + 0.07 * y + c)));
    return out;
}

TEST(Jpeg, GreyIsWithinTheTransformsRounding) {
    const auto pixels = smooth_pixels(40, 30, 1);
    const RawImage raw = texels(test::jpeg_file(40, 30, 1, false, pixels));
    ASSERT_EQ(raw.channels, 1);
    // Quality 100 quantises by 1: coefficients are off by 1/2 each, in the mean far less than 1.
    double squares = 0;
    for (size_t i = 0; i < pixels.size(); ++i) squares += std::pow(static_cast<int>(raw.data[i]) - pixels[i], 2);
    EXPECT_LT(squares / static_cast<double>(pixels.size()), 0.5);
}

TEST(Jpeg, ColourAndProgressive) {
    const auto pixels = smooth_pixels(33, 17, 3);
    const RawImage baseline = texels(test::jpeg_file(33, 17, 3, false, pixels));
    const RawImage progressive = texels(test::jpeg_file(33, 17, 3, true, pixels));
    ASSERT_EQ(baseline.channels, 3);
    EXPECT_EQ(baseline.data, progressive.data) << "the same coefficients, sent in another order";
    for (size_t i = 0; i < pixels.size(); ++i) ASSERT_NEAR(static_cast<int>(baseline.data[i]), pixels[i], 12);
    const auto image = decode_image(test::jpeg_file(33, 17, 3, false, pixels), "test", {});
    EXPECT_EQ(image->pixels[5], srgb_decode(static_cast<float>(static_cast<int>(baseline.data[5])) / 255.0f));
}

TEST(Jpeg, CmykIsRefusedByName) {
    const auto raw = decode_texels(test::jpeg_file(8, 8, 4, false, smooth_pixels(8, 8, 4)), "a.jpg", {});
    ASSERT_FALSE(raw);
    EXPECT_NE(raw.error().message.find("CMYK"), std::string::npos) << raw.error().message;
    EXPECT_EQ(raw.error().where.file, "a.jpg");
}

TEST(ImageKind, ByTheFirstBytes) {
    const Image image = test::sample_image(8, 8);
    EXPECT_EQ(image_kind(test::encoded(image, "a.exr")), ImageFileKind::exr);
    EXPECT_EQ(image_kind(test::encoded(image, "a.png")), ImageFileKind::png);
    EXPECT_EQ(image_kind(test::encoded(image, "a.hdr")), ImageFileKind::hdr);
    EXPECT_EQ(image_kind(test::encoded(image, "a.pfm")), ImageFileKind::pfm);
    EXPECT_EQ(image_kind(test::jpeg_file(8, 8, 1, false, smooth_pixels(8, 8, 1))), ImageFileKind::jpeg);
    for (const char* other : {"", "P", "PF", "P6\n", "#", "GIF89a", "{}"})
        EXPECT_EQ(image_kind(other), ImageFileKind::unknown) << other;
}

}  // namespace
}  // namespace steradian
