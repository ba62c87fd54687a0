// Files that lie, end early or were hit by a stray particle: refused or decoded, never a crash, never much memory.
#include <OpenEXR/ImfChannelList.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "image/decode.h"
#include "image/exr_files.h"
#include "image/samples.h"
#include "support/support.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define STERADIAN_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define STERADIAN_SANITIZED 1
#endif
#endif

namespace steradian {
namespace {

float some_value(const std::string&, int x, int y) { return static_cast<float>(x * 3 + y) / 7; }

std::string tiled_exr() {
    Imf::Header floats(20, 11);
    floats.setTileDescription(Imf::TileDescription(8, 8));
    floats.compression() = Imf::PIZ_COMPRESSION;
    for (const char* name : {"R", "G", "B"}) floats.channels().insert(name, Imf::Channel(Imf::FLOAT));
    return test::exr_file(floats, some_value);
}

/// Small files of every kind, by name.
std::vector<std::pair<std::string, std::string>> samples() {
    const Image image = test::sample_image(9, 5);
    std::vector<unsigned char> bytes(9 * 5 * 3);
    for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<unsigned char>(i * 53);
    return {{"exr", test::encoded(image, "a.exr")},
            {"half exr", test::encoded(image, "a.exr", {.exr = ExrPrecision::half})},
            {"tiled exr", tiled_exr()},
            {"multipart exr", test::two_part_exr()},
            {"deep exr", test::deep_exr()},
            {"png", test::encoded(image, "a.png")},
            {"16 bit png", test::png_file(3, 2, 16, 2, std::string(2 * 19, '\0'))},
            {"hdr", test::encoded(image, "a.hdr")},
            {"pfm", test::encoded(image, "a.pfm")},
            {"jpeg", test::jpeg_file(9, 5, 3, false, bytes)},
            {"progressive jpeg", test::jpeg_file(9, 5, 3, true, bytes)}};
}

constexpr ImageLimits kLimits{1 << 22};

/// Decodes both ways; what comes out must hold what it says.
bool decode_both(const std::string& bytes) {
    const auto raw = decode_texels(bytes, "test", kLimits);
    const auto image = decode_image(bytes, "test", kLimits);
    if (raw) {
        EXPECT_LE(uint64_t(raw->width) * raw->height, kLimits.max_pixels);
    }
    if (image) {
        EXPECT_LE(uint64_t(image->width) * image->height, kLimits.max_pixels);
        EXPECT_EQ(image->pixels.size(), size_t(image->width) * image->height * image->channels.size());
    } else {
        EXPECT_FALSE(image.error().message.empty());
        EXPECT_EQ(image.error().where.file, "test");
    }
    return raw.ok() && image.ok();
}

TEST(Hostile, EveryTruncationIsRefused) {
    for (const auto& [name, bytes] : samples()) {
        EXPECT_EQ(decode_both(bytes), name != "deep exr") << name;
        for (size_t length = 0; length < bytes.size(); ++length)
            EXPECT_FALSE(decode_both(bytes.substr(0, length)))
                << name << " cut to " << length << " of " << bytes.size();
    }
}

TEST(Hostile, BitFlips) {
    std::mt19937 random(3);
    const int rounds = test::by_tier(1000, 20000);
    for (const auto& [name, bytes] : samples())
        for (int round = 0; round < rounds; ++round) {
            std::string bad = bytes;
            for (unsigned flips = 1 + random() % 3; flips-- > 0;) {
                const size_t bit = random() % (bad.size() * 8);
                bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ (1 << bit % 8));
            }
            (void)decode_both(bad);
        }
}

TEST(Hostile, ForeignFilesAreNamed) {
    for (const std::string& bytes : {std::string(), std::string("GIF89a........"), std::string(1000, '\0')}) {
        const auto image = decode_image(bytes, "x.png", {});
        ASSERT_FALSE(image);
        EXPECT_EQ(image.error().code, ErrorCode::bad_input);
        EXPECT_TRUE(image.error().str().starts_with("x.png")) << image.error().str();
    }
}

TEST(Hostile, SpecialFilesAreRefused) {
    const test::TemporaryFolder folder;
    EXPECT_FALSE(read_image(folder.file("missing.exr")));
    EXPECT_FALSE(read_image(folder.path().string()));
    EXPECT_FALSE(read_image("/dev/zero"));
    EXPECT_FALSE(read_texels("/dev/zero", {}));
    test::spit(folder.file("empty.exr"), "");
    EXPECT_NE(read_image(folder.file("empty.exr")).error().message.find("empty"), std::string::npos);
}

// --- Bombs: at most 512 MiB and 2 s, whatever a file of a few bytes claims. ---

int decode_in_child(const void* argument) {
    const auto& bytes = *static_cast<const std::string*>(argument);
    const bool texels = decode_texels(bytes, "bomb", {}).ok(), image = decode_image(bytes, "bomb", {}).ok();
    return texels || image ? 1 : 0;
}

void expect_cheap(const std::string& bytes, const std::string& name, bool may_decode = false) {
    const test::Cost cost = test::cost_of(decode_in_child, &bytes);
    EXPECT_GE(cost.exit_code, 0) << name;
    EXPECT_TRUE(may_decode || cost.exit_code == 0) << name;
#if !defined(STERADIAN_SANITIZED)
    EXPECT_LE(cost.peak_bytes, uint64_t(512) << 20) << name;
    EXPECT_LE(cost.seconds, 2.0) << name;
#endif
}

/// `bytes` with a number put over what stands at an offset.
template <class T>
std::string patched(std::string bytes, size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
    return bytes;
}

TEST(Bombs, Png) {
    // 60 kB of deflated zeros under headers that claim more and more, in every layout.
    const std::string rows(60'000'000, '\0');
    const std::string packed = test::png_file(65535, 65535, 16, 6, rows);
    EXPECT_LT(packed.size(), 64'000u);
    expect_cheap(packed, "65535²");
    expect_cheap(test::png_file(16384, 8192, 16, 6, rows), "as large as the limit");
    expect_cheap(test::png_file(0x7fffffff, 1, 1, 0, rows), "one row");
    expect_cheap(test::png_file(1, 0x7fffffff, 1, 0, rows), "one column");
    expect_cheap(test::png_file(7000, 8000, 8, 0, rows), "honest but expanded 1000 times", true);
    expect_cheap(test::png_file(20000, 20000, 1, 3, rows), "palette without a palette");
}

TEST(Bombs, PngChunks) {
    const std::string file = test::png_file(1, 1, 8, 0, std::string(2, '\0'));
    for (const char* type : {"tEXt", "zTXt", "iTXt", "iCCP", "sPLT", "pCAL", "sCAL", "eXIf", "IDAT", "PLTE"}) {
        std::string bad =
            file.substr(0, 8 + 25) + std::string("\x7f\xff\xff\xff", 4) + type + "k" + std::string(100, '\0');
        expect_cheap(bad, type);
    }
}

TEST(Bombs, PngText) {
    std::string head = test::png_file(1, 1, 8, 0, std::string(2, '\0'));
    const std::string zeros(4'000'000, '\0');
    const std::string inner = test::png_file(1, 1, 8, 0, zeros);  // borrow its deflate stream
    const size_t idat = inner.find("IDAT");
    const std::string stream = inner.substr(idat + 4, inner.find("IEND") - 4 - 4 - idat - 4);
    std::string chunks;
    for (int i = 0; i < 500; ++i) chunks += test::png_chunk("zTXt", std::string("k\0\0", 3) + stream);
    head.insert(8 + 25, chunks);
    expect_cheap(head, "500 × 4 MB of text", true);
}

TEST(Bombs, Jpeg) {
    std::vector<unsigned char> pixels(16 * 16, 7);
    const auto with_size = [](std::string bytes, uint16_t width, uint16_t height) {
        size_t frame = bytes.find("\xff\xc0");
        if (frame == std::string::npos) frame = bytes.find("\xff\xc2");
        const char size[] = {static_cast<char>(height >> 8), static_cast<char>(height), static_cast<char>(width >> 8),
                             static_cast<char>(width)};
        return bytes.replace(frame + 5, 4, size, 4);
    };
    const std::string baseline = test::jpeg_file(16, 16, 1, false, pixels),
                      progressive = test::jpeg_file(16, 16, 1, true, pixels);
    for (const auto& [width, height] :
         {std::pair<uint16_t, uint16_t>{65500, 65500}, {65500, 2000}, {11000, 11000}, {65500, 1}, {1, 65500}}) {
        expect_cheap(with_size(baseline, width, height), "baseline");
        expect_cheap(with_size(progressive, width, height), "progressive");
    }
}

TEST(Bombs, JpegScans) {
    // A progressive file whose last scan is repeated thousands of times: each costs a pass over the whole picture.
    std::vector<unsigned char> pixels(2000 * 2000, 7);
    std::string bytes = test::jpeg_file(2000, 2000, 1, true, pixels);
    const size_t last = bytes.rfind("\xff\xda");
    const std::string scan = bytes.substr(last, bytes.size() - 2 - last);
    for (int i = 0; i < 3000; ++i) bytes.insert(bytes.size() - 2, scan);
    expect_cheap(bytes, "3000 scans", true);
}

TEST(Bombs, Exr) {
    const std::string file = test::encoded(test::sample_image(9, 5), "a.exr");
    const size_t data = file.find(std::string("dataWindow\0box2i\0", 17)) + 17 + 4;
    const size_t display = file.find(std::string("displayWindow\0box2i\0", 20)) + 20 + 4;
    for (const auto& [width, height] : {std::pair<int32_t, int32_t>{65535, 65535},
                                        {10000, 10000},
                                        {1 << 26, 2},
                                        {2, 1 << 26},
                                        {0x7fffffff, 0x7fffffff},
                                        {-5, -5}}) {
        expect_cheap(patched(patched(file, data + 8, width - 1), data + 12, height - 1), "data window");
        expect_cheap(patched(patched(file, display + 8, width - 1), display + 12, height - 1), "display window");
    }
    // Attributes and offsets that claim gigabytes.
    for (const std::string& type : {std::string("\0chlist\0", 8), std::string("\0chromaticities\0", 16)})
        for (const int32_t size : {0x7ffffff0, 0x10000000, -1})
            expect_cheap(patched(file, file.rfind(type) + type.size(), size), type);
    // Attributes that say how long they are twice.
    for (const std::string& type : {std::string("stringvector"), std::string("preview"), std::string("chlist"),
                                    std::string("idmanifest"), std::string("string"), std::string("box2i")}) {
        const std::string attribute =
            "extra" + std::string(1, '\0') + type + std::string("\0\x08\0\0\0\xff\xff\xff\x7f\xff\xff\xff\x7f", 13);
        std::string bad = file;
        expect_cheap(bad.insert(8, attribute), type);
    }
    const std::string tiled = tiled_exr();
    const size_t tile = tiled.find(std::string("tiledesc\0", 9)) + 9 + 4;
    for (const uint32_t side : {0u, 1u, 60000u, 0x7fffffffu, 0xffffffffu}) {
        expect_cheap(patched(tiled, tile, side), "tile width", true);
        expect_cheap(patched(patched(tiled, tile, side), tile + 4, side), "tiles", true);
    }
}

TEST(Bombs, HdrAndPfm) {
    for (const char* size : {"-Y 65535 +X 65535", "-Y 11000 +X 11000", "-Y 1 +X 134217728", "-Y 134217728 +X 1",
                             "-Y 99999999999 +X 1", "-Y 0 +X 5"})
        expect_cheap(std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n") + size + "\n" + std::string(1000, '\1'),
                     size);
    // Old runs: each count is a further digit of base 256.
    expect_cheap("#?RADIANCE\n\n-Y 1 +X 100000000\n" + std::string("\x80\x80\x80\x80", 4) + std::string(4 * 100, '\1'),
                 "old runs");
    for (const char* size :
         {"65535 65535", "1 134217728", "134217728 1", "99999999999 1", "1e9 1e9", "-1 -1", "nan nan"})
        expect_cheap(std::string("PF\n") + size + "\n-1\n" + std::string(1000, '\1'), size);
}

}  // namespace
}  // namespace steradian
