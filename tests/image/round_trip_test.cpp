// What is written comes back: to the bit where the format can hold it.
#include <gtest/gtest.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "image/decode.h"
#include "image/samples.h"
#include "image/tone.h"
#include "support/support.h"

namespace steradian {
namespace {

using test::encoded;
using test::sample_image;

constexpr float kInf = std::numeric_limits<float>::infinity();

Image decoded(const std::string& bytes) {
    auto image = decode_image(bytes, "test", {});
    if (!image) throw std::runtime_error(image.error().str());
    return *std::move(image);
}

// The documented layout, put together by hand and hashed in one call; and the number, so that it cannot drift.
TEST(ImageHash, IsXxh3OverTheDocumentedBytes) {
    Image image;
    image.width = 2;
    image.height = 1;
    image.channels = {"R", "depth"};
    image.pixels = {0.0f, -0.0f, 1.5f, kInf};
    image.metadata["software"] = "does not count";
    std::string bytes;
    const auto add = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    add(uint32_t(2)), add(uint32_t(1)), add(uint32_t(2));
    add(uint64_t(1)), bytes += "R";
    add(uint64_t(5)), bytes += "depth";
    for (const uint32_t bits : {0x00000000u, 0x80000000u, 0x3fc00000u, 0x7f800000u}) add(bits);
    const XXH128_hash_t digest = XXH3_128bits(bytes.data(), bytes.size());
    char expected[33];
    std::snprintf(expected, sizeof expected, "%016llx%016llx", static_cast<unsigned long long>(digest.high64),
                  static_cast<unsigned long long>(digest.low64));
    EXPECT_EQ(image_hash(image), expected);
    EXPECT_EQ(image_hash(image), "6157a8a496f2d4dbe545cbd08e8cd137");
}

TEST(ImageHash, SeesEverythingButMetadata) {
    const Image image = sample_image(3, 4);
    const std::string hash = image_hash(image);
    Image other = image;
    other.metadata["a"] = "b";
    EXPECT_EQ(image_hash(other), hash);
    other.pixels[7] = std::nextafter(other.pixels[7], kInf);
    EXPECT_NE(image_hash(other), hash);
    other = image;
    std::swap(other.width, other.height);
    EXPECT_NE(image_hash(other), hash);
    other = image;
    other.channels[0] = "r";
    EXPECT_NE(image_hash(other), hash);
}

TEST(RoundTrip, SinglePrecisionExrKeepsEveryBit) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 40u}, {40u, 1u}, {33u, 47u}}) {
        Image image = sample_image(width, height);
        image.pixels[0] = kInf;
        image.pixels[1] = -0.0f;
        image.pixels[2] = std::numeric_limits<float>::quiet_NaN();
        image.metadata = {{"software", "steradian"}, {"seed", "7"}, {"umlaut", "ä €"}};
        const Image back = decoded(encoded(image, "a.exr"));
        EXPECT_EQ(image_hash(back), image_hash(image));
        EXPECT_EQ(back.metadata, image.metadata);
    }
}

TEST(RoundTrip, ExrKeepsAnyChannelsInTheirOrder) {
    for (const std::vector<std::string>& channels : {std::vector<std::string>{"Y"},
                                                     {"Z"},
                                                     {"R", "G", "B", "A"},
                                                     {"B", "G", "R"},
                                                     {"depth", "R", "G", "B", "N.X", "N.Y", "N.Z"},
                                                     {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B"},
                                                     {"with space", "a.b.c"},
                                                     {"G"}}) {
        const Image image = sample_image(5, 3, channels);
        EXPECT_EQ(image_hash(decoded(encoded(image, "a.exr"))), image_hash(image)) << channels[0];
    }
}

TEST(RoundTrip, HalfExrRoundsToTheNearest) {
    const Image image = sample_image(40, 30);
    const Image back = decoded(encoded(image, "a.exr", {.exr = ExrPrecision::half}));
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        // Half has 11 significant bits, and steps of 2^-24 below 2^-14.
        const float bound = std::max(std::ldexp(std::fabs(image.pixels[i]), -11), 0x1p-25f);
        ASSERT_LE(std::fabs(back.pixels[i] - image.pixels[i]), bound) << image.pixels[i];
    }
}

TEST(RoundTrip, ChannelsHaveTypesOfTheirOwn) {
    Image image = sample_image(3, 1, {"R", "Z", "id"});
    image.pixels = {1.0f / 3, 1e10f, 16777216, 70000, 1.0f / 3, 0, 2, -0.0f, 4294967040.0f};
    image.types = {ChannelType::by_options, ChannelType::single, ChannelType::uint32};
    Diagnostics diagnostics;
    const std::string file = encoded(image, "a.exr", {.exr = ExrPrecision::half}, &diagnostics);
    const Image back = decoded(file);
    EXPECT_NEAR(back.pixels[0], 1.0f / 3, 1e-3f);
    EXPECT_NE(back.pixels[0], 1.0f / 3);
    EXPECT_EQ(back.pixels[3], 65504.0f);
    for (const size_t i : {1u, 2u, 4u, 5u, 7u, 8u}) EXPECT_EQ(back.pixels[i], image.pixels[i]);
    EXPECT_EQ(diagnostics.warnings().size(), 1u);
    // What was whole stays whole when the file is written again, in half precision or not.
    EXPECT_EQ(back.types[2], ChannelType::uint32);
    EXPECT_NE(back.types[0], ChannelType::uint32);
    const Image again = decoded(encoded(back, "b.exr", {.exr = ExrPrecision::half}));
    EXPECT_EQ(again.pixels[8], image.pixels[8]);
}

TEST(RoundTrip, MeasurementsAreNeverHalf) {
    const std::vector<std::string> singles{"Z", "P.X", "P.Y", "P.Z", "uv.U", "uv.V", "variance.R"};
    for (const std::string& name : singles) {
        Image image = sample_image(2, 1, {name});
        image.pixels = {1e10f, 1.0f / 3};
        Diagnostics diagnostics;
        const std::string file = encoded(image, "a.exr", {.exr = ExrPrecision::half}, &diagnostics);
        EXPECT_EQ(decoded(file).pixels, image.pixels) << name;
        // The same when the file is written again.
        EXPECT_EQ(decoded(encoded(decoded(file), "b.exr", {.exr = ExrPrecision::half})).pixels, image.pixels) << name;
        EXPECT_TRUE(diagnostics.warnings().empty());
    }
    for (const char* name : {"R", "N.Z", "albedo.R", "uvw", "Pz"}) {
        Image image = sample_image(2, 1, {name});
        image.pixels = {1, 1.0f / 3};
        EXPECT_NE(decoded(encoded(image, "a.exr", {.exr = ExrPrecision::half})).pixels, image.pixels) << name;
    }
}

TEST(RoundTrip, WholeNumbersAreClampedAndCounted) {
    Image image = sample_image(5, 1, {"id"});
    image.types = {ChannelType::uint32};
    image.pixels = {-1, 0x1p32f, std::numeric_limits<float>::quiet_NaN(), 7, kInf};
    Diagnostics diagnostics;
    const Image back = decoded(encoded(image, "a.exr", {}, &diagnostics));
    EXPECT_EQ(back.pixels, (std::vector<float>{0, 0x1p32f, 0, 7, 0x1p32f}));  // 2³² - 1 as a float
    ASSERT_EQ(diagnostics.warnings().size(), 1u);
    EXPECT_EQ(diagnostics.warnings()[0].count, 4u);
}

TEST(ColorChannels, AreRedGreenAndBlueAlone) {
    Image image = sample_image(4, 3, {"Z", "B", "A", "R", "N.X", "G"});
    image.metadata = {{"a", "b"}};
    const Image color = color_channels(image);
    EXPECT_EQ(color.channels, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_EQ(color.metadata, image.metadata);
    ASSERT_EQ(color.pixels.size(), 36u);
    for (size_t i = 0; i < 12; ++i) {
        EXPECT_EQ(color.pixels[3 * i], image.pixels[6 * i + 3]);
        EXPECT_EQ(color.pixels[3 * i + 1], image.pixels[6 * i + 5]);
        EXPECT_EQ(color.pixels[3 * i + 2], image.pixels[6 * i + 1]);
    }
    EXPECT_TRUE(color_channels(sample_image(4, 3, {"R", "G", "X"})).pixels.empty());
}

TEST(RoundTrip, HalfExrClampsAndCounts) {
    Image image = sample_image(4, 1, {"Y"});
    image.pixels = {65504.0f, 65505.0f, -1e30f, kInf};
    Diagnostics diagnostics;
    const Image back = decoded(encoded(image, "a.exr", {.exr = ExrPrecision::half}, &diagnostics));
    EXPECT_EQ(back.pixels, (std::vector<float>{65504, 65504, -65504, 65504}));
    ASSERT_EQ(diagnostics.warnings().size(), 1u);
    EXPECT_EQ(diagnostics.warnings()[0].count, 3u);
}

TEST(RoundTrip, PfmKeepsEveryBit) {
    Image image = sample_image(7, 5);
    image.pixels[3] = kInf;
    const std::string file = encoded(image, "a.pfm");
    EXPECT_EQ(image_hash(decoded(file)), image_hash(image));
    // The bottom row comes first, little-endian.
    EXPECT_TRUE(file.starts_with("PF\n7 5\n-1.0\n"));
    EXPECT_EQ(std::memcmp(file.data() + 12, &image.pixels[4 * 7 * 3], 7 * 3 * sizeof(float)), 0);
    const Image grey = sample_image(7, 5, {"Y"});
    EXPECT_EQ(image_hash(decoded(encoded(grey, "a.pfm"))), image_hash(grey));
}

TEST(Pfm, ReadsBigEndianAndScale) {
    const std::string file("Pf 2 1\n2\n\x3f\x80\0\0\xbf\0\0\0", 17);
    EXPECT_EQ(decoded(file).pixels, (std::vector<float>{2, -1}));
}

TEST(RoundTrip, HdrIsWithinHalfAStepOfTheSharedExponent) {
    for (const uint32_t width : {1u, 7u, 8u, 200u}) {
        Image image = sample_image(width, 9);
        for (float& v : image.pixels) v = std::fabs(v);
        for (size_t x = 0; x < width; ++x) image.pixels[3 * x] = 0.25f;  // long runs in the first row
        const std::string file = encoded(image, "a.hdr");
        const Image back = decoded(file);
        for (size_t i = 0; i < image.pixels.size(); i += 3) {
            const float largest = std::max({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
            for (size_t c = 0; c < 3; ++c)
                ASSERT_LE(std::fabs(back.pixels[i + c] - image.pixels[i + c]), std::ldexp(largest, -7) / 2) << i;
        }
        EXPECT_EQ(encoded(back, "b.hdr"), file) << "what the format holds is kept exactly";
    }
}

TEST(Hdr, ExtremesAreClampedAndCounted) {
    Image image = sample_image(5, 1);
    image.pixels = {-1,     0, 0, kInf,        0,         0, std::numeric_limits<float>::quiet_NaN(), 1, 1,
                    1e-44f, 0, 0, 0x1.fep126f, 0x1p-140f, 3};
    Diagnostics diagnostics;
    const Image back = decoded(encoded(image, "a.hdr", {}, &diagnostics));
    EXPECT_EQ(back.pixels, (std::vector<float>{0, 0, 0, 0x1.fep126f, 0, 0, 0, 1, 1, 0, 0, 0, 0x1.fep126f, 0, 0}));
    ASSERT_EQ(diagnostics.warnings().size(), 1u);
    EXPECT_EQ(diagnostics.warnings()[0].count, 3u);
}

TEST(Hdr, ReadsOldRunsOrientationAndExposure) {
    const std::string head = "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\nEXPOSURE=0.25\n\n";
    // One pixel (1, 0.5, 0) and two repeats of it; the exposures' product is 1/2.
    const Image flat = decoded(head + "-Y 1 +X 3\n" + std::string("\x80\x40\x00\x81\x01\x01\x01\x02", 8));
    EXPECT_EQ(flat.pixels, (std::vector<float>{2, 1, 0, 2, 1, 0, 2, 1, 0}));
    const Image turned =
        decoded(head + "+Y 2 -X 2\n" + std::string("\x80\0\0\x80\0\x80\0\x80\0\0\x80\x80\x80\x80\x80\x80", 16));
    EXPECT_EQ(turned.pixels, (std::vector<float>{1, 1, 1, 0, 0, 1, 0, 1, 0, 1, 0, 0}));
    EXPECT_FALSE(decode_image(head + "+X 2 -Y 2\n", "test", {}));
}

TEST(RoundTrip, PngIsTheNearestSrgbStep) {
    Image image = sample_image(31, 17, {"R", "G", "B", "A"});
    image.metadata = {{"Title", "a sphere"}, {"Comment", "ä"}};
    const std::string file = encoded(image, "a.png");
    const auto raw = decode_texels(file, "test", {});
    ASSERT_TRUE(raw) << raw.error().str();
    ASSERT_EQ(raw->channels, 4);
    ASSERT_EQ(raw->format, TexelFormat::u8);
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        const float x = image.pixels[i];
        const float shown = i % 4 == 3 ? std::min(std::max(x, 0.0f), 1.0f) : srgb_encode(x);
        ASSERT_EQ(static_cast<int>(raw->data[i]), static_cast<int>(shown * 255.0f + 0.5f)) << x;
    }
    const Image back = decoded(file);
    EXPECT_EQ(back.metadata, image.metadata);
    EXPECT_EQ(encoded(back, "b.png"), file) << "8-bit values survive linearising and encoding";
}

TEST(RoundTrip, EqualPicturesAreEqualFiles) {
    Image image = sample_image(50, 40);
    image.metadata = {{"seed", "1"}};
    for (const char* name : {"a.exr", "a.png", "a.hdr", "a.pfm"})
        EXPECT_EQ(encoded(image, name), encoded(image, name)) << name;
}

TEST(WriteImage, RefusesWhatMakesNoSense) {
    const test::TemporaryFolder folder;
    const auto expect = [&](const std::string& name, const Image& image, ErrorCode code,
                            const ImageWriteOptions& options = {}) {
        const auto status = write_image(folder.file(name), image, options);
        ASSERT_FALSE(status) << name;
        EXPECT_EQ(status.error().code, code) << status.error().str();
        EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << name;
    };
    const Image good = sample_image(4, 4);
    expect("a.gif", good, ErrorCode::usage);
    expect("a", good, ErrorCode::usage);
    expect("missing/a.exr", good, ErrorCode::resources);
    expect("a.png", good, ErrorCode::usage, {.view = "agxx"});
    expect("a.png", good, ErrorCode::usage, {.exposure = kInf});
    expect("a.png", sample_image(4, 4, {"X", "Z"}), ErrorCode::usage);
    Image bad = good;
    bad.pixels.pop_back();
    expect("a.exr", bad, ErrorCode::usage);
    expect("a.exr", Image{}, ErrorCode::usage);
    expect("a.exr", sample_image(4, 4, {"R", "R"}), ErrorCode::usage);
    expect("a.exr", sample_image(4, 4, {""}), ErrorCode::usage);
    bad = good;
    bad.metadata["dataWindow"] = "x";
    expect("a.exr", bad, ErrorCode::usage);
    bad.metadata = {{"", "x"}};
    expect("a.exr", bad, ErrorCode::usage);
}

TEST(WriteImage, SaysWhatAFormatLeavesOut) {
    const Image image = sample_image(4, 4, {"R", "G", "B", "A", "depth"});
    Diagnostics diagnostics;
    (void)encoded(image, "a.pfm", {}, &diagnostics);
    ASSERT_EQ(diagnostics.warnings().size(), 1u);
    EXPECT_NE(diagnostics.warnings()[0].message.find("A, depth"), std::string::npos);
}

TEST(Scales, ThatNoFloatCanHoldAreRefused) {
    const auto fails = [](const std::string& bytes) { return !decode_image(bytes, "test", {}); };
    for (const char* scale : {"1e300", "-1e39", "1e-300", "nan", "inf", "0"})
        EXPECT_TRUE(fails(std::string("Pf\n1 1\n") + scale + "\nabcd")) << scale;
    for (const char* exposure : {"1e300", "1e39", "1e-39", "1e-300"})
        EXPECT_TRUE(fails(std::string("#?RADIANCE\nEXPOSURE=") + exposure + "\n\n-Y 1 +X 1\nabcd")) << exposure;
    EXPECT_FALSE(fails("Pf\n1 1\n-1e38\nabcd"));
    EXPECT_FALSE(fails("#?RADIANCE\nEXPOSURE=1e37\n\n-Y 1 +X 1\nabcd"));
}

TEST(PngOutput, CountsPixelsThatAreNotFiniteAndDefinesThem) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    Image image;
    image.width = 5, image.height = 1;
    image.channels = {"R", "G", "B", "A"};
    image.pixels = {kNan, kInf, -kInf, 1, 1, 1, 1, kNan, 0, 0, 0, kInf, 3e38f, -3e38f, 0, 1, 0.5f, 0.5f, 0.5f, 0.5f};
    const test::TemporaryFolder folder;
    const std::string path = folder.file("a.png");
    for (const std::string_view view : view_names())
        for (const float exposure : {0.0f, 100.0f, -100.0f}) {
            Diagnostics diagnostics;
            ImageWriteOptions options;
            options.view = view, options.exposure = exposure;
            ASSERT_TRUE(write_image(path, image, options, &diagnostics));
            ASSERT_EQ(diagnostics.warnings().size(), 1u) << view;
            EXPECT_EQ(diagnostics.warnings()[0].count, 3u);  // the large ones and the overflow of the exposure are not
            EXPECT_NE(diagnostics.warnings()[0].message.find("not finite"), std::string::npos);
            const RawImage raw = read_texels(path, {}).value();
            EXPECT_EQ(raw.data[7], std::byte{0});
            EXPECT_EQ(raw.data[11], std::byte{255});
            if (view != "srgb") continue;
            EXPECT_EQ(raw.data[0], std::byte{0});
            EXPECT_EQ(raw.data[1], std::byte{255});
            EXPECT_EQ(raw.data[2], std::byte{0});
        }
}

}  // namespace
}  // namespace steradian
