#include "render/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>

#include "support/support.h"

namespace steradian {
namespace {

TileSums sums_of(size_t pixels, RgbSum value) {
    TileSums out(pixels, {});
    out.color.assign(pixels, value);
    return out;
}
TileSums sums_of(size_t pixels, double value) { return sums_of(pixels, RgbSum{value, 2 * value, 3 * value}); }

TEST(Film, TilesCoverTheWindowOnceOnAnAbsoluteGrid) {
    for (const uint32_t size : {1u, 7u, 16u, 256u}) {
        const Crop window{5, 9, 70, 41};
        const Film film(window, size);
        std::vector<int> covered(size_t(65) * 32, 0);
        for (size_t t = 0; t < film.tiles(); ++t) {
            const TileRect r = film.rect(t);
            EXPECT_EQ(r.x0 / size, (r.x1 - 1) / size);
            EXPECT_EQ(r.y0 / size, (r.y1 - 1) / size);
            for (uint32_t y = r.y0; y < r.y1; ++y)
                for (uint32_t x = r.x0; x < r.x1; ++x) ++covered.at((y - window.y0) * 65 + x - window.x0);
        }
        EXPECT_TRUE(std::all_of(covered.begin(), covered.end(), [](int n) { return n == 1; }));
    }
}

TEST(Film, TheOrderInWhichBlocksArriveDoesNotMatter) {
    // Values whose sum depends on the order of addition.
    std::vector<double> values;
    for (int b = 0; b < 40; ++b) values.push_back(b % 3 == 0 ? 1e16 : b % 3 == 1 ? 1.0 + b : -1e16);
    const auto picture = [&](const std::vector<int>& order) {
        Film film({0, 0, 4, 4}, 4);
        for (const int b : order) film.commit(0, uint64_t(b), kBlockSamples, sums_of(16, values[size_t(b)]));
        return film.develop().pixels;
    };
    std::vector<int> order(40);
    for (int b = 0; b < 40; ++b) order[size_t(b)] = b;
    const std::vector<float> expected = picture(order);
    std::mt19937 shuffle(7);
    for (int i = 0; i < 20; ++i) {
        std::shuffle(order.begin(), order.end(), shuffle);
        EXPECT_EQ(picture(order), expected);
    }
}

/// A picture that was stopped early is black where nothing is known, not nearest to the camera.
TEST(Film, ATileWithoutSamplesShowsNothing) {
    Film film({0, 0, 2, 1}, 1, AovSet{Aov::depth, Aov::samples});
    film.commit(0, 0, 64, TileSums(1, SumKinds(AovSet{Aov::depth, Aov::samples})));
    const Image image = film.develop();
    EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "Z", "samples.count"}));
    EXPECT_EQ(image.pixels, (std::vector<float>{0, 0, 0, 1e10f, 64, 0, 0, 0, 1e10f, 0}));
}

TEST(Film, ABlockThatIsFinishedEarlyIsHeldBack) {
    Film film({0, 0, 2, 1}, 16);
    film.commit(0, 1, 64, sums_of(2, 640));
    EXPECT_EQ(film.samples_per_pixel().max, 0u);
    EXPECT_EQ(film.develop().pixels, std::vector<float>(6, 0.0f));
    film.commit(0, 0, 64, sums_of(2, 64));
    EXPECT_EQ(film.samples_per_pixel().min, 128u);
    EXPECT_EQ(film.develop().pixels[0], 5.5f);
    film.commit(0, 2, 4, sums_of(2, 22));  // an open last block
    EXPECT_EQ(film.samples_per_pixel().min, 132u);
    EXPECT_EQ(film.develop().pixels[1], 11.0f);
}

TEST(Film, ABlockInPartsIsTheBlock) {
    // Values whose sum depends on the order of addition: 1e16 + 1 loses the 1.
    const double parts[] = {1, 1e16, 3, -1e16, 5};
    Film whole({0, 0, 2, 1}, 16), in_parts({0, 0, 2, 1}, 16);
    for (uint64_t block = 0; block < 3; ++block) {
        RgbSum sum;
        uint32_t done = 0;
        for (size_t i = 0; i < 5; ++i) {
            const uint32_t samples = i == 4 ? (block == 2 ? 1 : kBlockSamples - done) : 9;
            sum += RgbSum{parts[i], 2 * parts[i], 3 * parts[i]};
            TileSums sums = in_parts.open_sums(0);
            for (RgbSum& s : sums.color) s += RgbSum{parts[i], 2 * parts[i], 3 * parts[i]};
            in_parts.extend(0, samples, std::move(sums));
            done += samples;
        }
        whole.commit(0, block, done, sums_of(2, sum));
        EXPECT_EQ(in_parts.samples_per_pixel().max, whole.samples_per_pixel().max);
        EXPECT_EQ(in_parts.develop().pixels, whole.develop().pixels);
    }
}

TEST(Film, SnapshotsAreSafeWhileOthersCommit) {
    Film film({0, 0, 64, 64}, 16);
    std::thread writer([&] {
        for (uint64_t b = 0; b < 50; ++b)
            for (size_t t = 0; t < film.tiles(); ++t) film.commit(t, b, 64, sums_of(256, 64));
    });
    for (int i = 0; i < 20; ++i)
        for (const float v : film.develop().pixels) ASSERT_TRUE(v == 0 || v == 1 || v == 2 || v == 3) << v;
    writer.join();
}

// Recursive summation of n positive terms has a relative error below n·2⁻⁵³; here in two levels, 64 and n/64, so below
// (64 + n/64)·2⁻⁵³ = 1.7e-9 for n = 10⁹. The terms have no short binary fractions.
TEST(Film, SumsStayExactAtManySamples) {
    const uint64_t samples = test::run_everything() ? 1'000'000'000 : 64'000'000;
    const float values[4] = {0.1f, 1000.3f, 3.3e-5f, 17.77f};
    RgbSum block;
    for (uint32_t i = 0; i < kBlockSamples; ++i)
        block.add({values[i % 4], values[(i + 1) % 4], values[(i + 2) % 4]}, 1.0f);
    Film film({0, 0, 1, 1}, 1);
    for (uint64_t b = 0; b < samples / kBlockSamples; ++b) film.commit(0, b, kBlockSamples, sums_of(1, block));
    const double expected = (double(values[0]) + double(values[1]) + double(values[2]) + double(values[3])) / 4;
    EXPECT_EQ(film.samples_per_pixel().min, samples);
    const Image image = film.develop();
    for (int c = 0; c < 3; ++c) EXPECT_EQ(image.pixels[size_t(c)], static_cast<float>(expected));
}

}  // namespace
}  // namespace steradian
