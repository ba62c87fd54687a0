// Outside collections of files, where they are there.
#include <gtest/gtest.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "image/decode.h"
#include "steradian/image_io.h"
#include "support/support.h"

namespace steradian {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& folder, const std::string& extension) {
    std::vector<fs::path> out;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().extension() == extension) out.push_back(entry.path());
    std::sort(out.begin(), out.end());
    return out;
}

/// The part of the collection, or nothing when it is not on this machine.
std::optional<fs::path> suite(const std::string& name) {
    const auto shared = test::shared_folder();
    if (!shared || !fs::is_directory(*shared / "suites" / name)) return std::nullopt;
    return *shared / "suites" / name;
}

TEST(LibpngSuite, ValidFilesDecode) {
    const auto folder = suite("libpng_testpngs");
    if (!folder) GTEST_SKIP() << "libpng_testpngs is not here";
    size_t twins = 0;
    const auto paths = files_in(*folder, ".png");
    EXPECT_GE(paths.size(), 100u);
    for (const fs::path& path : paths) {
        const auto raw = read_texels(path.string(), {});
        ASSERT_TRUE(raw) << raw.error().str();
        const std::string name = path.filename().string();
        const bool grey = name.starts_with("gray");
        // By the chunk, not by the name: some of 16 bits are named so without having it.
        const bool alpha = name.find("alpha") != name.npos || test::slurp(path).find("tRNS") != name.npos;
        if (!name.starts_with("ch")) {
            EXPECT_EQ(raw->channels, (grey ? 1 : 3) + alpha) << name;
        }
        EXPECT_EQ(raw->format, name.find("-16") != name.npos ? TexelFormat::u16 : TexelFormat::u8) << name;
        EXPECT_TRUE(read_image(path.string())) << name;
        // The same texels under another statement of their gamma are the same texels.
        for (const char* gamma : {"-1.8", "-linear", "-sRGB"}) {
            const size_t at = name.find(gamma);
            if (at == name.npos) continue;
            const fs::path twin = *folder / (name.substr(0, at) + name.substr(at + std::strlen(gamma)));
            const auto other = read_texels(twin.string(), {});
            ASSERT_TRUE(other) << twin;
            EXPECT_EQ(other->channels, raw->channels) << name;
            twins += other->data == raw->data;
        }
    }
    std::printf("%zu files, %zu of them with the same texels as their twin\n", paths.size(), twins);
}

TEST(LibpngSuite, BadFilesAreRefusedOrDecoded) {
    const auto folder = suite("libpng_testpngs");
    if (!folder) GTEST_SKIP() << "libpng_testpngs is not here";
    size_t refused = 0, all = 0;
    for (const char* part : {"crashers", "badpal", "png-3"})
        for (const fs::path& path : files_in(*folder / part, ".png")) {
            const auto raw = read_texels(path.string(), {});
            EXPECT_TRUE(raw || !raw.error().message.empty()) << path;
            refused += !raw;
            ++all;
        }
    for (const char* name : {"badcrc", "badadler", "huge_IDAT"})
        EXPECT_FALSE(read_texels((*folder / "crashers" / name).string() + ".png", {})) << name;
    std::printf("%zu of %zu refused\n", refused, all);
}

/// Bounds from the bytes of an attribute "name\0box2i\0" of an EXR file: x0, y0, x1, y1.
std::array<int32_t, 4> window_of(const std::string& bytes, const std::string& name) {
    const std::string key = name + std::string("\0box2i\0", 7);
    const size_t at = bytes.find(key);
    std::array<int32_t, 4> out{};
    if (at == bytes.npos) throw std::runtime_error("no " + name);
    std::memcpy(out.data(), bytes.data() + at + key.size() + 4, sizeof out);
    return out;
}

TEST(OpenExrSuite, DisplayWindows) {
    const auto folder = suite("openexr_images");
    if (!folder) GTEST_SKIP() << "openexr_images is not here";
    const auto paths = files_in(*folder / "DisplayWindow", ".exr");
    EXPECT_EQ(paths.size(), 16u);
    for (const fs::path& path : paths) {
        const std::string bytes = test::slurp(path);
        const auto display = window_of(bytes, "displayWindow"), data = window_of(bytes, "dataWindow");
        const auto raw = decode_texels(bytes, path.string(), {});
        const auto image = decode_image(bytes, path.string(), {});
        ASSERT_TRUE(raw) << raw.error().str();
        ASSERT_TRUE(image) << image.error().str();
        ASSERT_EQ(image->width, static_cast<uint32_t>(display[2] - display[0] + 1)) << path;
        ASSERT_EQ(image->height, static_cast<uint32_t>(display[3] - display[1] + 1)) << path;
        ASSERT_EQ(raw->format, TexelFormat::f16);
        for (int64_t y = display[1]; y <= display[3]; ++y)
            for (int64_t x = display[0]; x <= display[2]; ++x) {
                const bool in = x >= data[0] && x <= data[2] && y >= data[1] && y <= data[3];
                const float shown =
                    image->pixels[static_cast<size_t>((y - display[1]) * image->width + x - display[0]) *
                                  image->channels.size()];
                if (!in) {
                    ASSERT_EQ(shown, 0.0f) << path;
                } else {
                    half value;
                    std::memcpy(&value,
                                raw->data.data() +
                                    static_cast<size_t>((y - data[1]) * raw->width + x - data[0]) * raw->channels * 2,
                                2);
                    ASSERT_EQ(shown, static_cast<float>(value)) << path;
                }
            }
    }
}

TEST(OpenExrSuite, UnusualPixels) {
    const auto folder = suite("openexr_images");
    if (!folder) GTEST_SKIP() << "openexr_images is not here";
    size_t decoded = 0;
    for (const fs::path& path : files_in(*folder / "TestImages", ".exr")) {
        const auto image = read_image(path.string());
        EXPECT_TRUE(image) << image.error().str();
        decoded += image.ok();
        EXPECT_TRUE(read_texels(path.string(), {})) << path;
    }
    EXPECT_GE(decoded, 11u);

    // Every half there is comes through, the ones that are no numbers too.
    const auto all = read_texels((*folder / "TestImages" / "AllHalfValues.exr").string(), {});
    ASSERT_TRUE(all);
    std::vector<bool> seen(65536);
    for (size_t i = 0; i + 1 < all->data.size(); i += 2) {
        uint16_t bits;
        std::memcpy(&bits, all->data.data() + i, 2);
        seen[bits] = true;
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 65536);

    const auto rings = read_image((*folder / "TestImages" / "BrightRings.exr").string());
    const auto broken = read_image((*folder / "TestImages" / "BrightRingsNanInf.exr").string());
    ASSERT_TRUE(rings && broken);
    const auto bad = [](const Image& image) {
        return std::count_if(image.pixels.begin(), image.pixels.end(), [](float v) { return !std::isfinite(v); });
    };
    EXPECT_EQ(bad(*rings), 0);
    EXPECT_GT(bad(*broken), 0) << "kept, for whoever uses the picture to deal with";
}

}  // namespace
}  // namespace steradian
