#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "image/colour_space.h"
#include "image/decode.h"
#include "image/exr_files.h"
#include "image/samples.h"

namespace steradian {
namespace {

float value_at(const std::string& channel, int x, int y) {
    return static_cast<float>(channel[channel.size() - 1]) + static_cast<float>(x) / 64 + static_cast<float>(y) * 8;
}

Imf::Header header_of(Imath::Box2i display, Imath::Box2i data, std::initializer_list<const char*> channels) {
    Imf::Header header(display, data);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const char* name : channels) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    return header;
}

const Imath::Box2i kWindow({0, 0}, {36, 21});

Image decoded(const std::string& bytes) {
    auto image = decode_image(bytes, "test", {});
    if (!image) throw std::runtime_error(image.error().str());
    return *std::move(image);
}

/// Every pixel is value_at inside `data` and 0 outside, in the coordinates of `display`.
void expect_values(const Image& image, Imath::Box2i display, Imath::Box2i data) {
    ASSERT_EQ(image.width, static_cast<uint32_t>(display.max.x - display.min.x + 1));
    ASSERT_EQ(image.height, static_cast<uint32_t>(display.max.y - display.min.y + 1));
    size_t i = 0;
    for (int y = display.min.y; y <= display.max.y; ++y)
        for (int x = display.min.x; x <= display.max.x; ++x)
            for (const std::string& channel : image.channels)
                ASSERT_EQ(image.pixels[i++], data.intersects(Imath::V2i(x, y)) ? value_at(channel, x, y) : 0.0f)
                    << channel << " at " << x << ", " << y;
}

TEST(Exr, EveryLosslessCompressionScanlineAndTiled) {
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION})
        for (const bool tiled : {false, true})
            for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
                Imf::Header header = header_of(kWindow, kWindow, {"R", "G", "B"});
                header.compression() = compression;
                header.lineOrder() = tiled ? Imf::INCREASING_Y : order;
                if (tiled) header.setTileDescription(Imf::TileDescription(16, 5));
                expect_values(decoded(test::exr_file(header, value_at)), kWindow, kWindow);
            }
}

TEST(Exr, DataWindowIsPlacedInTheDisplayWindow) {
    const Imath::Box2i display({-3, 5}, {20, 30});
    for (const Imath::Box2i& data :
         {Imath::Box2i({-3, 5}, {20, 30}), Imath::Box2i({0, 8}, {4, 9}), Imath::Box2i({-50, -50}, {50, 50}),
          Imath::Box2i({15, 25}, {40, 60}), Imath::Box2i({-9, 0}, {-3, 5}), Imath::Box2i({100, 100}, {110, 103})}) {
        const std::string file = test::exr_file(header_of(display, data, {"R", "G", "B", "Z"}), value_at);
        expect_values(decoded(file), display, data);
        const auto texels = decode_texels(file, "test", {});
        ASSERT_TRUE(texels);
        EXPECT_EQ(texels->width, static_cast<uint32_t>(data.max.x - data.min.x + 1))
            << "texels are those of the data window";
        EXPECT_EQ(texels->channels, 3);
        float first;
        std::memcpy(&first, texels->data.data(), sizeof first);
        EXPECT_EQ(first, value_at("R", data.min.x, data.min.y));
    }
}

TEST(Exr, TexelsKeepHalf) {
    const Image image = test::sample_image(9, 7);
    const auto texels = decode_texels(test::encoded(image, "a.exr", {.exr = ExrPrecision::half}), "test", {});
    ASSERT_TRUE(texels);
    EXPECT_EQ(texels->format, TexelFormat::f16);
    EXPECT_EQ(texels->data.size(), 9u * 7 * 3 * 2);
    EXPECT_EQ(decode_texels(test::encoded(image, "a.exr"), "test", {})->format, TexelFormat::f32);
}

TEST(Exr, TexelsAreTheColourOfTheFirstLayerThatHasIt) {
    const auto channels_of = [](std::initializer_list<const char*> names) {
        const auto raw = decode_texels(test::exr_file(header_of(kWindow, kWindow, names), value_at), "test", {});
        return raw ? int(raw->channels) : 0;
    };
    EXPECT_EQ(channels_of({"R", "G", "B", "A", "Z"}), 4);
    EXPECT_EQ(channels_of({"Z", "diffuse.R", "diffuse.G", "diffuse.B"}), 3);
    EXPECT_EQ(channels_of({"Y", "A"}), 2);
    EXPECT_EQ(channels_of({"Z"}), 1);
    EXPECT_EQ(channels_of({"X", "Z"}), 0);
}

TEST(Exr, FirstPartWithColour) {
    const Image image = decoded(test::two_part_exr());
    EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
    for (const float v : image.pixels) EXPECT_EQ(v, 2);
}

TEST(Exr, DeepIsRefusedByName) {
    const auto image = decode_image(test::deep_exr(), "test", {});
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().code, ErrorCode::bad_input);
    EXPECT_NE(image.error().message.find("deep"), std::string::npos) << image.error().message;
}

/// A linear ramp, which linear interpolation of chroma reproduces but for the last column and row.
Rgb ramp(int x, int y) { return {0.5f + static_cast<float>(x) / 64, 0.75f, 0.25f + static_cast<float>(y) / 64}; }

float luma_chroma(const std::string& channel, int x, int y) {
    const Rgb c = ramp(x, y);
    const float luma = luminance(c);
    return channel == "Y" ? luma : channel == "RY" ? (c.r - luma) / luma : channel == "BY" ? (c.b - luma) / luma : 1.0f;
}

TEST(Exr, LuminanceAndChroma) {
    for (const int sampling : {1, 2}) {
        const Imath::Box2i window({-2, 4}, {17, 15});
        Imf::Header header(window, window);
        header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
        header.channels().insert("RY", Imf::Channel(Imf::FLOAT, sampling, sampling));
        header.channels().insert("BY", Imf::Channel(Imf::FLOAT, sampling, sampling));
        const std::string file = test::exr_file(header, luma_chroma);
        const Image image = decoded(file);
        ASSERT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
        // Chroma is a quotient, so that between samples it is not quite linear: second differences over 8 bound it.
        const float tolerance = sampling == 1 ? 2e-4f : 2e-3f;
        for (int y = 4; y <= 15; ++y)
            for (int x = -2; x <= 17; ++x) {
                if (sampling == 2 && (x == 17 || y == 15)) continue;
                const float* pixel = &image.pixels[3 * static_cast<size_t>((y - 4) * 20 + x + 2)];
                const Rgb expected = ramp(x, y);
                for (int c = 0; c < 3; ++c) ASSERT_NEAR(pixel[c], expected[c], tolerance) << x << ", " << y;
            }
        EXPECT_EQ(decode_texels(file, "test", {})->channels, 3);
    }
}

TEST(Exr, OtherSubsamplingIsRefused) {
    Imf::Header header(2, 2);
    for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(Imf::FLOAT, 2, 2));
    const std::string file = test::exr_file(header, value_at);
    EXPECT_FALSE(decode_image(file, "test", {}));
    EXPECT_FALSE(decode_texels(file, "test", {}));
}

/// What a file says whose primaries are these, of the Rec. 709 colour c: through XYZ with exact white D65.
TEST(Exr, XyzPrimariesBecomeRec709) {
    // IEC 61966-2-1, XYZ of linear Rec. 709 to four digits: the columns are the primaries.
    static constexpr double kXyz[3][3] = {{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
    static constexpr double kColour[3] = {0.75, 0.25, 0.125};
    Imf::Header header = header_of(kWindow, kWindow, {"R", "G", "B"});
    Imf::addChromaticities(header, Imf::Chromaticities({1, 0}, {0, 1}, {0, 0}, {1 / 3.0f, 1 / 3.0f}));
    const auto value = [](const std::string& channel, int, int) {
        const int row = channel == "R" ? 0 : channel == "G" ? 1 : 2;
        return static_cast<float>(kXyz[row][0] * kColour[0] + kXyz[row][1] * kColour[1] + kXyz[row][2] * kColour[2]);
    };
    const Image image = decoded(test::exr_file(header, value));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixels[static_cast<size_t>(c)], kColour[c], 2e-3);
}

TEST(Exr, WhiteStaysWhite) {
    // ACES AP1 with its white near D60.
    const std::array<float, 8> ap1 = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    const auto matrix = rec709_from_primaries(ap1);
    ASSERT_TRUE(matrix);
    const Rgb white = *matrix * Rgb{1, 1, 1};
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1, 1e-5f);
    // The published ACEScg to linear Rec. 709 matrix (Bradford).
    static constexpr double kPublished[3][3] = {
        {1.70505, -0.62179, -0.08326}, {-0.13026, 1.14080, -0.01055}, {-0.02400, -0.12897, 1.15297}};
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 3; ++j) EXPECT_NEAR((*matrix)[i][j], kPublished[i][j], 2e-4);
}

TEST(Exr, Rec709IsLeftAloneAndNonsenseIsRefused) {
    const auto same = rec709_from_primaries(kRec709Primaries);
    ASSERT_TRUE(same);
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 3; ++j) EXPECT_NEAR((*same)[i][j], i == j, 1e-12);
    Imf::Header header = header_of(kWindow, kWindow, {"R", "G", "B"});
    Imf::addChromaticities(header, Imf::Chromaticities());
    expect_values(decoded(test::exr_file(header, value_at)), kWindow, kWindow);
    Imf::addChromaticities(header, Imf::Chromaticities({0, 0}, {0, 0}, {0, 0}, {0, 0}));
    EXPECT_FALSE(decode_image(test::exr_file(header, value_at), "test", {}));
}

TEST(Exr, MipmapsAreReadAtFullSize) {
    Imf::Header header = header_of(kWindow, kWindow, {"R", "G", "B"});
    header.setTileDescription(Imf::TileDescription(64, 64, Imf::MIPMAP_LEVELS));
    expect_values(decoded(test::exr_file(header, value_at)), kWindow, kWindow);
}

}  // namespace
}  // namespace steradian
